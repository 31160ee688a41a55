!> Tables of results: columns of the history and fields over the plate. A row is a text whose cells are separated by
!> bars. Each folder defines its rows; they are the source of the header of the history, `implam explain`, the manual
!> and the attributes in the field file.
module result_tables
  use text, only: append, line_t, to_text
  implicit none
  private
  public :: cell, field_row, markdown_table, name_with_number, plain_table

  !> Characters of a row, enough for the longest.
  integer, parameter, public :: result_row_length = 220
  !> Characters of a name, enough for the longest.
  integer, parameter, public :: result_name_length = 24

  !> Cells of a row of the history, and their positions. Type: that of its numbers; logical: 0 or 1.
  character(len=*), parameter, public :: column_heading = 'name | type | unit | meaning'
  integer, parameter, public :: column_name = 1, column_type = 2, column_unit = 3, column_meaning = 4

  !> Cells of a row of the fields, and their positions. Name: in the file, with N for a number; on: points or cells;
  !> choice: the value of `fields` in &output that writes it, - if it is always written; needs: the group of the deck
  !> that it requires.
  character(len=*), parameter, public :: field_heading = 'name | on | unit | choice | needs | meaning'
  integer, parameter, public :: field_name = 1, field_place = 2, field_unit = 3, field_choice = 4, field_needs = 5, &
                                field_meaning = 6

  !> Physical dimensions, named as in the table of the deck; - if there is none.
  character(len=*), parameter, public :: unit_kinds = '- time length area length/time force pressure energy radian'
  !> Types of numbers.
  character(len=*), parameter, public :: number_types = 'real integer logical'

contains

  !> One cell of a row.
  pure function cell(row, number) result(content)
    character(len=*), intent(in) :: row
    !> Number of the cell, from 1
    integer, intent(in) :: number
    !> Its content without blanks; empty if the row has fewer cells
    character(len=:), allocatable :: content
    integer :: start, length, k

    ! Without a list of texts, which gfortran 12 leaks, as fields are looked up at every output time.
    start = 1
    do k = 2, number
      start = start + length_to_bar(row(start:)) + 1
    end do
    length = length_to_bar(row(start:))
    content = trim(adjustl(row(start:start + length - 1)))
  end function cell

  !> Number of characters before the next bar, or of all.
  pure integer function length_to_bar(rest) result(length)
    !> Rest of a row
    character(len=*), intent(in) :: rest

    length = index(rest, '|') - 1
    if (length < 0) length = len(rest)
  end function length_to_bar

  !> Row of the field of that name, with numbers between underscores replaced by N if there is no row of the name
  !> itself; 0: none.
  pure integer function field_row(rows, name) result(place)
    !> The table
    character(len=*), intent(in) :: rows(:)
    !> Name in the file, such as ply_12_failure
    character(len=*), intent(in) :: name

    place = row_named(rows, name)
    if (place == 0) place = row_named(rows, with_n_for_numbers(name))
  end function field_row

  !> Row that begins with a name; 0 if there is none.
  pure integer function row_named(rows, name) result(place)
    !> The table
    character(len=*), intent(in) :: rows(:)
    character(len=*), intent(in) :: name

    do place = size(rows), 1, -1
      if (cell(rows(place), field_name) == name) return
    end do
  end function row_named

  !> A name with N for each number between underscores.
  pure function with_n_for_numbers(name) result(pattern)
    !> Such as ply_12_sigma11
    character(len=*), intent(in) :: name
    !> Such as ply_N_sigma11
    character(len=:), allocatable :: pattern
    integer :: start, finish

    pattern = ''
    start = 1
    do while (start <= len(name))
      finish = start + index(name(start:)//'_', '_') - 2
      if (finish >= start .and. verify(name(start:finish), '0123456789') == 0) then
        pattern = pattern//'N_'
      else
        pattern = pattern//name(start:finish)//'_'
      end if
      start = finish + 2
    end do
    pattern = pattern(:len(pattern) - 1)
  end function with_n_for_numbers

  !> A name with a number for its N.
  pure function name_with_number(pattern, number) result(name)
    !> Such as area_below_N
    character(len=*), intent(in) :: pattern
    integer, intent(in) :: number
    !> Such as area_below_3; the pattern itself if it has no N between underscores
    character(len=:), allocatable :: name
    integer :: place

    name = pattern
    place = index(pattern//'_', '_N_')
    if (place > 0) name = pattern(:place)//to_text(number)//pattern(place + 2:)
  end function name_with_number

  !> Number of cells of a row.
  pure integer function cells_of(row)
    character(len=*), intent(in) :: row
    integer :: i

    cells_of = 1 + count([(row(i:i) == '|', i=1, len(row))])
  end function cells_of

  !> A table in Markdown, for the manual.
  subroutine markdown_table(heading, rows, lines)
    !> Contents of the cells, separated by bars
    character(len=*), intent(in) :: heading
    !> The table
    character(len=*), intent(in) :: rows(:)
    !> Lines of the table
    type(line_t), allocatable, intent(out) :: lines(:)
    integer :: i, bar

    call append(lines, '| '//heading//' |')
    call append(lines, repeat('|---', cells_of(heading))//'|')
    do i = 1, size(rows)
      bar = index(rows(i), ' |')
      call append(lines, '| `'//rows(i)(:bar - 1)//'`'//trim(rows(i)(bar:))//' |')
    end do
  end subroutine markdown_table

  !> A table in columns of equal width, for the terminal.
  subroutine plain_table(heading, rows, lines)
    !> Contents of the cells, separated by bars
    character(len=*), intent(in) :: heading
    !> The table
    character(len=*), intent(in) :: rows(:)
    type(line_t), allocatable, intent(inout) :: lines(:)
    integer, allocatable :: widths(:)
    integer :: i, j

    widths = [(len(cell(heading, j)), j=1, cells_of(heading))]
    do i = 1, size(rows)
      widths = max(widths, [(len(cell(rows(i), j)), j=1, size(widths))])
    end do
    call append(lines, padded(heading))
    do i = 1, size(rows)
      call append(lines, padded(rows(i)))
    end do

  contains

    !> A row with its cells filled up to the widths.
    pure function padded(row) result(line)
      character(len=*), intent(in) :: row
      character(len=:), allocatable :: line
      integer :: k

      line = ''
      do k = 1, size(widths)
        line = line//'  '//cell(row, k)//repeat(' ', widths(k) - len(cell(row, k)))
      end do
      line = trim(line)
    end function padded
  end subroutine plain_table
end module result_tables
