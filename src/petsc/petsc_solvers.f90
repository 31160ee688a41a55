!> Direct solution of large symmetric equations by MUMPS behind PETSc, on any number of ranks (Amestoy et al., SIAM J.
!> Matrix Anal. Appl. 23, 2001).
module petsc_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
  use petscksp, only: tMat, tKSP, tPC, PETSC_DECIDE, PETSC_TRUE, PETSC_FALSE, PETSC_NULL_SCALAR, MAT_GLOBAL_SUM, &
                      MAT_INFO_SIZE, MAT_INFO_NZ_USED, MAT_INFO_MEMORY, KSPSetOperators, MatDenseGetArrayF90, &
                      MatDenseRestoreArrayF90
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal
  use factor_packages, only: prepare_mumps, mumps_report, why_not_factored, mumps_outcome, mumps_memory, &
                             mumps_entries, mumps_singular, mumps_short_of_room
  use free_mechanisms, only: mechanism_t
  use freed_memory, only: give_back_freed, keep_freed
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use petsc_matrices, only: petsc_matrix_t, put, take
  use petsc_session, only: report_petsc
  implicit none
  private
  public :: petsc_solver_t

  !> PETSC_ERR_MAT_CH_ZRPVT, which other packages than MUMPS return when a pivot is zero or negative
  integer, parameter :: petsc_zero_pivot = 81
  !> What is wrong with a solve that comes too early
  character(len=*), parameter :: no_factor = 'The linear equations were to be solved before they were factored.'

  !> A symmetric matrix in PETSc and its factor.
  type, extends(linear_solver_t) :: petsc_solver_t
    !> All ranks
    type(communicator_t), private :: communicator
    !> True between `define` and `release`
    logical, private :: defined = .false.
    !> True while there is a factor
    logical, private :: factored = .false.
    !> True if MUMPS factors, which the options of the user may have changed
    logical, private :: by_mumps = .false.
    !> Number of rows that this rank owns
    integer, private :: rows = 0
    !> Room beyond MUMPS' estimate at first, in %, negative for its own choice
    integer, private :: usual_room = -1
    !> The matrix
    type(petsc_matrix_t), private :: matrix
    !> Finds parts of the structure that can move freely
    type(mechanism_t), private :: mechanism
    !> PETSc's solver, which applies the factor once
    type(tKSP), private :: solver
    !> What makes and keeps the factor
    type(tPC), private :: factorization
  contains
    procedure :: define
    procedure :: clear
    procedure :: add
    procedure :: finish_assembly
    procedure :: factorize
    procedure :: solve
    procedure :: solve_many
    procedure :: statistics
    procedure :: package_used
    procedure :: release
    procedure, private :: create_solver
    procedure, private :: renew_factor
    procedure, private :: factorize_once
    procedure, private :: find_mechanism
    procedure, private :: finish_solve
  end type petsc_solver_t

