!> Small dense systems.
module dense_systems
  use kinds, only: wp
  implicit none
  private
  public :: solve_dense

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
  end interface

contains

  !> Solves a small dense system.
  subroutine solve_dense(matrix, x, singular)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    !> True: there is no solution, x is of no use
    logical, intent(out) :: singular
    real(wp), allocatable :: factors(:, :), columns(:, :)
    integer, allocatable :: pivots(:)
    integer :: info

    singular = .false.
    if (size(x) == 0) return
    factors = matrix
    columns = reshape(x, [size(x), 1])
    allocate (pivots(size(x)))
    call dgesv(size(x), 1, factors, size(x), pivots, columns, size(x), info)
    singular = info /= 0
    x = columns(:, 1)
  end subroutine solve_dense
end module dense_systems
