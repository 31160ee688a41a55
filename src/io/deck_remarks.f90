!> Writes the messages of checks across keys and groups in the one form that all messages have.
module deck_remarks
  use deck_contents, only: deck_t
  use deck_entries, only: value_t, shown_values
  use deck_problems, only: problems_t
  implicit none
  private
  public :: tell, remark

contains

  !> Adds an error that belongs to a key, or to a group if the key is empty.
  subroutine tell(deck, problems, group, key, fault, place)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Receives the error
    type(problems_t), intent(inout) :: problems
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> What is wrong; what is allowed
    character(len=*), intent(in) :: fault
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    call problems%error(line_of(deck, group, key, place), group, key, head(deck, group, key, place)//fault)
  end subroutine tell

  !> Adds a warning that belongs to a key, or to a group if the key is empty.
  subroutine remark(deck, problems, group, key, message, place)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Receives the warning
    type(problems_t), intent(inout) :: problems
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> One clause
    character(len=*), intent(in) :: message
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    call problems%warning(line_of(deck, group, key, place), group, key, head(deck, group, key, place)//message)
  end subroutine remark

  !> Line to name.
  pure integer function line_of(deck, group, key, place) result(line)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    if (key == '') then
      line = deck%settings%line_of_group(group, place)
    else
      line = deck%settings%line_of(group, key, place)
    end if
  end function line_of

  !> Beginning of a message.
  pure function head(deck, group, key, place) result(beginning)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> Which of the groups of this name
    integer, intent(in), optional :: place
    !> Such as `&time step = 1e-6: `
    character(len=:), allocatable :: beginning
    type(value_t), allocatable :: values(:)

    beginning = '&'//group
    if (key /= '') beginning = beginning//' '//key
    if (deck%settings%is_given(group, key, place)) then
      call deck%settings%take_values(group, key, values, place)
      beginning = beginning//' ='//shown_values(values)
    end if
    beginning = beginning//': '
  end function head
end module deck_remarks
