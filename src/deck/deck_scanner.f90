!> Scans a deck before its values are read, because a compiler's namelist READ takes a misspelt group as absent and
!> silently ignores a missing slash, a repeated key, a truncated text or an empty value.
module deck_scanner
  use deck_entries, only: value_t, entry_t, block_t, append_entry, append_values, split_repeats, shown, shown_values, &
                          max_values
  use deck_problems, only: problems_t, any_key
  use deck_tokens, only: token_t, cursor_t, next_token, skip_to_group, token_end, token_group, token_slash, &
                         token_key, token_word, token_quoted, token_cut, token_comma, token_equals
  use deck_typography, only: take_plain
  use text, only: to_text, lower_case
  implicit none
  private
  public :: scan_t, scan_deck

  !> Largest deck in bytes, and longest line.
  integer, parameter, public :: max_bytes = 1000000, longest_line = 4000
  !> Bytes that some editors put at the start of a file: the mark of UTF-8.
  character(len=3), parameter :: byte_order_mark = char(239)//char(187)//char(191)

  !> Contents of a deck.
  type :: scan_t
    !> The groups in order
    type(block_t), allocatable :: blocks(:)
    !> The keys in order
    type(entry_t), allocatable :: entries(:)
    !> Values found so far
    integer :: values = 0
    !> True: the last group has not ended yet
    logical, private :: open = .false.
    !> True: the last key may have further values
    logical, private :: collecting = .false.
    !> True: the last word was a comma or =, so that a value is due
    logical, private :: value_due = .false.
  end type scan_t

