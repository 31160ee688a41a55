!> Interfaces of the procedures of LAPACK that Fortran calls.
module lapack_interfaces
  use kinds, only: wp
  implicit none
  private
  public :: dgesv, dpotrf, dpotrs

  interface
    !> LAPACK: solves with a general matrix by elimination with pivoting.
    subroutine dgesv(n, columns, a, lda, pivots, b, ldb, info)
      import :: wp
      !> Order, right-hand sides, leading dimensions
      integer, intent(in) :: n, columns, lda, ldb
      !> Matrix, overwritten by its factors
      real(wp), intent(inout) :: a(lda, *)
      !> Row exchanges
      integer, intent(out) :: pivots(*)
      !> Right-hand sides, overwritten by the solution
      real(wp), intent(inout) :: b(ldb, *)
      !> Greater than 0: singular
      integer, intent(out) :: info
    end subroutine dgesv

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
  end interface
end module lapack_interfaces
