!> Small dense symmetric equations solved by LAPACK on one rank: what the sparse solvers are compared with.
module dense_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  implicit none
  private
  public :: dense_solver_t

  !> Blocks of this many columns are factored at once
  integer, parameter :: block_size = 64

  !> A dense symmetric matrix and its factor L D L^T by Bunch and Kaufman's pivoting.
  type, extends(linear_solver_t) :: dense_solver_t
    !> The matrix, both triangles
    real(wp), allocatable, private :: matrix(:, :)
    !> Its factor in the lower triangle
    real(wp), allocatable, private :: factor(:, :)
    !> Rows exchanged in the factor
    integer, allocatable, private :: pivots(:)
  contains
    procedure :: define
    procedure :: clear
    procedure :: add
    procedure :: finish_assembly
    procedure :: factorize
    procedure :: solve
    procedure :: solve_many
    procedure :: statistics
    procedure :: package_used
    procedure :: release
  end type dense_solver_t

  interface
    !> LAPACK: factor of a symmetric matrix.
    subroutine dsytrf(triangle, n, matrix, leading, pivots, work, work_size, info)
      import :: wp
      !> Which triangle
      character(len=1), intent(in) :: triangle
      !> Order, first dimension and size of the work space
      integer, intent(in) :: n, leading, work_size
      !> The matrix; its factor on return
      real(wp), intent(inout) :: matrix(leading, *)
      !> Rows exchanged
      integer, intent(out) :: pivots(*)
      !> Work space
      real(wp), intent(out) :: work(*)
      !> 0 for success
      integer, intent(out) :: info
    end subroutine dsytrf

    !> LAPACK: solution with that factor.
    subroutine dsytrs(triangle, n, columns, factor, leading, pivots, right, right_leading, info)
      import :: wp
      !> Which triangle
      character(len=1), intent(in) :: triangle
      !> Order, number of right-hand sides, first dimensions
      integer, intent(in) :: n, columns, leading, right_leading
      !> The factor
      real(wp), intent(in) :: factor(leading, *)
      !> Rows exchanged
      integer, intent(in) :: pivots(*)
      !> Right-hand sides; solutions on return
      real(wp), intent(inout) :: right(right_leading, *)
      !> 0 for success
      integer, intent(out) :: info
    end subroutine dsytrs

    !> LAPACK: reciprocal condition number from that factor.
    subroutine dsycon(triangle, n, factor, leading, pivots, norm, condition, work, integer_work, info)
      import :: wp
      !> Which triangle
      character(len=1), intent(in) :: triangle
      !> Order and first dimension
      integer, intent(in) :: n, leading
      !> The factor
      real(wp), intent(in) :: factor(leading, *)
      !> Rows exchanged
      integer, intent(in) :: pivots(*)
      !> Greatest sum of a column of the matrix, in magnitude
      real(wp), intent(in) :: norm
      !> Reciprocal condition number
      real(wp), intent(out) :: condition
      !> Work space of reals
      real(wp), intent(out) :: work(*)
      !> Work space of integers
      integer, intent(out) :: integer_work(*)
      !> 0 for success
      integer, intent(out) :: info
    end subroutine dsycon
  end interface

