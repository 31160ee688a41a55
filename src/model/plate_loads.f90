!> Loads of the plate at its points: pressure and lines, constant in a run.
module plate_loads
  use kinds, only: wp
  use placed_lines, only: placed_line_t
  implicit none
  private
  public :: plate_loads_t

  !> Pressure and lines.
  type :: plate_loads_t
    !> Nodal forces of the deck's pressure, (5, local points); ghosts zero. Allocated only with a pressure
    real(wp), allocatable :: pressure(:, :)
    !> Lines; empty: none
    type(placed_line_t), allocatable :: lines(:)
  contains
    procedure :: line_forces
    procedure :: add_holding_lines
    procedure :: static_loads
    procedure :: load_slopes
  end type plate_loads_t

contains

  !> Nodal forces of the lines at the owned points, of all of them or of those that are prescribed or not.
  pure subroutine line_forces(self, displacement, load_factor, forces, prescribed)
    class(plate_loads_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(in) :: load_factor
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: forces(:, :)
    !> True: prescribed lines only, false: the others; absent: all
    logical, intent(in), optional :: prescribed
    integer :: i

    forces = 0
    do i = 1, size(self%lines)
      if (present(prescribed)) then
        if (self%lines(i)%load%prescribed .neqv. prescribed) cycle
      end if
      call self%lines(i)%add_forces(displacement, load_factor, forces)
    end do
  end subroutine line_forces

  !> Adds the nodal forces that hold prescribed lines at zero displacement.
  pure subroutine add_holding_lines(self, displacement, forces)
    class(plate_loads_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    !> Forces on the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%lines)
      call self%lines(i)%add_holding_forces(displacement, forces)
    end do
  end subroutine add_holding_lines

  !> Nodal loads of a static analysis: pressure and lines, at the owned points.
  pure subroutine static_loads(self, displacement, load_factor, loads)
    class(plate_loads_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(in) :: load_factor
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: loads(:, :)

    call self%line_forces(displacement, load_factor, loads)
    if (allocated(self%pressure)) loads = loads + load_factor*self%pressure
  end subroutine static_loads

  !> Change of these loads with the load factor.
  pure subroutine load_slopes(self, loads)
    class(plate_loads_t), intent(in) :: self
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: loads(:, :)
    integer :: i

    loads = 0
    if (allocated(self%pressure)) loads = self%pressure
    do i = 1, size(self%lines)
      call self%lines(i)%add_slopes(loads)
    end do
  end subroutine load_slopes
end module plate_loads
