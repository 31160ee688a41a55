!> Changes on the diagonal of a factored operator without a new factorisation (Woodbury's identity):
!> a jump released or a contact closed or opened costs one solve, once.
module operator_changes
  use kinds, only: wp
  use communicators, only: communicator_t
  use dense_systems, only: dense_factor_t
  use numberings, only: numbering_t
  implicit none
  private
  public :: operator_changes_t, list_changes

  !> Part of a stiffness below which its change is left to the iterations: a law whose slope falls off
  !> exponentially goes to and fro without end where 0.2 of it is.
  real(wp), parameter :: noticed = 0.01_wp

  !> Solution of the factored operator for a unit force on one unknown.
  type :: column_t
    !> Equation of the unknown, from 0
    integer :: equation = -1
    !> Number of columns found together with this one: a restart finds them in the same company, since solvers
    !> round differently for different numbers of right-hand sides
    integer :: company = 0
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
    !> How many there are
    integer :: kept = 0
    !> Column of each change
    integer, allocatable :: column(:)
    !> System of the changes
    type(dense_factor_t), private :: system
  contains
    !> Forgets everything, after a factorisation.
    procedure :: clear
    !> True if changes are those already in force, or nearly so.
    procedure :: same
    !> Position of the column of an equation; 0: not found yet.
    procedure :: column_of
    !> Keeps a column.
    procedure :: keep
    !> Equation and company of each column kept.
    procedure :: list
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
    self%kept = 0
  end subroutine clear

  !> True if changes are those already in force, or nearly so.
  pure logical function same(self, equations, stiffness)
    !> The changes in force
    class(operator_changes_t), intent(in) :: self
    !> Equations wanted
    integer, intent(in) :: equations(:)
    !> Stiffness wanted
    real(wp), intent(in) :: stiffness(:)

    same = size(equations) == size(self%equations)
    if (same) same = all(equations == self%equations) .and. &
      all(abs(stiffness - self%stiffness) <= noticed*abs(stiffness))
  end function same

  !> Lists the jumps whose added stiffness has changed much since the factorisation, on every rank.
  subroutine list_changes(communicator, numbering, diagonal, have, want, equations, stiffness)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Diagonal of the operator, (5, points)
    real(wp), intent(in) :: diagonal(:, :)
    !> Stiffness added to the jumps when factored and wanted now, (3, points)
    real(wp), intent(in) :: have(:, :), want(:, :)
    !> Equations, ascending
    integer, allocatable, intent(out) :: equations(:)
    !> Change of stiffness
    real(wp), allocatable, intent(out) :: stiffness(:)
    logical, allocatable :: changed(:, :)

    associate (owned => numbering%owned)
      changed = .not. abs(want(:, :owned) - have(:, :owned)) <= noticed*max(want(:, :owned), have(:, :owned), &
                                                                          0.1_wp*diagonal(1:3, :owned)) &
                .and. numbering%equation(1:3, :owned) >= 0
      call communicator%allgather(pack(numbering%equation(1:3, :owned), changed), equations)
      call communicator%allgather(pack(want(:, :owned) - have(:, :owned), changed), stiffness)
    end associate
  end subroutine list_changes

  !> Position of the column of an equation; 0: not found yet.
  pure integer function column_of(self, equation) result(position)
    !> The changes
    class(operator_changes_t), intent(in) :: self
    !> The equation
    integer, intent(in) :: equation

    do position = self%kept, 1, -1
      if (self%columns(position)%equation == equation) return
    end do
  end function column_of

  !> Keeps a column.
  pure subroutine keep(self, equation, company, field)
    !> The changes
    class(operator_changes_t), intent(inout) :: self
    !> The equation
    integer, intent(in) :: equation
    !> Number of columns found together
    integer, intent(in) :: company
    !> Solution for a unit force on it, (5, points)
    real(wp), intent(in) :: field(:, :)
    type(column_t), allocatable :: more(:)
    integer :: k

    self%kept = self%kept + 1
    if (self%kept > size(self%columns)) then
      allocate (more(2*self%kept))
      do k = 1, self%kept - 1
        more(k)%equation = self%columns(k)%equation
        more(k)%company = self%columns(k)%company
        call move_alloc(self%columns(k)%field, more(k)%field)
      end do
      call move_alloc(more, self%columns)
    end if
    self%columns(self%kept)%equation = equation
    self%columns(self%kept)%company = company
    self%columns(self%kept)%field = field
  end subroutine keep

  !> Equation and company of each column kept.
  pure function list(self) result(columns)
    !> The changes
    class(operator_changes_t), intent(in) :: self
    !> Equation and company in turn, (2 columns)
    integer, allocatable :: columns(:)
    integer :: k

    columns = [([self%columns(k)%equation, self%columns(k)%company], k=1, self%kept)]
  end function list

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
    real(wp), allocatable :: matrix(:, :)
    integer :: k

    self%equations = equations
    self%stiffness = stiffness
    self%column = [(self%column_of(equations(k)), k=1, size(equations))]
    allocate (matrix(size(equations), size(equations)))
    do k = 1, size(equations)
      matrix(:, k) = values_at(numbering, equations, self%columns(self%column(k))%field)
      call communicator%sum(matrix(:, k))
      matrix(k, k) = matrix(k, k) + 1/stiffness(k)
    end do
    call self%system%factorize(matrix)
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
    integer :: k

    if (size(self%equations) == 0 .or. self%system%singular) return
    forces = values_at(numbering, self%equations, solution)
    call communicator%sum(forces)
    call self%system%solve(forces)
    do k = 1, size(forces)
      solution = solution - forces(k)*self%columns(self%column(k))%field
    end do
  end subroutine correct

  !> Values of a field at those of some equations that this rank owns, zero at the others.
  pure function values_at(numbering, equations, field) result(values)
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
  end function values_at
end module operator_changes
