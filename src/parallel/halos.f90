!> Points on the border between ranks: each point is owned by one rank and is a ghost on others.
module halos
  use mpi_f08, only: MPI_Comm, MPI_INTEGER, MPI_Alltoall, MPI_Alltoallv
  use border_messages, only: message_plan_t, new_message_plan, exchange, offsets
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_internal
  use kinds, only: wp
  implicit none
  private
  public :: halo_t

  !> The points of this rank, owned ones first and ghosts after them. Global numbers of points run
  !> from 1, contiguous by owning rank.
  type :: halo_t
    !> Number of points that this rank owns
    integer :: owned = 0
    !> Number of ghosts
    integer :: ghosts = 0
    !> Number of points on this rank
    integer :: points = 0
    !> Number of points of all ranks
    integer :: total = 0
    !> Global number of the first owned point
    integer :: first = 1
    !> All ranks
    type(MPI_Comm), private :: group
    !> Number of ranks
    integer, private :: size = 1
    !> Owned points that are ghosts on other ranks, and ghosts of this rank
    type(message_plan_t), private :: shared, ghosts_of_others
  contains
    procedure :: define
    procedure :: update
    procedure :: accumulate
  end type halo_t

contains

  !> Determines the exchange of ghosts between ranks. Collective.
  subroutine define(self, communicator, owned, ghost_numbers, error)
    class(halo_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    !> Number of points that this rank owns
    integer, intent(in) :: owned
    !> Global numbers of the ghosts, in the order in which they follow the owned points
    integer, intent(in) :: ghost_numbers(:)
    !> Raised on all ranks when a ghost has no owner
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

  !> Exchanges with other ranks which points are ghosts where.
  subroutine exchange_lists(self, owner, ghost_numbers)
    class(halo_t), intent(inout) :: self
    !> Owning rank of each ghost
    integer, intent(in) :: owner(:)
    !> Global number of each ghost
    integer, intent(in) :: ghost_numbers(:)
    integer :: wanted(0:self%size - 1), requested(0:self%size - 1), r, i
    integer :: order(size(owner))
    integer, allocatable :: numbers(:)

    wanted = [(count(owner == r), r=0, self%size - 1)]
    call MPI_Alltoall(wanted, 1, MPI_INTEGER, requested, 1, MPI_INTEGER, self%group)
    order = [(pack([(i, i=1, size(owner))], owner == r), r=0, self%size - 1)]
    allocate (numbers(sum(requested)))
    call MPI_Alltoallv(ghost_numbers(order), wanted, offsets(wanted), MPI_INTEGER, &
                       numbers, requested, offsets(requested), MPI_INTEGER, self%group)
    self%ghosts_of_others = new_message_plan(wanted, self%owned + order)
    self%shared = new_message_plan(requested, numbers - self%first + 1)
  end subroutine exchange_lists

  !> Copies values of owned points to their ghosts.
  subroutine update(self, field)
    class(halo_t), intent(in) :: self
    !> Values, shape (components, points)
    real(wp), intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)

    if (self%size == 1) return
    call exchange(self%group, self%shared, self%ghosts_of_others, field, values)
    field(:, self%ghosts_of_others%columns) = values
  end subroutine update

  !> Adds values of ghosts to their owned points, in the order of ranks, and zeroes the ghosts.
  subroutine accumulate(self, field)
    class(halo_t), intent(in) :: self
    !> Values, shape (components, points)
    real(wp), intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)
    integer :: i

    if (self%size == 1) return
    call exchange(self%group, self%ghosts_of_others, self%shared, field, values)
    do i = 1, size(self%shared%columns)
      field(:, self%shared%columns(i)) = field(:, self%shared%columns(i)) + values(:, i)
    end do
    field(:, self%owned + 1:) = 0
  end subroutine accumulate
end module halos
