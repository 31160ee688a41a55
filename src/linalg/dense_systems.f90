!> Small dense systems, by elimination with pivoting.
module dense_systems
  use kinds, only: wp
  implicit none
  private
  public :: solve_dense, invert_dense

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

  !> Inverse of a dense matrix; zero if it is singular.
  function invert_dense(matrix) result(inverse)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Its inverse, (n, n)
    real(wp) :: inverse(size(matrix, 1), size(matrix, 1))
    real(wp) :: factors(size(matrix, 1), size(matrix, 1))
    integer :: pivots(size(matrix, 1)), info, i

    factors = matrix
    inverse = 0
    do i = 1, size(matrix, 1)
      inverse(i, i) = 1
    end do
    info = 0
    associate (n => size(matrix, 1))
      if (n > 0) call dgesv(n, n, factors, n, pivots, inverse, n, info)
    end associate
    if (info /= 0) inverse = 0
  end function invert_dense
end module dense_systems
