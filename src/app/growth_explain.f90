!> Measured errors of delaminations on long cells, for the terminal and the manual.
module growth_explain
  use growth_errors, only: growth_error_lines
  use text, only: append, line_t, lower_case
  implicit none
  private
  public :: explain_growth_errors, is_growth_topic

  !> Its name.
  character(len=*), parameter, public :: growth_topic = 'growth_errors'
  !> The command that prints it.
  character(len=*), parameter, public :: growth_topic_sentence = &
    '`implam explain growth_errors` lists measured errors of delaminations on cells longer than their process zone.'

contains

  !> True for the name of the table.
  pure logical function is_growth_topic(topic)
    !> The topic of the command line
    character(len=*), intent(in) :: topic

    is_growth_topic = lower_case(topic) == growth_topic
  end function is_growth_topic

  !> The table, on the terminal with what it holds for.
  subroutine explain_growth_errors(markdown, lines)
    !> True: as a table for the manual
    logical, intent(in) :: markdown
    type(line_t), allocatable, intent(out) :: lines(:)
    type(line_t), allocatable :: table(:)

    call growth_error_lines(markdown, table)
    if (markdown) then
      lines = table
      return
    end if
    allocate (lines(0))
    call append(lines, 'Least and largest errors with &delamination growth_control=''energy'' and central differences,')
    call append(lines, 'with at least so many cells in the process zone of an interface:')
    call append(lines, '  load at growth of strips over the closed form, by cells in the process zone of their mode,')
    call append(lines, '  area and peak force of impacts over those on the finest cells, by cells in that of shear.')
    lines = [lines, table]
    call append(lines, '`implam check DECK` prints the cells in the process zones of a deck.')
  end subroutine explain_growth_errors
end module growth_explain
