!> Changes on the diagonal of a factored operator without a new factorisation (Woodbury's identity):
!> a jump released or a contact closed or opened costs one solve, once.
module operator_changes
  use kinds, only: wp
  use communicators, only: communicator_t
  use dense_systems, only: solve_dense
  use numberings, only: numbering_t
  implicit none
  private
  public :: operator_changes_t

  !> Solution of the factored operator for a unit force on one unknown.
  type :: column_t
    !> Equation of the unknown, from 0
    integer :: equation = -1
    !> The solution, (5, points)
    real(wp), allocatable :: field(:, :)
  end type column_t

  !> The changes in force, and the columns found so far.
  type :: operator_changes_t
    !> Equations changed, ascending, and what is added to their diagonals
    integer, allocatable :: equations(:)
    !> Stiffness added to the diagonals of these equations
    real(wp), allocatable :: stiffness(:)
    !> Columns found since the factorisation
    type(column_t), allocatable :: columns(:)
    !> Column of each change
    integer, allocatable :: column(:)
    !> System of the changes
    real(wp), allocatable :: matrix(:, :)
  contains
    !> Forgets everything, after a factorisation.
    procedure :: clear
    !> Position of the column of an equation; 0: not found yet.
    procedure :: column_of
    !> Keeps a column.
    procedure :: keep
    !> Puts changes in force whose columns are all kept.
    procedure :: set
    !> Turns a solution of the factored operator into one of the changed operator.
    procedure :: correct
  end type operator_changes_t

contains

  !> Forgets everything, after a factorisation.
  pure subroutine clear(self)
    !> The changes
    class(operator_changes_t), intent(inout) :: self

    self%equations = [integer ::]
    self%stiffness = [real(wp) ::]
    self%column = [integer ::]
    if (allocated(self%columns)) deallocate (self%columns)
    allocate (self%columns(0))
    self%matrix = reshape([real(wp) ::], [0, 0])
  end subroutine clear

  !> Position of the column of an equation; 0: not found yet.
  pure integer function column_of(self, equation) result(position)
    !> The changes
    class(operator_changes_t), intent(in) :: self
    !> The equation
    integer, intent(in) :: equation

    do position = size(self%columns), 1, -1
      if (self%columns(position)%equation == equation) return
    end do
  end function column_of

  !> Keeps a column.
  pure subroutine keep(self, equation, field)
    !> The changes
    class(operator_changes_t), intent(inout) :: self
    !> The equation
    integer, intent(in) :: equation
    !> Solution for a unit force on it, (5, points)
    real(wp), intent(in) :: field(:, :)

    self%columns = [self%columns, column_t(equation, field)]
  end subroutine keep

  !> Puts changes in force whose columns are all kept.
  subroutine set(self, communicator, numbering, equations, stiffness)
    !> The changes
    class(operator_changes_t), intent(inout) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Equations changed, the same on every rank, ascending
    integer, intent(in) :: equations(:)
    !> Stiffness added to their diagonals, none zero
    real(wp), intent(in) :: stiffness(:)
    integer :: k

    self%equations = equations
    self%stiffness = stiffness
    self%column = [(self%column_of(equations(k)), k=1, size(equations))]
    self%matrix = reshape(spread(0.0_wp, 1, size(equations)**2), [size(equations), size(equations)])
    do k = 1, size(equations)
      self%matrix(:, k) = values_at(communicator, numbering, equations, self%columns(self%column(k))%field)
      self%matrix(k, k) = self%matrix(k, k) + 1/stiffness(k)
    end do
  end subroutine set

  !> Turns a solution of the factored operator into one of the changed operator.
  subroutine correct(self, communicator, numbering, solution)
    !> The changes
    class(operator_changes_t), intent(in) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    real(wp) :: forces(size(self%equations))
    logical :: singular
    integer :: k

    if (size(self%equations) == 0) return
    forces = values_at(communicator, numbering, self%equations, solution)
    call solve_dense(self%matrix, forces, singular)
    if (singular) return
    do k = 1, size(forces)
      solution = solution - forces(k)*self%columns(self%column(k))%field
    end do
  end subroutine correct

  !> Values of a field at some equations, the same on every rank.
  function values_at(communicator, numbering, equations, field) result(values)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> The equations, ascending
    integer, intent(in) :: equations(:)
    !> The field, (5, points)
    real(wp), intent(in) :: field(:, :)
    !> Values
    real(wp) :: values(size(equations))
    integer :: k, point, component

    values = 0
    do k = 1, size(equations)
      if (.not. numbering%owns(equations(k))) cycle
      call numbering%place_of(equations(k), point, component)
      values(k) = field(component, point)
    end do
    call communicator%sum(values)
  end function values_at
end module operator_changes
