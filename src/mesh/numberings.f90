!> Equations: one for every unknown that is not held, numbered rank by rank, and the pattern of the
!> matrix that couples them. Renewed as a whole when unknowns are released.
module numberings
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use distributions, only: distribution_t
  use matrix_patterns, only: find_pattern
  implicit none
  private
  public :: numbering_t, number_equations

  !> Equation numbers and the rows of this rank.
  type :: numbering_t
    !> Equation (from 0) of each unknown of this rank's points, ghosts too; -1: held, (5, local points)
    integer, allocatable :: equation(:, :)
    !> First row of this rank, its rows, and all rows
    integer :: first_row = 0, rows = 0, total = 0
    !> Points that this rank owns
    integer :: owned = 0
    !> Pattern of this rank's rows: start of each row (from 1) and columns (from 0, ascending)
    integer, allocatable :: row_start(:), columns(:)
    !> Point and component of each row of this rank, (2, rows)
    integer, allocatable, private :: places(:, :)
  contains
    !> True if this rank has an equation.
    procedure :: owns
    !> Point and component of an equation of this rank.
    procedure :: place_of
    !> Copies between fields over points and vectors of this rank's rows.
    procedure :: gather
    procedure :: scatter
  end type numbering_t

contains

  !> Numbers the unknowns that are not held and finds the pattern of this rank's rows.
  subroutine number_equations(mesh, distribution, held, self)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Owners of the points
    type(distribution_t), intent(in) :: distribution
    !> Held unknowns of every point of the mesh, (5, points)
    logical, intent(in) :: held(:, :)
    !> The numbering
    type(numbering_t), intent(out) :: self
    integer :: equation(5, mesh%points())

    call number_all(distribution, held, equation)
    self%total = count(.not. held)
    self%owned = distribution%owned
    self%rows = count(.not. held(:, distribution%points(:distribution%owned)))
    self%first_row = first_row_of(equation, distribution)
    self%equation = equation(:, distribution%points)
    call find_places(self)
    call find_pattern(mesh, equation, mesh%point_node(distribution%points(self%places(1, :))), &
                      self%row_start, self%columns)
  end subroutine number_equations

  !> Point and component of each row.
  pure subroutine find_places(self)
    !> The numbering
    type(numbering_t), intent(inout) :: self
    integer :: point, component

    allocate (self%places(2, self%rows))
    do point = 1, self%owned
      do component = 1, 5
        if (self%equation(component, point) < 0) cycle
        self%places(:, self%equation(component, point) - self%first_row + 1) = [point, component]
      end do
    end do
  end subroutine find_places

  !> True if this rank has an equation.
  pure logical function owns(self, equation)
    !> The numbering
    class(numbering_t), intent(in) :: self
    !> Equation, from 0
    integer, intent(in) :: equation

    owns = equation >= self%first_row .and. equation < self%first_row + self%rows
  end function owns

  !> Point and component of an equation of this rank.
  pure subroutine place_of(self, equation, point, component)
    !> The numbering
    class(numbering_t), intent(in) :: self
    !> Equation, from 0
    integer, intent(in) :: equation
    !> Position of the point among this rank's, and component, 1 to 5
    integer, intent(out) :: point, component

    point = self%places(1, equation - self%first_row + 1)
    component = self%places(2, equation - self%first_row + 1)
  end subroutine place_of

  !> Equation numbers of every point of the mesh, in rank order.
  subroutine number_all(distribution, held, equation)
    !> Rank order of the points
    type(distribution_t), intent(in) :: distribution
    !> Held unknowns
    logical, intent(in) :: held(:, :)
    !> Equations, from 0; -1: held
    integer, intent(out) :: equation(:, :)
    integer :: in_order(size(held, 2)), place, component, next

    in_order(distribution%number + 1) = [(place, place=1, size(in_order))]
    next = 0
    equation = -1
    do place = 1, size(in_order)
      do component = 1, 5
        if (held(component, in_order(place))) cycle
        equation(component, in_order(place)) = next
        next = next + 1
      end do
    end do
  end subroutine number_all

  !> Number of rows before this rank's.
  pure integer function first_row_of(equation, distribution) result(first)
    !> Equations of every point
    integer, intent(in) :: equation(:, :)
    !> Owners
    type(distribution_t), intent(in) :: distribution
    integer :: point, start

    start = huge(1)
    if (size(distribution%points) > 0) start = distribution%number(distribution%points(1))
    first = 0
    do point = 1, size(equation, 2)
      if (distribution%number(point) < start) first = first + count(equation(:, point) >= 0)
    end do
  end function first_row_of

  !> Rows of this rank from a field over its points.
  pure subroutine gather(self, field, vector)
    !> The numbering
    class(numbering_t), intent(in) :: self
    !> (5, local points)
    real(wp), intent(in) :: field(:, :)
    !> (rows)
    real(wp), intent(out) :: vector(:)
    integer :: point, component, row

    row = 0
    do point = 1, self%owned
      do component = 1, 5
        if (self%equation(component, point) < 0) cycle
        row = row + 1
        vector(row) = field(component, point)
      end do
    end do
  end subroutine gather

  !> Field over the owned points from the rows of this rank; held unknowns become zero, ghosts are left alone.
  pure subroutine scatter(self, vector, field)
    !> The numbering
    class(numbering_t), intent(in) :: self
    !> (rows)
    real(wp), intent(in) :: vector(:)
    !> (5, local points)
    real(wp), intent(inout) :: field(:, :)
    integer :: point, component, row

    row = 0
    do point = 1, self%owned
      do component = 1, 5
        if (self%equation(component, point) < 0) then
          field(component, point) = 0
        else
          row = row + 1
          field(component, point) = vector(row)
        end if
      end do
    end do
  end subroutine scatter
end module numberings
