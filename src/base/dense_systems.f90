!> Small dense systems, by elimination with pivoting.
module dense_systems
  use kinds, only: wp
  implicit none
  private
  public :: solve_dense, pseudo_inverse, symmetric_modes

  interface
    !> LAPACK: solves with a general matrix.
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

    !> LAPACK: eigenvalues and eigenvectors of a symmetric matrix.
    pure subroutine dsyev(jobz, uplo, n, a, lda, values, work, lwork, info)
      import :: wp
      !> V: with eigenvectors; triangle used
      character(len=1), intent(in) :: jobz, uplo
      !> Order, leading dimension, length of the work space
      integer, intent(in) :: n, lda, lwork
      !> Matrix, overwritten by its eigenvectors
      real(wp), intent(inout) :: a(lda, *)
      !> Eigenvalues in ascending order
      real(wp), intent(out) :: values(*), work(*)
      !> Greater than 0: not converged
      integer, intent(out) :: info
    end subroutine dsyev
  end interface

contains

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

  !> Pseudo-inverse of a symmetric positive semidefinite matrix: its inverse if it has one. For a right-hand side in the
  !> range of the matrix it gives the solution of smallest norm. Eigenvalues below n*epsilon of the largest are taken as
  !> zero (G. H. Golub, C. F. Van Loan, Matrix Computations, 2013, section 5.4.1).
  function pseudo_inverse(matrix) result(inverse)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Its pseudo-inverse, (n, n)
    real(wp) :: inverse(size(matrix, 1), size(matrix, 1))
    real(wp) :: vectors(size(matrix, 1), size(matrix, 1)), values(size(matrix, 1)), work(34*size(matrix, 1))
    integer :: info, first, n

    n = size(matrix, 1)
    inverse = 0
    if (n == 0) return
    vectors = matrix
    call dsyev('V', 'U', n, vectors, n, values, work, size(work), info)
    if (info /= 0) return
    first = count(values <= n*epsilon(values)*values(n)) + 1
    inverse = matmul(vectors(:, first:)/spread(values(first:), 1, n), transpose(vectors(:, first:)))
  end function pseudo_inverse

  !> Eigenvalues of a symmetric matrix in ascending order, and its eigenvectors.
  pure subroutine symmetric_modes(matrix, values)
    !> The matrix, (n, n), on return its eigenvectors, each of length 1
    real(wp), intent(inout) :: matrix(:, :)
    !> Eigenvalues, (n)
    real(wp), intent(out) :: values(:)
    real(wp) :: vectors(size(values), size(values)), work(34*size(values))
    integer :: info

    vectors = matrix
    call dsyev('V', 'U', size(values), vectors, size(values), values, work, size(work), info)
    matrix = vectors
  end subroutine symmetric_modes
end module dense_systems
