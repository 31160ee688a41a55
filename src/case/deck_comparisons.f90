!> Comparison of two decks in words.
module deck_comparisons
  use deck_contents, only: deck_t
  use kinds, only: wp
  use material_parameters, only: constant_names, constants, constants_of
  use roundings, only: rounding
  use text, only: rounded_text, to_text
  implicit none
  private
  public :: both, differ, list_objection, material_objection, short_list

  !> Digits of numbers in a list, for numbers with a relative difference above 1e-9.
  integer, parameter :: digits = 10

contains

  !> A clause with both values.
  pure function both(what, here, there) result(clause)
    !> The quantity
    character(len=*), intent(in) :: what
    !> Value in the deck, and in that of the other run
    character(len=*), intent(in) :: here, there
    character(len=:), allocatable :: clause

    clause = what//': '//here//' here and '//there//' there'
  end function both

  !> True where two numbers differ by more than rounding.
  elemental logical function differ(here, there)
    !> The numbers
    real(wp), intent(in) :: here, there

    differ = abs(here - there) > rounding*max(abs(here), abs(there))
  end function differ

  !> A clause with two lists; empty: they do not differ.
  pure function list_objection(what, here, there) result(objection)
    !> The quantity
    character(len=*), intent(in) :: what
    !> List of the deck, and that of the other run
    real(wp), intent(in) :: here(:), there(:)
    character(len=:), allocatable :: objection
    logical :: is_other

    objection = ''
    is_other = size(here) /= size(there)
    if (.not. is_other) is_other = any(differ(here, there))
    if (is_other) objection = both(what, short_list(here), short_list(there))
  end function list_objection

  !> First difference of the materials of as many plies.
  function material_objection(deck, old, mine, its, owner) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> Index of each ply's material, and of that in the other deck
    integer, intent(in) :: mine(:), its(:)
    !> Of the plies; empty: they are named by their numbers
    character(len=*), intent(in) :: owner
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection
    real(wp) :: here(constants), there(constants)
    integer :: ply, i

    objection = ''
    do ply = 1, size(mine)
      here = constants_of(deck%setup%materials(mine(ply)))
      there = constants_of(old%setup%materials(its(ply)))
      i = findloc(differ(here, there), .true., dim=1)
      if (i == 0) cycle
      objection = owner
      if (owner == '') objection = 'ply '//to_text(ply)
      objection = both('&material '//trim(constant_names(i))//' of '//objection, to_text(here(i)), to_text(there(i)))
      return
    end do
  end function material_objection

  !> Numbers as text.
  pure function short_list(numbers) result(list)
    !> The numbers
    real(wp), intent(in) :: numbers(:)
    !> Separated by blanks; none: without a number
    character(len=:), allocatable :: list
    integer :: i

    list = ''
    do i = 1, size(numbers)
      list = list//' '//rounded_text(numbers(i), digits)
    end do
    list = list(min(2, len(list) + 1):)
    if (size(numbers) == 0) list = 'none'
  end function short_list
end module deck_comparisons
