!> Equilibrium of a few cohesive points on a linear plate: the small dense system that is left when every other unknown
!> is eliminated by the factored operator.
!>
!> A force q on the jumps moves them by C q, with C the operator's answers to unit forces. With the operator's own
!> stiffness D of a jump the force that mends it is q = D x - (t(j + x) - t(j)), so the change x of the jumps solves
!> C^-1 (x - x_free) - D x + t(j + x) - t(j) = 0: softening points are met exactly, however many pass their onset.
module condensed_points
  use kinds, only: wp
  use outside_forces, only: outside_force_t
  use softening_points, only: softening_point_t
  use softening_systems, only: softening_system_t
  implicit none
  private
  public :: condensed_point_t, condensed_points_t

  !> Forces left over those at the strength of a point: far below any tolerance of equilibrium. With 1e-7 a tolerance of
  !> 1e-9 of all forces is asked for at a point that counts as settled, and the iteration stands still.
  real(wp), parameter :: settled = 1.0e-10_wp

  !> A cohesive point of the system; the stiffness that the operator has of its jumps is told by unknown.
  type, extends(softening_point_t) :: condensed_point_t
    !> Change of those jumps that are no unknowns here
    real(wp) :: drift(3) = 0
    !> Unknown of each jump; 0: none
    integer :: unknown(3) = 0
  end type condensed_point_t

  !> The system. Its last unknown is the motion under a force from outside, if there is one.
  type, extends(softening_system_t) :: condensed_points_t
    !> The points
    type(condensed_point_t), allocatable :: points(:)
    !> Stiffness of each unknown in the operator, less what ties and contacts have added since: (unknowns)
    real(wp), allocatable :: held(:)
    !> Inverse of the operator's answers to unit forces, (unknowns, unknowns)
    real(wp), allocatable :: stiffness(:, :)
    !> Change of the unknowns by the operator alone, (unknowns)
    real(wp), allocatable :: free(:)
    !> What the points hold beyond what the operator takes for it, less the force from outside, (unknowns)
    real(wp), allocatable :: forces(:)
    !> Change of the force from outside, and its slope
    real(wp), private :: load = 0, slope = 0
  contains
    !> Change of the jumps at equilibrium.
    procedure :: solve
    !> What Newton's method asks for.
    procedure :: find_force
    procedure :: find_tangent
    procedure :: is_settled
  end type condensed_points_t

contains

  !> Change of the jumps at equilibrium.
  subroutine solve(self, outside, change)
    !> The system
    class(condensed_points_t), intent(inout) :: self
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, target, intent(inout) :: outside
    !> First guess on entry, solution on return, (unknowns)
    real(wp), intent(inout) :: change(:)

    if (allocated(outside)) self%outside => outside
    call self%bring_into_balance(change)
    self%outside => null()
  end subroutine solve

  !> Force out of balance: what the operator answers with, and the change of the forces that hold the points less what
  !> the operator takes for it, t(j + x) - t(j) - D x, less the change of the force from outside.
  subroutine find_force(self, x, force)
    !> The system; receives the latter
    class(condensed_points_t), intent(inout) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: x(:)
    !> Force, (unknowns)
    real(wp), intent(out) :: force(:)
    real(wp) :: holding(3)
    integer :: i, k

    self%forces = -self%held*x
    do i = 1, size(self%points)
      associate (point => self%points(i))
        holding = point%force(change_of(point, x))
        do k = 1, 3
          if (point%unknown(k) > 0) self%forces(point%unknown(k)) = self%forces(point%unknown(k)) + holding(k)
        end do
      end associate
    end do
    self%load = 0
    self%slope = 0
    if (associated(self%outside)) then
      call self%outside%at(x(size(x)), self%load, self%slope)
      self%forces(size(x)) = self%forces(size(x)) - self%load
    end if
    force = matmul(self%stiffness, x - self%free) + self%forces
  end subroutine find_force

  !> Tangent of the system.
  subroutine find_tangent(self, x, kind, matrix)
    !> The system
    class(condensed_points_t), intent(in) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: x(:)
    !> Which of the points' derivatives: slopes_true, slopes_rising or slopes_secant
    integer, intent(in) :: kind
    !> The matrix, (unknowns, unknowns)
    real(wp), allocatable, intent(out) :: matrix(:, :)
    real(wp) :: slopes(3, 3)
    integer :: i, k, l

    matrix = self%stiffness
    do i = 1, size(self%held)
      matrix(i, i) = matrix(i, i) - self%held(i)
    end do
    matrix(size(x), size(x)) = matrix(size(x), size(x)) - self%slope
    do i = 1, size(self%points)
      associate (point => self%points(i), place => self%points(i)%unknown)
        slopes = point%excess(change_of(point, x), kind)
        do k = 1, 3
          do l = 1, 3
            if (place(k) > 0 .and. place(l) > 0) matrix(place(k), place(l)) = matrix(place(k), place(l)) + slopes(k, l)
          end do
        end do
      end associate
    end do
  end subroutine find_tangent

  !> True if the forces left are far below those at the strength of each point.
  pure logical function is_settled(self, force)
    !> The system
    class(condensed_points_t), intent(in) :: self
    !> The force, (unknowns)
    real(wp), intent(in) :: force(:)

    is_settled = all(abs(force) <= settled*max(force_scale(self), abs(self%load)))
  end function is_settled

  !> Change of a point's jumps with a change of the unknowns.
  pure function change_of(point, x) result(change)
    !> The point
    type(condensed_point_t), intent(in) :: point
    !> Change of the unknowns
    real(wp), intent(in) :: x(:)
    !> Of two shears and opening
    real(wp) :: change(3)
    integer :: k

    change = point%drift
    do k = 1, 3
      if (point%unknown(k) > 0) change(k) = x(point%unknown(k))
    end do
  end function change_of

  !> Force of each unknown at the strength of its point, that of all of them for ties, contacts and the force from
  !> outside.
  pure function force_scale(self) result(scale)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Force, (unknowns)
    real(wp) :: scale(size(self%held))
    integer :: i, k

    scale = 0
    do i = 1, size(self%points)
      associate (point => self%points(i))
        do k = 1, 3
          if (point%unknown(k) > 0) &
            scale(point%unknown(k)) = point%area*min(point%faces%law%strength_shear, point%faces%law%strength_opening)
        end do
      end associate
    end do
    where (.not. scale > 0) scale = sum(scale)
  end function force_scale
end module condensed_points
