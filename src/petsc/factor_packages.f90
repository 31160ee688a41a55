!> What the package that factors matrices behind PETSc must be told, and what it reports: MUMPS (Amestoy et al., SIAM J.
!> Matrix Anal. Appl. 23, 2001).
module factor_packages
  use petscksp, only: tMat, tPC
  implicit none
  private
  public :: prepare_mumps, mumps_report, why_not_factored

  !> MUMPS' controls: room beyond the estimate in %, and whether the root of the elimination tree stays on
  !> one rank and is factored like the rest of it.
  integer, parameter :: control_room = 14, control_root = 13
  !> MUMPS' reports: outcome, memory in MB, entries of the factor
  integer, parameter, public :: mumps_outcome = 1, mumps_memory = 22, mumps_entries = 29
  !> MUMPS' outcome for a singular matrix
  integer, parameter, public :: mumps_singular = -10
  !> Outcomes of MUMPS that more room cures
  integer, parameter, public :: mumps_short_of_room(*) = [-8, -9, -11, -14, -15, -17, -19, -20]

contains

  !> Sets the controls of MUMPS for a factor that isn't filled yet.
  subroutine prepare_mumps(factorization, room, ierr)
    !> What is to make the factor
    type(tPC), intent(in) :: factorization
    !> Room beyond MUMPS' estimate in %, negative for its own choice
    integer, intent(in) :: room
    !> First code of PETSc that isn't zero
    integer, intent(out) :: ierr
    type(tMat) :: factor
    integer :: codes(4)

    codes = 0
    call PCFactorSetUpMatSolverType(factorization, codes(1))
    call PCFactorGetMatrix(factorization, factor, codes(2))
    ierr = maxval(codes)
    if (ierr /= 0) return
    call MatMumpsSetIcntl(factor, control_root, 1, codes(3))
    if (room >= 0) call MatMumpsSetIcntl(factor, control_room, room, codes(4))
    ierr = maxval(codes)
  end subroutine prepare_mumps

  !> One of MUMPS' reports on the factor, INFOG.
  integer function mumps_report(factorization, number)
    !> What made the factor
    type(tPC), intent(in) :: factorization
    !> Which report
    integer, intent(in) :: number
    type(tMat) :: factor
    integer :: ierr

    mumps_report = 0
    call PCFactorGetMatrix(factorization, factor, ierr)
    if (ierr == 0) call MatMumpsGetInfog(factor, number, mumps_report, ierr)
  end function mumps_report

  !> A sentence that says why there is no factor.
  pure function why_not_factored(by_mumps, outcome) result(sentence)
    !> Whether MUMPS failed
    logical, intent(in) :: by_mumps
    !> Its outcome, INFOG(1)
    integer, intent(in) :: outcome
    !> The sentence
    character(len=:), allocatable :: sentence
    character(len=12) :: number

    if (by_mumps .and. outcome < 0 .and. outcome /= mumps_singular) then
      write (number, '(i0)') outcome
      sentence = 'MUMPS could not factor the stiffness matrix, probably for lack of memory (code '//trim(number)//').'
    else if (by_mumps) then
      sentence = 'The stiffness matrix is singular: a part of the plate can move freely.'
    else
      sentence = 'The stiffness matrix is singular or not positive definite.'
    end if
  end function why_not_factored
end module factor_packages
