!> Direct solution of large symmetric equations by packages behind PETSc: MUMPS on any number of ranks
!> (Amestoy et al., SIAM J. Matrix Anal. Appl. 23, 2001), CHOLMOD on one (Chen et al., ACM TOMS 35, 2008).
module petsc_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use petscksp, only: tMat, tVec, tKSP, tPC, PETSC_DECIDE, PETSC_TRUE, PETSC_FALSE, PETSC_NULL_SCALAR, &
                      PETSC_NULL_OPTIONS, ADD_VALUES, INSERT_VALUES, MAT_FINAL_ASSEMBLY, &
                      MAT_IGNORE_LOWER_TRIANGULAR, MAT_NEW_NONZERO_LOCATION_ERR, MAT_SPD, MAT_GLOBAL_SUM, &
                      MAT_INFO_SIZE, MAT_INFO_NZ_USED, MAT_INFO_MEMORY, MatSetValues, KSPSetOperators, &
                      VecGetArrayF90, VecRestoreArrayF90, VecGetArrayReadF90, VecRestoreArrayReadF90, &
                      MatDenseGetArrayF90, MatDenseRestoreArrayF90
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal, exit_usage
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use petsc_session, only: report_petsc
  use symmetric_rows, only: symmetric_rows_t
  implicit none
  private
  public :: petsc_solver_t

  !> MUMPS' controls: room beyond the estimate in %, whether the root of the elimination tree stays on
  !> one rank (only then are its negative pivots counted), whether pivots of zero are found.
  integer, parameter :: control_room = 14, control_root = 13, control_null_pivots = 24
  !> MUMPS' control of what a pivot of zero is, relative to the scaled matrix
  integer, parameter :: control_null_size = 3
  !> MUMPS' reports: outcome, negative pivots, memory in MB, entries of the factor, pivots of zero
  integer, parameter :: report_outcome = 1, report_negative = 12, report_memory = 22, report_entries = 29, &
                        report_null_pivots = 28
  !> Outcomes of MUMPS that more room cures
  integer, parameter :: outcomes_short_of_room(*) = [-8, -9, -11, -14, -15, -17, -19, -20]
  !> MUMPS' outcome for a singular matrix
  integer, parameter :: outcome_singular = -10
  !> PETSC_ERR_MAT_CH_ZRPVT, which CHOLMOD returns when a pivot is zero or negative
  integer, parameter :: petsc_zero_pivot = 81
  !> A pivot that is smaller consists of rounding errors
  real(wp), parameter :: null_pivot = 1e-14_wp

  !> A symmetric matrix in PETSc and its factor. On one rank PETSc works on our own rows in place.
  type, extends(linear_solver_t) :: petsc_solver_t
    !> What factors the matrix: `mumps`, or `cholmod` on one rank for positive definite matrices. Set before `define`.
    character(len=8) :: package = 'mumps'
    !> All ranks
    type(communicator_t), private :: communicator
    !> True between `define` and `release`
    logical, private :: defined = .false.
    !> True if MUMPS factors, which the options of the user may have changed
    logical, private :: by_mumps = .false.
    !> Rows of the matrix on one rank
    type(symmetric_rows_t), private :: rows
    !> The matrix as PETSc knows it
    type(tMat), private :: matrix
    !> PETSc's solver, which applies the factor once
    type(tKSP), private :: solver
    !> What makes and keeps the factor
    type(tPC), private :: factorization
    !> Right-hand side and solution
    type(tVec), private :: right, left
    !> First code that PETSc returned for an added matrix, 0 for success
    integer, private :: trouble = 0
  contains
    procedure :: define
    procedure :: clear
    procedure :: add
    procedure :: finish_assembly
    procedure :: factorize
    procedure :: solve
    procedure :: solve_many
    procedure :: multiply
    procedure :: negative_pivots
    procedure :: statistics
    procedure :: release
    procedure, private :: create_matrix
    procedure, private :: create_solver
    procedure, private :: prepare_mumps
    procedure, private :: factorize_once
    procedure, private :: test_solve_explodes
    procedure, private :: finish_solve
    procedure, private :: mumps_report
  end type petsc_solver_t

