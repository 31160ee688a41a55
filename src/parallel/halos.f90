!> Points on the border between ranks: each point is owned by one rank and seen as a ghost by others.
module halos
  use mpi_f08, only: MPI_Comm, MPI_Request, MPI_DOUBLE_PRECISION, MPI_INTEGER, MPI_STATUSES_IGNORE, MPI_Irecv, &
                     MPI_Isend, MPI_Waitall, MPI_Alltoall, MPI_Alltoallv
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_internal
  use kinds, only: wp
  implicit none
  private
  public :: halo_t

  !> Points exchanged with other ranks in one direction, grouped by rank.
  type :: traffic_t
    !> The other ranks, ascending
    integer, allocatable :: ranks(:)
    !> Where the points of each of these ranks begin, shape (ranks + 1)
    integer, allocatable :: start(:)
    !> Local points, grouped by rank
    integer, allocatable :: points(:)
  end type traffic_t

  !> The points of this rank, owned ones first and ghosts after them. Global numbers of points run
  !> from 1, contiguous by owning rank.
  type :: halo_t
    !> Number of points that this rank owns
    integer :: owned = 0
    !> Number of points seen here but owned elsewhere
    integer :: ghosts = 0
    !> Number of points seen here
    integer :: points = 0
    !> Number of points of all ranks
    integer :: total = 0
    !> Global number of the first owned point
    integer :: first = 1
    !> All ranks
    type(MPI_Comm), private :: group
    !> Number of ranks
    integer, private :: size = 1
    !> Owned points that others see, and ghosts
    type(traffic_t), private :: shared, seen
  contains
    !> Finds out with whom to exchange what.
    procedure :: define
    !> Copies values of owned points to their ghosts.
    procedure :: update
    !> Adds values of ghosts to their owned points and zeroes the ghosts.
    procedure :: accumulate
  end type halo_t

