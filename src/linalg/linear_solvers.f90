!> Direct solution of large symmetric linear equations by PETSc. Rows are shared out among the ranks in contiguous
!> blocks; equations are numbered from 0 over all ranks.
module linear_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal, exit_usage
  use factor_packages, only: packages_for, why_not_factored, factor_made, factor_not_positive, factor_singular
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

  !> The two factors that a solver may have, and what options for each begin with
  integer, parameter :: definite = 1, indefinite = 2
  character(len=11), parameter :: prefixes(2) = [character(len=11) :: '', 'indefinite_']

  !> A symmetric matrix and its factor. The factor stays what it was until `factorize` is called again,
  !> whatever values are assembled meanwhile.
  type :: linear_solver_t
    !> One of the factorization_* choices; to be set before `define`
    integer :: factorization = factorization_automatic
    !> Number of factorizations so far
    integer :: factorizations = 0
    !> Number of right-hand sides solved so far
    integer :: solves = 0
    !> Factorizations of a matrix that was promised to be positive definite and was not
    integer, private :: indefinite_matrices = 0
    !> All ranks
    type(communicator_t), private :: communicator
    !> Number of rows of all ranks
    integer, private :: total_rows = 0
    !> The matrix, which callers assemble
    type(petsc_matrix_t) :: matrix
    !> Its factor as a rule, and that of a matrix that broke its promise, set up when that happens
    type(petsc_factor_t), private :: factors(2)
    !> Which of them is in force
    integer, private :: current = definite
    !> True while there is a factor
    logical, private :: factored = .false.
    !> True: the matrix is promised to be positive definite
    logical, private :: promised = .false.
    !> Motion of least stiffness, by which mechanisms of the structure are found
    real(wp), allocatable, private :: mode(:)
  contains
    !> Sets the pattern of the matrix, anew if there was one; called by all ranks together.
    procedure :: define
    !> Factors the matrix as it was assembled last; called by all ranks together. If it fails there is no factor.
    procedure :: factorize
    !> Solves for one right-hand side with the factor; called by all ranks together.
    procedure :: solve
    !> Size of the factor, the same on every rank.
    procedure :: statistics
    !> Name of what factors the matrix, and how often something else had to.
    procedure :: package_used
    !> Frees matrix and factor.
    procedure :: release
    procedure, private :: set_up_factor
    procedure, private :: make_factor
  end type linear_solver_t

