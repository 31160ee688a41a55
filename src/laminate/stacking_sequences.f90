!> Stacking sequences in the notation of the field, such as [45/0/-45/90]2s: ASTM D6507 on one line of plain text.
module stacking_sequences
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: read_sequence

  !> Largest number of plies of a laminate.
  integer, parameter, public :: max_plies = 1000
  !> Largest magnitude of an angle, degrees: a full turn.
  real(wp), parameter :: max_degrees = 360
  !> Largest plausible angle; a larger number may be a lost subscript, as in 302 for 30_2.
  real(wp), parameter, public :: usual_degrees = 180
  !> Explanation of the notation for several plies of one angle.
  character(len=*), parameter, public :: count_hint = 'a count of plies follows _, as in 0_2'
  character(len=*), parameter :: digits = '0123456789'
  !> The signs of a pair of plies as one character of UTF-8, and the minus of typesetters.
  character(len=*), parameter :: plus_minus = char(194)//char(177), typeset_minus = char(226)//char(136)//char(146)

  !> A position in a sequence, and its first fault.
  type :: reader_t
    !> The sequence
    character(len=:), allocatable :: text
    !> Next character
    integer :: at = 1
    !> Clause; empty: no fault so far
    character(len=:), allocatable :: fault
  end type reader_t

