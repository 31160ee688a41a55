!> Changes on the diagonal of a factored operator without a new factorization (Woodbury's identity):
!> a jump released or a contact closed or opened costs one solve, once.
module woodbury_updates
  use kinds, only: wp
  use communicators, only: communicator_t
  use dense_systems, only: dense_factor_t, positive_factor_t
  use numberings, only: numbering_t
  implicit none
  private
  public :: woodbury_updates_t, list_changes, gather_changes

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
  type :: woodbury_updates_t
    !> Equations changed, ascending, and what is added to their diagonals
    integer, allocatable :: equations(:)
    !> Stiffness added to the diagonals of these equations
    real(wp), allocatable :: stiffness(:)
    !> Columns found since the factorization
    type(column_t), allocatable :: columns(:)
    !> How many there are
    integer :: kept = 0
    !> Value of each of them at the equations of all, (kept, kept)
    real(wp), allocatable, private :: compliance(:, :)
    !> Stiffness of the columns; unallocated: not asked for since the last column
    real(wp), allocatable, private :: inverse(:, :)
    !> Column of each change
    integer, allocatable :: column(:)
    !> System of the changes
    type(dense_factor_t), private :: system
  contains
    !> Forgets everything, after a factorization.
    procedure :: clear
    !> True if changes are those already in force, or nearly so.
    procedure :: same
    !> Position of the column of an equation; 0: not found yet.
    procedure :: column_of
    !> Keeps columns found together.
    procedure :: keep
    !> Equation and company of each column kept.
    procedure :: list
    !> The changes in force as a field.
    procedure :: spread_out
    !> Puts changes in force whose columns are all kept.
    procedure :: set
    !> Turns a solution of the factored operator into one of the changed operator.
    procedure :: correct
    !> Adds a combination of columns to a solution.
    procedure :: combine
    !> Values of a field at the equations of the columns.
    procedure :: values => values_at_columns
    !> Stiffness of the factored operator against motions of the columns' unknowns.
    procedure :: stiffness_of_columns
  end type woodbury_updates_t

contains

  !> Forgets everything, after a factorization.
  pure subroutine clear(self)
    !> The changes
    class(woodbury_updates_t), intent(inout) :: self

    self%equations = [integer ::]
    self%stiffness = [real(wp) ::]
    self%column = [integer ::]
    self%compliance = reshape([real(wp) ::], [0, 0])
    if (allocated(self%columns)) deallocate (self%columns)
    allocate (self%columns(0))
    self%kept = 0
    if (allocated(self%inverse)) deallocate (self%inverse)
  end subroutine clear

  !> True if changes are those already in force, or nearly so.
  pure logical function same(self, equations, stiffness)
    !> The changes in force
    class(woodbury_updates_t), intent(in) :: self
    !> Equations wanted
    integer, intent(in) :: equations(:)
    !> Stiffness wanted
    real(wp), intent(in) :: stiffness(:)

    same = size(equations) == size(self%equations)
    if (same) same = all(equations == self%equations) .and. &
      all(abs(stiffness - self%stiffness) <= noticed*abs(stiffness))
  end function same

  !> Lists the jumps whose added stiffness has changed much since the factorization, on every rank.
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
      call gather_changes(communicator, numbering, merge(want(:, :owned) - have(:, :owned), 0.0_wp, changed), &
                          equations, stiffness)
    end associate
  end subroutine list_changes

  !> Lists changes of the jumps' stiffness, those that are not zero, on every rank. Points that follow add theirs to
  !> those of their leaders.
  subroutine gather_changes(communicator, numbering, change, equations, stiffness)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Change of stiffness, (3, owned points)
    real(wp), intent(in) :: change(:, :)
    !> Equations, ascending
    integer, allocatable, intent(out) :: equations(:)
    !> Change of stiffness of each
    real(wp), allocatable, intent(out) :: stiffness(:)
    real(wp) :: total(3, size(change, 2))
    logical, allocatable :: changed(:, :)
    integer :: point

    total = change
    do point = 1, size(total, 2)
      if (numbering%leader(point) == 0) cycle
      total(:, numbering%leader(point)) = total(:, numbering%leader(point)) + total(:, point)
      total(:, point) = 0
    end do
    changed = .not. abs(total) <= 0
    call communicator%allgather(pack(numbering%equation(1:3, :numbering%owned), changed), equations)
    call communicator%allgather(pack(total, changed), stiffness)
  end subroutine gather_changes

  !> Position of the column of an equation; 0: not found yet.
  pure integer function column_of(self, equation) result(position)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> The equation
    integer, intent(in) :: equation

    do position = self%kept, 1, -1
      if (self%columns(position)%equation == equation) return
    end do
  end function column_of

  !> Keeps columns found together.
  subroutine keep(self, communicator, numbering, equations, fields)
    !> The changes
    class(woodbury_updates_t), intent(inout) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Equations of the new columns, the same on every rank
    integer, intent(in) :: equations(:)
    !> Solution for a unit force on each, ghosts up to date, (5, points, columns)
    real(wp), intent(in) :: fields(:, :, :)
    type(column_t), allocatable :: more(:)
    real(wp), allocatable :: compliance(:, :), values(:)
    integer :: before, k

    before = self%kept
    self%kept = before + size(equations)
    allocate (more(self%kept), compliance(self%kept, self%kept))
    compliance(:before, :before) = self%compliance
    do k = 1, before
      more(k)%equation = self%columns(k)%equation
      more(k)%company = self%columns(k)%company
      call move_alloc(self%columns(k)%field, more(k)%field)
    end do
    do k = 1, size(equations)
      more(before + k)%equation = equations(k)
      more(before + k)%company = size(equations)
      more(before + k)%field = fields(:, :, k)
    end do
    call move_alloc(more, self%columns)
    values = [(values_at(numbering, self%columns%equation, fields(:, :, k)), k=1, size(equations))]
    call communicator%sum(values)
    compliance(:, before + 1:) = reshape(values, [self%kept, size(equations)])
    compliance(before + 1:, :before) = transpose(compliance(:before, before + 1:))
    call move_alloc(compliance, self%compliance)
    if (allocated(self%inverse)) deallocate (self%inverse)
  end subroutine keep

  !> Equation and company of each column kept.
  pure function list(self) result(columns)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> Equation and company in turn, (2 columns)
    integer, allocatable :: columns(:)
    integer :: k

    columns = [([self%columns(k)%equation, self%columns(k)%company], k=1, self%kept)]
  end function list

  !> The changes in force as a field, which holds for any number of ranks.
  pure subroutine spread_out(self, numbering, field)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Change of the stiffness of the jumps, zero where there is none and at ghosts, (3, points)
    real(wp), intent(out) :: field(:, :)
    integer :: k, point, component

    field = 0
    if (.not. allocated(self%equations)) return
    do k = 1, size(self%equations)
      if (.not. numbering%owns(self%equations(k))) cycle
      call numbering%place_of(self%equations(k), point, component)
      field(component, point) = self%stiffness(k)
    end do
    ! A point that follows has the same as its leader.
    do point = 1, numbering%owned
      field(:, point) = field(:, point)/numbering%sharers(point)
    end do
    do point = 1, numbering%owned
      if (numbering%leader(point) > 0) field(:, point) = field(:, numbering%leader(point))
    end do
  end subroutine spread_out

  !> Puts changes in force whose columns are all kept.
  subroutine set(self, equations, stiffness)
    !> The changes
    class(woodbury_updates_t), intent(inout) :: self
    !> Equations changed, the same on every rank, ascending
    integer, intent(in) :: equations(:)
    !> Stiffness added to their diagonals, none zero
    real(wp), intent(in) :: stiffness(:)
    real(wp), allocatable :: matrix(:, :)
    integer :: k

    self%equations = equations
    self%stiffness = stiffness
    self%column = [(self%column_of(equations(k)), k=1, size(equations))]
    matrix = self%compliance(self%column, self%column)
    do k = 1, size(equations)
      matrix(k, k) = matrix(k, k) + 1/stiffness(k)
    end do
    call self%system%factorize(matrix)
  end subroutine set

  !> Turns a solution of the factored operator into one of the changed operator.
  subroutine correct(self, communicator, numbering, solution)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    real(wp) :: forces(size(self%equations))
    integer :: k, point, component

    if (size(self%equations) == 0 .or. self%system%singular) return
    forces = values_at(numbering, self%equations, solution)
    call communicator%sum(forces)
    call self%system%solve(forces)
    call self%combine(self%column, forces, solution)
    ! What the changes leave of the unknowns themselves is a small difference; it is known better from their forces.
    do k = 1, size(forces)
      if (.not. numbering%owns(self%equations(k))) cycle
      call numbering%place_of(self%equations(k), point, component)
      solution(component, point) = forces(k)/self%stiffness(k)
    end do
    call numbering%spread(solution)
  end subroutine correct

  !> Takes a combination of columns out of a solution.
  pure subroutine combine(self, columns, forces, solution)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> Positions of the columns
    integer, intent(in) :: columns(:)
    !> Force of each
    real(wp), intent(in) :: forces(:)
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    integer :: k

    ! Four at a time: memory is read faster in several places at once.
    do k = 4, size(forces), 4
      associate (c => columns(k - 3:k), f => forces(k - 3:k))
        solution = solution - f(1)*self%columns(c(1))%field - f(2)*self%columns(c(2))%field &
                   - f(3)*self%columns(c(3))%field - f(4)*self%columns(c(4))%field
      end associate
    end do
    do k = size(forces) - modulo(size(forces), 4) + 1, size(forces)
      solution = solution - forces(k)*self%columns(columns(k))%field
    end do
  end subroutine combine

  !> Values of a field at the equations of all columns kept, the same on every rank.
  function values_at_columns(self, communicator, numbering, field) result(values)
    !> The changes
    class(woodbury_updates_t), intent(in) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> The field, (5, points)
    real(wp), intent(in) :: field(:, :)
    !> Values, (kept)
    real(wp), allocatable :: values(:)

    allocate (values(self%kept))
    if (self%kept == 0) return
    values = values_at(numbering, self%columns(:self%kept)%equation, field)
    call communicator%sum(values)
  end function values_at_columns

  !> Stiffness of the factored operator against motions of the columns' unknowns and one more.
  subroutine stiffness_of_columns(self, answer, compliance, stiffness)
    !> The changes
    class(woodbury_updates_t), intent(inout) :: self
    !> What a unit force on the one more does to the others, (kept), and to itself; 0: there is none
    real(wp), intent(in) :: answer(:), compliance
    !> Inverse of the answers to unit forces, (unknowns, unknowns)
    real(wp), allocatable, intent(out) :: stiffness(:, :)
    type(positive_factor_t) :: factor
    real(wp), allocatable :: matrix(:, :)
    integer :: unknowns

    if (.not. allocated(self%inverse)) then
      unknowns = self%kept
      if (compliance > 0) unknowns = unknowns + 1
      allocate (matrix(unknowns, unknowns))
      matrix(:self%kept, :self%kept) = self%compliance
      if (compliance > 0) then
        matrix(unknowns, :self%kept) = answer
        matrix(:self%kept, unknowns) = answer
        matrix(unknowns, unknowns) = compliance
      end if
      call factor%factorize(matrix)
      self%inverse = factor%inverse()
    end if
    stiffness = self%inverse
  end subroutine stiffness_of_columns

  !> Values of a field at those of some equations that this rank owns, zero at the others.
  pure function values_at(numbering, equations, field) result(values)
    !> Equations of this rank's points
    type(numbering_t), intent(in) :: numbering
    !> The equations
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
end module woodbury_updates
