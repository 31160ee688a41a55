!> Small dense systems.
module dense_systems
  use kinds, only: wp
  implicit none
  private
  public :: positive_factor_t, solve_dense

  !> A small symmetric matrix, factorized if it is positive definite.
  type :: positive_factor_t
    !> True: the matrix is positive definite and factorized
    logical :: positive = .false.
    !> Its lower factor, (n, n)
    real(wp), allocatable, private :: factors(:, :)
  contains
    !> Factorizes a matrix.
    procedure :: factorize => factorize_positive
    !> Solves with the factors.
    procedure :: solve => solve_positive
  end type positive_factor_t

  interface
    !> LAPACK: solves a general system by elimination with pivoting.
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

    !> LAPACK: factorizes a symmetric positive definite matrix.
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

contains

  !> Factorizes a symmetric matrix, or finds that it is not positive definite.
  subroutine factorize_positive(self, matrix)
    !> Receives the factor
    class(positive_factor_t), intent(inout) :: self
    !> Matrix, its lower triangle is read, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    integer :: info

    self%factors = matrix
    self%positive = .true.
    if (size(matrix) == 0) return
    call dpotrf('L', size(matrix, 1), self%factors, size(matrix, 1), info)
    self%positive = info == 0
  end subroutine factorize_positive

  !> Solves with the factor of a positive definite matrix.
  subroutine solve_positive(self, x)
    !> The factor
    class(positive_factor_t), intent(in) :: self
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    integer :: info

    if (size(x) > 0) call dpotrs('L', size(x), 1, self%factors, size(x), x, size(x), info)
  end subroutine solve_positive

  !> Solves a small dense system.
  subroutine solve_dense(matrix, x, singular)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    !> True: there is no solution, x is unchanged
    logical, intent(out) :: singular
    real(wp) :: factors(size(x), size(x)), solution(size(x))
    integer :: pivots(size(x)), info

    factors = matrix
    solution = x
    info = 0
    if (size(x) > 0) call dgesv(size(x), 1, factors, size(x), pivots, solution, size(x), info)
    singular = info /= 0
    if (.not. singular) x = solution
  end subroutine solve_dense
end module dense_systems
