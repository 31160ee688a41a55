!> Rows of tables for the terminal and for pages.
module text_tables
  use text, only: line_t
  implicit none
  private
  public :: table_row

contains

  !> One row of a table.
  pure function table_row(cells, widths, markdown) result(row)
    !> Texts of the row
    type(line_t), intent(in) :: cells(:)
    !> Characters of each column on the terminal
    integer, intent(in) :: widths(:)
    !> True: cells are separated by bars, for a page
    logical, intent(in) :: markdown
    character(len=:), allocatable :: row
    integer :: i

    row = merge('|', ' ', markdown)
    do i = 1, size(cells)
      row = row//' '//cells(i)%text
      if (markdown) then
        row = row//' |'
      else
        row = row//repeat(' ', max(1, widths(i) - len(cells(i)%text)))
      end if
    end do
    row = trim(row)
  end function table_row
end module text_tables
