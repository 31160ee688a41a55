!> Messages that differ only in numbers are reported as one, with ranges of numbers and lists of plies.
module grouped_messages
  use text, only: line_t, listed
  implicit none
  private
  public :: skeleton, merged

  !> Placeholder of a number.
  character, parameter :: mark = achar(1)
  character(len=*), parameter :: figures = '0123456789', letters = 'abcdefghijklmnopqrstuvwxyz_'// &
                                                                   'ABCDEFGHIJKLMNOPQRSTUVWXYZ'

contains

  !> A message without its numbers: the common part of messages that are reported as one.
  pure function skeleton(message) result(bare)
    character(len=*), intent(in) :: message
    !> The same with a mark for each number
    character(len=:), allocatable :: bare
    integer :: from, to, next

    bare = ''
    next = 1
    do
      call find_number(message, next, from, to)
      if (from == 0) exit
      bare = bare//message(next:from - 1)//mark
      next = to + 1
    end do
    bare = bare//message(next:)
  end function skeleton

  !> One message for several of one skeleton.
  pure function merged(messages) result(message)
    !> The messages, at least one
    type(line_t), intent(in) :: messages(:)
    !> The first message, with the numbers of the others next to its own
    character(len=:), allocatable :: message
    type(line_t) :: numbers(size(messages))
    integer :: next(size(messages)), start, from, to, i

    message = ''
    next = 1
    do
      start = next(1)
      do i = 1, size(messages)
        call find_number(messages(i)%text, next(i), from, to)
        if (from == 0) exit
        numbers(i)%text = messages(i)%text(from:to)
        next(i) = to + 1
        if (i == 1) message = message//messages(1)%text(start:from - 1)
      end do
      if (from == 0) exit
      if (index(message//'|', ' ply |') > 0) then
        if (any_differ(numbers)) message = message(:len(message) - 2)//'ies '
        message = message//listed(integers(numbers))
      else
        message = message//ranged(numbers)
      end if
    end do
    message = message//messages(1)%text(start:)
  end function merged

  !> Position of the next number that is a separate word.
  pure subroutine find_number(message, start, from, to)
    character(len=*), intent(in) :: message
    !> Where to begin
    integer, intent(in) :: start
    !> Its first and last character; 0: there is none
    integer, intent(out) :: from, to
    integer :: digit

    to = start - 1
    do
      from = 0
      digit = scan(message(to + 1:), figures)
      if (digit == 0) return
      from = to + digit
      to = from + span(message(from:))
      ! A number with two points is a version.
      if (index(message(from:to), '.') /= index(message(from:to), '.', .true.)) cycle
      if (from == 1) exit
      if (message(from - 1:from - 1) == '-') from = from - 1
      if (from == 1) exit
      if (scan(message(from - 1:from - 1), letters) == 0) exit
    end do
  end subroutine find_number

  !> Number of characters after the first that belong to a number.
  pure integer function span(rest)
    !> Text that begins with a digit
    character(len=*), intent(in) :: rest
    integer :: sign

    span = verify(rest//'!', figures//'.') - 2
    ! A full stop ends a sentence.
    if (rest(span + 1:span + 1) == '.') span = span - 1
    if (span + 3 > len(rest)) return
    if (scan(rest(span + 2:span + 2), 'eE') == 0) return
    sign = merge(1, 0, scan(rest(span + 3:span + 3), '+-') > 0)
    if (span + 3 + sign > len(rest)) return
    if (scan(rest(span + 3 + sign:span + 3 + sign), figures) == 0) return
    span = span + 1 + sign + verify(rest(span + 3 + sign:)//'!', figures) - 1
  end function span

  !> True: not all of some numbers are the same.
  pure logical function any_differ(numbers)
    !> The numbers
    type(line_t), intent(in) :: numbers(:)
    integer :: i

    any_differ = any([(numbers(i)%text /= numbers(1)%text, i=1, size(numbers))])
  end function any_differ

  !> Whole numbers as such.
  pure function integers(numbers) result(values)
    !> Their texts
    type(line_t), intent(in) :: numbers(:)
    integer :: values(size(numbers))
    integer :: i

    do i = 1, size(numbers)
      read (numbers(i)%text, *) values(i)
    end do
  end function integers

  !> Smallest to largest of some numbers.
  pure function ranged(numbers) result(words)
    !> The numbers
    type(line_t), intent(in) :: numbers(:)
    !> Such as 0.1 to 0.3; the number itself if all are the same
    character(len=:), allocatable :: words
    double precision :: values(size(numbers))
    integer :: i

    do i = 1, size(numbers)
      read (numbers(i)%text, *) values(i)
    end do
    words = numbers(minloc(values, 1))%text
    if (maxval(values) > minval(values)) words = words//' to '//numbers(maxloc(values, 1))%text
  end function ranged
end module grouped_messages
