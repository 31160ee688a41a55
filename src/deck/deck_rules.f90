!> Checks a scanned deck against the vocabulary: unknown and repeated names, types, counts and ranges.
module deck_rules
  use allowed_values, only: allowed_sentence
  use deck_entries, only: value_t, entry_t, shown, shown_values
  use deck_problems, only: problems_t
  use deck_scanner, only: scan_t
  use deck_settings, only: settings_t, setting_t, present_group_t
  use deck_values, only: fault_of_value, fault_of_count, decimal_commas, limit_of_size, literal_value
  use deck_vocabulary, only: vocabulary_t, key_entry_t
  use text, only: line_t, ended, joined, lower_case, nearest_name, to_text, words_of
  implicit none
  private
  public :: resolve_settings

  !> Largest number of groups of one name; no laminate has so many materials.
  integer, parameter :: max_repetitions = 100

contains

  !> Turns a scanned deck into keys in effect and reports every name and value that is not allowed.
  subroutine resolve_settings(scan, vocabulary, settings, problems)
    type(scan_t), intent(in) :: scan
    type(vocabulary_t), intent(in) :: vocabulary
    type(settings_t), intent(out) :: settings
    type(problems_t), intent(inout) :: problems
    logical :: accepted(size(scan%blocks))
    integer :: i

    allocate (settings%groups(0), settings%items(0))
    do i = 1, size(scan%blocks)
      call check_group(scan, i, vocabulary, settings, problems, accepted(i))
      if (problems%is_full()) return
    end do
    do i = 1, size(scan%entries)
      if (accepted(scan%entries(i)%block)) call check_key(scan, i, place_of(scan, accepted, scan%entries(i)%block), &
                                                          vocabulary, problems)
      if (problems%is_full()) return
    end do
    do i = 1, size(vocabulary%groups)
      call resolve_group(scan, accepted, vocabulary, i, settings, problems)
    end do
  end subroutine resolve_settings

  !> Whether a group is known and allowed here.
  subroutine check_group(scan, block, vocabulary, settings, problems, accepted)
    type(scan_t), intent(in) :: scan
    !> Index of the group in it
    integer, intent(in) :: block
    type(vocabulary_t), intent(in) :: vocabulary
    !> The group is added to these
    type(settings_t), intent(inout) :: settings
    type(problems_t), intent(inout) :: problems
    !> True: its keys are used
    logical, intent(out) :: accepted
    type(present_group_t) :: new
    character(len=:), allocatable :: nearest
    integer :: index, earlier

    accepted = .false.
    associate (group => scan%blocks(block))
      index = vocabulary%group_index(group%name)
      earlier = settings%groups_named(group%name)
      if (index == 0) then
        nearest = nearest_name(group%name, vocabulary%group_names())
        if (nearest /= '') then
          call problems%error(group%line, nearest, '', '&'//shown(group%name)// &
                              ': there is no such group; did you mean &'//nearest//'?')
        else
          call problems%error(group%line, '', '', '&'//shown(group%name)//': there is no such group; allowed: '// &
                              joined(vocabulary%group_names(), ', ')//'.')
        end if
      else if (earlier > 0 .and. all(vocabulary%groups(index)%presence /= &
                                     [character(len=10) :: 'repeatable', 'several'])) then
        call problems%error(group%line, '', '', '&'//group%name//': the group was already given in line '// &
                            to_text(settings%line_of_group(group%name))//'; give it once.')
      else if (earlier >= max_repetitions) then
        call problems%error(group%line, '', '', '&'//group%name//': the group comes more than '// &
                            to_text(max_repetitions)//' times.')
      else
        accepted = .true.
        new%name = lower_case(group%name)
        new%line = group%line
        settings%groups = [settings%groups, new]
      end if
    end associate
  end subroutine check_group

  !> Checks that a key belongs to its group and is given once.
  subroutine check_key(scan, entry, place, vocabulary, problems)
    type(scan_t), intent(in) :: scan
    !> Index of the key in it
    integer, intent(in) :: entry
    !> Index of the key's group among those of this name
    integer, intent(in) :: place
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(inout) :: problems
    integer :: earlier

    associate (this => scan%entries(entry), group => scan%blocks(scan%entries(entry)%block)%name)
      if (this%key == '') return
      if (vocabulary%key_index(group, this%key) == 0) then
        call report_unknown_key(lower_case(group), place, this, vocabulary, problems)
        return
      end if
      earlier = entry_of(scan, this%block, this%key)
      if (earlier /= entry) call problems%error(this%line, group, this%key, message_head(group, this)// &
        'the key was already given in line '//to_text(scan%entries(earlier)%line)//'; give it once.', place)
    end associate
  end subroutine check_key

  !> A key that its group does not have.
  subroutine report_unknown_key(group, place, entry, vocabulary, problems)
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    !> The key
    type(entry_t), intent(in) :: entry
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: nearest
    type(line_t), allocatable :: others(:)

    nearest = nearest_name(entry%key, vocabulary%key_names(group))
    others = vocabulary%groups_with(entry%key)
    if (nearest /= '' .and. size(others) == 0) then
      call problems%error(entry%line, group, nearest, message_head(group, entry)// &
                          'the group has no such key; did you mean '//nearest//'?', place)
    else if (size(others) > 0) then
      call problems%error(entry%line, group, entry%key, message_head(group, entry)// &
                          'the group has no such key; it belongs to &'//joined(others, ', &')//'.', place)
    else
      call problems%error(entry%line, group, entry%key, message_head(group, entry)// &
                          'the group has no such key; allowed: '//joined(vocabulary%key_names(group), ', ')//'.', place)
    end if
  end subroutine report_unknown_key

  !> Adds all keys of the groups of one name, given or by default.
  subroutine resolve_group(scan, accepted, vocabulary, group, settings, problems)
    type(scan_t), intent(in) :: scan
    !> True for groups that are used
    logical, intent(in) :: accepted(:)
    type(vocabulary_t), intent(in) :: vocabulary
    !> Index of the group in the table
    integer, intent(in) :: group
    !> The keys are added to these
    type(settings_t), intent(inout) :: settings
    type(problems_t), intent(inout) :: problems
    integer :: block, place

    associate (entry => vocabulary%groups(group))
      place = 0
      do block = 1, size(scan%blocks)
        if (.not. accepted(block) .or. lower_case(scan%blocks(block)%name) /= entry%name) cycle
        place = place + 1
        call resolve_keys(scan, block, place, vocabulary, entry%name, settings, problems)
      end do
      if (place > 0) return
      if (entry%presence == 'settings') then
        call resolve_keys(scan, 0, 1, vocabulary, entry%name, settings, problems)
      else if (all(entry%presence /= [character(len=8) :: 'optional', 'several', 'hidden']) .and. &
               .not. problems%concern(entry%name)) then
        ! Without any group the deck was already reported to have none.
        if (size(scan%blocks) > 0) call problems%error(0, entry%name, '', &
          '&'//entry%name//' is missing; `implam explain '//entry%name//'` lists its keys.')
      end if
    end associate
  end subroutine resolve_group

  !> Adds all keys of one group.
  subroutine resolve_keys(scan, block, place, vocabulary, group, settings, problems)
    type(scan_t), intent(in) :: scan
    !> Index of the group in it; 0: the deck does not have it
    integer, intent(in) :: block
    integer, intent(in) :: place
    type(vocabulary_t), intent(in) :: vocabulary
    character(len=*), intent(in) :: group
    !> The keys are added to these
    type(settings_t), intent(inout) :: settings
    type(problems_t), intent(inout) :: problems
    type(setting_t) :: setting, blank
    integer :: i, entry

    do i = 1, size(vocabulary%keys)
      associate (key => vocabulary%keys(i))
        if (key%group /= group) cycle
        setting = blank
        setting%group = group
        setting%key = key%name
        setting%place = place
        entry = entry_of(scan, block, key%name)
        if (entry > 0) then
          setting%given = .true.
          setting%line = scan%entries(entry)%line
          setting%valid = scan%entries(entry)%valid
          setting%values = scan%entries(entry)%values
          if (setting%valid) call check_values(key, place, scan%entries(entry), vocabulary, setting%valid, problems)
          if (setting%valid) call take_spelling(key, setting%values)
        else
          setting%line = settings%line_of_group(group, place)
          allocate (setting%values(merge(1, 0, key%has_literal_default())))
          if (key%has_literal_default()) setting%values(1) = literal_value(key%default)
          if (key%default == 'required' .and. .not. problems%concern(group, key%name, place)) &
            call problems%error(setting%line, group, key%name, '&'//group//' '//key%name//' is missing; '// &
                                ended(allowed_sentence(key)), place)
        end if
        settings%items = [settings%items, setting]
      end associate
    end do
  end subroutine resolve_keys

  !> Number and values of a given key.
  subroutine check_values(key, place, entry, vocabulary, valid, problems)
    type(key_entry_t), intent(in) :: key
    integer, intent(in) :: place
    !> The key as the deck gives it
    type(entry_t), intent(in) :: entry
    type(vocabulary_t), intent(in) :: vocabulary
    !> True: the values can be used
    logical, intent(out) :: valid
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: fault, count_fault, limit
    integer :: i, forgotten

    fault = ''
    limit = ''
    do i = 1, size(entry%values)
      if (fault == '') then
        fault = fault_of_value(key, entry%values(i))
        limit = limit_of_size(key, entry%values(i))
      end if
      forgotten = 0
      if (.not. entry%values(i)%quoted) forgotten = vocabulary%key_index(key%group, entry%values(i)%text)
      if (forgotten == 0) cycle
      call problems%error(entry%line, key%group, entry%values(i)%text, message_head(key%group, entry)// &
                          'there is no = behind '//entry%values(i)%text//'; write key = value.', place)
      valid = .false.
      return
    end do
    count_fault = fault_of_count(key, size(entry%values))
    if (index(count_fault, 'too many') == 1 .and. decimal_commas(key, entry%values) /= '') then
      fault = count_fault//decimal_commas(key, entry%values)
    else if (fault == '') then
      fault = count_fault
    end if
    valid = fault == ''
    if (.not. valid) call problems%error(entry%line, key%group, key%name, message_head(key%group, entry)// &
                                         ended(fault//'; '//allowed_sentence(key)//limit), place)
  end subroutine check_values

  !> Replaces choices by their spelling in the table, as they are accepted in any case. A text with several choices is
  !> not changed.
  pure subroutine take_spelling(key, values)
    type(key_entry_t), intent(in) :: key
    !> Its values, valid
    type(value_t), intent(inout) :: values(:)
    type(line_t), allocatable :: choices(:)
    integer :: i, j

    if (key%kind /= 'choice' .and. key%kind /= 'choice or real') return
    ! In the table, conditions on a real value follow the choices after a comma.
    choices = words_of(key%allowed(:index(key%allowed//',', ',') - 1), ' ')
    do i = 1, size(values)
      do j = 1, size(choices)
        if (lower_case(values(i)%text) == lower_case(choices(j)%text)) values(i)%text = choices(j)%text
      end do
    end do
  end subroutine take_spelling

  !> Index of a group among those of its name.
  pure integer function place_of(scan, accepted, block) result(place)
    type(scan_t), intent(in) :: scan
    !> True for groups that are used
    logical, intent(in) :: accepted(:)
    !> Index of the group in it
    integer, intent(in) :: block
    integer :: i

    place = count([(accepted(i) .and. lower_case(scan%blocks(i)%name) == lower_case(scan%blocks(block)%name), &
                    i=1, block)])
  end function place_of

  !> First key of this name in a group, 0 if it has none.
  pure integer function entry_of(scan, block, key) result(index)
    type(scan_t), intent(in) :: scan
    !> Index of the group in it
    integer, intent(in) :: block
    !> Name of the key
    character(len=*), intent(in) :: key

    do index = 1, size(scan%entries)
      if (scan%entries(index)%block == block .and. lower_case(scan%entries(index)%key) == lower_case(key)) return
    end do
    index = 0
  end function entry_of

  !> Beginning of a message: `&group key = values: `.
  pure function message_head(group, entry) result(head)
    character(len=*), intent(in) :: group
    !> The key as the deck gives it
    type(entry_t), intent(in) :: entry
    character(len=:), allocatable :: head

    head = '&'//lower_case(group)//' '//shown(entry%key)//' ='//shown_values(entry%values)//': '
  end function message_head
end module deck_rules
