!> Small dense systems.
module dense_systems
  use blas_interfaces, only: dgetrf, dgetrs, dpotrf, dpotrs, dpotri, dsyevd
  use kinds, only: wp
  implicit none
  private
  public :: dense_factor_t, positive_factor_t, solve_dense, solve_descending

  !> Size of an eigenvalue over the largest below which it counts as that: what lies along it is unknown by rounding.
  real(wp), parameter :: min_eigenvalue = 1.0e-10_wp

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

  !> A small symmetric matrix, factored if it is positive definite.
  type :: positive_factor_t
    !> True: it is, and there are factors
    logical :: positive = .false.
    !> Its lower factor, (n, n)
    real(wp), allocatable, private :: factors(:, :)
  contains
    !> Factors a matrix.
    procedure :: factorize => factorize_positive
    !> Solves with the factors.
    procedure :: solve => solve_positive
    !> The inverse of the matrix.
    procedure :: inverse
  end type positive_factor_t

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

  !> Factors a symmetric matrix, or finds that it is not positive definite.
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

  !> The inverse of a positive definite matrix.
  function inverse(self)
    !> Its factor
    class(positive_factor_t), intent(in) :: self
    !> The inverse, (n, n)
    real(wp), allocatable :: inverse(:, :)
    integer :: info, k

    inverse = self%factors
    if (size(inverse) == 0) return
    call dpotri('L', size(inverse, 1), inverse, size(inverse, 1), info)
    do k = 2, size(inverse, 1)
      inverse(:k - 1, k) = inverse(k, :k - 1)
    end do
  end function inverse

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

  !> Solves with a symmetric matrix as if its eigenvalues had their sizes without their signs. So x = |A|^-1 f goes
  !> along f whatever A is, and does what Newton's method does where A is positive (J. Nocedal, S. J. Wright, Numerical
  !> Optimization, 2006, section 3.4).
  subroutine solve_descending(matrix, x, found)
    !> Matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)
    !> Right-hand side on entry, solution on return, (n)
    real(wp), intent(inout) :: x(:)
    !> False: there are no eigenvalues, x is what it was
    logical, intent(out) :: found
    real(wp), allocatable :: vectors(:, :), values(:), work(:)
    integer, allocatable :: places(:)
    integer :: n, info

    n = size(x)
    vectors = matrix
    allocate (values(n), work(1 + 6*n + 2*n**2), places(3 + 5*n))
    call dsyevd('V', 'L', n, vectors, n, values, work, size(work), places, size(places), info)
    found = info == 0
    if (.not. found) return
    values = abs(values)
    x = matmul(vectors, matmul(x, vectors)/max(values, min_eigenvalue*maxval(values), tiny(values)))
  end subroutine solve_descending
end module dense_systems