contains

  !> Finds groups, keys and values; reports every error of syntax.
  subroutine scan_deck(content, scan, problems)
    !> Text of the deck
    character(len=*), intent(in) :: content
    !> Its contents
    type(scan_t), intent(out) :: scan
    type(problems_t), intent(inout) :: problems
    type(cursor_t) :: cursor
    type(token_t) :: token
    character(len=:), allocatable :: deck, unknown_word
    integer :: unknown_line
    logical :: readable

    allocate (scan%blocks(0), scan%entries(0))
    call check_characters(content, problems, readable)
    if (.not. readable) return
    call take_plain(content, problems, deck)
    if (index(deck, byte_order_mark) == 1) cursor%at = 4
    do while (.not. problems%is_full() .and. scan%values < max_values)
      if (.not. scan%open) then
        call skip_to_group(deck, cursor, unknown_word, unknown_line)
        if (unknown_line > 0) call problems%error(unknown_line, '', '', shown(unknown_word)// &
          ' is outside of a group, where Fortran would skip it; allowed: comments with ! and groups &name ... /')
        if (cursor%at > len(deck)) exit
      end if
      call next_token(deck, cursor, token)
      call take(scan, token, problems)
      if (token%kind == token_end) exit
    end do
    if (scan%values >= max_values) call problems%error(cursor%line, '', '', 'the deck has more than '// &
      to_text(max_values)//' keys and values; no deck needs so many.')
    if (size(scan%blocks) == 0 .and. problems%errors() == 0) call problems%error(0, '', '', &
      'the deck has no group; it needs at least &plate, &mesh, &material and &laminate.')
  end subroutine scan_deck

  !> Whether this is text with lines of a sensible length.
  subroutine check_characters(deck, problems, readable)
    character(len=*), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    !> False: scanning it would make no sense
    logical, intent(out) :: readable
    integer :: i, line, start, code

    line = 1
    start = 1
    readable = .false.
    do i = 1, len(deck)
      code = iachar(deck(i:i))
      if (code == 10) then
        line = line + 1
        start = i + 1
      else if (code == 127 .or. (code < 32 .and. code /= 9 .and. .not. is_line_end(deck, i))) then
        call problems%error(line, '', '', 'character '//to_text(i - start + 1)//' of the line has code '// &
                            to_text(code)//', which is not printable; a deck is plain text.')
        return
      else if (i - start >= longest_line) then
        call problems%error(line, '', '', 'the line is longer than '//to_text(longest_line)// &
                            ' characters; spread the values over several lines.')
        return
      end if
    end do
    readable = verify(deck, ' '//achar(9)//achar(10)//achar(13)) > 0
    if (.not. readable) call problems%error(0, '', '', &
      'the deck is empty; it needs at least &plate, &mesh, &material and &laminate.')
  end subroutine check_characters

  !> True: at this place is the carriage return of a line end as Windows writes it.
  pure logical function is_line_end(deck, at)
    character(len=*), intent(in) :: deck
    !> Place in it
    integer, intent(in) :: at

    is_line_end = iachar(deck(at:at)) == 13
    if (is_line_end .and. at < len(deck)) is_line_end = iachar(deck(at + 1:at + 1)) == 10
  end function is_line_end

  !> Adds a word of the deck to the result.
  subroutine take(scan, token, problems)
    type(scan_t), intent(inout) :: scan
    type(token_t), intent(in) :: token
    type(problems_t), intent(inout) :: problems

    select case (token%kind)
    case (token_group)
      call begin_block(scan, token, problems)
    case (token_slash)
      call finish_entry(scan, problems)
      scan%open = .false.
    case (token_end)
      call finish_entry(scan, problems)
      if (scan%open) call report_missing_slash(scan, 'the deck ends', problems)
    case (token_key)
      call begin_entry(scan, token, problems)
    case (token_word, token_quoted, token_cut)
      call take_value(scan, token, problems)
    case (token_comma)
      if (scan%value_due) call mark_faulty(scan, token%line, 'has no value in front of a comma; leave the comma out', &
                                     problems)
      scan%value_due = .true.
    case (token_equals)
      call mark_faulty(scan, token%line, 'has an = too many; write key = value', problems)
    end select
  end subroutine take

  !> A group begins.
  subroutine begin_block(scan, token, problems)
    type(scan_t), intent(inout) :: scan
    !> The group's name
    type(token_t), intent(in) :: token
    type(problems_t), intent(inout) :: problems
    type(block_t) :: block

    call finish_entry(scan, problems)
    if (lower_case(token%text) == 'end') then
      call problems%error(token%line, '', '', '&end is an obsolete form; end the group with /')
      scan%open = .false.
      return
    end if
    if (scan%open) call report_missing_slash(scan, '&'//shown(token%text)//' begins in line '// &
                                           to_text(token%line), problems)
    block%name = token%text
    block%line = token%line
    scan%blocks = [scan%blocks, block]
    scan%values = scan%values + 1
    scan%open = .true.
  end subroutine begin_block

  !> The open group is not ended.
  subroutine report_missing_slash(scan, event, problems)
    type(scan_t), intent(in) :: scan
    !> The consequence, end of a sentence
    character(len=*), intent(in) :: event
    type(problems_t), intent(inout) :: problems

    associate (last => scan%blocks(size(scan%blocks)))
      call problems%error(last%line, '', '', '&'//shown(last%name)//': '//event// &
                          ' before the group ends; end the group with /')
    end associate
  end subroutine report_missing_slash

  !> A key begins.
  subroutine begin_entry(scan, token, problems)
    type(scan_t), intent(inout) :: scan
    !> The key's name
    type(token_t), intent(in) :: token
    type(problems_t), intent(inout) :: problems
    type(entry_t) :: entry
    integer :: index_start

    call finish_entry(scan, problems)
    entry%block = size(scan%blocks)
    entry%line = token%line
    entry%key = token%text
    allocate (entry%values(0))
    index_start = scan_for(token%text, '(%')
    if (index_start > 1) entry%key = token%text(:index_start - 1)
    call append_entry(scan%entries, entry)
    scan%values = scan%values + 1
    scan%collecting = .true.
    scan%value_due = .true.
    if (index_start > 0) call mark_faulty(scan, token%line, 'is given part by part as '//shown(token%text)// &
                                    '; list all values behind one =', problems)
  end subroutine begin_entry

  !> Place of the first of some characters in a word, 0 if there is none.
  pure integer function scan_for(word, characters)
    character(len=*), intent(in) :: word
    !> The characters
    character(len=*), intent(in) :: characters
    intrinsic :: scan

    scan_for = scan(word, characters)
  end function scan_for

  !> Ends the list of values of the last key.
  subroutine finish_entry(scan, problems)
    type(scan_t), intent(inout) :: scan
    type(problems_t), intent(inout) :: problems

    if (scan%collecting) then
      associate (last => scan%entries(size(scan%entries)))
        if (size(last%values) == 0) call mark_faulty(scan, last%line, 'has no value; give one or leave the key out', &
                                                     problems)
      end associate
    end if
    scan%collecting = .false.
    scan%value_due = .false.
  end subroutine finish_entry

  !> A value of the last key.
  subroutine take_value(scan, token, problems)
    type(scan_t), intent(inout) :: scan
    !> The value
    type(token_t), intent(in) :: token
    type(problems_t), intent(inout) :: problems
    integer :: repeats
    type(value_t) :: value

    if (.not. scan%collecting) then
      call report_stray_value(scan, token, problems)
    else if (token%kind == token_cut) then
      call mark_faulty(scan, token%line, 'contains a text without its closing quote on the same line; close it', &
                       problems, any_key)
    else
      value%quoted = token%kind == token_quoted
      call split_repeats(token%text, value%quoted, token%repeats, repeats, value%text)
      if (repeats < 1 .or. (len(value%text) == 0 .and. .not. value%quoted)) then
        call mark_faulty(scan, token%line, 'has a wrong repeat count in '//shown(token%text)// &
                   '; write count*value with a count from 1 to '//to_text(max_values), problems)
      else if (scan%values + repeats > max_values) then
        scan%values = max_values
        scan%entries(size(scan%entries))%valid = .false.
      else
        call append_values(scan%entries(size(scan%entries))%values, repeats, value)
        scan%values = scan%values + repeats
      end if
    end if
    scan%value_due = .false.
    ! A text that is not closed includes the slash that may end its line.
    if (token%kind == token_cut .and. len_trim(token%text) > 0) then
      if (index(token%text, '/', back=.true.) == len_trim(token%text)) scan%open = .false.
      if (.not. scan%open) scan%collecting = .false.
    end if
  end subroutine take_value

  !> A value without a key.
  subroutine report_stray_value(scan, token, problems)
    type(scan_t), intent(inout) :: scan
    !> The value
    type(token_t), intent(in) :: token
    type(problems_t), intent(inout) :: problems
    type(entry_t) :: entry

    associate (group => scan%blocks(size(scan%blocks))%name)
      call problems%error(token%line, group, token%text, '&'//shown(group)//': '//shown(token%text)// &
                          ' has no key or no = behind it; write key = value.')
    end associate
    ! Text up to the next key belongs to the same error.
    entry%block = size(scan%blocks)
    entry%key = ''
    entry%line = token%line
    entry%valid = .false.
    allocate (entry%values(0))
    call append_entry(scan%entries, entry)
    scan%values = scan%values + 1
    scan%collecting = .true.
  end subroutine report_stray_value

  !> Reports an error in the syntax of the last key once, and excludes the key from further checks.
  subroutine mark_faulty(scan, line, fault, problems, keys)
    type(scan_t), intent(inout) :: scan
    !> Line of the fault
    integer, intent(in) :: line
    !> The error and the values allowed
    character(len=*), intent(in) :: fault
    type(problems_t), intent(inout) :: problems
    !> Keys of the error if not this one alone
    character(len=*), intent(in), optional :: keys
    character(len=:), allocatable :: concerned
    integer :: last

    last = size(scan%entries)
    associate (group => scan%blocks(size(scan%blocks))%name)
      if (.not. scan%collecting) then
        call problems%error(line, group, '', '&'//shown(group)// &
                            ': a comma or = in place of a key; write key = value.')
      else if (scan%entries(last)%valid) then
        concerned = scan%entries(last)%key
        if (present(keys)) concerned = keys
        call problems%error(line, group, concerned, '&'//shown(group)//' '// &
                            shown(scan%entries(last)%key)//' ='//shown_values(scan%entries(last)%values)//': '// &
                            fault//'.')
        scan%entries(last)%valid = .false.
      end if
    end associate
  end subroutine mark_faulty
end module deck_scanner
