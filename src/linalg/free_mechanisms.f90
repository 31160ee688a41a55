!> Detects a numerically singular matrix: a mechanism of the structure. Packages that factorize without pivoting do not
!> report it, so an inverse iteration for the smallest eigenvalue of the matrix with unit diagonal tests for it.
module free_mechanisms
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use petscksp, only: tKSP
  use communicators, only: communicator_t
  use kinds, only: wp
  use petsc_matrices, only: petsc_matrix_t
  implicit none
  private
  public :: has_mechanism

  !> Growth of a vector in one inverse iteration, the inverse of the smallest eigenvalue, above which this eigenvalue is
  !> round-off: five times the precision of 2.2e-16, as the matrix is scaled to a diagonal of 1
  real(wp), parameter :: largest_growth = 1e15_wp

contains

  !> True if a part of the structure can move without resistance. Two solves for the first factor, one for later ones.
  !> Collective.
  logical function has_mechanism(communicator, solver, matrix, mode) result(found)
    type(communicator_t), intent(in) :: communicator
    !> Applies the factor
    type(tKSP), intent(in) :: solver
    type(petsc_matrix_t), intent(inout) :: matrix
    !> Approximate eigenvector, this rank's rows; unallocated: none is known, or there is a mechanism
    real(wp), allocatable, intent(inout) :: mode(:)
    real(wp), allocatable :: scale(:)
    real(wp) :: growth
    integer :: pass, passes, ierr(3), i

    scale = sqrt(abs(matrix%diagonal()))
    passes = merge(1, 2, allocated(mode))
    if (.not. allocated(mode)) mode = [(cos(real(i, wp)), i=1, size(scale))]
    do pass = 1, passes
      call matrix%solve(solver, scale*mode, mode, ierr)
      found = communicator%any(any(ierr /= 0) .or. .not. all(ieee_is_finite(mode)))
      if (.not. found) then
        mode = scale*mode
        growth = maxval([0.0_wp, abs(mode)])
        call communicator%maximum(growth)
        found = growth > largest_growth .or. .not. growth > 0
      end if
      if (found) exit
      mode = mode/growth
    end do
    if (found) deallocate (mode)
  end function has_mechanism
end module free_mechanisms
