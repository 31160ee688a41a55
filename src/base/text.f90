!> Small helpers for text: lines, numbers as text, and the nearest of several names.
module text
  use kinds, only: long, wp
  use shortest_digits, only: find_shortest
  implicit none
  private
  public :: line_t, lower_case, to_text, rounded_text, counted, listed, joined, words_of, append, ended, &
            edit_distance, nearest_name

  !> One line of a list of lines.
  type :: line_t
    !> The line, without an end-of-line character
    character(len=:), allocatable :: text
  end type line_t

  !> Shortest usual text of a number.
  interface to_text
    module procedure integer_to_text, long_to_text, real_to_text
  end interface to_text

contains

  !> The same text with A-Z as a-z.
  pure function lower_case(mixed) result(lower)
    !> Any text
    character(len=*), intent(in) :: mixed
    !> In lower case
    character(len=len(mixed)) :: lower
    integer :: i

    lower = mixed
    do i = 1, len(mixed)
      if (mixed(i:i) >= 'A' .and. mixed(i:i) <= 'Z') lower(i:i) = achar(iachar(mixed(i:i)) + 32)
    end do
  end function lower_case

  !> Digits of an integer.
  pure function integer_to_text(value) result(digits)
    !> The number
    integer, intent(in) :: value
    !> Without blanks
    character(len=:), allocatable :: digits

    digits = long_to_text(int(value, long))
  end function integer_to_text

  !> Digits of a long integer.
  pure function long_to_text(value) result(digits)
    !> The number
    integer(long), intent(in) :: value
    !> Without blanks
    character(len=:), allocatable :: digits
    character(len=20) :: figures
    integer(long) :: left
    integer :: first

    ! Counted below zero, where the largest number has its counterpart.
    left = value
    if (value > 0) left = -value
    do first = len(figures), 1, -1
      figures(first:first) = achar(iachar('0') - int(mod(left, 10_long)))
      left = left/10
      if (left == 0) exit
    end do
    digits = figures(first:)
    if (value < 0) digits = '-'//digits
  end function long_to_text

  !> Shortest of the usual forms that reads back as the same number.
  pure function real_to_text(value) result(digits)
    real(wp), intent(in) :: value
    !> Such as 0.25, 1500 or 2.5e-06
    character(len=:), allocatable :: digits
    integer(long) :: number
    integer :: exponent
    logical :: known

    ! Many columns of a history are zero, with either sign.
    digits = '0'
    if (value >= 0 .and. value <= 0) return
    call find_shortest(abs(value), number, exponent, known)
    if (known) then
      digits = long_to_text(number)
      digits = plain_text(value < 0, digits, exponent + len(digits) - 1)
    else
      digits = tried_text(value)
    end if
  end function real_to_text

  !> The same by writing and reading, for numbers near the ends of the range and those between two texts.
  pure function tried_text(value) result(digits)
    real(wp), intent(in) :: value
    character(len=:), allocatable :: digits
    character(len=40) :: buffer
    character(len=12) :: form
    ! The largest number is 1.798e308.
    real(wp), parameter :: near_largest = 1.0e308_wp
    real(wp) :: again
    integer :: places, status

    ! What fewer digits give ends in zeros here, so that only these have to be tried. Near the largest number fewer
    ! could round to one that is too large to read.
    do places = merge(16, 14, abs(value) > near_largest), 16
      ! Without a width of its own an exponent of three digits would lose its letter.
      write (form, '(a,i0,a)') '(es40.', places, 'e3)'
      write (buffer, form) value
      read (buffer, *, iostat=status) again
      if (status /= 0 .or. again == value) exit
    end do
    digits = plain_decimal(trim(adjustl(buffer)))
  end function tried_text

  !> A number rounded for reading.
  pure function rounded_text(value, significant) result(digits)
    real(wp), intent(in) :: value
    !> Significant digits, 1 to 17; four if not given
    integer, intent(in), optional :: significant
    !> Such as 0.0004123
    character(len=:), allocatable :: digits
    character(len=40) :: buffer
    character(len=12) :: form
    integer :: places

    places = 3
    if (present(significant)) places = significant - 1
    write (form, '(a,i0,a)') '(es40.', places, 'e3)'
    ! Zero has a sign, which would be written.
    write (buffer, form) merge(0.0_wp, value, value >= 0 .and. value <= 0)
    digits = plain_decimal(trim(adjustl(buffer)))
  end function rounded_text

  !> A number with the noun of the counted items, in the plural unless the number is 1.
  pure function counted(digits, noun) result(words)
    !> The number as text
    character(len=*), intent(in) :: digits
    !> The noun in the singular, whose plural ends with s
    character(len=*), intent(in) :: noun
    !> Such as 1 step or 12 steps
    character(len=:), allocatable :: words

    words = digits//' '//noun
    if (digits /= '1') words = words//'s'
  end function counted

  !> Whole numbers in a row as ranges.
  pure function listed(numbers) result(words)
    !> Ascending numbers
    integer, intent(in) :: numbers(:)
    !> Such as 1 to 11, 13 to 23
    character(len=:), allocatable :: words
    integer :: i, first

    words = ''
    first = 1
    do i = 1, size(numbers)
      if (i < size(numbers)) then
        if (any(numbers(i + 1) - numbers(i) == [0, 1])) cycle
      end if
      if (first > 1) words = words//', '
      words = words//to_text(numbers(first))
      if (numbers(i) > numbers(first)) words = words//' to '//to_text(numbers(i))
      first = i + 1
    end do
  end function listed

  !> A number in scientific form as plain text.
  pure function plain_decimal(scientific) result(plain)
    !> Such as -2.50E-01
    character(len=*), intent(in) :: scientific
    !> Such as -0.25
    character(len=:), allocatable :: plain
    integer :: mark, exponent, first

    mark = scan(scientific, 'Ee')
    if (mark == 0) then
      plain = lower_case(scientific)
      return
    end if
    read (scientific(mark + 1:), *) exponent
    first = merge(2, 1, scientific(1:1) == '-')
    plain = plain_text(first == 2, scientific(first:first)//scientific(first + 2:mark - 1), exponent)
  end function plain_decimal

  !> A number without trailing zeros, and without an exponent where that is easier to read.
  pure function plain_text(negative, figures, exponent) result(plain)
    !> Whether it has a sign
    logical, intent(in) :: negative
    !> Its digits, the first of them before the point
    character(len=*), intent(in) :: figures
    !> Its exponent, which is written only outside -4 to 6
    integer, intent(in) :: exponent
    !> Such as -0.25
    character(len=:), allocatable :: plain
    character(len=:), allocatable :: sign
    integer :: last

    sign = ''
    if (negative) sign = '-'
    last = max(1, verify(figures, '0', back=.true.))
    if (exponent < -4 .or. exponent > 6) then
      plain = sign//figures(1:1)
      if (last > 1) plain = plain//'.'//figures(2:last)
      plain = plain//'e'//integer_to_text(exponent)
    else if (exponent < 0) then
      plain = sign//'0.'//repeat('0', -exponent - 1)//figures(:last)
    else if (last <= exponent + 1) then
      plain = sign//figures(:last)//repeat('0', exponent + 1 - last)
    else
      plain = sign//figures(:exponent + 1)//'.'//figures(exponent + 2:last)
    end if
  end function plain_text

  !> All lines in one text.
  pure function joined(lines, separator) result(all_lines)
    type(line_t), intent(in) :: lines(:)
    !> Text between two lines
    character(len=*), intent(in) :: separator
    !> The lines in order
    character(len=:), allocatable :: all_lines
    integer :: i

    all_lines = ''
    do i = 1, size(lines)
      if (i > 1) all_lines = all_lines//separator
      all_lines = all_lines//lines(i)%text
    end do
  end function joined

  !> Parts of a text between separators, without surrounding blanks.
  pure function words_of(sentence, separator) result(words)
    !> The text
    character(len=*), intent(in) :: sentence
    !> One character; several blanks count as one
    character(len=1), intent(in) :: separator
    !> The parts in order
    type(line_t), allocatable :: words(:)
    integer :: start, finish

    allocate (words(0))
    start = 1
    do while (start <= len(sentence) + 1)
      finish = index(sentence(start:), separator)
      finish = merge(start + finish - 1, len(sentence) + 1, finish > 0)
      if (separator /= ' ' .or. finish > start) call append(words, trim(adjustl(sentence(start:finish - 1))))
      start = finish + 1
    end do
  end function words_of

  !> Adds a line to a list.
  pure subroutine append(lines, line)
    !> The list
    type(line_t), allocatable, intent(inout) :: lines(:)
    character(len=*), intent(in) :: line
    type(line_t), allocatable :: longer(:)
    integer :: i

    if (.not. allocated(lines)) allocate (lines(0))
    allocate (longer(size(lines) + 1))
    do i = 1, size(lines)
      call move_alloc(lines(i)%text, longer(i)%text)
    end do
    longer(size(longer))%text = line
    call move_alloc(longer, lines)
  end subroutine append

  !> Number of characters to insert, delete, replace or swap with their neighbour to turn one word into another.
  pure integer function edit_distance(a, b) result(distance)
    !> The words
    character(len=*), intent(in) :: a, b
    integer :: table(0:len(a), 0:len(b)), i, j

    table(:, 0) = [(i, i=0, len(a))]
    table(0, :) = [(j, j=0, len(b))]
    do j = 1, len(b)
      do i = 1, len(a)
        table(i, j) = min(table(i - 1, j) + 1, table(i, j - 1) + 1, table(i - 1, j - 1) + merge(0, 1, a(i:i) == b(j:j)))
        if (i == 1 .or. j == 1) cycle
        if (a(i - 1:i) == b(j:j)//b(j - 1:j - 1)) table(i, j) = min(table(i, j), table(i - 2, j - 2) + 1)
      end do
    end do
    distance = table(len(a), len(b))
  end function edit_distance

  !> The known name most similar to a misspelt one, or an empty text if none is similar.
  pure function nearest_name(name, known) result(nearest)
    !> The name as written
    character(len=*), intent(in) :: name
    !> Known names
    type(line_t), intent(in) :: known(:)
    !> One of the known names, or ''
    character(len=:), allocatable :: nearest
    integer :: i, distance, best

    nearest = ''
    best = huge(best)
    if (len(name) > 40) return
    do i = 1, size(known)
      distance = edit_distance(lower_case(name), lower_case(known(i)%text))
      if (distance >= best .or. distance > max(1, max(len(name), len(known(i)%text))/3)) cycle
      if (distance >= min(len(name), len(known(i)%text))) cycle
      best = distance
      nearest = known(i)%text
    end do
  end function nearest_name

  !> A sentence with its full stop, which `.false.` has already.
  pure function ended(sentence)
    !> The sentence
    character(len=*), intent(in) :: sentence
    !> It ends with one full stop
    character(len=:), allocatable :: ended

    ended = sentence
    if (sentence(len(sentence):) /= '.') ended = sentence//'.'
  end function ended
end module text
