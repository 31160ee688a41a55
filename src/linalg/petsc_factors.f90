!> The factorization of a matrix by PETSc: a PC, and a KSP that applies it.
module petsc_factors
  use petscksp, only: tMat, tKSP, tPC, PETSC_COMM_SELF, PETSC_TRUE, PETSC_FALSE, MAT_FACTOR_CHOLESKY, MAT_LOCAL, &
                      MAT_INFO_SIZE, MAT_INFO_NZ_USED, MAT_INFO_MEMORY, MAT_SPD, KSPSetOperators
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_usage
  use factor_packages, only: package_title, prepare_mumps, mumps_report, mumps_outcome, mumps_memory, mumps_entries, &
                             mumps_negative_pivots, mumps_singular, mumps_lacks_memory, factor_succeeded, &
                             factor_not_positive, factor_singular, factor_lacks_memory
  use kinds, only: wp
  use petsc_session, only: report_petsc
  implicit none
  private
  public :: petsc_factor_t

  !> PETSC_ERR_MAT_CH_ZRPVT, which CHOLMOD returns for a pivot that is zero or negative; and PETSC_ERR_MEM and
  !> PETSC_ERR_LIB, for lack of memory
  integer, parameter :: bad_pivot = 81, no_memory(*) = [55, 76]

  !> Memory beyond MUMPS' estimate in %, ICNTL(14): MUMPS' default and, as its users' guide advises after a failure for
  !> lack of memory, twice and five times the estimate
  integer, parameter :: usual_margin = -1, larger_margins(*) = [100, 400]

  !> A factorization of PETSc and its settings.
  type :: petsc_factor_t
    !> True between `define` and `release`
    logical :: defined = .false.
    !> PETSc's name of the package; empty: the package is chosen by the user's options
    character(len=:), allocatable :: package
    !> True: one rank factorizes and solves for all of them
    logical, private :: gathered = .false.
    !> Applies the factors once
    type(tKSP) :: solver
    !> Computes and stores the factors
    type(tPC), private :: preconditioner
    !> All ranks
    type(communicator_t), private :: communicator
    !> True: the caller declares the matrix positive definite
    logical, private :: positive_definite = .true.
  contains
    procedure :: define
    procedure :: factorize
    procedure :: title
    procedure :: statistics
    procedure :: release
    procedure, private :: choose_package
    procedure, private :: gather_on_one_rank
    procedure, private :: factorize_gathered
    procedure, private :: factor_matrix
    procedure, private :: renew
    procedure, private :: factorize_once
    procedure, private :: check_mumps
  end type petsc_factor_t

