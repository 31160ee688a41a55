!> A dense lower factor that every rank has. The ranks share the work of making it and of solving with it.
module shared_triangles
  use communicators, only: communicator_t
  use kinds, only: wp
  implicit none
  private
  public :: shared_triangle_t

  !> Parts into which a solve for one right-hand side cuts the rows. Every rank solves with the triangles on the
  !> diagonal, a share of 1/parts, and reads its part of what stands below. The border of the 25 J panel, 1257 rows,
  !> asks for .76 ms of one rank; of two it takes .52 ms with 4 parts and .49 with 8.
  integer, parameter :: parts = 4

  !> Columns of a panel. Panels are dealt out to the ranks in turn.
  integer, parameter :: panel = 64

  !> The factor.
  type :: shared_triangle_t
    !> All ranks
    type(communicator_t), private :: communicator
    !> This rank's share of the matrix, then the lower factor of the sum, the same on every rank; kept for their memory,
    !> (n, n)
    real(wp), allocatable :: numbers(:, :)
    !> True: the matrix was positive definite, and there is a factor
    logical :: positive = .false.
  contains
    !> Sets the order.
    procedure :: define
    !> Adds the shares up and factors the sum in place.
    procedure :: factorize
    !> Solves for one right-hand side.
    procedure :: solve
    !> Solves for several right-hand sides.
    procedure :: solve_many
    procedure, private :: exchange, owner, find_panel, follow_panel, share_below
  end type shared_triangle_t

  interface
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

    !> BLAS: solves X L' = B and the like.
    subroutine dtrsm(side, uplo, trans, diag, m, n, alpha, a, lda, b, ldb)
      import :: wp
      !> 'R': L stands on the right; 'L': the lower triangle; 'T': its transpose; 'N': its diagonal is given
      character, intent(in) :: side, uplo, trans, diag
      !> Rows and columns of B, leading dimensions
      integer, intent(in) :: m, n, lda, ldb
      !> Factor of B
      real(wp), intent(in) :: alpha
      !> The triangle
      real(wp), intent(in) :: a(lda, *)
      !> B, overwritten by X
      real(wp), intent(inout) :: b(ldb, *)
    end subroutine dtrsm

    !> BLAS: C = alpha A B' + beta C and the like.
    subroutine dgemm(transa, transb, m, n, k, alpha, a, lda, b, ldb, beta, c, ldc)
      import :: wp
      !> 'N': the matrix itself, 'T': its transpose
      character, intent(in) :: transa, transb
      !> Rows and columns of C, columns of A, leading dimensions
      integer, intent(in) :: m, n, k, lda, ldb, ldc
      !> Factors
      real(wp), intent(in) :: alpha, beta
      !> A and B
      real(wp), intent(in) :: a(lda, *), b(ldb, *)
      !> C
      real(wp), intent(inout) :: c(ldc, *)
    end subroutine dgemm

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

    !> BLAS: solves with a triangle.
    subroutine dtrsv(uplo, trans, diag, n, a, lda, x, incx)
      import :: wp
      !> 'L': the lower triangle; 'N': itself, 'T': its transpose; 'N': its diagonal is given
      character, intent(in) :: uplo, trans, diag
      !> Order, leading dimension, stride
      integer, intent(in) :: n, lda, incx
      !> The triangle
      real(wp), intent(in) :: a(lda, *)
      !> Right-hand side, overwritten by the solution
      real(wp), intent(inout) :: x(*)
    end subroutine dtrsv

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
  end interface

