!> Explains the tables of results, for the terminal and the manual.
module result_explain
  use errors, only: error_t, exit_usage, fail
  use field_results, only: field_rows
  use result_rows, only: column_rows
  use result_tables, only: cell, column_heading, column_meaning, column_name, column_unit, field_heading, &
                           field_meaning, field_row, markdown_table, plain_table
  use summary_rows, only: summary_heading, summary_meaning, summary_table
  use text, only: append, line_t, lower_case
  implicit none
  private
  public :: explain_column, explain_results, is_result_topic

  !> Their names.
  character(len=*), parameter, public :: result_topics = 'history fields summary'
  !> The command that prints the tables.
  character(len=*), parameter, public :: result_topics_sentence = &
    '`implam explain history` lists the columns of NAME_history.csv, `implam explain fields` the fields of NAME.h5, &
      &`implam explain summary` the results in NAME_summary.json.'

contains

  !> True for the name of a table of results. Keys of the deck may have the same name.
  pure logical function is_result_topic(topic)
    !> The parsed command line
    character(len=*), intent(in) :: topic

    is_result_topic = index(' '//result_topics//' ', ' '//lower_case(topic)//' ') > 0 .and. len_trim(topic) > 0
  end function is_result_topic

  !> A column of the history or a field by name, also with a number for its N; no lines if there is none.
  subroutine explain_column(topic, lines, error)
    !> Such as work_external or area_below_3, optionally after the name of its table as in `history force`
    character(len=*), intent(in) :: topic
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Raised if a table is named and has no such column or field
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: name
    integer :: mark

    name = lower_case(trim(topic))
    mark = max(1, scan(name, ' .%'))
    if (is_result_topic(name(:mark - 1))) name = trim(adjustl(name(mark + 1:)))
    call find_column(name, lines)
    if (size(lines) == 0 .and. is_result_topic(lower_case(topic(:mark - 1)))) &
      call fail(error, exit_usage, 'There is no '//name//' in the results; `implam explain '//topic(:mark - 1)// &
                '` lists what there is.')
  end subroutine explain_column

  !> Explains a column of the history or a field.
  subroutine find_column(name, lines)
    character(len=*), intent(in) :: name
    !> The explanation; empty: there is none
    type(line_t), allocatable, intent(out) :: lines(:)

    allocate (lines(0))
    call find_in('NAME_history.csv', column_rows, column_meaning)
    call find_in('NAME_summary.json', summary_table, summary_meaning)
    call find_in('NAME.h5', field_rows, field_meaning)

  contains

    !> Explains the row of one table.
    subroutine find_in(file, rows, meaning)
      !> Name of the file, and rows of its table, which begin with name, type or place, and unit
      character(len=*), intent(in) :: file, rows(:)
      !> Cell of the meaning
      integer, intent(in) :: meaning
      integer :: row

      row = field_row(rows, name)
      if (row == 0) return
      call append(lines, file)
      call append(lines, '  '//cell(rows(row), column_name)//': '//cell(rows(row), meaning))
      if (cell(rows(row), column_unit) /= '-') call append(lines, '  unit: '//cell(rows(row), column_unit))
    end subroutine find_in
  end subroutine find_column

  !> The columns of the history or the fields over the plate.
  subroutine explain_results(topic, markdown, lines)
    !> `history`, `fields` or `summary`
    character(len=*), intent(in) :: topic
    !> True: the table alone, as Markdown
    logical, intent(in) :: markdown
    type(line_t), allocatable, intent(out) :: lines(:)

    select case (lower_case(topic))
    case ('history')
      call print_table('NAME_history.csv has a row for each accepted step, with central differences about 2000 '// &
                       'rows. Its columns, in their order:', column_heading, column_rows)
    case ('summary')
      call print_table('NAME_summary.json has these results, as far as the run has them, and further members:', &
                       summary_heading, summary_table)
    case default
      call print_table('NAME.h5 holds fields over the plate, which NAME.xdmf shows to ParaView. N is the number '// &
                       'of a ply, choice what `fields` in &output says:', field_heading, field_rows)
    end select

  contains

    !> One of the tables.
    subroutine print_table(sentence, heading, rows)
      !> Sentence above it on the terminal, its heading and rows
      character(len=*), intent(in) :: sentence, heading, rows(:)

      if (markdown) then
        call markdown_table(heading, rows, lines)
      else
        call append(lines, sentence)
        call plain_table(heading, rows, lines)
      end if
    end subroutine print_table
  end subroutine explain_results
end module result_explain