contains

  !> Chooses the package: the first that PETSc has, or that of the user's options.
  subroutine define(self, communicator, matrix, packages, positive_definite, prefix, error)
    class(petsc_factor_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    !> The matrix to be factored
    type(tMat), intent(in) :: matrix
    !> PETSc's names of packages, in order of preference
    character(len=*), intent(in) :: packages(:)
    !> True: the caller declares the matrix positive definite, which needs no pivoting
    logical, intent(in) :: positive_definite
    !> Prefix of the options for this solver, after the dash
    character(len=*), intent(in) :: prefix
    !> Set if PETSc fails, or (usage) has none of the packages
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(7)

    self%communicator = communicator
    self%positive_definite = positive_definite
    call KSPCreate(communicator%handle(), self%solver, ierr(1))
    self%defined = ierr(1) == 0
    call KSPSetOptionsPrefix(self%solver, prefix, ierr(2))
    call KSPSetOperators(self%solver, matrix, matrix, ierr(3))
    call KSPSetType(self%solver, 'preonly', ierr(4))
    call KSPGetPC(self%solver, self%preconditioner, ierr(5))
    call PCSetType(self%preconditioner, 'cholesky', ierr(6))
    call KSPSetFromOptions(self%solver, ierr(7))
    call report_petsc(ierr, error)
    if (.not. allocated(error)) call self%choose_package(matrix, packages, error)
    if (.not. allocated(error)) call self%renew(matrix, usual_margin, error)
  end subroutine define

  !> Chooses the package, unless the user's options do.
  subroutine choose_package(self, matrix, packages, error)
    class(petsc_factor_t), intent(inout) :: self
    !> The matrix to be factored
    type(tMat), intent(in) :: matrix
    !> PETSc's names of packages, in order of preference
    character(len=*), intent(in) :: packages(:)
    !> Set (usage) if PETSc has none of them
    type(error_t), allocatable, intent(inout) :: error
    character(len=64) :: name
    integer :: i, ierr, unset

    self%package = ''
    name = ''
    call PCGetType(self%preconditioner, name, ierr)
    if (name /= 'cholesky') return
    name = ''
    call PCFactorGetMatSolverType(self%preconditioner, name, unset)
    if (unset == 0 .and. name /= '') then
      self%package = trim(name)
      return
    end if
    call MatSetOption(matrix, MAT_SPD, merge(PETSC_TRUE, PETSC_FALSE, self%positive_definite), ierr)
    do i = 1, size(packages)
      if (packages(i) == 'cholmod' .and. self%communicator%size > 1) then
        call self%gather_on_one_rank(ierr)
        if (ierr /= 0) cycle
        self%package = 'cholmod'
        self%gathered = .true.
        return
      end if
      call PCFactorSetMatSolverType(self%preconditioner, trim(packages(i)), ierr)
      if (ierr == 0) call PCFactorSetUpMatSolverType(self%preconditioner, ierr)
      if (.not. self%communicator%all(ierr == 0)) cycle
      self%package = trim(packages(i))
      return
    end do
    call fail(error, exit_usage, 'This PETSc was built without '//package_title(packages(1))// &
              ', which is to factor the stiffness matrix.')
  end subroutine choose_package

  !> Gathers the matrix on one rank, which factorizes and solves for all by the serial package CHOLMOD.
  subroutine gather_on_one_rank(self, ierr)
    class(petsc_factor_t), intent(inout) :: self
    !> First non-zero code of PETSc, as if it was built without CHOLMOD
    integer, intent(out) :: ierr
    type(tMat) :: small, factor
    integer :: codes(7)

    call MatCreateSeqSBAIJ(PETSC_COMM_SELF, 1, 1, 1, 1, [1], small, codes(1))
    call MatGetFactor(small, 'cholmod', MAT_FACTOR_CHOLESKY, factor, codes(2))
    codes(3) = 0
    if (codes(2) == 0) call MatDestroy(factor, codes(3))
    call MatDestroy(small, codes(4))
    ierr = maxval(codes(:4))
    if (ierr /= 0) return
    call PCSetType(self%preconditioner, 'telescope', codes(5))
    call PCTelescopeSetReductionFactor(self%preconditioner, self%communicator%size, codes(6))
    call PCSetFromOptions(self%preconditioner, codes(7))
    ierr = maxval(codes)
  end subroutine gather_on_one_rank

  !> Factorizes on the rank that solves for all, before the first solve: after a failure within the solve the other
  !> ranks would wait forever.
  subroutine factorize_gathered(self, ierr)
    class(petsc_factor_t), intent(in) :: self
    !> PETSc's code
    integer, intent(out) :: ierr
    type(tKSP) :: inner

    ierr = 0
    if (self%communicator%rank > 0) return
    call PCTelescopeGetKSP(self%preconditioner, inner, ierr)
    if (ierr == 0) call KSPSetUp(inner, ierr)
  end subroutine factorize_gathered

  !> Creates new factors and sets the controls of the package.
  subroutine renew(self, matrix, memory_margin, error)
    class(petsc_factor_t), intent(inout) :: self
    !> The matrix to be factored
    type(tMat), intent(in) :: matrix
    !> Memory beyond MUMPS' estimate in %, negative for its own choice
    integer, intent(in) :: memory_margin
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(5)

    ierr = 0
    call PCReset(self%preconditioner, ierr(1))
    call KSPSetOperators(self%solver, matrix, matrix, ierr(2))
    ! MUMPS reads the option of the matrix on definiteness when the factors are created.
    call MatSetOption(matrix, MAT_SPD, merge(PETSC_TRUE, PETSC_FALSE, self%positive_definite), ierr(3))
    if (self%package /= '' .and. .not. self%gathered) call PCFactorSetUpMatSolverType(self%preconditioner, ierr(4))
    if (self%package == 'mumps' .and. ierr(4) == 0) call prepare_mumps(self%preconditioner, memory_margin, ierr(5))
    call report_petsc(ierr, error)
  end subroutine renew

  !> Factorizes a matrix, repeatedly with more memory if MUMPS requires it. Collective.
  subroutine factorize(self, matrix, outcome, error)
    class(petsc_factor_t), intent(inout) :: self
    type(tMat), intent(in) :: matrix
    !> One of the factor_* outcomes, the same on every rank
    integer, intent(out) :: outcome
    !> Set if PETSc fails for another reason than the values of the matrix
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr, attempt
    logical :: lacks_memory

    call self%factorize_once(matrix, outcome, lacks_memory, error)
    do attempt = 1, size(larger_margins)
      if (allocated(error) .or. .not. lacks_memory) exit
      call self%renew(matrix, larger_margins(attempt), error)
      if (.not. allocated(error)) call self%factorize_once(matrix, outcome, lacks_memory, error)
    end do
    call self%communicator%maximum(outcome)
    call self%communicator%agree(error)
    if (allocated(error)) return
    if (outcome == factor_succeeded) then
      ! The factors are kept until the next call of this procedure, also while new values are assembled.
      call KSPSetReusePreconditioner(self%solver, PETSC_TRUE, ierr)
    else
      ! After a failure the packages do not accept the existing factor again.
      call self%renew(matrix, usual_margin, error)
    end if
  end subroutine factorize

  !> Factorizes a matrix once.
  subroutine factorize_once(self, matrix, outcome, lacks_memory, error)
    class(petsc_factor_t), intent(inout) :: self
    type(tMat), intent(in) :: matrix
    integer, intent(out) :: outcome
    !> True: MUMPS needs more memory
    logical, intent(out) :: lacks_memory
    !> Set if PETSc fails for another reason than the values of the matrix
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3), failure

    lacks_memory = .false.
    outcome = factor_succeeded
    call KSPSetReusePreconditioner(self%solver, PETSC_FALSE, ierr(1))
    ! The same matrix is set again, so that the solver checks whether its values have changed.
    call KSPSetOperators(self%solver, matrix, matrix, ierr(2))
    call KSPSetUp(self%solver, ierr(3))
    if (self%gathered .and. ierr(3) == 0) call self%factorize_gathered(ierr(3))
    if (ierr(3) == bad_pivot) outcome = factor_not_positive
    if (any(ierr(3) == no_memory)) outcome = factor_lacks_memory
    if (outcome /= factor_succeeded) return
    call report_petsc(ierr, error)
    if (allocated(error)) return
    failure = 0
    call PCGetFailedReason(self%preconditioner, failure, ierr(3))
    if (failure /= 0) outcome = factor_singular
    if (self%package == 'mumps') call self%check_mumps(outcome, lacks_memory)
  end subroutine factorize_once

  !> Outcome of a factorization by MUMPS.
  subroutine check_mumps(self, outcome, lacks_memory)
    class(petsc_factor_t), intent(in) :: self
    integer, intent(inout) :: outcome
    !> True: it needs more memory
    logical, intent(out) :: lacks_memory

    associate (code => mumps_report(self%preconditioner, mumps_outcome))
      lacks_memory = any(code == mumps_lacks_memory)
      if (code < 0) outcome = merge(factor_singular, factor_lacks_memory, code == mumps_singular)
    end associate
    ! MUMPS accepts negative pivots of a matrix that was declared positive definite.
    if (outcome == factor_succeeded .and. self%positive_definite) then
      if (mumps_report(self%preconditioner, mumps_negative_pivots) > 0) outcome = factor_not_positive
    end if
  end subroutine check_mumps

  !> Usual name of the package.
  pure function title(self)
    class(petsc_factor_t), intent(in) :: self
    character(len=:), allocatable :: title

    title = package_title(self%package)
  end function title

  !> Size of the factors, the same on every rank.
  subroutine statistics(self, entries, megabytes)
    class(petsc_factor_t), intent(in) :: self
    !> Number of stored entries of the factors
    real(wp), intent(out) :: entries
    !> Memory of the factorization on all ranks, in MB
    real(wp), intent(out) :: megabytes
    type(tMat) :: factor
    double precision :: info(MAT_INFO_SIZE)
    integer :: counted, ierr
    logical :: found

    entries = 0
    megabytes = 0
    if (.not. self%defined) return
    if (self%package == 'mumps') then
      counted = mumps_report(self%preconditioner, mumps_entries)
      ! Beyond the range of an integer MUMPS reports millions, with a negative sign.
      entries = merge(-1e6_wp, 1.0_wp, counted < 0)*counted
      megabytes = mumps_report(self%preconditioner, mumps_memory)
    else
      info = 0
      call self%factor_matrix(factor, found)
      if (found) call MatGetInfo(factor, MAT_LOCAL, info, ierr)
      entries = info(MAT_INFO_NZ_USED)
      megabytes = info(MAT_INFO_MEMORY)/1e6_wp
      call self%communicator%sum(entries)
      call self%communicator%sum(megabytes)
    end if
  end subroutine statistics

  !> The factors of a package other than MUMPS.
  subroutine factor_matrix(self, factor, found)
    class(petsc_factor_t), intent(in) :: self
    !> The factor
    type(tMat), intent(out) :: factor
    !> False: this rank has no factors
    logical, intent(out) :: found
    type(tKSP) :: inner
    type(tPC) :: preconditioner
    integer :: ierr(3)

    found = self%package /= '' .and. .not. (self%gathered .and. self%communicator%rank > 0)
    if (.not. found) return
    ierr = 0
    preconditioner = self%preconditioner
    if (self%gathered) call PCTelescopeGetKSP(self%preconditioner, inner, ierr(1))
    if (self%gathered .and. ierr(1) == 0) call KSPGetPC(inner, preconditioner, ierr(2))
    if (all(ierr == 0)) call PCFactorGetMatrix(preconditioner, factor, ierr(3))
    found = all(ierr == 0)
  end subroutine factor_matrix

  !> Deallocates the factors.
  subroutine release(self)
    class(petsc_factor_t), intent(inout) :: self
    integer :: ierr

    if (self%defined) call KSPDestroy(self%solver, ierr)
    self%defined = .false.
    self%gathered = .false.
  end subroutine release
end module petsc_factors