contains

  !> Sets the pattern of the matrix, anew if there was one.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error)
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
    !> Raised when PETSc fails or the package doesn't suit
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr

    call self%release()
    if (self%package == 'cholmod' .and. (communicator%size > 1 .or. .not. positive_definite)) then
      call fail(error, exit_usage, 'CHOLMOD works on one rank and positive definite matrices only: choose MUMPS.')
      return
    end if
    self%communicator = communicator
    self%defined = .true.
    call self%create_matrix(first_row, total_rows, row_start, columns, error)
    if (.not. allocated(error)) then
      call MatSetOption(self%matrix, MAT_SPD, merge(PETSC_TRUE, PETSC_FALSE, positive_definite), ierr)
      call self%create_solver(error)
    end if
    call communicator%agree(error)
  end subroutine define

  !> Makes the matrix, with a place for every entry of the pattern.
  subroutine create_matrix(self, first_row, total_rows, row_start, columns, error)
    class(petsc_solver_t), intent(inout) :: self
    !> First row that this rank owns, and number of rows of all ranks
    integer, intent(in) :: first_row, total_rows
    !> Pattern of the owned rows, as for `define`
    integer, intent(in) :: row_start(:), columns(:)
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    integer :: rows, row, ierr(4), inner(size(row_start) - 1), outer(size(row_start) - 1)

    ierr = 0
    rows = size(row_start) - 1
    if (self%communicator%size == 1) then
      call self%rows%define(row_start, columns)
      call MatCreateSeqSBAIJWithArrays(self%communicator%handle(), 1, rows, rows, self%rows%start, &
                                       self%rows%columns, self%rows%values, self%matrix, ierr(1))
    else
      do row = 1, rows
        associate (mine => columns(row_start(row):row_start(row + 1) - 1))
          inner(row) = count(mine >= first_row + row - 1 .and. mine < first_row + rows)
          outer(row) = count(mine >= first_row + rows)
        end associate
      end do
      call MatCreateSBAIJ(self%communicator%handle(), 1, rows, rows, total_rows, total_rows, 0, inner, 0, outer, &
                          self%matrix, ierr(1))
      call MatSetOption(self%matrix, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE, ierr(2))
      call fill_pattern(self%matrix, first_row, row_start, columns, ierr(3))
      call MatSetOption(self%matrix, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE, ierr(4))
    end if
    call report_petsc(ierr, error)
  end subroutine create_matrix

  !> Puts zeros at all places of the pattern, as PETSc forgets places that the first assembly leaves out.
  subroutine fill_pattern(matrix, first_row, row_start, columns, ierr)
    !> The matrix
    type(tMat), intent(inout) :: matrix
    !> First row that this rank owns
    integer, intent(in) :: first_row
    !> Pattern of the owned rows, as for `define`
    integer, intent(in) :: row_start(:), columns(:)
    !> First code of PETSc that is not zero
    integer, intent(out) :: ierr
    real(wp), allocatable :: zeros(:)
    integer :: row, n

    allocate (zeros(size(columns)), source=0.0_wp)
    do row = 1, size(row_start) - 1
      n = row_start(row + 1) - row_start(row)
      call MatSetValues(matrix, 1, [first_row + row - 1], n, columns(row_start(row):row_start(row + 1) - 1), &
                        zeros(:n), INSERT_VALUES, ierr)
      if (ierr /= 0) return
    end do
    call MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY, ierr)
    call MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY, ierr)
  end subroutine fill_pattern

  !> Makes the solver and chooses what factors the matrix; options of the user come last.
  subroutine create_solver(self, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    character(len=32) :: package
    integer :: ierr(9), unasked

    ierr = 0
    if (self%package == 'cholmod') call prepare_cholmod(ierr(9))
    call MatCreateVecs(self%matrix, self%left, self%right, ierr(1))
    call KSPCreate(self%communicator%handle(), self%solver, ierr(2))
    call KSPSetOperators(self%solver, self%matrix, self%matrix, ierr(3))
    call KSPSetType(self%solver, 'preonly', ierr(4))
    call KSPGetPC(self%solver, self%factorization, ierr(5))
    call PCSetType(self%factorization, 'cholesky', ierr(6))
    call PCFactorSetMatSolverType(self%factorization, self%package, ierr(7))
    call KSPSetFromOptions(self%solver, ierr(8))
    call report_petsc(ierr, error)
    if (allocated(error)) return
    package = ''
    call PCFactorGetMatSolverType(self%factorization, package, unasked)
    self%by_mumps = unasked == 0 .and. package == 'mumps'
    if (self%by_mumps) call self%prepare_mumps(0, error)
  end subroutine create_solver

  !> Makes CHOLMOD find out, without words, that a matrix is not positive definite.
  subroutine prepare_cholmod(ierr)
    !> PETSc's code
    integer, intent(out) :: ierr

    call PetscOptionsSetValue(PETSC_NULL_OPTIONS, '-mat_cholmod_print', '0', ierr)
    ! Its other form, L D L^T, takes negative pivots without complaint.
    if (ierr == 0) call PetscOptionsSetValue(PETSC_NULL_OPTIONS, '-mat_cholmod_factor', 'supernodal', ierr)
  end subroutine prepare_cholmod

  !> Gives MUMPS a new factor to fill and sets its controls.
  subroutine prepare_mumps(self, room, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Room beyond MUMPS' estimate in %, 0 for its own choice
    integer, intent(in) :: room
    !> Raised when PETSc fails
    type(error_t), allocatable, intent(inout) :: error
    type(tMat) :: factor
    integer :: ierr(8)

    ierr = 0
    call PCReset(self%factorization, ierr(1))
    call KSPSetOperators(self%solver, self%matrix, self%matrix, ierr(2))
    call PCFactorSetUpMatSolverType(self%factorization, ierr(3))
    call PCFactorGetMatrix(self%factorization, factor, ierr(4))
    call MatMumpsSetIcntl(factor, control_root, 1, ierr(5))
    call MatMumpsSetIcntl(factor, control_null_pivots, 1, ierr(6))
    call MatMumpsSetCntl(factor, control_null_size, null_pivot, ierr(7))
    if (room > 0) call MatMumpsSetIcntl(factor, control_room, room, ierr(8))
    call report_petsc(ierr, error)
  end subroutine prepare_mumps

  !> Zeroes the values of the matrix.
  subroutine clear(self)
    class(petsc_solver_t), intent(inout) :: self

    self%trouble = 0
    if (self%communicator%size == 1) then
      self%rows%values = 0
      self%rows%complete = .true.
    else
      call MatZeroEntries(self%matrix, self%trouble)
    end if
  end subroutine clear

  !> Adds an element's matrix; each element is added by one rank only.
  subroutine add(self, equations, values)
    class(petsc_solver_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, owned by any rank; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)
    integer :: ierr

    if (self%communicator%size == 1) then
      call self%rows%add(equations, values)
    else
      call MatSetValues(self%matrix, size(equations), equations, size(equations), equations, values, ADD_VALUES, ierr)
      if (self%trouble == 0) self%trouble = ierr
    end if
  end subroutine add

  !> Brings the matrix together.
  subroutine finish_assembly(self, error)
    class(petsc_solver_t), intent(inout) :: self
    !> Raised on all ranks when an entry falls outside the pattern
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    ierr(1) = self%trouble
    call MatAssemblyBegin(self%matrix, MAT_FINAL_ASSEMBLY, ierr(2))
    call MatAssemblyEnd(self%matrix, MAT_FINAL_ASSEMBLY, ierr(3))
    if (any(ierr /= 0) .or. .not. self%rows%complete) then
      call fail(error, exit_internal, 'An element couples unknowns that the pattern of the matrix does not couple.')
    end if
    call self%communicator%agree(error)
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
      if (allocated(error) .or. all(outcome /= outcomes_short_of_room)) exit
      call self%prepare_mumps(rooms(attempt), error)
      call self%factorize_once(singular, outcome, error)
    end do
    ! After a failure MUMPS refuses to go on with the factor that it has.
    if (outcome < 0) call self%prepare_mumps(0, error)
    if (singular .or. outcome < 0) call fail(error, exit_convergence, why_not_factored(self%by_mumps, outcome))
    call self%communicator%agree(error)
    self%factorisations = self%factorisations + 1
    if (allocated(error)) return
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
    call KSPSetOperators(self%solver, self%matrix, self%matrix, ierr(2))
    call KSPSetUp(self%solver, ierr(3))
    singular = ierr(3) == petsc_zero_pivot
    if (singular) return
    call report_petsc(ierr, error)
    if (allocated(error)) return
    call PCGetFailedReason(self%factorization, failure, ierr(3))
    singular = failure /= 0
    if (self%by_mumps) then
      outcome = self%mumps_report(report_outcome)
      failure = self%mumps_report(report_null_pivots)
      singular = outcome == outcome_singular .or. (outcome >= 0 .and. failure > 0)
    else
      if (.not. singular) singular = self%test_solve_explodes()
    end if
  end subroutine factorize_once

  !> Whether the solution of a test case grows beyond what rounding errors allow, the matrix being scaled
  !> to a diagonal of ones.
  logical function test_solve_explodes(self)
    class(petsc_solver_t), intent(inout) :: self
    real(wp), pointer :: values(:)
    real(wp), allocatable :: scale(:)
    integer :: ierr, i

    test_solve_explodes = .true.
    call MatGetDiagonal(self%matrix, self%left, ierr)
    call VecGetArrayReadF90(self%left, values, ierr)
    allocate (scale(size(values)), source=sqrt(max(values, 0.0_wp)))
    call VecRestoreArrayReadF90(self%left, values, ierr)
    call put(self%right, scale*[(cos(real(i, wp)), i=1, size(scale))], ierr)
    call KSPSolve(self%solver, self%right, self%left, ierr)
    if (ierr == 0) then
      call VecGetArrayReadF90(self%left, values, ierr)
      test_solve_explodes = .not. all(ieee_is_finite(values))
      if (.not. test_solve_explodes) test_solve_explodes = any(scale*abs(values)*null_pivot > 1)
      call VecRestoreArrayReadF90(self%left, values, ierr)
    end if
  end function test_solve_explodes

  !> A sentence that says why there is no factor.
  pure function why_not_factored(by_mumps, outcome) result(sentence)
    !> Whether MUMPS failed
    logical, intent(in) :: by_mumps
    !> Its outcome, INFOG(1)
    integer, intent(in) :: outcome
    !> The sentence
    character(len=:), allocatable :: sentence
    character(len=12) :: number

    if (by_mumps .and. outcome < 0 .and. outcome /= outcome_singular) then
      write (number, '(i0)') outcome
      sentence = 'MUMPS could not factor the stiffness matrix, probably for lack of memory (code '//trim(number)//').'
    else if (by_mumps) then
      sentence = 'The stiffness matrix is singular: a part of the plate can move freely.'
    else
      sentence = 'The stiffness matrix is singular or not positive definite.'
    end if
  end function why_not_factored

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

    call put(self%right, right_hand_side, ierr(1))
    call KSPSolve(self%solver, self%right, self%left, ierr(2))
    call take(self%left, solution, ierr(3))
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

  !> Multiplies the matrix as it was assembled last.
  subroutine multiply(self, vector, product)
    class(petsc_solver_t), intent(inout) :: self
    !> Owned part of the vector
    real(wp), intent(in) :: vector(:)
    !> Owned part of matrix times vector
    real(wp), intent(out) :: product(:)
    integer :: ierr

    call put(self%right, vector, ierr)
    call MatMult(self%matrix, self%right, self%left, ierr)
    call take(self%left, product, ierr)
  end subroutine multiply

  !> Number of negative pivots of the factor, the same on every rank.
  integer function negative_pivots(self)
    class(petsc_solver_t), intent(in) :: self

    ! Without MUMPS only positive definite matrices have a factor.
    negative_pivots = 0
    if (self%by_mumps) negative_pivots = self%mumps_report(report_negative)
  end function negative_pivots

  !> Size of the factor, the same on every rank.
  subroutine statistics(self, factor_entries, megabytes)
    class(petsc_solver_t), intent(in) :: self
    !> Numbers stored in the factor
    real(wp), intent(out) :: factor_entries
    !> Memory of the factorisation on all ranks, in MB
    real(wp), intent(out) :: megabytes
    type(tMat) :: factor
    double precision :: info(MAT_INFO_SIZE)
    integer :: entries, ierr

    if (self%by_mumps) then
      entries = self%mumps_report(report_entries)
      ! MUMPS counts in millions, with a negative sign, what an integer can't hold.
      factor_entries = merge(-1e6_wp, 1.0_wp, entries < 0)*entries
      megabytes = self%mumps_report(report_memory)
    else
      info = 0
      call PCFactorGetMatrix(self%factorization, factor, ierr)
      if (ierr == 0) call MatGetInfo(factor, MAT_GLOBAL_SUM, info, ierr)
      factor_entries = info(MAT_INFO_NZ_USED)
      megabytes = info(MAT_INFO_MEMORY)/2**20
    end if
  end subroutine statistics

  !> Frees matrix and factor.
  subroutine release(self)
    class(petsc_solver_t), intent(inout) :: self
    integer :: ierr

    if (.not. self%defined) return
    call KSPDestroy(self%solver, ierr)
    call VecDestroy(self%right, ierr)
    call VecDestroy(self%left, ierr)
    call MatDestroy(self%matrix, ierr)
    call self%rows%release()
    self%defined = .false.
  end subroutine release

  !> One of MUMPS' reports on the factor, INFOG.
  integer function mumps_report(self, number)
    class(petsc_solver_t), intent(in) :: self
    !> Which report
    integer, intent(in) :: number
    type(tMat) :: factor
    integer :: ierr

    mumps_report = 0
    call PCFactorGetMatrix(self%factorization, factor, ierr)
    if (ierr == 0) call MatMumpsGetInfog(factor, number, mumps_report, ierr)
  end function mumps_report

  !> Copies values into a vector.
  subroutine put(vector, values, ierr)
    !> The vector
    type(tVec), intent(inout) :: vector
    !> Its owned part
    real(wp), intent(in) :: values(:)
    !> PETSc's code
    integer, intent(out) :: ierr
    real(wp), pointer :: inside(:)

    call VecGetArrayF90(vector, inside, ierr)
    if (ierr /= 0) return
    inside(:) = values
    call VecRestoreArrayF90(vector, inside, ierr)
  end subroutine put

  !> Copies values out of a vector.
  subroutine take(vector, values, ierr)
    !> The vector
    type(tVec), intent(inout) :: vector
    !> Its owned part
    real(wp), intent(out) :: values(:)
    !> PETSc's code
    integer, intent(out) :: ierr
    real(wp), pointer :: inside(:)

    call VecGetArrayReadF90(vector, inside, ierr)
    if (ierr /= 0) return
    values = inside
    call VecRestoreArrayReadF90(vector, inside, ierr)
  end subroutine take
end module petsc_solvers
