!> Checks single values of a deck: type, choice and range.
module deck_values
  use allowed_values, only: branch_of
  use deck_entries, only: value_t, shown
  use deck_vocabulary, only: key_entry_t
  use kinds, only: wp
  use text, only: line_t, append, words_of, lower_case, nearest_name, to_text
  implicit none
  private
  public :: fault_of_value, fault_of_count, decimal_commas, limit_of_size, literal_value, &
            real_value, integer_value, logical_value

  !> Range of numbers, so that their products remain finite and nonzero: the size of reals other than 0 is at least
  !> 10**-29 and less than 10**30, that of integers less than 10**9.
  integer, parameter :: max_decades = 30, max_integer_decades = 9
  !> Characters of a name, in lower case
  character(len=*), parameter :: name_characters = 'abcdefghijklmnopqrstuvwxyz0123456789._-'
  !> Longest number, name and text
  integer, parameter :: longest_number = 60, longest_name = 80, longest_text = 1000

contains

  !> Error of a value, or an empty text.
  pure function fault_of_value(key, value) result(fault)
    type(key_entry_t), intent(in) :: key
    !> One of its values
    type(value_t), intent(in) :: value
    !> Part of a sentence, such as `1.5 is not a whole number`
    character(len=:), allocatable :: fault

    select case (key%kind)
    case ('real', 'integer')
      fault = fault_of_number(key, value)
    case ('logical')
      fault = ''
      if (value%quoted .or. verify(lower_case(value%text), 'truefals.') > 0 .or. .not. any(lower_case(value%text) == &
        [character(len=7) :: '.true.', '.false.', 'true', 'false', '.t.', '.f.', 't', 'f'])) then
        fault = shown(value%text)//' is neither .true. nor .false.'
      end if
    case ('choice or real')
      if (value%quoted) then
        fault = fault_of_choice(branch_of(key, 'choice'), value%text)
      else
        fault = fault_of_number(branch_of(key, 'real'), value)
      end if
    case default
      fault = shown(value%text)//' has no quotes'
      if (value%quoted) fault = fault_of_text(key, value%text)
    end select
  end function fault_of_value

  !> Error of a number, or of a word that the key accepts in its place, or an empty text.
  pure function fault_of_number(key, value) result(fault)
    type(key_entry_t), intent(in) :: key
    !> One of its values
    type(value_t), intent(in) :: value
    !> Part of a sentence
    character(len=:), allocatable :: fault
    logical :: is_number
    integer :: decade

    call measure_number(value%text, is_number, decade)
    fault = ''
    if (value%quoted) then
      if (index(key%allowed, ', or '''//lower_case(value%text)//'''') > 0) return
      fault = ''''//shown(value%text)//''' is a text in quotes, not a number'
    else if (is_not_finite(value%text)) then
      fault = shown(value%text)//' is not finite'
    else if (.not. is_number) then
      fault = shown(value%text)//' is not a number'
    else if (key%kind == 'integer' .and. verify(value%text, '+-0123456789') > 0) then
      fault = shown(value%text)//' is not a whole number'
    else if (abs(decade) >= merge(max_integer_decades, max_decades, key%kind == 'integer')) then
      fault = shown(value%text)//' is too '//trim(merge('large', 'small', decade > 0))//' a number'
    else if (.not. in_range(key%allowed, real_value(value))) then
      fault = shown(value%text)//' is outside the range'
    end if
  end function fault_of_number

  !> Error of a text, or an empty text.
  pure function fault_of_text(key, word) result(fault)
    type(key_entry_t), intent(in) :: key
    !> The text without its quotes
    character(len=*), intent(in) :: word
    !> Part of a sentence
    character(len=:), allocatable :: fault

    fault = ''
    select case (key%kind)
    case ('choice')
      fault = fault_of_choice(key, word)
    case ('name')
      if (len(word) == 0) then
        fault = 'the name is empty'
      else if (len(word) > longest_name) then
        fault = 'the name is longer than 80 characters'
      else if (verify(lower_case(word), name_characters) > 0) then
        fault = 'the name has other characters'
      else if (verify(word(1:1), '._-') == 0) then
        fault = 'the name begins with '//word(1:1)
      end if
    case default
      if (len(word) > longest_text) fault = 'the text is longer than 1000 characters'
      if (key%allowed /= 'any text' .and. len_trim(word) == 0) fault = 'the text is empty'
    end select
  end function fault_of_text

  !> Error of a choice, or an empty text. A key of several choices accepts one text with all, separated by commas.
  pure function fault_of_choice(key, word) result(fault)
    type(key_entry_t), intent(in) :: key
    !> The text without its quotes
    character(len=*), intent(in) :: word
    !> Part of a sentence
    character(len=:), allocatable :: fault
    type(line_t), allocatable :: choices(:), chosen(:)
    integer :: i, j

    choices = words_of(key%allowed, ' ')
    allocate (chosen(0))
    if (key%values == '1 or more') then
      chosen = words_of(word, ',')
    else
      call append(chosen, word)
    end if
    fault = ''
    do j = 1, size(chosen)
      associate (name => chosen(j)%text)
        if (any([(lower_case(choices(i)%text) == lower_case(name), i=1, size(choices))])) cycle
        fault = ''''//shown(name)//''' is not a choice'
        if (nearest_name(name, choices) /= '') fault = fault//' (meant '''//nearest_name(name, choices)//'''?)'
        return
      end associate
    end do
  end function fault_of_choice

  !> Error of the number of values, or an empty text; lists over the plies are checked with the laminate.
  pure function fault_of_count(key, number) result(fault)
    type(key_entry_t), intent(in) :: key
    !> Number of its values
    integer, intent(in) :: number
    !> Part of a sentence
    character(len=:), allocatable :: fault
    logical :: right

    select case (key%values)
    case ('1')
      right = number == 1
    case ('2')
      right = number == 2
    case ('1 or 4')
      right = number == 1 .or. number == 4
    case default
      right = number >= 1
    end select
    fault = ''
    if (.not. right) fault = trim(merge('too many', 'too few ', number > 2 .or. key%values == '1'))//' values'
  end function fault_of_count

  !> Probable cause of too many values, or an empty text: numbers with decimal commas.
  pure function decimal_commas(key, values) result(hint)
    type(key_entry_t), intent(in) :: key
    !> Its values, too many
    type(value_t), intent(in) :: values(:)
    !> Part of a sentence
    character(len=:), allocatable :: hint
    character(len=:), allocatable :: whole, fraction
    integer :: i

    hint = ''
    if (key%kind /= 'real' .or. mod(size(values), 2) == 1 .or. any(values%quoted)) return
    do i = 1, size(values), 2
      ! A sign and digits, then digits and perhaps an exponent.
      if (verify(values(i)%text, '+-0123456789') > 0 .or. verify(values(i + 1)%text, '0123456789eEdD+-') > 0 .or. &
          verify(values(i + 1)%text(:1), '0123456789') > 0) return
    end do
    whole = values(1)%text
    fraction = values(2)%text
    hint = ' (a comma separates values; for a decimal write '//whole//'.'//fraction//')'
  end function decimal_commas

  !> Limit by the size of numbers, if a value exceeds it; else an empty text.
  pure function limit_of_size(key, value) result(limit)
    type(key_entry_t), intent(in) :: key
    !> A value at fault
    type(value_t), intent(in) :: value
    !> End of a sentence, such as `, < 1e30`
    character(len=:), allocatable :: limit
    character(len=:), allocatable :: largest
    logical :: is_number
    integer :: decade, most

    limit = ''
    if (value%quoted .or. .not. any(key%kind == [character(len=7) :: 'real', 'integer'])) return
    call measure_number(value%text, is_number, decade)
    most = merge(max_integer_decades, max_decades, key%kind == 'integer')
    largest = '1e'//to_text(most)
    if (.not. is_number .or. abs(decade) < most) return
    if (decade < 0) then
      if (.not. in_range(key%allowed, 10.0_wp**(1 - most))) return
      limit = ', at least 1e'//to_text(1 - most)//' in size'
      if (in_range(key%allowed, 0.0_wp)) limit = ', 0 or'//limit(2:)
    else if (key%allowed == 'any') then
      limit = ' > -'//largest//', < '//largest
    else if (index(key%allowed, '<') == 0) then
      limit = ', < '//largest
    end if
  end function limit_of_size

  !> The value of the default of a key.
  pure function literal_value(default) result(value)
    !> A default as the table has it
    character(len=*), intent(in) :: default
    type(value_t) :: value

    value%quoted = default(1:1) == ''''
    value%text = default
    if (value%quoted) value%text = default(2:len(default) - 1)
  end function literal_value

  !> The number of a word, which is valid.
  pure real(wp) function real_value(value)
    type(value_t), intent(in) :: value
    integer :: status

    read (value%text, *, iostat=status) real_value
    if (status /= 0) real_value = 0
  end function real_value

  !> The integer of a word, which is valid.
  pure integer function integer_value(value)
    type(value_t), intent(in) :: value
    integer :: status

    read (value%text, *, iostat=status) integer_value
    if (status /= 0) integer_value = 0
  end function integer_value

  !> The logical value of a word, which is valid.
  pure logical function logical_value(value)
    type(value_t), intent(in) :: value

    logical_value = scan(lower_case(value%text), 't') > 0
  end function logical_value

  !> True: a way to write infinity or not-a-number.
  pure logical function is_not_finite(word)
    character(len=*), intent(in) :: word
    character(len=:), allocatable :: bare

    bare = lower_case(word)
    if (scan(bare(:min(1, len(bare))), '+-') == 1) bare = bare(2:)
    is_not_finite = bare == 'nan' .or. bare == 'inf' .or. bare == 'infinity' .or. index(bare, 'nan(') == 1
  end function is_not_finite

  !> Whether a word is a number, and its decimal magnitude, determined without overflow.
  pure subroutine measure_number(word, is_number, decade)
    character(len=*), intent(in) :: word
    !> True: sign, digits, point and exponent are valid
    logical, intent(out) :: is_number
    !> Power of ten of its first digit that is not 0; 0 for the number 0
    integer, intent(out) :: decade
    integer :: mark, point, first, exponent, start, status
    character(len=:), allocatable :: mantissa

    decade = 0
    is_number = .false.
    if (len(word) == 0 .or. len(word) > longest_number) return
    mark = scan(word, 'eEdD')
    if (mark == 0) mark = len(word) + 1
    start = 1
    if (scan(word(1:1), '+-') == 1) start = 2
    mantissa = word(start:mark - 1)
    if (scan(mantissa, '0123456789') == 0 .or. verify(mantissa, '0123456789.') > 0) return
    point = index(mantissa, '.')
    if (point /= index(mantissa, '.', back=.true.)) return
    exponent = 0
    if (mark <= len(word)) then
      call read_exponent(word(mark + 1:), exponent, status)
      if (status /= 0) return
    end if
    is_number = .true.
    if (point == 0) point = len(mantissa) + 1
    first = scan(mantissa, '123456789')
    if (first == 0) return
    decade = exponent + point - first
    if (first < point) decade = decade - 1
  end subroutine measure_number

  !> Reads an exponent; one of many digits counts as a thousand decades.
  pure subroutine read_exponent(word, exponent, status)
    !> Sign and digits
    character(len=*), intent(in) :: word
    !> Its value
    integer, intent(out) :: exponent
    !> 0: it is one
    integer, intent(out) :: status
    integer :: start

    exponent = 0
    status = 1
    start = 1
    if (len(word) > 0) start = merge(2, 1, scan(word(1:1), '+-') == 1)
    if (start > len(word)) return
    if (verify(word(start:), '0123456789') > 0) return
    exponent = 1000
    status = 0
    if (len_trim(word(start:)) <= 4) read (word(start:), *, iostat=status) exponent
    if (word(1:1) == '-') exponent = -exponent
  end subroutine read_exponent

  !> True: all conditions are met.
  pure logical function in_range(conditions, number)
    !> Such as `> 0, <= 1, or 'all'`; `any` is none
    character(len=*), intent(in) :: conditions
    real(wp), intent(in) :: number
    type(line_t), allocatable :: condition(:), parts(:)
    real(wp) :: limit
    integer :: i

    in_range = .true.
    if (conditions == 'any') return
    condition = words_of(conditions, ',')
    do i = 1, size(condition)
      parts = words_of(condition(i)%text, ' ')
      ! A word in place of a number.
      if (parts(1)%text == 'or') cycle
      read (parts(2)%text, *) limit
      select case (parts(1)%text)
      case ('>')
        in_range = in_range .and. number > limit
      case ('>=')
        in_range = in_range .and. number >= limit
      case ('<')
        in_range = in_range .and. number < limit
      case ('<=')
        in_range = in_range .and. number <= limit
      end select
    end do
  end function in_range
end module deck_values
