!> Writes the messages of checks across keys and groups in the one form that all messages have.
module deck_remarks
  use deck_entries, only: value_t, shown_values
  use deck_problems, only: problems_t
  use deck_settings, only: settings_t
  implicit none
  private
  public :: tell, remark

contains

  !> Adds an error that belongs to a key, or to a group if the key is empty.
  subroutine tell(settings, problems, group, key, fault, place)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives the error
    type(problems_t), intent(inout) :: problems
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> What is wrong; what is allowed
    character(len=*), intent(in) :: fault
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    call problems%error(line_of(settings, group, key, place), group, key, head(settings, group, key, place)//fault)
  end subroutine tell

  !> Adds a warning that belongs to a key, or to a group if the key is empty.
  subroutine remark(settings, problems, group, key, message, place)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives the warning
    type(problems_t), intent(inout) :: problems
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> One clause
    character(len=*), intent(in) :: message
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    call problems%warning(line_of(settings, group, key, place), group, key, head(settings, group, key, place)//message)
  end subroutine remark

  !> Line to name.
  pure integer function line_of(settings, group, key, place) result(line)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> Which of the groups of this name
    integer, intent(in), optional :: place

    if (key == '') then
      line = settings%line_of_group(group, place)
    else
      line = settings%line_of(group, key, place)
    end if
  end function line_of

  !> Beginning of a message.
  pure function head(settings, group, key, place) result(beginning)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Names of group and key
    character(len=*), intent(in) :: group, key
    !> Which of the groups of this name
    integer, intent(in), optional :: place
    !> Such as `&time step = 1e-6: `
    character(len=:), allocatable :: beginning
    type(value_t), allocatable :: values(:)

    beginning = '&'//group
    if (key /= '') beginning = beginning//' '//key
    if (settings%is_given(group, key, place)) then
      call settings%take_values(group, key, values, place)
      beginning = beginning//' ='//shown_values(values)
    end if
    beginning = beginning//': '
  end function head
end module deck_remarks
