!> Explains what results hold, for the terminal and for the manual.
module result_explain
  use field_results, only: field_rows
  use result_rows, only: column_rows
  use result_tables, only: column_heading, field_heading, markdown_table, plain_table
  use text, only: append, line_t, lower_case
  implicit none
  private
  public :: explain_results, is_result_topic

  !> Their names.
  character(len=*), parameter, public :: result_topics = 'history fields'
  !> How to ask for the tables.
  character(len=*), parameter, public :: result_topics_sentence = &
    '`implam explain history` lists the columns of NAME_history.csv, `implam explain fields` the fields of NAME.h5.'

contains

  !> True for the name of a table of results. Keys of the deck may have the same name.
  pure logical function is_result_topic(topic)
    !> What is asked
    character(len=*), intent(in) :: topic

    is_result_topic = lower_case(topic) == 'history' .or. lower_case(topic) == 'fields'
  end function is_result_topic

  !> The columns of the history or the fields over the plate.
  subroutine explain_results(topic, markdown, lines)
    !> `history` or `fields`
    character(len=*), intent(in) :: topic
    !> True: the table alone, as Markdown
    logical, intent(in) :: markdown
    !> The explanation
    type(line_t), allocatable, intent(out) :: lines(:)

    if (lower_case(topic) == 'history') then
      if (markdown) then
        call markdown_table(column_heading, column_rows, lines)
      else
        call append(lines, 'NAME_history.csv has a row for each accepted step. Its columns, in their order:')
        call plain_table(column_heading, column_rows, lines)
      end if
    else if (markdown) then
      call markdown_table(field_heading, field_rows, lines)
    else
      call append(lines, 'NAME.h5 holds fields over the plate, which NAME.xdmf shows to ParaView. N is the number '// &
                         'of a ply, choice what `fields` in &output says:')
      call plain_table(field_heading, field_rows, lines)
    end if
  end subroutine explain_results
end module result_explain
