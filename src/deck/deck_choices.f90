!> Integer constants of the choices of the deck.
module deck_choices
  use text, only: line_t, lower_case, words_of
  implicit none
  private
  public :: code_of

contains

  !> Constant of a choice; the first one for an unknown word.
  pure integer function code_of(word, names, codes) result(code)
    !> The choice
    character(len=*), intent(in) :: word
    !> Choices separated by blanks
    character(len=*), intent(in) :: names
    !> Their constants
    integer, intent(in) :: codes(:)
    type(line_t), allocatable :: choices(:)
    integer :: i

    choices = words_of(names, ' ')
    code = codes(1)
    do i = 1, size(choices)
      if (choices(i)%text == lower_case(word)) code = codes(i)
    end do
  end function code_of
end module deck_choices
