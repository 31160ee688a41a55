!> A dense lower factor that every rank has. The ranks share the work of making it and of solving with it.
module shared_triangles
  use blas_interfaces, only: dgemm, dgemv, dpotrf, dpotrs, dtrsm, dtrsv
  use communicators, only: communicator_t
  use kinds, only: wp
  implicit none
  private
  public :: shared_triangle_t

  !> Parts into which a solve for one right-hand side cuts the rows. Every rank solves with the triangles on the
  !> diagonal, a share of 1/parts, and reads its part of what stands below. The border of the 25 J panel, 1257 rows,
  !> asks for .76 ms of one rank; of two it takes .52 ms with 4 parts and .49 with 8.
  integer, parameter :: parts = 4

  !> Columns of a panel. Panels are dealt out to the ranks in turn. The owners' work on them, for which the others wait,
  !> is 1.5 panel/n of all operations.
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
    procedure, private :: exchange, owner, find_panel, follow_panel, find_share
  end type shared_triangle_t

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
      call self%find_share(b, n - b, first, last)
      if (last >= first) call dgemv('N', last - first + 1, b - a + 1, 1.0_wp, self%numbers(first, a), n, x(a:b), 1, &
                                    1.0_wp, taken(first:last), 1)
    end do
    do k = parts, 1, -1
      a = (k - 1)*n/parts + 1
      b = k*n/parts
      call self%find_share(b, n - b, first, last)
      taken(a:b) = 0
      if (last >= first) call dgemv('T', last - first + 1, b - a + 1, 1.0_wp, self%numbers(first, a), n, &
                                    x(first:last), 1, 0.0_wp, taken(a:b), 1)
      if (k < parts) call self%communicator%sum(taken(a:b))
      x(a:b) = x(a:b) - taken(a:b)
      if (b >= a) call dtrsv('L', 'T', 'N', b - a + 1, self%numbers(a, a), n, x(a:b), 1)
    end do
  end subroutine solve

  !> This rank's share of a number of things.
  pure subroutine find_share(self, before, number, first, last)
    class(shared_triangle_t), intent(in) :: self
    !> Things before the first one, and how many there are
    integer, intent(in) :: before, number
    !> The first and the last of this rank
    integer, intent(out) :: first, last

    associate (rank => self%communicator%rank, ranks => self%communicator%size)
      first = before + rank*number/ranks + 1
      last = before + (rank + 1)*number/ranks
    end associate
  end subroutine find_share

  !> Solves for several right-hand sides, each of which one rank solves for; called by all ranks together.
  subroutine solve_many(self, x)
    class(shared_triangle_t), intent(in) :: self
    !> Right-hand sides on entry, solutions on return, the same on every rank, (n, columns)
    real(wp), contiguous, intent(inout) :: x(:, :)
    integer :: first, last, info

    call self%find_share(0, size(x, 2), first, last)
    if (last >= first .and. size(x, 1) > 0) &
      call dpotrs('L', size(x, 1), last - first + 1, self%numbers, size(x, 1), x(:, first:last), size(x, 1), info)
    x(:, :first - 1) = 0
    x(:, last + 1:) = 0
    call self%communicator%sum(x)
  end subroutine solve_many
end module shared_triangles