contains

  !> Sets the pattern of the matrix, anew if there was one; called by all ranks together.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error)
    class(linear_solver_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> Number of the first row that this rank owns, from 0
    integer, intent(in) :: first_row
    !> Number of rows of all ranks
    integer, intent(in) :: total_rows
    !> Where the columns of each owned row begin, from 1, shape (owned rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns of the owned rows in both triangles, from 0, ascending within a row, diagonal included
    integer, intent(in) :: columns(:)
    !> A promise that saves work
    logical, intent(in) :: positive_definite
    !> Raised when the solver cannot be set up
    type(error_t), allocatable, intent(inout) :: error

    call self%release()
    self%communicator = communicator
    self%total_rows = total_rows
    self%promised = positive_definite
    if (self%factorization == factorization_cholmod .and. .not. positive_definite) &
      call fail(error, exit_usage, 'CHOLMOD factors what stays positive definite only: choose '// &
                "'automatic' or 'mumps' for factorization of &solver.")
    if (allocated(error)) return
    call self%matrix%define(communicator, first_row, total_rows, row_start, columns, error)
    if (.not. allocated(error)) call self%set_up_factor(definite, positive_definite, error)
    call communicator%agree(error)
  end subroutine define

  !> Chooses the package of a factor.
  subroutine set_up_factor(self, number, positive_definite, error)
    class(linear_solver_t), intent(inout) :: self
    !> Which of the two factors
    integer, intent(in) :: number
    !> Whether the matrix is promised to be positive definite
    logical, intent(in) :: positive_definite
    !> Raised when PETSc fails or has no package
    type(error_t), allocatable, intent(inout) :: error

    call self%factors(number)%define(self%communicator, self%matrix%object, &
                                     packages_for(self%factorization, positive_definite, self%communicator%size, &
                                                  self%total_rows), &
                                     positive_definite, trim(prefixes(number)), error)
  end subroutine set_up_factor

  !> Factors the matrix as it was assembled last; called by all ranks together. Which package does it follows from the
  !> matrix alone, so that a run taken up again has the same factor.
  subroutine factorize(self, error)
    class(linear_solver_t), intent(inout) :: self
    !> Raised on all ranks when the matrix is singular or memory is short
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

  !> Makes the factor in force and looks whether a part of the structure can move freely.
  subroutine make_factor(self, outcome, error)
    class(linear_solver_t), intent(inout) :: self
    !> One of the factor_* outcomes
    integer, intent(out) :: outcome
    !> Raised when PETSc fails for another reason than the numbers
    type(error_t), allocatable, intent(inout) :: error

    call self%factors(self%current)%factorize(self%matrix%object, outcome, error)
    if (outcome /= factor_made .or. allocated(error)) return
    if (has_mechanism(self%communicator, self%factors(self%current)%solver, self%matrix, self%mode)) &
      outcome = factor_singular
  end subroutine make_factor

  !> Solves for one right-hand side with the factor; called by all ranks together.
  subroutine solve(self, right_hand_side, solution, error)
    class(linear_solver_t), intent(inout) :: self
    !> Owned part of the right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Owned part of the solution
    real(wp), intent(out) :: solution(:)
    !> Raised on all ranks when there is no finite solution, which PETSc does not always say
    type(error_t), allocatable, intent(inout) :: error
    integer :: reason, ierr(4)

    solution = 0
    if (.not. self%factored) call fail(error, exit_internal, 'Linear equations are solved before they are factored.')
    if (allocated(error)) return
    self%solves = self%solves + 1
    associate (solver => self%factors(self%current)%solver)
      call self%matrix%solve(solver, right_hand_side, solution, ierr(:3))
      call KSPGetConvergedReason(solver, reason, ierr(4))
    end associate
    if (self%communicator%all(all(ieee_is_finite(solution)) .and. reason > 0 .and. all(ierr == 0))) return
    call report_petsc(ierr, error)
    call fail(error, exit_convergence, 'The linear equations have no finite solution.')
    call self%communicator%agree(error)
  end subroutine solve

  !> Size of the factor, the same on every rank.
  subroutine statistics(self, factor_entries, megabytes)
    class(linear_solver_t), intent(in) :: self
    !> Numbers stored in the factor; 0: there is none
    real(wp), intent(out) :: factor_entries
    !> Memory of the factorization on all ranks, in MB
    real(wp), intent(out) :: megabytes

    call self%factors(self%current)%statistics(factor_entries, megabytes)
  end subroutine statistics

  !> Name of what factors the matrix, and how often something else had to.
  function package_used(self) result(name)
    class(linear_solver_t), intent(in) :: self
    !> The name
    character(len=:), allocatable :: name

    name = self%factors(definite)%title()
    if (self%indefinite_matrices == 0) return
    name = name//' ('//to_text(self%indefinite_matrices)//' of '//to_text(self%factorizations)//' factorizations'// &
           ' by '//self%factors(indefinite)%title()//', as the matrix was not positive definite)'
  end function package_used

  !> Frees matrix and factor.
  subroutine release(self)
    class(linear_solver_t), intent(inout) :: self
    integer :: i

    do i = 1, size(self%factors)
      call self%factors(i)%release()
    end do
    call self%matrix%release()
    if (allocated(self%mode)) deallocate (self%mode)
    self%factored = .false.
  end subroutine release
end module linear_solvers
