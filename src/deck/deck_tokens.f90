!> Words of a deck: splits namelist text into groups, keys, values, commas and slashes.
module deck_tokens
  implicit none
  private
  public :: token_t, cursor_t, next_token, skip_blanks, skip_to_group

  !> Kinds of tokens; a truncated text is one without a closing quote in its line.
  integer, parameter, public :: token_end = 0, token_group = 1, token_slash = 2, token_key = 3, token_word = 4, &
                                token_quoted = 5, token_cut = 6, token_comma = 7, token_equals = 8

  !> End of a line, and the other characters that count as blanks.
  character(len=1), parameter :: new_line_character = achar(10)
  character(len=4), parameter :: blanks = ' '//achar(9)//achar(10)//achar(13)

  !> One word of the deck.
  type :: token_t
    !> One of the kinds above
    integer :: kind = token_end
    !> Line it begins in
    integer :: line = 0
    !> Name of the group or key, the word, or the text without its quotes
    character(len=:), allocatable :: text
    !> Digits of a repeat count in front of a quoted text, or empty
    character(len=:), allocatable :: repeats
  end type token_t

  !> Place in the deck.
  type :: cursor_t
    !> Next character
    integer :: at = 1
    !> Its line
    integer :: line = 1
  end type cursor_t

contains

  !> Takes the next word inside a group.
  pure subroutine next_token(deck, cursor, token)
    character(len=*), intent(in) :: deck
    !> Moved behind the word
    type(cursor_t), intent(inout) :: cursor
    type(token_t), intent(out) :: token

    call skip_blanks(deck, cursor)
    token%line = cursor%line
    token%text = ''
    token%repeats = ''
    if (cursor%at > len(deck)) return
    select case (deck(cursor%at:cursor%at))
    case (',')
      token%kind = token_comma
      cursor%at = cursor%at + 1
    case ('=')
      token%kind = token_equals
      cursor%at = cursor%at + 1
    case ("'", '"')
      call take_quoted(deck, cursor, token)
    case default
      if (starts_group(deck, cursor%at)) then
        call take_group(deck, cursor, token)
      else if (ends_group(deck, cursor%at)) then
        token%kind = token_slash
        cursor%at = cursor%at + 1
      else
        call take_word(deck, cursor, token)
      end if
    end select
  end subroutine next_token

  !> Skips blanks, ends of lines and comments.
  pure subroutine skip_blanks(deck, cursor)
    character(len=*), intent(in) :: deck
    !> Moved to the next significant character
    type(cursor_t), intent(inout) :: cursor
    logical :: comment

    comment = .false.
    do while (cursor%at <= len(deck))
      if (deck(cursor%at:cursor%at) == new_line_character) then
        cursor%line = cursor%line + 1
        comment = .false.
      else if (deck(cursor%at:cursor%at) == '!') then
        comment = .true.
      else if (.not. comment .and. index(blanks, deck(cursor%at:cursor%at)) == 0) then
        return
      end if
      cursor%at = cursor%at + 1
    end do
  end subroutine skip_blanks

  !> Between groups, skips everything up to the next group or the end.
  pure subroutine skip_to_group(deck, cursor, unknown_word, unknown_line)
    character(len=*), intent(in) :: deck
    !> Moved to the & of the next group
    type(cursor_t), intent(inout) :: cursor
    !> First word that is neither a comment nor a group, or empty
    character(len=:), allocatable, intent(out) :: unknown_word
    !> Its line
    integer, intent(out) :: unknown_line
    integer :: start

    unknown_word = ''
    unknown_line = 0
    do
      call skip_blanks(deck, cursor)
      if (cursor%at > len(deck)) return
      if (starts_group(deck, cursor%at)) return
      start = cursor%at
      do while (cursor%at <= len(deck))
        if (index(blanks//'!', deck(cursor%at:cursor%at)) > 0) exit
        if (starts_group(deck, cursor%at)) exit
        cursor%at = cursor%at + 1
      end do
      if (unknown_line > 0) cycle
      unknown_word = deck(start:cursor%at - 1)
      unknown_line = cursor%line
    end do
  end subroutine skip_to_group

  !> True: at this position is an & followed by a name.
  pure logical function starts_group(deck, at)
    character(len=*), intent(in) :: deck
    !> Place in it
    integer, intent(in) :: at

    starts_group = .false.
    if (deck(at:at) == '&' .and. at < len(deck)) starts_group = is_letter(deck(at + 1:at + 1))
  end function starts_group

  !> True: a slash that is not followed by a word, so that it is not part of a path or fraction.
  pure logical function ends_group(deck, at)
    character(len=*), intent(in) :: deck
    !> Place in it
    integer, intent(in) :: at

    ends_group = deck(at:at) == '/'
    if (ends_group .and. at < len(deck)) ends_group = index(blanks//'!&,', deck(at + 1:at + 1)) > 0
  end function ends_group

  !> True: a letter from a to z.
  pure logical function is_letter(character)
    !> One character
    character(len=1), intent(in) :: character

    is_letter = (character >= 'a' .and. character <= 'z') .or. (character >= 'A' .and. character <= 'Z')
  end function is_letter

  !> Takes &name.
  pure subroutine take_group(deck, cursor, token)
    character(len=*), intent(in) :: deck
    !> At the &; moved behind the name
    type(cursor_t), intent(inout) :: cursor
    !> The group's name
    type(token_t), intent(inout) :: token
    integer :: finish

    finish = cursor%at + 1
    do while (finish < len(deck))
      if (is_letter(deck(finish + 1:finish + 1)) .or. scan('0123456789_', deck(finish + 1:finish + 1)) > 0) then
        finish = finish + 1
      else
        exit
      end if
    end do
    token%kind = token_group
    token%text = deck(cursor%at + 1:finish)
    cursor%at = finish + 1
  end subroutine take_group

  !> Takes a text between quotes; a doubled quote represents one.
  pure subroutine take_quoted(deck, cursor, token)
    character(len=*), intent(in) :: deck
    !> At the opening quote; moved behind the closing one or to the end of the line
    type(cursor_t), intent(inout) :: cursor
    type(token_t), intent(inout) :: token
    character(len=1) :: quote
    integer :: start, line_end, step

    quote = deck(cursor%at:cursor%at)
    token%kind = token_cut
    line_end = index(deck(cursor%at:), new_line_character)
    line_end = merge(cursor%at + line_end - 2, len(deck), line_end > 0)
    start = cursor%at + 1
    do
      step = index(deck(start:line_end), quote)
      if (step == 0) exit
      token%text = token%text//deck(start:start + step - 2)
      cursor%at = start + step
      if (cursor%at > line_end) then
        token%kind = token_quoted
      else if (deck(cursor%at:cursor%at) /= quote) then
        token%kind = token_quoted
      end if
      if (token%kind == token_quoted) return
      token%text = token%text//quote
      start = cursor%at + 1
    end do
    token%text = token%text//deck(start:line_end)
    cursor%at = line_end + 1
  end subroutine take_quoted

  !> Takes a word: a key if = follows, else a value; a repeat count in front of a quote joins the quoted text.
  pure subroutine take_word(deck, cursor, token)
    character(len=*), intent(in) :: deck
    !> At its first character; moved behind the word, or behind the = of a key
    type(cursor_t), intent(inout) :: cursor
    type(token_t), intent(inout) :: token
    type(cursor_t) :: ahead
    integer :: finish, last

    finish = end_of_word(deck, cursor%at)
    token%kind = token_word
    token%text = deck(cursor%at:finish)
    cursor%at = finish + 1
    last = len(token%text)
    if (cursor%at <= len(deck) .and. token%text(last:last) == '*') then
      if (index('''"', deck(cursor%at:cursor%at)) > 0) then
        token%repeats = token%text(:last - 1)
        token%text = ''
        call take_quoted(deck, cursor, token)
        return
      end if
    end if
    ahead = cursor
    call skip_blanks(deck, ahead)
    if (ahead%at > len(deck)) return
    if (deck(ahead%at:ahead%at) /= '=') return
    token%kind = token_key
    cursor = cursor_t(ahead%at + 1, ahead%line)
  end subroutine take_word

  !> Last character of the word that begins here; text in parentheses belongs to it.
  pure integer function end_of_word(deck, start) result(finish)
    character(len=*), intent(in) :: deck
    !> First character of the word
    integer, intent(in) :: start
    logical :: inside

    inside = deck(start:start) == '('
    finish = start
    do while (finish < len(deck))
      if (deck(finish + 1:finish + 1) == new_line_character) exit
      if (.not. inside) then
        if (index(blanks//',=!''"', deck(finish + 1:finish + 1)) > 0) exit
        if (starts_group(deck, finish + 1) .or. ends_group(deck, finish + 1)) exit
      end if
      finish = finish + 1
      inside = (inside .or. deck(finish:finish) == '(') .and. deck(finish:finish) /= ')'
    end do
  end function end_of_word
end module deck_tokens
