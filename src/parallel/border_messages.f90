!> Exchange between ranks across their borders: columns of a table, grouped by rank.
module border_messages
  use mpi_f08, only: MPI_Comm, MPI_Request, MPI_DOUBLE_PRECISION, MPI_STATUSES_IGNORE, MPI_Irecv, MPI_Isend, MPI_Waitall
  use kinds, only: wp
  implicit none
  private
  public :: message_plan_t, new_message_plan, exchange, offsets

  !> Columns exchanged with other ranks in one direction, grouped by rank.
  type :: message_plan_t
    !> The other ranks, ascending
    integer, allocatable :: ranks(:)
    !> Where the columns of each of these ranks begin, shape (ranks + 1)
    integer, allocatable :: start(:)
    !> The columns, grouped by rank
    integer, allocatable :: columns(:)
  end type message_plan_t

contains

  !> Sums of the items before each.
  pure function offsets(counts)
    !> Number of items of each rank
    integer, intent(in) :: counts(:)
    !> Number of items of the ranks before each
    integer :: offsets(size(counts))
    integer :: r

    offsets = [(sum(counts(:r - 1)), r=1, size(counts))]
  end function offsets

  !> Columns to exchange, from the number of them for each rank.
  pure function new_message_plan(counts, columns) result(plan)
    !> Number of columns exchanged with each rank
    integer, intent(in) :: counts(0:)
    !> The columns, grouped by rank
    integer, intent(in) :: columns(:)
    !> The same without the ranks that exchange nothing
    type(message_plan_t) :: plan
    integer :: r

    allocate (plan%ranks(count(counts > 0)), source=pack([(r, r=0, size(counts) - 1)], counts > 0))
    allocate (plan%start(size(plan%ranks) + 1))
    plan%start = [1, (1 + sum(counts(:plan%ranks(r))), r=1, size(plan%ranks))]
    allocate (plan%columns(size(columns)), source=columns)
  end function new_message_plan

  !> Sends the values of some columns and receives those of columns of other ranks.
  subroutine exchange(group, sent, received, field, values)
    !> All ranks
    type(MPI_Comm), intent(in) :: group
    !> Columns that are sent, and columns of the other ranks' that are received
    type(message_plan_t), intent(in) :: sent, received
    !> Values, shape (components, columns)
    real(wp), intent(in) :: field(:, :)
    !> Values received, shape (components, columns received)
    real(wp), allocatable, asynchronous, intent(out) :: values(:, :)
    real(wp), allocatable, asynchronous :: own(:, :)
    type(MPI_Request) :: requests(size(sent%ranks) + size(received%ranks))
    integer :: i

    allocate (values(size(field, 1), size(received%columns)))
    do i = 1, size(received%ranks)
      call MPI_Irecv(values(1, received%start(i)), size(field, 1)*(received%start(i + 1) - received%start(i)), &
                     MPI_DOUBLE_PRECISION, received%ranks(i), 0, group, requests(i))
    end do
    own = field(:, sent%columns)
    do i = 1, size(sent%ranks)
      call MPI_Isend(own(1, sent%start(i)), size(field, 1)*(sent%start(i + 1) - sent%start(i)), &
                     MPI_DOUBLE_PRECISION, sent%ranks(i), 0, group, requests(size(received%ranks) + i))
    end do
    call MPI_Waitall(size(requests), requests, MPI_STATUSES_IGNORE)
  end subroutine exchange
end module border_messages
