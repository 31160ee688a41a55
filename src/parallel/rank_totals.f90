!> Totals over all ranks that do not depend on the number of ranks or the partition: exact sums, rounded once.
module rank_totals
  use communicators, only: communicator_t
  use exact_sums, only: exact_sum_t
  use kinds, only: wp, long
  implicit none
  private
  public :: total_of, totals_of

  !> Sum over the ranks, the same on every rank: of a list, of a table, or of exact sums of this rank's terms.
  interface total_of
    module procedure total_of_list, total_of_table, total_of_sum
  end interface total_of

contains

  !> Sum of the lists of all ranks. Collective.
  real(wp) function total_of_list(communicator, values) result(total)
    type(communicator_t), intent(in) :: communicator
    !> This rank's terms, any number of them
    real(wp), intent(in) :: values(:)
    type(exact_sum_t) :: sum

    call sum%add(values)
    total = total_of_sum(communicator, sum)
  end function total_of_list

  !> Sum of the tables of all ranks. Collective.
  real(wp) function total_of_table(communicator, values) result(total)
    type(communicator_t), intent(in) :: communicator
    !> This rank's terms, any number of them
    real(wp), intent(in) :: values(:, :)
    type(exact_sum_t) :: sum

    call sum%add(values)
    total = total_of_sum(communicator, sum)
  end function total_of_table

  !> Total of the sums of all ranks. Collective.
  real(wp) function total_of_sum(communicator, sum) result(total)
    type(communicator_t), intent(in) :: communicator
    !> Sum of this rank's terms
    type(exact_sum_t), intent(in) :: sum
    real(wp) :: totals(1)

    totals = totals_of(communicator, [sum])
    total = totals(1)
  end function total_of_sum

  !> Totals of several sums of all ranks, in one message. Collective.
  function totals_of(communicator, sums) result(totals)
    type(communicator_t), intent(in) :: communicator
    !> Sums of this rank's terms
    type(exact_sum_t), intent(in) :: sums(:)
    !> The totals, the same on every rank
    real(wp) :: totals(size(sums))
    type(exact_sum_t) :: all(size(sums))
    integer(long), allocatable :: chunks(:)
    integer :: i, places

    all = sums
    if (communicator%size > 1 .and. size(sums) > 0) then
      places = size(all(1)%chunks)
      allocate (chunks(places*size(sums)))
      do i = 1, size(sums)
        call all(i)%carry()
        chunks((i - 1)*places + 1:i*places) = all(i)%chunks
      end do
      call communicator%sum(chunks)
      do i = 1, size(sums)
        all(i)%chunks = chunks((i - 1)*places + 1:i*places)
      end do
    end if
    totals = [(all(i)%rounded(), i=1, size(sums))]
  end function totals_of
end module rank_totals
