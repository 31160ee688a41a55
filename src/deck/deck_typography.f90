!> Typographic characters of word processors and web pages: each is reported with its line, and replaced for the
!> remaining checks. They are allowed in texts and comments.
module deck_typography
  use deck_problems, only: problems_t
  implicit none
  private
  public :: take_plain

  !> Bytes of the characters in UTF-8: minus, en dash, two no-break spaces, thin space, curly quotes.
  character(len=3), parameter :: signs(*) = [character(len=3) :: &
    char(226)//char(136)//char(146), char(226)//char(128)//char(147), char(194)//char(160), &
    char(226)//char(128)//char(175), char(226)//char(128)//char(137), char(226)//char(128)//char(152), &
    char(226)//char(128)//char(153), char(226)//char(128)//char(156), char(226)//char(128)//char(157)]
  !> Meaning of each.
  character(len=1), parameter :: plain(*) = ['-', '-', ' ', ' ', ' ', '''', '''', '"', '"']
  !> Its name in messages.
  character(len=40), parameter :: advice(*) = [character(len=40) :: &
    'a Unicode minus (U+2212); write -', 'a dash (U+2013); write -', 'a no-break space (U+00A0); write a blank', &
    'a no-break space (U+202F); write a blank', 'a thin space (U+2009); write a blank', &
    'a curly quote (U+2018); write ''', 'a curly quote (U+2019); write ''', &
    'a curly quote (U+201C); write "', 'a curly quote (U+201D); write "']

  !> Where in the deck: inside of a comment, of a text, or of neither.
  type :: place_t
    !> Line
    integer :: line = 1
    !> True: a comment
    logical :: comment = .false.
    !> Quote that ends the text; a blank: none
    character(len=1) :: quote = ' '
    !> True: a curly quote began the text, and another may end it
    logical :: curly = .false.
    !> Kinds of characters reported in this line
    logical :: reported(size(signs)) = .false.
  end type place_t

contains

  !> The deck with plain characters. Each kind is reported once a line.
  subroutine take_plain(deck, problems, clean)
    character(len=*), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    !> The text
    character(len=:), allocatable, intent(out) :: clean
    type(place_t) :: place
    integer :: at, kind, copied

    clean = ''
    copied = 0
    at = 1
    do while (at <= len(deck))
      kind = kind_at(deck, at)
      if (kind > 0 .and. counts(place, kind)) then
        if (.not. place%reported(kind)) &
          call problems%error(place%line, '', '', 'this line has '//trim(advice(kind))//'.')
        place%reported(kind) = .true.
        clean = clean//deck(copied + 1:at - 1)//plain(kind)
        if (index('''"', plain(kind)) > 0) place%curly = place%quote == ' '
        call pass(place, plain(kind))
        at = at + len_trim(signs(kind))
        copied = at - 1
      else
        call pass(place, deck(at:at))
        at = at + 1
      end if
    end do
    clean = clean//deck(copied + 1:)
  end subroutine take_plain

  !> Index of the typographic character at a position; 0: there is none.
  pure integer function kind_at(deck, at) result(kind)
    character(len=*), intent(in) :: deck
    !> Place in it
    integer, intent(in) :: at

    kind = 0
    if (iachar(deck(at:at)) < 128) return
    do kind = size(signs), 1, -1
      if (index(deck(at:min(at + 2, len(deck))), trim(signs(kind))) == 1) return
    end do
  end function kind_at

  !> True: the character would be read as part of the deck's grammar.
  pure logical function counts(place, kind)
    !> Position in the deck
    type(place_t), intent(in) :: place
    !> Index of the character
    integer, intent(in) :: kind

    counts = .false.
    if (kind == 0 .or. place%comment) return
    counts = place%quote == ' ' .or. (place%curly .and. plain(kind) == place%quote)
  end function counts

  !> Effect of a plain character: ends of lines, starts and ends of texts and comments.
  pure subroutine pass(place, next)
    !> Position in the deck
    type(place_t), intent(inout) :: place
    !> The character
    character(len=1), intent(in) :: next

    if (next == achar(10)) then
      place = place_t(line=place%line + 1)
    else if (place%comment) then
      return
    else if (place%quote /= ' ') then
      if (next == place%quote) place%quote = ' '
    else if (next == '!') then
      place%comment = .true.
    else if (next == '''' .or. next == '"') then
      place%quote = next
    end if
  end subroutine pass
end module deck_typography
