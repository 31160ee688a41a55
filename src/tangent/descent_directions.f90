!> A descent direction where the tangent of a step is not positive definite: Newton's direction with the absolute
!> values of the eigenvalues in a small subspace (J. Nocedal, S. J. Wright, Numerical Optimization, 2006, section 3.4;
!> Y. N.
!> Dauphin et al., Advances in Neural Information Processing Systems 27 (2014) 2933-2941).
module descent_directions
  use kinds, only: wp
  implicit none
  private
  public :: find_descent_direction

  !> Smallest magnitude of an eigenvalue relative to the largest; smaller ones are raised to it, as round-off hides
  !> them.
  real(wp), parameter :: min_eigenvalue = 1.0e-10_wp

  interface
    !> LAPACK: eigenvalues and eigenvectors of A x = lambda B x.
    subroutine dsygv(itype, jobz, uplo, n, a, lda, b, ldb, w, work, lwork, info)
      import :: wp
      !> 1: this problem; order, leading dimensions, size of the work array
      integer, intent(in) :: itype, n, lda, ldb, lwork
      !> 'V': eigenvectors too; 'L': lower triangles are given
      character, intent(in) :: jobz, uplo
      !> A, overwritten by the eigenvectors, and B, positive definite, overwritten by its factor
      real(wp), intent(inout) :: a(lda, *), b(ldb, *)
      !> Eigenvalues, ascending; work array
      real(wp), intent(out) :: w(*), work(*)
      !> Not 0: the eigenvalues were not found
      integer, intent(out) :: info
    end subroutine dsygv
  end interface

contains

  !> Coefficients of a descent direction in a subspace, if the tangent has negative curvature in it.
  subroutine find_descent_direction(tangent, metric, forces, coefficients, negative)
    !> Projection of the tangent on the basis of the subspace, (basis, basis); its symmetric part is used
    real(wp), intent(in) :: tangent(:, :)
    !> Projection of a positive definite operator close to it
    real(wp), intent(in) :: metric(:, :)
    !> Projection of the residual, (basis)
    real(wp), intent(in) :: forces(:)
    !> Coefficients of the basis vectors; unchanged without negative curvature, (basis)
    real(wp), intent(inout) :: coefficients(:)
    !> True: there is negative curvature
    logical, intent(out) :: negative
    real(wp) :: vectors(size(forces), size(forces)), factor(size(forces), size(forces)), values(size(forces))
    real(wp) :: work(max(1, 34*size(forces)))
    integer :: info

    vectors = (tangent + transpose(tangent))/2
    factor = (metric + transpose(metric))/2
    call dsygv(1, 'V', 'L', size(forces), vectors, size(forces), factor, size(forces), values, work, size(work), info)
    negative = .false.
    if (info /= 0) return
    negative = values(1) < -min_eigenvalue*maxval(abs(values))
    if (.not. negative) return
    values = abs(values)
    coefficients = matmul(vectors, matmul(forces, vectors)/max(values, min_eigenvalue*maxval(values)))
  end subroutine find_descent_direction
end module descent_directions