contains

  !> Sets the order of the matrix, anew if there was one; the pattern is of no use to it.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error, seen)
    class(dense_solver_t), intent(inout) :: self
    !> One rank
    type(communicator_t), intent(in) :: communicator
    !> Number of the first row, 0
    integer, intent(in) :: first_row
    !> Number of rows
    integer, intent(in) :: total_rows
    !> Where the columns of each row begin
    integer, intent(in) :: row_start(:)
    !> Columns of the rows
    integer, intent(in) :: columns(:)
    !> Whether the matrix is positive definite, which is of no use to it
    logical, intent(in) :: positive_definite
    !> Raised on more than one rank
    type(error_t), allocatable, intent(inout) :: error
    integer, intent(in), optional :: seen(:)

    call self%release()
    if (communicator%size > 1) then
      call fail(error, exit_internal, 'The dense solver works on one rank only.')
      return
    end if
    allocate (self%matrix(total_rows, total_rows), source=0.0_wp)
    allocate (self%pivots(total_rows))
  end subroutine define

  !> Zeroes the values of the matrix.
  subroutine clear(self)
    class(dense_solver_t), intent(inout) :: self

    self%matrix = 0
  end subroutine clear

  !> Adds an element's matrix.
  subroutine add(self, equations, values)
    class(dense_solver_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, from 0; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)
    integer :: i, j

    do j = 1, size(equations)
      do i = 1, size(equations)
        if (min(equations(i), equations(j)) < 0) cycle
        associate (entry => self%matrix(equations(i) + 1, equations(j) + 1))
          entry = entry + values(i, j)
        end associate
      end do
    end do
  end subroutine add

  !> Nothing needs to be brought together on one rank.
  subroutine finish_assembly(self, error)
    class(dense_solver_t), intent(inout) :: self
    !> Never raised
    type(error_t), allocatable, intent(inout) :: error
  end subroutine finish_assembly

  !> Factors the matrix as it was assembled last.
  subroutine factorize(self, error)
    class(dense_solver_t), intent(inout) :: self
    !> Raised when the matrix is singular
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: work(max(block_size, 2)*size(self%pivots)), condition
    integer :: integer_work(size(self%pivots)), n, info

    n = size(self%pivots)
    self%factor = self%matrix
    call dsytrf('L', n, self%factor, n, self%pivots, work, size(work), info)
    condition = 0
    if (info == 0) call dsycon('L', n, self%factor, n, self%pivots, maxval(sum(abs(self%matrix), 1)), condition, &
                               work, integer_work, info)
    if (condition < epsilon(condition)) call fail(error, exit_convergence, 'The dense matrix is singular.')
    self%factorizations = self%factorizations + 1
  end subroutine factorize

  !> Solves for one right-hand side with the factor.
  subroutine solve(self, right_hand_side, solution, error)
    class(dense_solver_t), intent(inout) :: self
    !> Right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Solution
    real(wp), intent(out) :: solution(:)
    !> Raised when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: solutions(size(solution), 1)

    call self%solve_many(reshape(right_hand_side, shape(solutions)), solutions, error)
    solution = solutions(:, 1)
  end subroutine solve

  !> Solves for several right-hand sides with the factor.
  subroutine solve_many(self, right_hand_sides, solutions, error)
    class(dense_solver_t), intent(inout) :: self
    !> Right-hand sides, shape (rows, right-hand sides)
    real(wp), intent(in) :: right_hand_sides(:, :)
    !> Solutions, shape (rows, right-hand sides)
    real(wp), intent(out) :: solutions(:, :)
    !> Raised when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    integer :: n, info

    n = size(self%pivots)
    solutions = right_hand_sides
    call dsytrs('L', n, size(solutions, 2), self%factor, n, self%pivots, solutions, n, info)
    if (info /= 0 .or. .not. all(ieee_is_finite(solutions))) then
      call fail(error, exit_convergence, 'The dense equations have no finite solution.')
    end if
    self%solves = self%solves + size(solutions, 2)
  end subroutine solve_many

  !> Size of the factor.
  subroutine statistics(self, factor_entries, megabytes)
    class(dense_solver_t), intent(in) :: self
    !> Numbers stored in the factor
    real(wp), intent(out) :: factor_entries
    !> Memory of the factor in MB
    real(wp), intent(out) :: megabytes

    factor_entries = size(self%pivots)*(size(self%pivots) + 1.0_wp)/2
    megabytes = real(storage_size(self%factor), wp)/8*size(self%factor)/2**20
  end subroutine statistics

  !> What factors the matrix.
  function package_used(self) result(name)
    class(dense_solver_t), intent(in) :: self
    !> Its name
    character(len=:), allocatable :: name

    name = 'LAPACK'
  end function package_used

  !> Frees matrix and factor.
  subroutine release(self)
    class(dense_solver_t), intent(inout) :: self

    if (allocated(self%matrix)) deallocate (self%matrix, self%pivots)
    if (allocated(self%factor)) deallocate (self%factor)
  end subroutine release
end module dense_solvers
