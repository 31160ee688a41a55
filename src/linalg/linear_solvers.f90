!> Direct solution of large symmetric linear equations by PETSc. Rows are distributed over the ranks in contiguous
!> blocks; equations are numbered from 0 over all ranks.
module linear_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal, exit_usage
  use factor_packages, only: packages_for, why_not_factored, factor_made, factor_not_positive, factor_singular
  use free_mechanisms, only: mechanism_t
  use kinds, only: wp
  use linear_solver_parameters, only: factorization_automatic, factorization_cholmod
  use petsc_factors, only: petsc_factor_t
  use petsc_matrices, only: petsc_matrix_t, put, take
  use petsc_session, only: report_petsc
  use text, only: to_text
  implicit none
  private
  public :: linear_solver_t

  !> Message for a solve without a factorization
  character(len=*), parameter :: no_factor = 'The linear equations were to be solved before they were factored.'
  !> The two factorizations of a solver, and the prefixes of their options
  integer, parameter :: definite = 1, indefinite = 2
  character(len=11), parameter :: prefixes(2) = [character(len=11) :: '', 'indefinite_']

  !> A symmetric matrix and its factorization, which is unchanged until the next call of `factorize`, also while new
  !> values are assembled.
  type :: linear_solver_t
    !> One of the factorization_* choices; to be set before `define`
    integer :: factorization = factorization_automatic
    !> Number of factorizations so far
    integer :: factorizations = 0
    !> Number of right-hand sides solved so far
    integer :: solves = 0
    !> Factorizations of a matrix that was declared positive definite but is not
    integer, private :: indefinite_matrices = 0
    !> All ranks
    type(communicator_t), private :: communicator
    !> Number of rows of this rank, and of all ranks
    integer, private :: rows = 0, total_rows = 0
    !> The matrix, assembled by the caller
    type(petsc_matrix_t) :: matrix
    !> Factorization of a positive definite matrix, and of an indefinite one, created when first needed
    type(petsc_factor_t), private :: factors(2)
    !> Index of the one in use
    integer, private :: current = definite
    !> True after a factorization
    logical, private :: factored = .false.
    !> True: the caller declares the matrix positive definite
    logical, private :: promised = .false.
    !> Test for mechanisms of the structure
    type(mechanism_t), private :: mechanism
  contains
    !> Sets the pattern of the matrix, replacing a previous one. Collective.
    procedure :: define
    !> Factorizes the assembled matrix. Collective.
    procedure :: factorize
    !> Solves for one right-hand side. Collective.
    procedure :: solve
    !> Product of the matrix with a vector. Collective.
    procedure :: multiply
    !> Size of the factors, the same on every rank.
    procedure :: statistics
    !> True if the matrix is factorized.
    procedure :: has_factor
    !> Name of the package, and number of factorizations by the second package.
    procedure :: package_used
    !> Deallocates matrix and factors.
    procedure :: release
    procedure, private :: set_up_factor
    procedure, private :: make_factor
    procedure, private :: find_mechanism
    procedure, private :: finish_solve
  end type linear_solver_t

