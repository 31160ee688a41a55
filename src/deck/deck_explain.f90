!> Explains groups and keys from the table, for the terminal and for the manual.
module deck_explain
  use allowed_values, only: allowed_sentence
  use deck_vocabulary, only: vocabulary_t, key_entry_t, group_entry_t
  use errors, only: error_t, fail, exit_usage
  use key_conditions, only: conditions_in_words
  use text, only: line_t, append, ended, joined, lower_case, nearest_name, words_of
  use usual_ranges, only: range_in_words
  implicit none
  private
  public :: explain, explain_table

contains

  !> Explains all groups, one group, one key of a group, or a key of any group.
  subroutine explain(vocabulary, topic, lines, error)
    type(vocabulary_t), intent(in) :: vocabulary
    !> Empty, `plate`, `plate%`, `plate%length`, `plate.length`, `plate length` or `length`, with or without &
    character(len=*), intent(in) :: topic
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Raised if there is no such group or key
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: group
    type(line_t), allocatable :: owners(:)
    integer :: mark, i

    allocate (lines(0))
    group = trim(adjustl(topic))
    if (index(group, '&') == 1) group = group(2:)
    mark = scan(group, '%. ')
    ! A mark without a key behind it, as by a shell's completion, leaves the group.
    if (mark > 0 .and. mark == len(group)) then
      group = group(:mark - 1)
      mark = 0
    end if
    owners = vocabulary%groups_with(group)
    if (len(group) == 0) then
      call explain_groups(vocabulary, lines)
    else if (mark > 0) then
      call explain_one(vocabulary, group(:mark - 1), group(mark + 1:), lines, error)
    else if (vocabulary%group_index(group) == 0 .and. size(owners) > 0) then
      do i = 1, size(owners)
        call explain_one(vocabulary, owners(i)%text, group, lines, error)
      end do
    else
      call explain_group(vocabulary, group, lines, error)
    end if
  end subroutine explain

  !> One line per group.
  subroutine explain_groups(vocabulary, lines)
    type(vocabulary_t), intent(in) :: vocabulary
    type(line_t), allocatable, intent(inout) :: lines(:)
    integer :: i

    call append(lines, 'A deck is a file of Fortran namelists. Its groups:')
    do i = 1, size(vocabulary%groups)
      associate (group => vocabulary%groups(i))
        if (group%presence == 'hidden') cycle
        call append(lines, '  &'//group%name//repeat(' ', max(1, 14 - len(group%name)))//'('// &
                    presence_in_words(group)//') '//group%meaning)
      end associate
    end do
    call append(lines, '`implam explain GROUP` lists the keys of a group, `implam explain GROUP KEY` one key.')
  end subroutine explain_groups

  !> A group and its keys.
  subroutine explain_group(vocabulary, name, lines, error)
    type(vocabulary_t), intent(in) :: vocabulary
    character(len=*), intent(in) :: name
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> Raised if there is no such group
    type(error_t), allocatable, intent(inout) :: error
    integer :: i

    call require_group(vocabulary, name, error)
    if (allocated(error)) return
    associate (group => vocabulary%groups(vocabulary%group_index(name)))
      call append(lines, '&'//group%name//' ('//presence_in_words(group)//'): '//group%meaning)
      do i = 1, size(vocabulary%keys)
        if (vocabulary%keys(i)%group == group%name) call explain_key(vocabulary%keys(i), lines)
      end do
    end associate
  end subroutine explain_group

  !> One key of a group.
  subroutine explain_one(vocabulary, group, key, lines, error)
    type(vocabulary_t), intent(in) :: vocabulary
    character(len=*), intent(in) :: group, key
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> Raised if there is no such key
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: nearest

    call require_group(vocabulary, group, error)
    if (allocated(error)) return
    if (vocabulary%key_index(group, key) > 0) then
      call append(lines, '&'//lower_case(group))
      call explain_key(vocabulary%keys(vocabulary%key_index(group, key)), lines)
      return
    end if
    nearest = nearest_name(key, vocabulary%key_names(group))
    if (nearest /= '') then
      call fail(error, exit_usage, '&'//lower_case(group)//' has no key '//key//'; did you mean '//nearest//'?')
    else
      call fail(error, exit_usage, '&'//lower_case(group)//' has no key '//key//'; it has '// &
                joined(vocabulary%key_names(group), ', ')//'.')
    end if
  end subroutine explain_one

  !> Raises an error if there is no group of this name.
  subroutine require_group(vocabulary, name, error)
    type(vocabulary_t), intent(in) :: vocabulary
    character(len=*), intent(in) :: name
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: nearest
    type(line_t), allocatable :: keys(:)
    integer :: i

    if (vocabulary%group_index(name) > 0) return
    nearest = nearest_name(name, vocabulary%group_names())
    if (nearest /= '') nearest = '&'//nearest
    if (nearest == '') then
      allocate (keys(0))
      do i = 1, size(vocabulary%keys)
        call append(keys, vocabulary%keys(i)%name)
      end do
      nearest = nearest_name(name, keys)
    end if
    if (nearest /= '') then
      call fail(error, exit_usage, 'There is no group or key '//name//'; did you mean '//nearest//'?')
    else
      call fail(error, exit_usage, 'There is no group or key '//name//'; the groups are '// &
                joined(vocabulary%group_names(), ', ')//'.')
    end if
  end subroutine require_group

  !> Two lines on a key, one on its conditions, and one on its usual range.
  subroutine explain_key(key, lines)
    type(key_entry_t), intent(in) :: key
    type(line_t), allocatable, intent(inout) :: lines(:)
    character(len=:), allocatable :: unit

    unit = ''
    if (key%unit /= '-') unit = '; unit: '//key%unit
    call append(lines, '  '//key%name//repeat(' ', max(1, 18 - len(key%name)))//key%meaning)
    call append(lines, repeat(' ', 20)//allowed_sentence(key)//unit//'; '//ended(default_in_words(key)))
    if (key%used_with /= '') call append(lines, repeat(' ', 20)//conditions_in_words(key%used_with, '')//'.')
    if (key%usual /= '') call append(lines, repeat(' ', 20)//range_in_words(key%usual)//'.')
  end subroutine explain_key

  !> Whether a group is required and repeatable, in words.
  pure function presence_in_words(group) result(words)
    type(group_entry_t), intent(in) :: group
    character(len=:), allocatable :: words

    select case (group%presence)
    case ('repeatable')
      words = 'required, repeatable'
    case ('several')
      words = 'optional, repeatable'
    case ('settings')
      words = 'optional, has defaults'
    case default
      words = group%presence
    end select
  end function presence_in_words

  !> The default of a key.
  pure function default_in_words(key) result(words)
    type(key_entry_t), intent(in) :: key
    character(len=:), allocatable :: words

    if (key%default == 'required') then
      words = 'required'
    else if (key%default == 'none') then
      words = 'no default'
    else if (key%has_literal_default()) then
      words = 'default: '//key%default
    else
      words = 'default: '//key%default(3:)
    end if
  end function default_in_words

  !> The keys of a group as a Markdown table.
  subroutine explain_table(vocabulary, group, lines, error)
    type(vocabulary_t), intent(in) :: vocabulary
    character(len=*), intent(in) :: group
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Raised if there is no such group, or if it is a key
    type(error_t), allocatable, intent(inout) :: error
    integer :: i

    allocate (lines(0))
    if (scan(group, '%. ') > 0 .or. &
        (vocabulary%group_index(group) == 0 .and. size(vocabulary%groups_with(group)) > 0)) then
      call fail(error, exit_usage, '--markdown prints tables of groups; explain the key '//group//' without it.')
    else
      call require_group(vocabulary, group, error)
    end if
    if (allocated(error)) return
    call append(lines, '| key | type | values | unit | default | allowed | meaning |')
    call append(lines, '|---|---|---|---|---|---|---|')
    do i = 1, size(vocabulary%keys)
      if (vocabulary%keys(i)%group == lower_case(group)) call append(lines, table_row(vocabulary%keys(i)))
    end do
  end subroutine explain_table

  !> One row of a Markdown table.
  pure function table_row(key) result(row)
    type(key_entry_t), intent(in) :: key
    character(len=:), allocatable :: row
    character(len=:), allocatable :: default, allowed, conditions
    type(line_t), allocatable :: choices(:)

    default = key%default
    if (key%has_literal_default()) default = '`'//default//'`'
    if (default(1:1) == '=') default = default(3:)
    allowed = key%allowed
    if (key%kind == 'choice') then
      choices = words_of(key%allowed, ' ')
      allowed = '`'''//joined(choices, '''`, `''')//'''`'
    end if
    if (key%kind == 'choice or real') then
      choices = words_of(allowed(:index(allowed, ',') - 1), ' ')
      allowed = '`'''//joined(choices, '''`, `''')//'''`'//allowed(index(allowed, ','):)
    end if
    conditions = ''
    if (key%used_with /= '') conditions = '; '//conditions_in_words(key%used_with, '`')
    if (key%usual /= '') conditions = conditions//'; '//range_in_words(key%usual)
    if (conditions /= '') conditions = ' ('//conditions(3:)//')'
    row = '| `'//key%name//'` | '//key%kind//' | '//key%values//' | '//key%unit//' | '//default//' | '//allowed// &
          ' | '//key%meaning(:len(key%meaning) - 1)//conditions//'. |'
  end function table_row
end module deck_explain
