!> Small dense systems.
module dense_systems
  use kinds, only: wp
  implicit none
  private
  public :: dense_factor_t, solve_dense

  !> A small matrix, factored.
  type :: dense_factor_t
    !> True: there are no solutions
    logical :: singular = .false.
    !> Its triangular factors, (n, n)
    real(wp), allocatable, private :: factors(:, :)
    !> Row exchanges, (n)
    integer, allocatable, private :: pivots(:)
  contains
    !> Factors a matrix.
    procedure :: factorize
    !> Solves with the factors.
    procedure :: solve
  end type dense_factor_t

  interface
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
  end interface

contains

  !> Factors a matrix.
  subroutine factorize(self, matrix)
    !> Receives the factors
    class(dense_factor_t), intent(inout) :: self
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    integer :: info

    self%factors = matrix
    self%pivots = spread(0, 1, size(matrix, 1))
    self%singular = .false.
    if (size(matrix) == 0) return
    call dgetrf(size(matrix, 1), size(matrix, 1), self%factors, size(matrix, 1), self%pivots, info)
    self%singular = info /= 0
  end subroutine factorize

  !> Solves with the factors of a matrix that is not singular.
  subroutine solve(self, x)
    !> The factors
    class(dense_factor_t), intent(in) :: self
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    integer :: info

    if (size(x) > 0) call dgetrs('N', size(x), 1, self%factors, size(x), self%pivots, x, size(x), info)
  end subroutine solve

  !> Solves a small dense system.
  subroutine solve_dense(matrix, x, singular)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    !> True: there is no solution, x is what it was
    logical, intent(out) :: singular
    type(dense_factor_t) :: factor

    call factor%factorize(matrix)
    singular = factor%singular
    if (.not. singular) call factor%solve(x)
  end subroutine solve_dense
end module dense_systems
