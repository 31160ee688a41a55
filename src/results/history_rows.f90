!> Header and rows of a history as text. Cells of a row are right-aligned by blanks, which all readers of CSV accept
!> before numbers. Names have no blanks, which many readers would treat as part of the name.
module history_rows
  use kinds, only: long, wp
  use text, only: to_text
  implicit none
  private
  public :: header, row, widths_of

  !> Characters of the longest text of a double, -1.2345678901234567e-100, and of a count.
  integer, parameter :: longest_real = 24, longest_count = 10

contains

  !> First line of the file.
  pure function header(columns) result(line)
    character(len=*), intent(in) :: columns(:)
    character(len=:), allocatable :: line
    integer :: i

    line = ''
    do i = 1, size(columns)
      if (i > 1) line = line//','
      line = line//trim(columns(i))
    end do
  end function header

  !> Characters of each column, those of its name at least.
  pure function widths_of(columns, whole) result(widths)
    character(len=*), intent(in) :: columns(:)
    logical, intent(in) :: whole(:)
    integer :: widths(size(columns))

    widths = max(len_trim(columns), merge(longest_count, longest_real, whole))
  end function widths_of

  !> One row as text: the shortest texts that read back as the same numbers.
  pure function row(values, whole, widths) result(line)
    real(wp), intent(in) :: values(:)
    logical, intent(in) :: whole(:)
    !> Characters of each column
    integer, intent(in) :: widths(:)
    character(len=:), allocatable :: line
    character(len=:), allocatable :: number
    integer :: i, first, last

    allocate (character(len=sum(max(widths, longest_real)) + size(widths)) :: line)
    last = 0
    do i = 1, size(values)
      if (whole(i)) then
        number = to_text(nint(values(i), long))
      else
        number = to_text(values(i))
      end if
      first = last + merge(2, 1, i > 1)
      if (i > 1) line(first - 1:first - 1) = ','
      last = first - 1 + max(widths(i), len(number))
      line(first:last - len(number)) = ''
      line(last - len(number) + 1:last) = number
    end do
    line = line(:last)
  end function row
end module history_rows
