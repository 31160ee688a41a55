!> Small dense systems.
module dense_systems
  use lapack_interfaces, only: dgetrf, dgetrs, dpotrf, dpotrs
  use kinds, only: wp
  implicit none
  private
  public :: dense_factor_t, positive_factor_t, solve_dense

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