contains

  !> Sets the pattern of the matrix, anew if there was one.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error, seen)
    class(petsc_solver_t), intent(inout) :: self
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
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    !> Not needed: PETSc carries to other ranks what is added to their rows
    integer, intent(in), optional :: seen(:)

    call self%release()
    call give_back_freed()
    self%communicator = communicator
    self%rows = size(row_start) - 1
    self%defined = .true.
    ! Without pivoting, and with nothing to share out, the factor is as large as MUMPS says beforehand.
    self%usual_room = merge(0, -1, positive_definite .and. communicator%size == 1)
    call self%matrix%define(communicator, first_row, total_rows, row_start, columns, positive_definite, error)
    if (.not. allocated(error)) call self%create_solver(error)
    call communicator%agree(error)
  end subroutine define

  !> Makes the solver and chooses what factors the matrix; options of the user come last.
  subroutine create_solver(self, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    character(len=32) :: package
    integer :: ierr(8), unasked

    ierr = 0
    call KSPCreate(self%communicator%handle(), self%solver, ierr(2))
    call KSPSetOperators(self%solver, self%matrix%object, self%matrix%object, ierr(3))
    call KSPSetType(self%solver, 'preonly', ierr(4))
    call KSPGetPC(self%solver, self%factorization, ierr(5))
    call PCSetType(self%factorization, 'cholesky', ierr(6))
    call PCFactorSetMatSolverType(self%factorization, 'mumps', ierr(7))
    call KSPSetFromOptions(self%solver, ierr(8))
    call report_petsc(ierr, error)
    if (allocated(error)) return
    package = ''
    call PCFactorGetMatSolverType(self%factorization, package, unasked)
    self%by_mumps = unasked == 0 .and. package == 'mumps'
    call self%renew_factor(self%usual_room, error)
  end subroutine create_solver

  !> Gives the package a new factor to fill and sets its controls.
  subroutine renew_factor(self, room, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Room beyond MUMPS' estimate in %, negative for its own choice
    integer, intent(in) :: room
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    ierr(3) = 0
    call PCReset(self%factorization, ierr(1))
    call KSPSetOperators(self%solver, self%matrix%object, self%matrix%object, ierr(2))
    if (self%by_mumps) call prepare_mumps(self%factorization, room, ierr(3))
    call report_petsc(ierr, error)
  end subroutine renew_factor

  !> Zeroes the values of the matrix.
  subroutine clear(self)
    class(petsc_solver_t), intent(inout) :: self

    call self%matrix%clear()
  end subroutine clear

  !> Adds an element's matrix; each element is added by one rank only.
  subroutine add(self, equations, values)
    class(petsc_solver_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, owned by any rank; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)

    call self%matrix%add(equations, values)
  end subroutine add

  !> Brings the matrix together.
  subroutine finish_assembly(self, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Raised on all ranks when an entry falls outside the pattern
    type(error_t), allocatable, intent(inout) :: error

    call self%matrix%finish_assembly(error)
  end subroutine finish_assembly

  !> Factors the matrix as it was assembled last, with ever more room if that is what lacks.
  subroutine factorize(self, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Raised on all ranks when the matrix is singular or memory is short
    type(error_t), allocatable, intent(inout) :: error
    logical :: singular
    integer :: ierr, attempt, outcome
    integer, parameter :: rooms(*) = [100, 400]

    call self%factorize_once(singular, outcome, error)
    do attempt = 1, size(rooms)
      if (allocated(error) .or. all(outcome /= mumps_short_of_room)) exit
      call self%renew_factor(rooms(attempt), error)
      call self%factorize_once(singular, outcome, error)
    end do
    if (singular .or. outcome < 0) then
      ! After a failure the packages refuse to go on with the factor that they have.
      call self%renew_factor(self%usual_room, error)
      call fail(error, exit_convergence, why_not_factored(self%by_mumps, outcome))
    end if
    call self%communicator%agree(error)
    self%factorizations = self%factorizations + 1
    self%factored = .not. allocated(error)
    if (.not. self%factored) return
    ! Ordering and pattern are done: the same blocks are needed from now on.
    call keep_freed()
    ! The factor stays, whatever is assembled, until the next call of this procedure.
    call KSPSetReusePreconditioner(self%solver, PETSC_TRUE, ierr)
  end subroutine factorize

  !> Factors the matrix once.
  subroutine factorize_once(self, singular, outcome, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Whether the matrix proved singular, or not positive definite without MUMPS
    logical, intent(out) :: singular
    !> MUMPS' outcome, negative for a failure; 0 without MUMPS
    integer, intent(out) :: outcome
    !> Raised when PETSc fails for another reason than the numbers
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3), failure

    outcome = 0
    failure = 0
    call KSPSetReusePreconditioner(self%solver, PETSC_FALSE, ierr(1))
    ! Setting the same matrix again is what makes the solver look whether its values changed.
    call KSPSetOperators(self%solver, self%matrix%object, self%matrix%object, ierr(2))
    call KSPSetUp(self%solver, ierr(3))
    singular = ierr(3) == petsc_zero_pivot
    if (singular) return
    call report_petsc(ierr, error)
    if (allocated(error)) return
    if (self%by_mumps) outcome = mumps_report(self%factorization, mumps_outcome)
    call PCGetFailedReason(self%factorization, failure, ierr(3))
    singular = failure /= 0 .and. (outcome == 0 .or. outcome == mumps_singular)
    if (failure == 0 .and. outcome >= 0) call self%find_mechanism(singular)
  end subroutine factorize_once

  !> Finds out whether a part of the structure can move freely.
  subroutine find_mechanism(self, found)
    class(petsc_solver_t), intent(inout) :: self
    !> Whether it can
    logical, intent(out) :: found
    real(wp), allocatable :: values(:)
    integer :: ierr(4), pass

    allocate (values(self%rows))
    call MatGetDiagonal(self%matrix%object, self%matrix%left, ierr(1))
    call take(self%matrix%left, values, ierr(2))
    call self%mechanism%begin(values)
    do pass = 1, self%mechanism%passes
      call put(self%matrix%right, self%mechanism%right_hand_side(), ierr(2))
      call KSPSolve(self%solver, self%matrix%right, self%matrix%left, ierr(3))
      call take(self%matrix%left, values, ierr(4))
      if (any(ierr /= 0)) values = ieee_value(1.0_wp, ieee_quiet_nan)
      call self%mechanism%judge(self%communicator, values, found)
      if (found) exit
    end do
  end subroutine find_mechanism

  !> Solves for one right-hand side with the factor.
  subroutine solve(self, right_hand_side, solution, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Owned part of the right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Owned part of the solution
    real(wp), intent(out) :: solution(:)
    !> Raised on all ranks when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    solution = 0
    if (.not. self%factored) call fail(error, exit_internal, no_factor)
    if (allocated(error)) return
    call put(self%matrix%right, right_hand_side, ierr(1))
    call KSPSolve(self%solver, self%matrix%right, self%matrix%left, ierr(2))
    call take(self%matrix%left, solution, ierr(3))
    call self%finish_solve(all(ieee_is_finite(solution)), 1, ierr, error)
  end subroutine solve

  !> Solves for several right-hand sides with the factor.
  subroutine solve_many(self, right_hand_sides, solutions, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Owned parts of the right-hand sides, shape (owned rows, right-hand sides)
    real(wp), intent(in) :: right_hand_sides(:, :)
    !> Owned parts of the solutions, shape (owned rows, right-hand sides)
    real(wp), intent(out) :: solutions(:, :)
    !> Raised on all ranks when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    type(tMat) :: right, left
    real(wp), pointer :: values(:, :)
    integer :: ierr(9)

    solutions = 0
    if (.not. self%factored) call fail(error, exit_internal, no_factor)
    if (allocated(error)) return
    associate (rows => size(solutions, 1), count => size(solutions, 2))
      call MatCreateDense(self%communicator%handle(), rows, PETSC_DECIDE, PETSC_DECIDE, count, PETSC_NULL_SCALAR, &
                          right, ierr(1))
      call MatCreateDense(self%communicator%handle(), rows, PETSC_DECIDE, PETSC_DECIDE, count, PETSC_NULL_SCALAR, &
                          left, ierr(2))
    end associate
    call MatDenseGetArrayF90(right, values, ierr(3))
    values(:, :) = right_hand_sides
    call MatDenseRestoreArrayF90(right, values, ierr(4))
    call KSPMatSolve(self%solver, right, left, ierr(5))
    call MatDenseGetArrayF90(left, values, ierr(6))
    solutions = values
    call MatDenseRestoreArrayF90(left, values, ierr(7))
    call MatDestroy(right, ierr(8))
    call MatDestroy(left, ierr(9))
    call self%finish_solve(all(ieee_is_finite(solutions)), size(solutions, 2), ierr, error)
  end subroutine solve_many

  !> Counts solves and finds out whether they gave a solution, which PETSc does not always say.
  subroutine finish_solve(self, finite, count, codes, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Whether this rank's part of the solution is finite
    logical, intent(in) :: finite
    !> Number of right-hand sides
    integer, intent(in) :: count
    !> Codes that PETSc returned
    integer, intent(in) :: codes(:)
    !> Raised on all ranks when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    integer :: reason, ierr

    self%solves = self%solves + count
    call KSPGetConvergedReason(self%solver, reason, ierr)
    if (self%communicator%all(finite .and. reason > 0 .and. all(codes == 0))) return
    call report_petsc(codes, error)
    call fail(error, exit_convergence, 'The linear equations have no finite solution.')
    call self%communicator%agree(error)
  end subroutine finish_solve

  !> Size of the factor, the same on every rank.
  subroutine statistics(self, factor_entries, megabytes)
    class(petsc_solver_t), intent(in) :: self
    !> Numbers stored in the factor
    real(wp), intent(out) :: factor_entries
    !> Memory of the factorization on all ranks, in MB
    real(wp), intent(out) :: megabytes
    type(tMat) :: factor
    double precision :: info(MAT_INFO_SIZE)
    integer :: entries, ierr

    if (self%by_mumps) then
      entries = mumps_report(self%factorization, mumps_entries)
      ! MUMPS counts in millions, with a negative sign, what an integer can't hold.
      factor_entries = merge(-1e6_wp, 1.0_wp, entries < 0)*entries
      megabytes = mumps_report(self%factorization, mumps_memory)
    else
      info = 0
      call PCFactorGetMatrix(self%factorization, factor, ierr)
      if (ierr == 0) call MatGetInfo(factor, MAT_GLOBAL_SUM, info, ierr)
      factor_entries = info(MAT_INFO_NZ_USED)
      megabytes = info(MAT_INFO_MEMORY)/2**20
    end if
  end subroutine statistics

  !> What factors the matrix.
  function package_used(self) result(name)
    class(petsc_solver_t), intent(in) :: self
    !> Its name
    character(len=:), allocatable :: name

    name = 'MUMPS'
    if (self%defined .and. .not. self%by_mumps) name = 'a package of PETSc'
  end function package_used

  !> Frees matrix and factor.
  subroutine release(self)
    class(petsc_solver_t), intent(inout) :: self
    integer :: ierr

    if (.not. self%defined) return
    call KSPDestroy(self%solver, ierr)
    call self%matrix%release()
    self%defined = .false.
    self%factored = .false.
    call self%mechanism%forget()
  end subroutine release
end module petsc_solvers
