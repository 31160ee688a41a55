!> Interfaces of the procedures of BLAS and LAPACK that Fortran calls.
module blas_interfaces
  use kinds, only: wp
  implicit none
  private
  public :: dgemv, dgemm, dgetrf, dgetrs, dpotrf, dpotrs, dpotri, dsyevd

  interface
    !> BLAS: y = alpha A x + beta y, or with the transpose of A.
    subroutine dgemv(trans, m, n, alpha, a, lda, x, incx, beta, y, incy)
      import :: wp
      !> 'N': the matrix itself, 'T': its transpose
      character, intent(in) :: trans
      !> Rows, columns, leading dimension, strides
      integer, intent(in) :: m, n, lda, incx, incy
      !> Factors
      real(wp), intent(in) :: alpha, beta
      !> Matrix and vector
      real(wp), intent(in) :: a(lda, *), x(*)
      !> Result
      real(wp), intent(inout) :: y(*)
    end subroutine dgemv

    !> BLAS: C = alpha A B + beta C, or with transposes.
    subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: wp
      !> 'N': the matrix itself, 'T': its transpose
      character, intent(in) :: transa, transb
      !> Rows and columns of C, length of the sums, leading dimensions
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      !> Factors
      real(wp), intent(in) :: alpha, beta
      !> Matrices
      real(wp), intent(in) :: a(lda, *), b(ldb, *)
      !> Result
      real(wp), intent(inout) :: c(ldc, *)
    end subroutine dgemm

    !> LAPACK: factors a general matrix by elimination with pivoting.
    subroutine dgetrf(m, n, a, lda, pivots, info)
      import :: wp
      !> Rows, columns, leading dimension
      integer, intent(in) :: m, n, lda
      !> Matrix, overwritten by its factors
      real(wp), intent(inout) :: a(lda, *)
      !> Row exchanges
      integer, intent(out) :: pivots(*)
      !> Greater than 0: singular
      integer, intent(out) :: info
    end subroutine dgetrf

    !> LAPACK: solves with the factors of dgetrf.
    subroutine dgetrs(trans, n, columns, a, lda, pivots, b, ldb, info)
      import :: wp
      !> 'N': the matrix itself
      character, intent(in) :: trans
      !> Order, right-hand sides, leading dimensions
      integer, intent(in) :: n, columns, lda, ldb
      !> Factors
      real(wp), intent(in) :: a(lda, *)
      !> Row exchanges
      integer, intent(in) :: pivots(*)
      !> Right-hand sides, overwritten by the solution
      real(wp), intent(inout) :: b(ldb, *)
      !> Not 0: an argument is wrong
      integer, intent(out) :: info
    end subroutine dgetrs

    !> LAPACK: factors a symmetric matrix that is positive definite.
    subroutine dpotrf(uplo, n, a, lda, info)
      import :: wp
      !> 'L': its lower triangle is given
      character, intent(in) :: uplo
      !> Order, leading dimension
      integer, intent(in) :: n, lda
      !> Matrix, overwritten by its factor
      real(wp), intent(inout) :: a(lda, *)
      !> Greater than 0: not positive definite
      integer, intent(out) :: info
    end subroutine dpotrf

    !> LAPACK: solves with the factor of dpotrf.
    subroutine dpotrs(uplo, n, columns, a, lda, b, ldb, info)
      import :: wp
      !> 'L': the lower factor
      character, intent(in) :: uplo
      !> Order, right-hand sides, leading dimensions
      integer, intent(in) :: n, columns, lda, ldb
      !> Factor
      real(wp), intent(in) :: a(lda, *)
      !> Right-hand sides, overwritten by the solution
      real(wp), intent(inout) :: b(ldb, *)
      !> Not 0: an argument is wrong
      integer, intent(out) :: info
    end subroutine dpotrs

    !> LAPACK: the inverse from the factor of dpotrf.
    subroutine dpotri(uplo, n, a, lda, info)
      import :: wp
      !> 'L': the lower factor
      character, intent(in) :: uplo
      !> Order, leading dimension
      integer, intent(in) :: n, lda
      !> Factor, its triangle overwritten by that of the inverse
      real(wp), intent(inout) :: a(lda, *)
      !> Not 0: there is none
      integer, intent(out) :: info
    end subroutine dpotri

    !> LAPACK: eigenvalues and eigenvectors of a symmetric matrix.
    subroutine dsyevd(jobz, uplo, n, a, lda, w, work, lwork, iwork, liwork, info)
      import :: wp
      !> 'V': eigenvectors too; 'L': the lower triangle is given
      character, intent(in) :: jobz, uplo
      !> Order, leading dimension, sizes of the room to work in
      integer, intent(in) :: n, lda, lwork, liwork
      !> Matrix, overwritten by its eigenvectors
      real(wp), intent(inout) :: a(lda, *)
      !> Eigenvalues, room to work in
      real(wp), intent(out) :: w(*), work(*)
      !> Room to work in
      integer, intent(out) :: iwork(*)
      !> Not 0: they were not found
      integer, intent(out) :: info
    end subroutine dsyevd
  end interface
end module blas_interfaces