contains

  !> Sets the pattern of the matrix, replacing a previous one. Collective.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error)
    class(linear_solver_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> Number of the first row that this rank owns, from 0
    integer, intent(in) :: first_row
    !> Number of rows of all ranks
    integer, intent(in) :: total_rows
    !> Index of the first column of each owned row, from 1, shape (owned rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns of the owned rows in both triangles, from 0, ascending within a row, diagonal included
    integer, intent(in) :: columns(:)
    !> True: the caller declares the matrix positive definite, which needs no pivoting
    logical, intent(in) :: positive_definite
    !> Set if the solver cannot be created
    type(error_t), allocatable, intent(inout) :: error

    call self%release()
    self%communicator = communicator
    self%rows = size(row_start) - 1
    self%total_rows = total_rows
    self%promised = positive_definite
    if (self%factorization == factorization_cholmod .and. .not. positive_definite) &
      call fail(error, exit_usage, 'CHOLMOD factorizes positive definite matrices only: choose '// &
                "'automatic' or 'mumps' for factorization of &solver.")
    if (allocated(error)) return
    call self%matrix%define(communicator, first_row, total_rows, row_start, columns, error)
    if (.not. allocated(error)) call self%set_up_factor(definite, positive_definite, error)
    call communicator%agree(error)
  end subroutine define

  !> Chooses the package of a factorization.
  subroutine set_up_factor(self, number, positive_definite, error)
    class(linear_solver_t), intent(inout) :: self
    !> Index of the factorization
    integer, intent(in) :: number
    !> True: the caller declares the matrix positive definite
    logical, intent(in) :: positive_definite
    !> Set if PETSc fails or has no package
    type(error_t), allocatable, intent(inout) :: error

    call self%factors(number)%define(self%communicator, self%matrix%object, &
                                     packages_for(self%factorization, positive_definite, self%communicator%size, &
                                                  self%total_rows), &
                                     positive_definite, trim(prefixes(number)), error)
  end subroutine set_up_factor

  !> Factorizes the assembled matrix. Collective. The choice of the package depends on the matrix only, so that a
  !> restarted run has the same factors.
  subroutine factorize(self, error)
    class(linear_solver_t), intent(inout) :: self
    !> Set on all ranks if the matrix is singular or memory is insufficient
    type(error_t), allocatable, intent(inout) :: error
    integer :: outcome

    self%factorizations = self%factorizations + 1
    self%current = definite
    call self%make_factor(outcome, error)
    if (outcome == factor_not_positive .and. self%promised .and. self%factorization /= factorization_cholmod .and. &
        .not. allocated(error)) then
      self%indefinite_matrices = self%indefinite_matrices + 1
      self%current = indefinite
      if (.not. self%factors(indefinite)%defined) call self%set_up_factor(indefinite, .false., error)
      if (.not. allocated(error)) call self%make_factor(outcome, error)
    end if
    if (.not. allocated(error) .and. outcome /= factor_made) &
      call fail(error, exit_convergence, why_not_factored(self%factors(self%current)%title(), outcome))
    self%factored = .not. allocated(error)
  end subroutine factorize

  !> Factorizes with the package in use, and tests for mechanisms of the structure.
  subroutine make_factor(self, outcome, error)
    class(linear_solver_t), intent(inout) :: self
    !> One of the factor_* outcomes
    integer, intent(out) :: outcome
    !> Set if PETSc fails for another reason than the values of the matrix
    type(error_t), allocatable, intent(inout) :: error

    call self%factors(self%current)%factorize(self%matrix%object, outcome, error)
    if (outcome == factor_made .and. .not. allocated(error)) call self%find_mechanism(outcome)
  end subroutine make_factor

  !> Tests for mechanisms of the structure.
  subroutine find_mechanism(self, outcome)
    class(linear_solver_t), intent(inout) :: self
    !> factor_singular on return if there is one
    integer, intent(inout) :: outcome
    real(wp), allocatable :: values(:)
    logical :: found
    integer :: ierr(3), pass

    allocate (values(self%rows))
    call self%matrix%diagonal(values, ierr(1))
    call self%mechanism%begin(values)
    do pass = 1, self%mechanism%passes
      call put(self%matrix%right, self%mechanism%right_hand_side(), ierr(1))
      call KSPSolve(self%factors(self%current)%solver, self%matrix%right, self%matrix%left, ierr(2))
      call take(self%matrix%left, values, ierr(3))
      if (any(ierr /= 0)) values = ieee_value(1.0_wp, ieee_quiet_nan)
      call self%mechanism%assess(self%communicator, values, found)
      if (found) outcome = factor_singular
      if (found) return
    end do
  end subroutine find_mechanism

  !> Solves for one right-hand side. Collective.
  subroutine solve(self, right_hand_side, solution, error)
    class(linear_solver_t), intent(inout) :: self
    !> Owned part of the right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Owned part of the solution
    real(wp), intent(out) :: solution(:)
    !> Set on all ranks if there is no finite solution
    type(error_t), allocatable, intent(inout) :: error

    integer :: ierr(3)

    solution = 0
    if (.not. self%factored) call fail(error, exit_internal, no_factor)
    if (allocated(error)) return
    call put(self%matrix%right, right_hand_side, ierr(1))
    call KSPSolve(self%factors(self%current)%solver, self%matrix%right, self%matrix%left, ierr(2))
    call take(self%matrix%left, solution, ierr(3))
    call self%finish_solve(all(ieee_is_finite(solution)), ierr, error)
  end subroutine solve

  !> Product of the assembled matrix with a vector. Collective.
  subroutine multiply(self, vector, product, error)
    class(linear_solver_t), intent(inout) :: self
    !> Owned part of the vector
    real(wp), intent(in) :: vector(:)
    !> Owned part of the product
    real(wp), intent(out) :: product(:)
    !> Set if PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    call put(self%matrix%right, vector, ierr(1))
    call MatMult(self%matrix%object, self%matrix%right, self%matrix%left, ierr(2))
    call take(self%matrix%left, product, ierr(3))
    call report_petsc(ierr, error)
  end subroutine multiply

  !> Counts solves, and tests whether the solution is finite, which PETSc does not always report.
  subroutine finish_solve(self, finite, codes, error)
    class(linear_solver_t), intent(inout) :: self
    !> True: this rank's part of the solution is finite
    logical, intent(in) :: finite
    !> Codes that PETSc returned
    integer, intent(in) :: codes(:)
    !> Set on all ranks if there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    integer :: reason, ierr

    self%solves = self%solves + 1
    call KSPGetConvergedReason(self%factors(self%current)%solver, reason, ierr)
    if (self%communicator%all(finite .and. reason > 0 .and. all(codes == 0))) return
    call report_petsc(codes, error)
    call fail(error, exit_convergence, 'The linear equations have no finite solution.')
    call self%communicator%agree(error)
  end subroutine finish_solve

  !> True between the first factorization and `release`.
  pure logical function has_factor(self)
    class(linear_solver_t), intent(in) :: self

    has_factor = self%factors(self%current)%defined
  end function has_factor

  !> Size of the factors, the same on every rank.
  subroutine statistics(self, factor_entries, megabytes)
    class(linear_solver_t), intent(in) :: self
    !> Number of stored entries of the factors
    real(wp), intent(out) :: factor_entries
    !> Memory of the factorization on all ranks, in MB
    real(wp), intent(out) :: megabytes

    call self%factors(self%current)%statistics(factor_entries, megabytes)
  end subroutine statistics

  !> Name of the package, and number of factorizations by the second package.
  function package_used(self) result(name)
    class(linear_solver_t), intent(in) :: self
    !> The name
    character(len=:), allocatable :: name

    name = self%factors(definite)%title()
    if (self%indefinite_matrices == 0) return
    name = name//' ('//to_text(self%indefinite_matrices)//' of '//to_text(self%factorizations)// &
      ' factorizations by '// &
           self%factors(indefinite)%title()//', as the matrix was not positive definite)'
  end function package_used

  !> Deallocates matrix and factors.
  subroutine release(self)
    class(linear_solver_t), intent(inout) :: self
    integer :: i

    do i = 1, size(self%factors)
      call self%factors(i)%release()
    end do
    call self%matrix%release()
    call self%mechanism%reset()
    self%factored = .false.
  end subroutine release
end module linear_solvers
