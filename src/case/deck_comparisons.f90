!> Comparison of two decks in words.
module deck_comparisons
  use kinds, only: wp
  use roundings, only: rounding
  use text, only: rounded_text
  implicit none
  private
  public :: both, differ, integer_list, short_list

  !> Digits of numbers in a list, for numbers with a relative difference above 1e-9.
  integer, parameter :: digits = 10

contains

  !> A clause with both values.
  pure function both(what, here, there) result(clause)
    !> The quantity
    character(len=*), intent(in) :: what
    !> Value in the deck, and in that of the other run
    character(len=*), intent(in) :: here, there
    !> The clause
    character(len=:), allocatable :: clause

    clause = what//': '//here//' here and '//there//' there'
  end function both

  !> True where two numbers differ by more than rounding.
  elemental logical function differ(here, there)
    !> The numbers
    real(wp), intent(in) :: here, there

    differ = abs(here - there) > rounding*max(abs(here), abs(there))
  end function differ

  !> Numbers as text.
  pure function short_list(numbers) result(list)
    !> The numbers
    real(wp), intent(in) :: numbers(:)
    !> Separated by blanks
    character(len=:), allocatable :: list
    integer :: i

    list = ''
    do i = 1, size(numbers)
      list = list//' '//rounded_text(numbers(i), digits)
    end do
    list = list(min(2, len(list) + 1):)
  end function short_list

  !> Integers as text.
  pure function integer_list(numbers) result(list)
    !> The numbers
    integer, intent(in) :: numbers(:)
    !> Separated by blanks
    character(len=:), allocatable :: list

    list = short_list(real(numbers, wp))
    if (size(numbers) == 0) list = 'none'
  end function integer_list
end module deck_comparisons
