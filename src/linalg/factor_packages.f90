!> Packages behind PETSc that factor symmetric matrices: CHOLMOD (Chen et al., ACM Trans. Math. Softw. 35, 2008), which
!> works on one rank, for all of them if there are several; MUMPS (Amestoy et al., SIAM J. Matrix Anal. Appl. 23, 2001)
!> on any number of ranks; PETSc's own on one.
module factor_packages
  use petscksp, only: tMat, tPC
  use linear_solver_parameters, only: factorization_cholmod, factorization_mumps
  implicit none
  private
  public :: packages_for, package_title, prepare_mumps, mumps_report, why_not_factored

  !> MUMPS' controls: room beyond the estimate in %, and whether the root of the elimination tree stays on
  !> one rank and is factored like the rest of it.
  integer, parameter :: control_room = 14, control_root = 13
  !> MUMPS' reports: outcome, negative pivots, memory in MB, entries of the factor
  integer, parameter, public :: mumps_outcome = 1, mumps_negative_pivots = 12, mumps_memory = 22, mumps_entries = 29
  !> MUMPS' outcome for a singular matrix
  integer, parameter, public :: mumps_singular = -10
  !> Outcomes of MUMPS that more room cures
  integer, parameter, public :: mumps_short_of_room(*) = [-8, -9, -11, -14, -15, -17, -19, -20]

  !> What comes of a factorization
  integer, parameter, public :: factor_made = 0, factor_not_positive = 1, factor_singular = 2, factor_lacks_memory = 3

  !> Rows up to which one rank factors for all. Measured: on two ranks MUMPS takes 1.3 times as long for a solve as
  !> CHOLMOD on one for 59 000 rows, and .93 times for 240 000.
  integer, parameter :: max_rows_for_one = 200000

contains

  !> PETSc's names of the packages that suit, the best first.
  pure function packages_for(factorization, positive_definite, ranks, rows) result(names)
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> Whether the matrix is promised to be positive definite
    logical, intent(in) :: positive_definite
    !> Number of ranks, and of rows on all of them
    integer, intent(in) :: ranks, rows
    !> The names
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

  !> What people call a package.
  pure function package_title(name) result(title)
    !> PETSc's name of it; empty: no package factors
    character(len=*), intent(in) :: name
    !> The title
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

  !> Sets the controls of MUMPS for a factor that isn't filled yet.
  subroutine prepare_mumps(preconditioner, memory_margin, ierr)
    !> What is to make the factor
    type(tPC), intent(in) :: preconditioner
    !> Room beyond MUMPS' estimate in %, negative for its own choice
    integer, intent(in) :: memory_margin
    !> First code of PETSc that isn't zero
    integer, intent(out) :: ierr
    type(tMat) :: factor
    integer :: codes(3)

    codes = 0
    call PCFactorGetMatrix(preconditioner, factor, codes(1))
    if (codes(1) == 0) call MatMumpsSetIcntl(factor, control_root, 1, codes(2))
    if (codes(1) == 0 .and. memory_margin >= 0) call MatMumpsSetIcntl(factor, control_room, memory_margin, codes(3))
    ierr = maxval(codes)
  end subroutine prepare_mumps

  !> One of MUMPS' reports on the factor, INFOG.
  integer function mumps_report(preconditioner, number)
    !> What made the factor
    type(tPC), intent(in) :: preconditioner
    !> Which report
    integer, intent(in) :: number
    type(tMat) :: factor
    integer :: ierr

    mumps_report = 0
    call PCFactorGetMatrix(preconditioner, factor, ierr)
    if (ierr == 0) call MatMumpsGetInfog(factor, number, mumps_report, ierr)
  end function mumps_report

  !> A sentence that says why there is no factor.
  pure function why_not_factored(title, outcome) result(sentence)
    !> Who failed
    character(len=*), intent(in) :: title
    !> One of the factor_* outcomes
    integer, intent(in) :: outcome
    !> The sentence
    character(len=:), allocatable :: sentence

    select case (outcome)
    case (factor_singular)
      sentence = 'The stiffness matrix is singular: a part of the plate can move freely.'
    case (factor_not_positive)
      sentence = 'The stiffness matrix is singular or not positive definite.'
    case default
      sentence = title//' could not factor the stiffness matrix, probably for lack of memory.'
    end select
  end function why_not_factored
end module factor_packages