contains

  !> Angles of the plies from the struck face on.
  pure subroutine read_sequence(text, angles, fault)
    !> The sequence
    character(len=*), intent(in) :: text
    !> Degrees; to be used if there is no fault
    real(wp), allocatable, intent(out) :: angles(:)
    !> Clause with place and error; empty: none
    character(len=:), allocatable, intent(out) :: fault
    type(reader_t) :: reader
    logical :: barred

    reader%text = trim(text)
    reader%fault = ''
    call step(reader, 0)
    call read_list(reader, angles, barred)
    if (reader%fault == '' .and. reader%at <= len(reader%text)) then
      if (scan(next(reader), '])') > 0) then
        call object(reader, 'it closes no bracket')
      else
        call object(reader, 'it does not belong here; angles are separated by /')
      end if
    end if
    if (barred) call object(reader, 'the middle ply is marked by ~, but no s mirrors it')
    fault = reader%fault
  end subroutine read_sequence

  !> Items separated by slashes, up to a bracket or the end.
  pure recursive subroutine read_list(reader, angles, barred)
    type(reader_t), intent(inout) :: reader
    !> Degrees
    real(wp), allocatable, intent(out) :: angles(:)
    !> True: the last ply is the middle one, which a mirror does not repeat
    logical, intent(out) :: barred
    real(wp), allocatable :: item(:)

    allocate (angles(0))
    do
      call read_item(reader, item, barred)
      if (reader%fault /= '') return
      angles = [angles, item]
      if (size(angles) > max_plies) then
        call object(reader, 'the sequence has more than '//to_text(max_plies)//' plies')
        return
      end if
      if (next(reader) /= '/') return
      if (barred) then
        call object(reader, 'another ply follows, but ~ marks the last of a bracket with s')
        return
      end if
      call step(reader, 1)
    end do
  end subroutine read_list

  !> An angle or a pair with its count, or a bracket with its suffix.
  pure recursive subroutine read_item(reader, angles, barred)
    type(reader_t), intent(inout) :: reader
    !> Degrees
    real(wp), allocatable, intent(out) :: angles(:)
    !> True: a ply marked by ~
    logical, intent(out) :: barred
    character(len=1) :: closing
    integer :: count

    barred = .false.
    if (scan(next(reader), '[(') == 0) then
      call read_angle(reader, angles)
      if (reader%fault /= '') return
      if (next(reader) == '_') then
        call step(reader, 1)
        call read_count(reader, count)
        if (reader%fault == '') angles = repeated(angles, count)
      else if (next(reader) == '~' .and. size(angles) == 1) then
        call step(reader, 1)
        barred = .true.
      else if (scan(next(reader), 'sS') > 0) then
        call object(reader, 's mirrors a bracket, not an angle')
      end if
      return
    end if
    closing = merge(']', ')', next(reader) == '[')
    call step(reader, 1)
    call read_list(reader, angles, barred)
    if (reader%fault /= '') return
    if (next(reader) /= closing) then
      call object(reader, closing//' or / is missing')
      return
    end if
    call step(reader, 1)
    call read_suffix(reader, angles, barred)
  end subroutine read_item

  !> Counts, s and T behind a bracket, applied in their order: 2s repeats, then mirrors.
  pure subroutine read_suffix(reader, angles, barred)
    type(reader_t), intent(inout) :: reader
    !> Angles of the bracket; receive the repetitions of the suffix
    real(wp), allocatable, intent(inout) :: angles(:)
    !> True: the last ply is the middle one; false after a mirror
    logical, intent(inout) :: barred
    integer :: count

    do while (reader%fault == '' .and. scan(next(reader), digits//'_sStT') > 0)
      select case (next(reader))
      case ('s', 'S')
        call step(reader, 1)
        angles = [angles, angles(size(angles) - merge(1, 0, barred):1:-1)]
        barred = .false.
      case ('t', 'T')
        call step(reader, 1)
      case ('_')
        call step(reader, 1)
        if (scan(next(reader), digits//'sStT') == 0) call object(reader, 'a count, s or T is expected after _')
      case default
        call read_count(reader, count)
        if (reader%fault == '') angles = repeated(angles, count)
      end select
      if (size(angles) > max_plies) call object(reader, 'the sequence has more than '//to_text(max_plies)//' plies')
    end do
  end subroutine read_suffix

  !> An angle, or a pair of opposite ones.
  pure subroutine read_angle(reader, angles)
    type(reader_t), intent(inout) :: reader
    !> Degrees, one or two
    real(wp), allocatable, intent(out) :: angles(:)
    character(len=:), allocatable :: signs, number
    integer :: last, status
    real(wp) :: angle

    allocate (angles(0))
    signs = ''
    if (index(rest(reader), plus_minus) == 1) then
      signs = '+-'
    else if (any(next_two(reader) == ['+-', '-+'])) then
      signs = next_two(reader)
    else if (scan(next(reader), '+-') > 0) then
      signs = next(reader)
    end if
    call step(reader, len(signs))
    number = rest(reader)
    last = verify(number//'/', digits//'.') - 1
    read (number(:last), *, iostat=status) angle
    if (last == 0 .or. index(number(:last), '.') /= index(number(:last), '.', back=.true.)) status = 1
    if (status /= 0) then
      if (index(number, typeset_minus) == 1) then
        call object(reader, 'this is a Unicode minus; write -')
      else
        call object(reader, 'an angle is expected, such as 45, -45 or +-45')
      end if
      return
    end if
    if (scan(number(:1), '0') == 1 .and. scan(number(2:min(2, last)), digits) == 1) then
      call object(reader, 'an angle has no leading zero; '//count_hint)
      return
    end if
    if (angle > max_degrees) then
      call object(reader, 'the angle is larger than 360 degrees; '//count_hint)
      return
    end if
    call step(reader, last)
    if (next(reader) == ',') call object(reader, 'angles are separated by /, and a decimal has a point')
    select case (signs)
    case ('+-')
      angles = [angle, -angle]
    case ('-+')
      angles = [-angle, angle]
    case ('-')
      angles = [-angle]
    case default
      angles = [angle]
    end select
  end subroutine read_angle

  !> A count from 1 to the most plies.
  pure subroutine read_count(reader, count)
    type(reader_t), intent(inout) :: reader
    !> The count
    integer, intent(out) :: count
    character(len=:), allocatable :: number
    integer :: last, status

    count = 0
    number = rest(reader)
    last = verify(number//'/', digits) - 1
    status = 1
    if (last > 0 .and. last <= 4) read (number(:last), *, iostat=status) count
    if (status /= 0 .or. count < 1 .or. count > max_plies) then
      call object(reader, 'a count from 1 to '//to_text(max_plies)//' is expected')
      return
    end if
    call step(reader, last)
  end subroutine read_count

  !> Repeats plies, up to one more than the permitted number.
  pure function repeated(angles, count) result(plies)
    !> Degrees
    real(wp), intent(in) :: angles(:)
    !> Number of repetitions
    integer, intent(in) :: count
    !> Degrees
    real(wp), allocatable :: plies(:)
    integer :: i, times

    times = min(count, max_plies/size(angles) + 1)
    plies = [(angles, i=1, times)]
  end function repeated

  !> Advances by some characters and the blanks after them.
  pure subroutine step(reader, length)
    type(reader_t), intent(inout) :: reader
    !> Number of characters
    integer, intent(in) :: length

    reader%at = reader%at + length
    do while (reader%at <= len(reader%text))
      if (reader%text(reader%at:reader%at) /= ' ') exit
      reader%at = reader%at + 1
    end do
  end subroutine step

  !> Next character; a blank at the end.
  pure character(len=1) function next(reader)
    type(reader_t), intent(in) :: reader

    next = rest(reader)//' '
  end function next

  !> Next two characters, filled up with blanks.
  pure character(len=2) function next_two(reader)
    type(reader_t), intent(in) :: reader

    next_two = rest(reader)
  end function next_two

  !> Text that has not been read.
  pure function rest(reader) result(words)
    type(reader_t), intent(in) :: reader
    !> From the next character on
    character(len=:), allocatable :: words

    words = reader%text(reader%at:)
  end function rest

  !> Stores the first error, with the next character.
  pure subroutine object(reader, clause)
    !> Where it is
    type(reader_t), intent(inout) :: reader
    !> The error
    character(len=*), intent(in) :: clause
    integer :: i, last

    if (reader%fault /= '') return
    if (reader%at > len(reader%text)) then
      reader%fault = 'at its end: '//clause
      return
    end if
    ! Bytes 10xxxxxx continue a character of UTF-8.
    last = reader%at
    do while (last < len(reader%text))
      if (ibits(iachar(reader%text(last + 1:last + 1)), 6, 2) /= 2) exit
      last = last + 1
    end do
    reader%fault = 'at character '// &
      to_text(count([(ibits(iachar(reader%text(i:i)), 6, 2) /= 2, i=1, reader%at)]))//', '// &
      ''''//reader%text(reader%at:last)//''': '//clause
  end subroutine object
end module stacking_sequences