contains

  !> Sets the order.
  subroutine define(self, communicator, rows)
    class(shared_triangle_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> The order
    integer, intent(in) :: rows

    self%communicator = communicator
    if (allocated(self%numbers)) deallocate (self%numbers)
    allocate (self%numbers(rows, rows))
  end subroutine define

  !> Adds the shares up and factors the sum in place, panel by panel: the rank that owns one finds it and gives it to
  !> the others, and each takes it out of its own panels; called by all ranks together.
  subroutine factorize(self)
    !> Lower triangles are read
    class(shared_triangle_t), intent(inout) :: self
    real(wp), allocatable, target :: room(:)
    integer :: first, last

    allocate (room(size(self%numbers, 1)*panel))
    self%positive = .true.
    do first = 1, size(self%numbers, 1), panel
      last = min(first + panel - 1, size(self%numbers, 1))
      call self%exchange(first, last, .true., room)
    end do
    do first = 1, size(self%numbers, 1), panel
      last = min(first + panel - 1, size(self%numbers, 1))
      if (self%owner(first) == self%communicator%rank) call self%find_panel(first, last)
      call self%exchange(first, last, .false., room)
      ! A panel that was not found begins with no number.
      self%positive = self%numbers(first, first) > 0
      if (.not. self%positive) return
      call self%follow_panel(first, last)
    end do
  end subroutine factorize

  !> Adds the ranks' shares of a panel up on the rank that owns it, or gives the panel to the others.
  subroutine exchange(self, first, last, adds, room)
    class(shared_triangle_t), intent(inout) :: self
    !> Its first and last column
    integer, intent(in) :: first, last
    !> True: adds up
    logical, intent(in) :: adds
    !> Room for a panel
    real(wp), target, contiguous, intent(inout) :: room(:)
    real(wp), pointer, contiguous :: columns(:, :)

    columns(first:size(self%numbers, 1), first:last) => room
    columns = self%numbers(first:, first:last)
    if (adds) then
      call self%communicator%sum_at(self%owner(first), room(:size(columns)))
    else
      call self%communicator%broadcast(room(:size(columns)), self%owner(first))
    end if
    self%numbers(first:, first:last) = columns
  end subroutine exchange

  !> The rank that a panel was dealt out to.
  pure integer function owner(self, first)
    class(shared_triangle_t), intent(in) :: self
    !> Its first column
    integer, intent(in) :: first

    owner = mod((first - 1)/panel, self%communicator%size)
  end function owner

  !> Finds the columns of a panel, from which those before it are out.
  subroutine find_panel(self, first, last)
    class(shared_triangle_t), intent(inout) :: self
    !> Its first and last column
    integer, intent(in) :: first, last
    integer :: n, info

    n = size(self%numbers, 1)
    call dpotrf('L', last - first + 1, self%numbers(first, first), n, info)
    if (info /= 0) self%numbers(first, first) = 0
    if (info /= 0 .or. last == n) return
    call dtrsm('R', 'L', 'T', 'N', n - last, last - first + 1, 1.0_wp, self%numbers(first, first), n, &
               self%numbers(last + 1, first), n)
  end subroutine find_panel

  !> Takes a panel out of those of this rank behind it.
  subroutine follow_panel(self, first, last)
    class(shared_triangle_t), intent(inout) :: self
    !> Its first and last column
    integer, intent(in) :: first, last
    integer :: next, n

    n = size(self%numbers, 1)
    do next = last + 1, n, panel
      if (self%owner(next) /= self%communicator%rank) cycle
      call dgemm('N', 'T', n - next + 1, min(panel, n - next + 1), last - first + 1, -1.0_wp, &
                 self%numbers(next, first), n, self%numbers(next, first), n, 1.0_wp, self%numbers(next, next), n)
    end do
  end subroutine follow_panel

  !> Solves for one right-hand side; called by all ranks together.
  subroutine solve(self, x)
    class(shared_triangle_t), intent(in) :: self
    !> Right-hand side on entry, solution on return, the same on every rank, (n)
    real(wp), contiguous, intent(inout) :: x(:)
    real(wp) :: taken(size(x))
    integer :: k, a, b, first, last, n

    n = size(x)
    taken = 0
    do k = 1, parts
      a = (k - 1)*n/parts + 1
      b = k*n/parts
      if (k > 1) call self%communicator%sum(taken(a:b))
      x(a:b) = x(a:b) - taken(a:b)
      if (b >= a) call dtrsv('L', 'N', 'N', b - a + 1, self%numbers(a, a), n, x(a:b), 1)
      call self%share_below(b, first, last)
      if (last >= first) call dgemv('N', last - first + 1, b - a + 1, 1.0_wp, self%numbers(first, a), n, x(a:b), 1, &
                                    1.0_wp, taken(first:last), 1)
    end do
    do k = parts, 1, -1
      a = (k - 1)*n/parts + 1
      b = k*n/parts
      call self%share_below(b, first, last)
      taken(a:b) = 0
      if (last >= first) call dgemv('T', last - first + 1, b - a + 1, 1.0_wp, self%numbers(first, a), n, &
                                    x(first:last), 1, 0.0_wp, taken(a:b), 1)
      if (k < parts) call self%communicator%sum(taken(a:b))
      x(a:b) = x(a:b) - taken(a:b)
      if (b >= a) call dtrsv('L', 'T', 'N', b - a + 1, self%numbers(a, a), n, x(a:b), 1)
    end do
  end subroutine solve

  !> Rows of this rank among those below a row.
  pure subroutine share_below(self, row, first, last)
    class(shared_triangle_t), intent(in) :: self
    !> The row
    integer, intent(in) :: row
    !> The first and the last of them
    integer, intent(out) :: first, last

    associate (below => size(self%numbers, 1) - row, rank => self%communicator%rank, ranks => self%communicator%size)
      first = row + rank*below/ranks + 1
      last = row + (rank + 1)*below/ranks
    end associate
  end subroutine share_below

  !> Solves for several right-hand sides, each of which one rank solves for; called by all ranks together.
  subroutine solve_many(self, x)
    class(shared_triangle_t), intent(in) :: self
    !> Right-hand sides on entry, solutions on return, the same on every rank, (n, columns)
    real(wp), contiguous, intent(inout) :: x(:, :)
    integer :: first, last, info

    associate (columns => size(x, 2), rank => self%communicator%rank, ranks => self%communicator%size)
      first = rank*columns/ranks + 1
      last = (rank + 1)*columns/ranks
    end associate
    if (last >= first .and. size(x, 1) > 0) &
      call dpotrs('L', size(x, 1), last - first + 1, self%numbers, size(x, 1), x(:, first:last), size(x, 1), info)
    x(:, :first - 1) = 0
    x(:, last + 1:) = 0
    call self%communicator%sum(x)
  end subroutine solve_many
end module shared_triangles
