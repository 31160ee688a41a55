!> Sums at points of contributions from elements of several ranks, in the order of the mesh.
!>
!> Floating-point addition is not associative, so that a sum at a point on the border between ranks depends on the order
!> of its terms. Each contribution to such a point therefore has its own column after the points. The owner receives
!> those of the other ranks and adds all in ascending order, as a single rank does.
module border_sums
  use mpi_f08, only: MPI_Comm, MPI_INTEGER, MPI_Alltoall, MPI_Alltoallv
  use border_messages, only: message_plan_t, new_message_plan, exchange, offsets
  use communicators, only: communicator_t
  use halos, only: halo_t
  use kinds, only: wp
  implicit none
  private
  public :: border_sum_t

  !> The contributions to points on the borders of this rank.
  type :: border_sum_t
    !> Columns of a field that contributions are added to: the points, then one column for each contribution at a border
    integer :: columns = 0
    !> Number of points that this rank owns
    integer, private :: owned = 0
    !> All ranks
    type(MPI_Comm), private :: group
    !> Number of ranks
    integer, private :: size = 1
    !> Contributions to ghosts, and those that other ranks send for owned points
    type(message_plan_t), private :: sent, received
    !> Owned points on a border, and where the terms of each begin in the next, (points + 1)
    integer, allocatable, private :: points(:), first(:)
    !> Column of the field, or minus the number of a received column, in the order of addition
    integer, allocatable, private :: terms(:)
  contains
    procedure :: define
    procedure :: add
  end type border_sum_t

contains

  !> Finds the column to which each contribution is added: that of its point, or at a border a column of its own.
  !> Collective.
  subroutine define(self, communicator, halo, points, order, targets)
    class(border_sum_t), intent(out) :: self
    type(communicator_t), intent(in) :: communicator
    !> The points
    type(halo_t), intent(in) :: halo
    !> Local point of each contribution of this rank
    integer, intent(in) :: points(:)
    !> Position of each in the order of summation. Contributions with equal positions are those of one rank, in the
    !> order of this list
    integer, intent(in) :: order(:)
    !> Column of each
    integer, intent(out) :: targets(:)
    real(wp) :: origin(2, halo%points)
    integer, allocatable :: at(:), place(:)
    logical :: borders(halo%points)
    integer :: i, owned

    self%owned = halo%owned
    self%columns = halo%points
    self%size = communicator%size
    targets = points
    if (self%size == 1) return
    self%group%mpi_val = communicator%handle()
    owned = halo%owned
    origin(1, :) = communicator%rank
    origin(2, :) = [(i, i=1, halo%points)]
    call halo%update(origin)
    call exchange_lists(self, nint(origin(1, points)), nint(origin(2, points)), order, communicator%rank, at, place)
    borders = .false.
    borders(owned + 1:) = .true.
    borders(at) = .true.
    do i = 1, size(points)
      if (.not. borders(points(i))) cycle
      self%columns = self%columns + 1
      targets(i) = self%columns
    end do
    ! Until here `sent` lists contributions; their columns are known only now.
    self%sent%columns = targets(self%sent%columns)
    borders(owned + 1:) = .false.
    call list_terms(self, [pack(points, borders(points)), at], [pack(order, borders(points)), place], &
                    [pack(targets, borders(points)), (-i, i=1, size(at))], borders(:owned))
  end subroutine define

  !> Informs the owners of ghosts which contributions they receive.
  subroutine exchange_lists(self, owner, origin, order, rank, at, place)
    class(border_sum_t), intent(inout) :: self
    !> Rank that owns the point of each contribution, local number of the point there, and position in the sum
    integer, intent(in) :: owner(:), origin(:), order(:)
    !> This rank
    integer, intent(in) :: rank
    !> Owned point and position in the sum of each contribution received
    integer, allocatable, intent(out) :: at(:), place(:)
    integer :: going(0:self%size - 1), coming(0:self%size - 1), r, i
    integer, allocatable :: grouped(:)

    allocate (grouped(0))
    do r = 0, self%size - 1
      if (r /= rank) grouped = [grouped, pack([(i, i=1, size(owner))], owner == r)]
    end do
    going = [(count(owner == r .and. r /= rank), r=0, self%size - 1)]
    call MPI_Alltoall(going, 1, MPI_INTEGER, coming, 1, MPI_INTEGER, self%group)
    allocate (at(sum(coming)), place(sum(coming)))
    call MPI_Alltoallv(origin(grouped), going, offsets(going), MPI_INTEGER, &
                       at, coming, offsets(coming), MPI_INTEGER, self%group)
    call MPI_Alltoallv(order(grouped), going, offsets(going), MPI_INTEGER, &
                       place, coming, offsets(coming), MPI_INTEGER, self%group)
    self%sent = new_message_plan(going, grouped)
    self%received = new_message_plan(coming, at)
  end subroutine exchange_lists

  !> Lists the terms of each owned point on a border in the order in which they are added.
  pure subroutine list_terms(self, at, place, columns, borders)
    class(border_sum_t), intent(inout) :: self
    !> Owned point, position in its sum and column of each term
    integer, intent(in) :: at(:), place(:), columns(:)
    !> True for owned points on a border
    logical, intent(in) :: borders(:)
    integer :: begin(size(borders)), next(size(borders)), places(size(at)), i, j

    self%points = pack([(i, i=1, size(borders))], borders)
    allocate (self%first(size(self%points) + 1), self%terms(size(at)))
    next = 0
    do i = 1, size(at)
      next(at(i)) = next(at(i)) + 1
    end do
    self%first(1) = 1
    do i = 1, size(self%points)
      self%first(i + 1) = self%first(i) + next(self%points(i))
      begin(self%points(i)) = self%first(i)
    end do
    next(self%points) = begin(self%points)
    do i = 1, size(at)
      ! Insertion: a point has few terms.
      do j = next(at(i)) - 1, begin(at(i)), -1
        if (places(j) <= place(i)) exit
        places(j + 1) = places(j)
        self%terms(j + 1) = self%terms(j)
      end do
      places(j + 1) = place(i)
      self%terms(j + 1) = columns(i)
      next(at(i)) = next(at(i)) + 1
    end do
  end subroutine list_terms

  !> Adds the contributions to their points, after those already there, and zeroes the ghosts and the columns of the
  !> contributions. Collective.
  subroutine add(self, field)
    class(border_sum_t), intent(in) :: self
    !> Values, shape (components, columns)
    real(wp), contiguous, intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)
    integer :: i, k

    if (self%size == 1) return
    call exchange(self%group, self%sent, self%received, field, values)
    do i = 1, size(self%points)
      associate (total => field(:, self%points(i)))
        do k = self%first(i), self%first(i + 1) - 1
          if (self%terms(k) > 0) then
            total = total + field(:, self%terms(k))
          else
            total = total + values(:, -self%terms(k))
          end if
        end do
      end associate
    end do
    field(:, self%owned + 1:) = 0
  end subroutine add
end module border_sums
