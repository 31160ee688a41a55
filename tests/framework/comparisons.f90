!> Comparisons used by the asserts. Arrays are flattened and passed with their shapes; a scalar has no shape and is
!> compared with every element of the other side. A NaN is never equal to, less or greater than anything.
module comparisons
  use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
  use, intrinsic :: iso_fortran_env, only: int64, real32, real64
  use test_failures, only: SourceLocation, add_failure
  implicit none
  private
  public :: compare, compare_strings, KEEP_ALL, TRIM_ALL, IGNORE_DIFFERENCES, IGNORE_ALL

  !> Treatment of blanks in strings: all of them count
  integer, parameter :: KEEP_ALL = 1
  !> Leading and trailing ones do not count
  integer, parameter :: TRIM_ALL = 2
  !> Several in a row count as one, leading and trailing ones do not count
  integer, parameter :: IGNORE_DIFFERENCES = 3
  !> None of them count
  integer, parameter :: IGNORE_ALL = 4

  !> Compares integers or reals by the given relation.
  interface compare
    module procedure compare_integers, compare_reals
  end interface compare

contains

  !> Integers, exactly.
  subroutine compare_integers(relation, expected, found, shape_expected, shape_found, message, location)
    !> 'equal', 'different', '<', '<=', '>' or '>='
    character(len=*), intent(in) :: relation
    !> The two sides, flattened
    integer(int64), intent(in) :: expected(:), found(:)
    !> Their shapes
    integer, intent(in) :: shape_expected(:), shape_found(:)
    !> Message of the test's author
    character(len=*), intent(in), optional :: message
    !> Position of the assert
    type(SourceLocation), intent(in), optional :: location
    logical :: holds(size(found))
    integer :: i

    if (shapes_differ(shape_expected, shape_found, message, location)) return
    do i = 1, size(found)
      associate (e => expected(min(i, size(expected))), f => found(i))
        select case (relation)
        case ('equal')
          holds(i) = e == f
        case ('different')
          holds(i) = e /= f
        case ('<')
          holds(i) = e < f
        case ('<=')
          holds(i) = e <= f
        case ('>')
          holds(i) = e > f
        case ('>=')
          holds(i) = e >= f
        end select
      end associate
    end do
    i = findloc(holds, .false., dim=1)
    if (i > 0) call add_failure(statement(relation, text_of_integer(expected(min(i, size(expected)))), &
                                          text_of_integer(found(i)), position(i, shape_found)), message, location)
  end subroutine compare_integers

  !> Reals, to a tolerance.
  subroutine compare_reals(relation, expected, found, shape_expected, shape_found, tolerance, message, location)
    !> 'equal', 'relatively equal', 'different', '<', '<=', '>' or '>='
    character(len=*), intent(in) :: relation
    !> The two sides, flattened
    real(real64), intent(in) :: expected(:), found(:)
    !> Their shapes
    integer, intent(in) :: shape_expected(:), shape_found(:)
    !> Largest difference allowed, a real of any kind; absent: 0; a text here is the message
    class(*), intent(in), optional :: tolerance
    !> Message of the test's author
    character(len=*), intent(in), optional :: message
    !> Position of the assert
    type(SourceLocation), intent(in), optional :: location
    logical :: holds(size(found))
    real(real64) :: allowed
    integer :: i

    if (shapes_differ(shape_expected, shape_found, message, location)) return
    allowed = real_of(tolerance)
    do i = 1, size(found)
      holds(i) = real_holds(relation, expected(min(i, size(expected))), found(i), allowed)
    end do
    i = findloc(holds, .false., dim=1)
    if (i == 0) return
    associate (e => expected(min(i, size(expected))), f => found(i))
      call add_failure(statement(relation, text_of_real(e), text_of_real(f), &
                                 position(i, shape_found)//apart(relation, e, f, allowed)), &
                       remark(tolerance, message), location)
    end associate
  end subroutine compare_reals

  !> Whether the relation holds between two reals. No arithmetic is done on a NaN, which a debug build would trap.
  pure logical function real_holds(relation, expected, found, tolerance) result(holds)
    !> Name of the relation
    character(len=*), intent(in) :: relation
    !> The two sides and the difference allowed
    real(real64), intent(in) :: expected, found, tolerance

    holds = .false.
    if (ieee_is_nan(expected) .or. ieee_is_nan(found) .or. ieee_is_nan(tolerance)) then
      holds = relation == 'different'
      return
    end if
    select case (relation)
    case ('equal')
      holds = close(expected, found, tolerance)
    case ('relatively equal')
      holds = close(expected, found, tolerance*abs(expected))
    case ('different')
      holds = .not. close(expected, found, tolerance)
    case ('<')
      holds = expected < found
    case ('<=')
      holds = expected <= found
    case ('>')
      holds = expected > found
    case ('>=')
      holds = expected >= found
    end select
  end function real_holds

  !> Whether two numbers are equal to the tolerance. Infinity is equal to itself only.
  pure logical function close(a, b, allowed)
    !> The two numbers and the difference allowed
    real(real64), intent(in) :: a, b, allowed

    close = a == b
    if (close .or. abs(a) > huge(a) .or. abs(b) > huge(b)) return
    close = abs(a/2 - b/2) <= allowed/2
  end function close

  !> Strings.
  subroutine compare_strings(relation, expected, found, whitespace, message, location)
    !> 'equal' or 'different'
    character(len=*), intent(in) :: relation
    !> The two sides
    character(len=*), intent(in) :: expected, found
    !> Treatment of blanks; absent: leading and trailing ones do not count
    integer, intent(in), optional :: whitespace
    !> Message of the test's author
    character(len=*), intent(in), optional :: message
    !> Position of the assert
    type(SourceLocation), intent(in), optional :: location
    character(len=:), allocatable :: e, f
    integer :: blanks

    blanks = TRIM_ALL
    if (present(whitespace)) blanks = whitespace
    e = reduced(expected, blanks)
    f = reduced(found, blanks)
    if ((e == f .and. len(e) == len(f)) .neqv. relation == 'equal') then
      call add_failure(statement(relation, '"'//expected//'"', '"'//found//'"', ''), message, location)
    end if
  end subroutine compare_strings

  !> A string without the blanks that do not count.
  pure function reduced(string, blanks) result(short)
    !> The string
    character(len=*), intent(in) :: string
    !> Treatment of blanks
    integer, intent(in) :: blanks
    character(len=:), allocatable :: short
    integer :: i

    if (blanks == KEEP_ALL) then
      short = string
    else if (blanks == TRIM_ALL) then
      short = trim(adjustl(string))
    else
      short = ''
      do i = 1, len_trim(string)
        if (string(i:i) /= ' ') then
          short = short//string(i:i)
        else if (blanks == IGNORE_DIFFERENCES .and. len(short) > 0 .and. string(i + 1:i + 1) /= ' ') then
          short = short//' '
        end if
      end do
    end if
  end function reduced

  !> Adds a failure if the shapes do not conform.
  logical function shapes_differ(shape_expected, shape_found, message, location)
    !> The two shapes; an expected scalar conforms with every shape
    integer, intent(in) :: shape_expected(:), shape_found(:)
    !> Message of the test's author
    character(len=*), intent(in), optional :: message
    !> Position of the assert
    type(SourceLocation), intent(in), optional :: location
    character(len=80) :: text

    shapes_differ = size(shape_expected) > 0 .and. size(shape_expected) /= size(shape_found)
    if (size(shape_expected) == size(shape_found)) shapes_differ = any(shape_expected /= shape_found)
    if (.not. shapes_differ) return
    write (text, '(*(g0,:," "))') 'expected shape', shape_expected, ', found shape', shape_found
    call add_failure(trim(text), message, location)
  end function shapes_differ

  !> The sentence of a failure.
  pure function statement(relation, expected, found, remark) result(text)
    !> Name of the relation, both sides and further text
    character(len=*), intent(in) :: relation, expected, found, remark
    character(len=:), allocatable :: text

    select case (relation)
    case ('equal', 'relatively equal')
      text = 'expected '//expected//', found '//found//remark
    case ('different')
      text = 'expected anything but '//expected//', found '//found//remark
    case default
      text = 'expected '//expected//' '//relation//' '//found//', found otherwise'//remark
    end select
  end function statement

  !> Position in an array of the element with a given number; empty for a scalar.
  pure function position(number, dims) result(text)
    !> Number of the element in the order of storage
    integer, intent(in) :: number
    !> Shape of the array
    integer, intent(in) :: dims(:)
    character(len=:), allocatable :: text
    integer :: i, rest

    text = ''
    if (size(dims) == 0) return
    rest = number - 1
    do i = 1, size(dims)
      text = text//','//text_of_integer(int(modulo(rest, dims(i)) + 1, int64))
      rest = rest/dims(i)
    end do
    text = ' at element ('//text(2:)//')'
  end function position

  !> Difference of two numbers and its tolerance; empty for relations of order.
  pure function apart(relation, a, b, allowed) result(text)
    !> Name of the relation
    character(len=*), intent(in) :: relation
    !> The two numbers and the tolerance
    real(real64), intent(in) :: a, b, allowed
    character(len=:), allocatable :: text

    text = ''
    if (index('<>=', relation(1:1)) > 0) return
    if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) then
      if (max(abs(a), abs(b)) < huge(a)/2) text = ', difference '//text_of_real(b - a)
    end if
    text = text//', tolerance '//text_of_real(allowed)
  end function apart

  !> The tolerance as a number.
  pure real(real64) function real_of(tolerance)
    !> A real of any kind; absent: 0
    class(*), intent(in), optional :: tolerance

    real_of = 0
    if (.not. present(tolerance)) return
    select type (tolerance)
    type is (real(real32))
      real_of = tolerance
    type is (real(real64))
      real_of = tolerance
    end select
  end function real_of

  !> The message, also if it is passed in place of the tolerance.
  pure function remark(tolerance, message) result(text)
    !> A real, or the message
    class(*), intent(in), optional :: tolerance
    !> The message
    character(len=*), intent(in), optional :: message
    character(len=:), allocatable :: text

    text = ''
    if (present(message)) text = message
    if (.not. present(tolerance)) return
    select type (tolerance)
    type is (character(len=*))
      text = tolerance
    end select
  end function remark

  !> An integer as text.
  pure function text_of_integer(value) result(text)
    !> The number
    integer(int64), intent(in) :: value
    character(len=:), allocatable :: text
    character(len=24) :: buffer

    write (buffer, '(i0)') value
    text = trim(buffer)
  end function text_of_integer

  !> A real as text, to its last digit.
  pure function text_of_real(value) result(text)
    !> The number
    real(real64), intent(in) :: value
    character(len=:), allocatable :: text
    character(len=32) :: buffer

    write (buffer, '(g0)') value
    text = trim(buffer)
  end function text_of_real
end module comparisons
