!> Direct solution of large symmetric linear equations by PETSc. Rows are distributed over the ranks in contiguous
!> blocks; equations are numbered from 0 over all ranks.
module linear_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal, exit_usage
  use factor_packages, only: packages_for, failure_message, factor_succeeded, factor_not_positive, factor_singular
  use free_mechanisms, only: has_mechanism
  use kinds, only: wp
  use linear_solver_parameters, only: factorization_automatic, factorization_cholmod
  use petsc_factors, only: petsc_factor_t
  use petsc_matrices, only: petsc_matrix_t
  use petsc_session, only: report_petsc
  use text, only: to_text
  implicit none
  private
  public :: linear_solver_t

  !> The two factorizations that a solver may have, and the prefixes of the options for each
  integer, parameter :: definite = 1, indefinite = 2
  character(len=11), parameter :: prefixes(2) = [character(len=11) :: '', 'indefinite_']

  !> A symmetric matrix and its factorization, which is unchanged until the next call of `factorize`, also while new
  !> values are assembled.
  type :: linear_solver_t
    !> One of the factorization_* choices; to be set before `define`
    integer :: factorization = factorization_automatic
    !> Number of factorizations so far
    integer :: factorizations = 0
    !> Factorizations of a matrix that was declared positive definite but is not
    integer, private :: indefinite_matrices = 0
    !> All ranks
    type(communicator_t), private :: communicator
    !> Number of rows of all ranks
    integer, private :: total_rows = 0
    !> The matrix, which callers assemble
    type(petsc_matrix_t) :: matrix
    !> Factorization of a positive definite matrix, and of an indefinite one, created when first needed
    type(petsc_factor_t), private :: factors(2)
    !> Index of the one in use
    integer, private :: current = definite
    !> Why there is no factor; blank after a factorization
    character(len=120) :: fault = 'The matrix has not been factored.'
    !> True: the caller declares the matrix positive definite
    logical, private :: declared_definite = .false.
    !> Motion of least stiffness, by which mechanisms of the structure are found
    real(wp), allocatable, private :: mode(:)
  contains
    procedure :: define
    procedure :: factorize
    procedure :: solve
    procedure :: statistics
    procedure :: package_used
    procedure :: release
    procedure, private :: set_up_factor
    procedure, private :: factorize_current
  end type linear_solver_t

contains

  !> Sets the pattern of the matrix, replacing a previous one. Collective.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error)
    class(linear_solver_t), intent(inout) :: self
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
    self%total_rows = total_rows
    self%declared_definite = positive_definite
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
    call self%factorize_current(outcome, error)
    if (outcome == factor_not_positive .and. self%declared_definite .and. &
        self%factorization /= factorization_cholmod .and. .not. allocated(error)) then
      self%indefinite_matrices = self%indefinite_matrices + 1
      self%current = indefinite
      if (.not. self%factors(indefinite)%defined) call self%set_up_factor(indefinite, .false., error)
      if (.not. allocated(error)) call self%factorize_current(outcome, error)
    end if
    if (.not. allocated(error) .and. outcome /= factor_succeeded) &
      call fail(error, exit_convergence, failure_message(self%factors(self%current)%title(), outcome))
    self%fault = ''
    if (allocated(error)) self%fault = error%message
  end subroutine factorize

  !> Factorizes with the package in use, and tests for mechanisms of the structure.
  subroutine factorize_current(self, outcome, error)
    class(linear_solver_t), intent(inout) :: self
    integer, intent(out) :: outcome
    !> Set if PETSc fails for another reason than the values of the matrix
    type(error_t), allocatable, intent(inout) :: error

    call self%factors(self%current)%factorize(self%matrix%object, outcome, error)
    if (outcome /= factor_succeeded .or. allocated(error)) return
    if (has_mechanism(self%communicator, self%factors(self%current)%solver, self%matrix, self%mode)) &
      outcome = factor_singular
  end subroutine factorize_current

  !> Solves for one right-hand side with the factor; called by all ranks together.
  subroutine solve(self, right_hand_side, solution, error)
    class(linear_solver_t), intent(inout) :: self
    !> Owned part of the right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Owned part of the solution
    real(wp), intent(out) :: solution(:)
    !> Raised on all ranks when the solution is not finite, which PETSc does not always report
    type(error_t), allocatable, intent(inout) :: error
    integer :: reason, ierr(4)

    solution = 0
    if (self%fault /= '') call fail(error, exit_internal, 'Linear equations are solved without a factor.')
    if (allocated(error)) return
    associate (solver => self%factors(self%current)%solver)
      call self%matrix%solve(solver, right_hand_side, solution, ierr(:3))
      call KSPGetConvergedReason(solver, reason, ierr(4))
    end associate
    if (self%communicator%all(all(ieee_is_finite(solution)) .and. reason > 0 .and. all(ierr == 0))) return
    call report_petsc(ierr, error)
    call fail(error, exit_convergence, 'The linear equations have no finite solution.')
    call self%communicator%agree(error)
  end subroutine solve

  !> Size of the factors, the same on every rank.
  subroutine statistics(self, factor_entries, megabytes)
    class(linear_solver_t), intent(in) :: self
    !> Numbers stored in the factor; 0: there is none
    real(wp), intent(out) :: factor_entries
    !> Memory of the factorization on all ranks, in MB
    real(wp), intent(out) :: megabytes

    call self%factors(self%current)%statistics(factor_entries, megabytes)
  end subroutine statistics

  !> Name of the package, and number of factorizations by the second package.
  function package_used(self) result(name)
    class(linear_solver_t), intent(in) :: self
    character(len=:), allocatable :: name

    name = self%factors(definite)%title()
    if (self%indefinite_matrices == 0) return
    name = name//' ('//to_text(self%indefinite_matrices)//' of '//to_text(self%factorizations)//' factorizations'// &
           ' by '//self%factors(indefinite)%title()//', as the matrix was not positive definite)'
  end function package_used

  !> Deallocates matrix and factors.
  subroutine release(self)
    class(linear_solver_t), intent(inout) :: self
    integer :: i

    do i = 1, size(self%factors)
      call self%factors(i)%release()
    end do
    call self%matrix%release()
    if (allocated(self%mode)) deallocate (self%mode)
    self%fault = 'The matrix has been released.'
  end subroutine release
end module linear_solvers
