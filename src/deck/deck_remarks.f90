!> Writes the messages of checks across keys and groups in the one form that all messages have.
module deck_remarks
  use deck_entries, only: value_t, shown_values
  use deck_problems, only: problems_t
  use deck_settings, only: settings_t
  use deck_vocabulary, only: vocabulary_t
  use key_conditions, only: missing_condition
  use text, only: line_t, words_of
  implicit none
  private
  public :: report, remark, remark_idle, remark_unused, are_clear

contains

  !> Adds an error that belongs to a key, or to a group if the key is empty.
  subroutine report(settings, problems, group, key, fault, place)
    type(settings_t), intent(in) :: settings
    type(problems_t), intent(inout) :: problems
    character(len=*), intent(in) :: group, key
    !> The error and the values allowed
    character(len=*), intent(in) :: fault
    integer, intent(in), optional :: place

    call problems%error(line_of(settings, group, key, place), group, key, head(settings, group, key, place)//fault, &
                        place)
  end subroutine report

  !> Adds a warning that belongs to a key, or to a group if the key is empty.
  subroutine remark(settings, problems, group, key, message, place)
    type(settings_t), intent(in) :: settings
    type(problems_t), intent(inout) :: problems
    character(len=*), intent(in) :: group, key
    !> One clause
    character(len=*), intent(in) :: message
    integer, intent(in), optional :: place

    call problems%warning(line_of(settings, group, key, place), group, key, head(settings, group, key, place)//message)
  end subroutine remark

  !> Adds a warning for each of some keys that is valid but has no effect.
  subroutine remark_idle(settings, problems, group, keys, message, place)
    type(settings_t), intent(in) :: settings
    type(problems_t), intent(inout) :: problems
    character(len=*), intent(in) :: group
    !> Names of keys, separated by blanks
    character(len=*), intent(in) :: keys
    !> Reason
    character(len=*), intent(in) :: message
    integer, intent(in), optional :: place
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    do i = 1, size(names)
      if (settings%find(group, names(i)%text, place) == 0) cycle
      if (allocated(settings%items(settings%find(group, names(i)%text, place))%origin)) cycle
      if (settings%is_given(group, names(i)%text, place) .and. settings%is_known(group, names(i)%text, place)) &
        call remark(settings, problems, group, names(i)%text, message, place)
    end do
  end subroutine remark_idle

  !> Adds a warning for each given key whose conditions do not hold.
  subroutine remark_unused(settings, vocabulary, problems)
    type(settings_t), intent(in) :: settings
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: reason
    integer :: i, place

    do i = 1, size(vocabulary%keys)
      associate (key => vocabulary%keys(i))
        if (key%used_with == '') cycle
        do place = 1, settings%groups_named(key%group)
          reason = missing_condition(settings, key%used_with, key%group, place)
          if (reason /= '') &
            call remark_idle(settings, problems, key%group, key%name, 'has no effect '//reason//'.', place)
        end do
      end associate
    end do
  end subroutine remark_unused

  !> True: some keys are valid or absent. A check that calls this first does not report errors caused by other errors.
  pure logical function are_clear(settings, problems, group, keys, place)
    type(settings_t), intent(in) :: settings
    type(problems_t), intent(in) :: problems
    character(len=*), intent(in) :: group
    !> Names of keys, separated by blanks
    character(len=*), intent(in) :: keys
    integer, intent(in), optional :: place
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    are_clear = .true.
    do i = 1, size(names)
      if (settings%is_given(group, names(i)%text, place)) then
        are_clear = are_clear .and. settings%is_known(group, names(i)%text, place)
      else if (settings%line_of_group(group, place) > 0) then
        are_clear = are_clear .and. .not. problems%concern(group, names(i)%text, place)
      else
        are_clear = are_clear .and. .not. problems%concern(group)
      end if
    end do
  end function are_clear

  !> Line of the deck to be named in a message.
  pure integer function line_of(settings, group, key, place) result(line)
    type(settings_t), intent(in) :: settings
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place

    if (key == '') then
      line = settings%line_of_group(group, place)
    else
      line = settings%line_of(group, key, place)
    end if
  end function line_of

  !> Beginning of a message.
  pure function head(settings, group, key, place) result(beginning)
    type(settings_t), intent(in) :: settings
    character(len=*), intent(in) :: group, key
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