contains

  !> Finds out with whom to exchange what; called by all ranks together.
  subroutine define(self, communicator, owned, ghost_numbers, error)
    class(halo_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> Number of points that this rank owns
    integer, intent(in) :: owned
    !> Global numbers of the ghosts, in the order in which they follow the owned points
    integer, intent(in) :: ghost_numbers(:)
    !> Raised on all ranks when a ghost belongs to nobody else
    type(error_t), allocatable, intent(inout) :: error
    integer, allocatable :: counts(:)
    integer :: last(0:communicator%size - 1), owner(size(ghost_numbers)), r

    self%owned = owned
    self%ghosts = size(ghost_numbers)
    self%points = owned + self%ghosts
    self%size = communicator%size
    self%first = communicator%preceding(owned) + 1
    call communicator%allgather([owned], counts)
    last = [(sum(counts(:r)), r=1, communicator%size)]
    self%total = sum(counts)
    owner = [(count(last < ghost_numbers(r)), r=1, self%ghosts)]
    if (any(owner == communicator%rank .or. owner == communicator%size .or. ghost_numbers < 1)) then
      call fail(error, exit_internal, 'A ghost point is owned by its own rank or by none.')
    end if
    call communicator%agree(error)
    if (allocated(error) .or. communicator%size == 1) return
    self%group%mpi_val = communicator%handle()
    call exchange_lists(self, owner, ghost_numbers)
  end subroutine define

  !> Tells the owners which of their points are seen here, and learns which are seen elsewhere.
  subroutine exchange_lists(self, owner, ghost_numbers)
    class(halo_t), intent(inout) :: self
    !> Owning rank of each ghost
    integer, intent(in) :: owner(:)
    !> Global number of each ghost
    integer, intent(in) :: ghost_numbers(:)
    integer :: wanted(0:self%size - 1), asked(0:self%size - 1), r, i
    integer :: order(size(owner))
    integer, allocatable :: numbers(:)

    wanted = [(count(owner == r), r=0, self%size - 1)]
    call MPI_Alltoall(wanted, 1, MPI_INTEGER, asked, 1, MPI_INTEGER, self%group)
    order = [(pack([(i, i=1, size(owner))], owner == r), r=0, self%size - 1)]
    allocate (numbers(sum(asked)))
    call MPI_Alltoallv(ghost_numbers(order), wanted, offsets(wanted), MPI_INTEGER, &
                       numbers, asked, offsets(asked), MPI_INTEGER, self%group)
    self%seen = new_traffic(wanted, self%owned + order)
    self%shared = new_traffic(asked, numbers - self%first + 1)
  end subroutine exchange_lists

  !> Sums of the items before each.
  pure function offsets(counts)
    !> Number of items of each rank
    integer, intent(in) :: counts(:)
    !> Number of items of the ranks before each
    integer :: offsets(size(counts))
    integer :: r

    offsets = [(sum(counts(:r - 1)), r=1, size(counts))]
  end function offsets

  !> Points to exchange, from the number of them for each rank.
  pure function new_traffic(counts, points) result(traffic)
    !> Number of points exchanged with each rank
    integer, intent(in) :: counts(0:)
    !> Local points, grouped by rank
    integer, intent(in) :: points(:)
    !> The same without the ranks that exchange nothing
    type(traffic_t) :: traffic
    integer :: r

    allocate (traffic%ranks(count(counts > 0)), source=pack([(r, r=0, size(counts) - 1)], counts > 0))
    allocate (traffic%start(size(traffic%ranks) + 1))
    traffic%start = [1, (1 + sum(counts(:traffic%ranks(r))), r=1, size(traffic%ranks))]
    allocate (traffic%points(size(points)), source=points)
  end function new_traffic

  !> Copies values of owned points to their ghosts.
  subroutine update(self, field)
    class(halo_t), intent(in) :: self
    !> Values, shape (components, points)
    real(wp), intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)

    if (self%size == 1) return
    call exchange(self%group, self%shared, self%seen, field, values)
    field(:, self%seen%points) = values
  end subroutine update

  !> Adds values of ghosts to their owned points, in the order of ranks, and zeroes the ghosts.
  subroutine accumulate(self, field)
    class(halo_t), intent(in) :: self
    !> Values, shape (components, points)
    real(wp), intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)
    integer :: i

    if (self%size == 1) return
    call exchange(self%group, self%seen, self%shared, field, values)
    do i = 1, size(self%shared%points)
      field(:, self%shared%points(i)) = field(:, self%shared%points(i)) + values(:, i)
    end do
    field(:, self%owned + 1:) = 0
  end subroutine accumulate

  !> Sends the values of some points while receiving those of others.
  subroutine exchange(group, sent, received, field, values)
    !> All ranks
    type(MPI_Comm), intent(in) :: group
    !> Points whose values are sent, and points whose values are received
    type(traffic_t), intent(in) :: sent, received
    !> Values, shape (components, points)
    real(wp), intent(in) :: field(:, :)
    !> Values received, shape (components, points received)
    real(wp), allocatable, asynchronous, intent(out) :: values(:, :)
    real(wp), allocatable, asynchronous :: own(:, :)
    type(MPI_Request) :: requests(size(sent%ranks) + size(received%ranks))
    integer :: i

    allocate (values(size(field, 1), size(received%points)))
    do i = 1, size(received%ranks)
      call MPI_Irecv(values(1, received%start(i)), size(field, 1)*(received%start(i + 1) - received%start(i)), &
                     MPI_DOUBLE_PRECISION, received%ranks(i), 0, group, requests(i))
    end do
    own = field(:, sent%points)
    do i = 1, size(sent%ranks)
      call MPI_Isend(own(1, sent%start(i)), size(field, 1)*(sent%start(i + 1) - sent%start(i)), &
                     MPI_DOUBLE_PRECISION, sent%ranks(i), 0, group, requests(size(received%ranks) + i))
    end do
    call MPI_Waitall(size(requests), requests, MPI_STATUSES_IGNORE)
  end subroutine exchange
end module halos
