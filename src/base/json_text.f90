!> Builds a text in JSON (RFC 8259), one member per line. Numbers read back as the same doubles; those that are not
!> finite are null.
module json_text
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: json_t

  !> A text that grows member by member. Starts with an object that is open.
  type :: json_t
    !> Text written so far
    character(len=:), allocatable, private :: content
    !> Brackets to close, outermost first
    character(len=:), allocatable, private :: open_brackets
    !> The next member is the first between its brackets
    logical, private :: at_first = .true.
  contains
    procedure :: begin
    procedure :: open_object
    procedure :: open_list
    procedure :: close => close_bracket
    !> Writes a member.
    generic :: put => put_real, put_reals, put_integer, put_logical, put_text
    procedure :: put_null
    procedure :: finished
    procedure, private :: put_real, put_reals, put_integer, put_logical, put_text, member, open_bracket
  end type json_t

contains

  !> Begins the text.
  pure subroutine begin(self)
    class(json_t), intent(inout) :: self

    self%content = '{'
    self%open_brackets = '}'
    self%at_first = .true.
  end subroutine begin

  !> Opens an object; within a list without a name.
  pure subroutine open_object(self, name)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name

    call self%open_bracket(name, '{', '}')
  end subroutine open_object

  !> Opens a list.
  pure subroutine open_list(self, name)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name

    call self%open_bracket(name, '[', ']')
  end subroutine open_list

  !> Opens an object or a list.
  pure subroutine open_bracket(self, name, opening, closing)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    !> Its brackets
    character(len=1), intent(in) :: opening, closing

    call self%member(name, opening)
    self%open_brackets = self%open_brackets//closing
    self%at_first = .true.
  end subroutine open_bracket

  !> Closes the innermost object or list.
  pure subroutine close_bracket(self)
    class(json_t), intent(inout) :: self
    integer :: depth

    depth = len(self%open_brackets)
    if (.not. self%at_first) self%content = self%content//new_line('a')//repeat('  ', depth - 1)
    self%content = self%content//self%open_brackets(depth:)
    self%open_brackets = self%open_brackets(:depth - 1)
    self%at_first = .false.
  end subroutine close_bracket

  !> Writes a real.
  pure subroutine put_real(self, name, value)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value

    call self%member(name, number(value))
  end subroutine put_real

  !> Writes a list of reals in one line.
  pure subroutine put_reals(self, name, values)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: values(:)
    character(len=:), allocatable :: list
    integer :: i

    list = ''
    do i = 1, size(values)
      if (i > 1) list = list//', '
      list = list//number(values(i))
    end do
    call self%member(name, '['//list//']')
  end subroutine put_reals

  !> Writes an integer.
  pure subroutine put_integer(self, name, value)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    integer, intent(in) :: value

    call self%member(name, to_text(value))
  end subroutine put_integer

  !> Writes a flag.
  pure subroutine put_logical(self, name, value)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    logical, intent(in) :: value

    call self%member(name, trim(merge('true ', 'false', value)))
  end subroutine put_logical

  !> Writes a text.
  pure subroutine put_text(self, name, value)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    character(len=*), intent(in) :: value

    call self%member(name, quoted(value))
  end subroutine put_text

  !> Writes a member without a value.
  pure subroutine put_null(self, name)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name

    call self%member(name, 'null')
  end subroutine put_null

  !> Closes all and gives the text.
  pure subroutine finished(self, content)
    class(json_t), intent(inout) :: self
    !> The text as written to a file
    character(len=:), allocatable, intent(out) :: content

    do while (len(self%open_brackets) > 0)
      call self%close()
    end do
    content = self%content//new_line('a')
  end subroutine finished

  !> Begins a line with a name and its value.
  pure subroutine member(self, name, value)
    class(json_t), intent(inout) :: self
    !> Its name; empty in a list
    character(len=*), intent(in) :: name
    !> The value as it is written
    character(len=*), intent(in) :: value

    if (.not. self%at_first) self%content = self%content//','
    self%content = self%content//new_line('a')//repeat('  ', len(self%open_brackets))
    if (name /= '') self%content = self%content//quoted(name)//': '
    self%content = self%content//value
    self%at_first = .false.
  end subroutine member

  !> A real as JSON has it.
  pure function number(value) result(digits)
    real(wp), intent(in) :: value
    !> Its digits, or null
    character(len=:), allocatable :: digits

    digits = 'null'
    if (ieee_is_finite(value)) digits = to_text(value)
  end function number

  !> A text between quotes. Bytes that are not UTF-8 are taken for Latin 1.
  pure function quoted(value) result(string)
    !> The text
    character(len=*), intent(in) :: value
    !> With characters that JSON forbids replaced by escape sequences
    character(len=:), allocatable :: string
    logical :: foreign
    integer :: i

    foreign = .not. is_utf8(value)
    string = '"'
    do i = 1, len(value)
      select case (iachar(value(i:i)))
      case (34, 92)
        string = string//'\'//value(i:i)
      case (10)
        string = string//'\n'
      case (0:9, 11:31, 127)
        string = string//escape(iachar(value(i:i)))
      case default
        if (foreign .and. iachar(value(i:i)) > 127) then
          string = string//escape(iachar(value(i:i)))
        else
          string = string//value(i:i)
        end if
      end select
    end do
    string = string//'"'
  end function quoted

  !> A character by its number.
  pure function escape(code)
    !> Number of the character
    integer, intent(in) :: code
    !> Such as \u001b
    character(len=6) :: escape

    write (escape, '(a,z4.4)') '\u', code
  end function escape

  !> True if all bytes above 127 belong to characters in UTF-8.
  pure logical function is_utf8(value)
    !> The text
    character(len=*), intent(in) :: value
    integer :: i, code, missing

    is_utf8 = .false.
    missing = 0
    do i = 1, len(value)
      code = iachar(value(i:i))
      if (missing > 0) then
        if (code < 128 .or. code > 191) return
        missing = missing - 1
      else if (code >= 194 .and. code <= 244) then
        missing = 1 + merge(1, 0, code >= 224) + merge(1, 0, code >= 240)
      else if (code > 127) then
        return
      end if
    end do
    is_utf8 = missing == 0
  end function is_utf8
end module json_text
