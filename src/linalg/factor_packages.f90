!> Packages for the factorization of symmetric matrices through PETSc: CHOLMOD (Chen et al., ACM Trans. Math. Softw. 35,
!> 2008) on one rank, which solves for all ranks if there are several; MUMPS (Amestoy et al., SIAM J. Matrix Anal. Appl.
!> 23, 2001) on any number of ranks; PETSc's own on one.
module factor_packages
  use petscksp, only: tMat, tPC
  use linear_solver_parameters, only: factorization_cholmod, factorization_mumps
  implicit none
  private
  public :: packages_for, package_title, prepare_mumps, mumps_report, failure_message

  !> MUMPS' controls: memory beyond the estimate in %, and whether the root of the elimination tree is factorized on one
  !> rank like the other nodes.
  integer, parameter :: control_memory = 14, control_root = 13
  !> MUMPS' reports: outcome, negative pivots, memory in MB, entries of the factor
  integer, parameter, public :: mumps_outcome = 1, mumps_negative_pivots = 12, mumps_memory = 22, mumps_entries = 29
  !> MUMPS' outcome for a singular matrix
  integer, parameter, public :: mumps_singular = -10
  !> Outcomes of MUMPS for lack of memory, after which the factorization is repeated with more
  integer, parameter, public :: mumps_lacks_memory(*) = [-8, -9, -11, -14, -15, -17, -19, -20]

  !> Outcomes of a factorization
  integer, parameter, public :: factor_succeeded = 0, factor_not_positive = 1, factor_singular = 2, &
                                factor_lacks_memory = 3

  !> Largest number of rows for which one rank factorizes for all. Measured: on two ranks MUMPS takes 1.3 times as long
  !> for a solve as CHOLMOD on one for 59 000 rows, and .93 times for 240 000.
  integer, parameter :: max_rows_for_one = 200000

contains

  !> PETSc's names of suitable packages, in order of preference.
  pure function packages_for(factorization, positive_definite, ranks, rows) result(names)
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> True: the caller declares the matrix positive definite
    logical, intent(in) :: positive_definite
    !> Number of ranks, and of rows on all of them
    integer, intent(in) :: ranks, rows
    character(len=7), allocatable :: names(:)

    if (factorization == factorization_cholmod) then
      names = ['cholmod']
    else if (positive_definite .and. factorization /= factorization_mumps .and. &
             (ranks == 1 .or. rows <= max_rows_for_one)) then
      names = ['cholmod', 'mumps  ', 'petsc  ']
    else
      names = ['mumps  ', 'petsc  ']
    end if
    if (ranks > 1) names = pack(names, names /= 'petsc')
  end function packages_for

  !> Usual name of a package.
  pure function package_title(name) result(title)
    !> PETSc's name of it; empty: none
    character(len=*), intent(in) :: name
    character(len=:), allocatable :: title

    select case (name)
    case ('cholmod')
      title = 'CHOLMOD'
    case ('mumps')
      title = 'MUMPS'
    case default
      title = 'PETSc'
    end select
  end function package_title

  !> Sets the controls of MUMPS before the factorization.
  subroutine prepare_mumps(preconditioner, memory_margin, ierr)
    !> The preconditioner that factorizes
    type(tPC), intent(in) :: preconditioner
    !> Memory beyond MUMPS' estimate in %, negative for its own choice
    integer, intent(in) :: memory_margin
    !> First non-zero code of PETSc
    integer, intent(out) :: ierr
    type(tMat) :: factor
    integer :: codes(3)

    codes = 0
    call PCFactorGetMatrix(preconditioner, factor, codes(1))
    if (codes(1) == 0) call MatMumpsSetIcntl(factor, control_root, 1, codes(2))
    if (codes(1) == 0 .and. memory_margin >= 0) call MatMumpsSetIcntl(factor, control_memory, memory_margin, codes(3))
    ierr = maxval(codes)
  end subroutine prepare_mumps

  !> One of MUMPS' reports on the factor, INFOG.
  integer function mumps_report(preconditioner, number)
    !> The preconditioner that factorized
    type(tPC), intent(in) :: preconditioner
    !> Number of the report
    integer, intent(in) :: number
    type(tMat) :: factor
    integer :: ierr

    mumps_report = 0
    call PCFactorGetMatrix(preconditioner, factor, ierr)
    if (ierr == 0) call MatMumpsGetInfog(factor, number, mumps_report, ierr)
  end function mumps_report

  !> Message for a failed factorization.
  pure function failure_message(title, outcome) result(sentence)
    !> Name of the package
    character(len=*), intent(in) :: title
    integer, intent(in) :: outcome
    character(len=:), allocatable :: sentence

    select case (outcome)
    case (factor_singular)
      sentence = 'The stiffness matrix is singular: a part of the plate can move without resistance.'
    case (factor_not_positive)
      sentence = 'The stiffness matrix is singular or not positive definite.'
    case default
      sentence = title//' could not factor the stiffness matrix, probably for lack of memory.'
    end select
  end function failure_message
end module factor_packages
