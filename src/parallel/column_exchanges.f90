!> Columns of a table, each computed by one rank, that other ranks need as well: neighbours exchange them.
module column_exchanges
  use mpi_f08, only: MPI_Comm
  use border_messages, only: exchange, new_message_plan, message_plan_t
  use communicators, only: communicator_t
  use kinds, only: wp
  implicit none
  private
  public :: column_exchange_t, new_column_exchange

  !> Columns that this rank sends to other ranks, and columns that it receives from them.
  type :: column_exchange_t
    !> All ranks
    type(MPI_Comm), private :: group
    !> Own columns that other ranks need, and columns of other ranks that this rank needs
    type(message_plan_t), private :: sent, received
    !> True: there are some
    logical, private :: needed = .false.
  contains
    procedure :: update
  end type column_exchange_t

contains

  !> Determines the exchange between ranks, from lists that are the same on every rank. Collective.
  function new_column_exchange(communicator, mine, groups) result(self)
    type(communicator_t), intent(in) :: communicator
    !> True for columns that this rank computes, (columns)
    logical, intent(in) :: mine(:)
    !> Columns of the group of each column, including itself, padded with zeros, (largest group, columns). A rank that
    !> computes one column of a group needs all of them
    integer, intent(in) :: groups(:, :)
    type(column_exchange_t) :: self
    integer :: sent(0:communicator%size - 1), received(0:communicator%size - 1), rank
    integer, allocatable :: outward(:), inward(:), owner(:)
    real(wp) :: ranks(size(mine))

    if (communicator%size == 1) return
    self%group%mpi_val = communicator%handle()
    ranks = merge(communicator%rank, 0, mine)
    call communicator%sum(ranks)
    owner = nint(ranks)
    allocate (outward(0), inward(0))
    do rank = 0, communicator%size - 1
      associate (out => needed_by(rank, owner == communicator%rank), &
                 in => needed_by(communicator%rank, owner == rank))
        sent(rank) = size(out)
        received(rank) = size(in)
        outward = [outward, out]
        inward = [inward, in]
      end associate
    end do
    self%sent = new_message_plan(sent, outward)
    self%received = new_message_plan(received, inward)
    self%needed = size(outward) + size(inward) > 0

  contains

    !> Those columns of a list that another rank needs, ascending.
    pure function needed_by(other, some) result(columns)
      !> The other rank
      integer, intent(in) :: other
      !> True for the columns
      logical, intent(in) :: some(:)
      integer, allocatable :: columns(:)
      logical :: needs(size(some))
      integer :: i

      needs = .false.
      do i = 1, size(some)
        if (some(i) .and. owner(i) /= other) needs(i) = any(owner(pack(groups(:, i), groups(:, i) > 0)) == other)
      end do
      columns = pack([(i, i=1, size(some))], needs)
    end function needed_by
  end function new_column_exchange

  !> Copies the columns of other ranks that are needed here. Collective among neighbours.
  subroutine update(self, field)
    class(column_exchange_t), intent(in) :: self
    !> Values, (components, columns)
    real(wp), intent(inout) :: field(:, :)
    real(wp), allocatable :: values(:, :)

    if (.not. self%needed) return
    call exchange(self%group, self%sent, self%received, field, values)
    field(:, self%received%columns) = values
  end subroutine update
end module column_exchanges
