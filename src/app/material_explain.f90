!> Published materials for the terminal and for the manual.
module material_explain
  use errors, only: error_t, exit_usage, fail
  use fibre_toughnesses, only: fibre_toughness_lines
  use material_library, only: library_lines, library_names
  use text, only: append, joined, line_t, lower_case, words_of
  implicit none
  private
  public :: explain_materials, is_material_topic

  !> Its name.
  character(len=*), parameter, public :: material_topic = 'materials'
  !> The command that prints them.
  character(len=*), parameter, public :: material_topic_sentence = &
    '`implam explain materials` lists published materials that a deck can name, with the source of each value.'

contains

  !> True for the name of the list of materials, also with that of one of them. A key of the deck has the same name.
  pure logical function is_material_topic(topic)
    !> The topic of the command line
    character(len=*), intent(in) :: topic

    is_material_topic = lower_case(topic) == material_topic .or. index(lower_case(topic), material_topic//'%') == 1
  end function is_material_topic

  !> The materials with their values and sources, or those whose names begin as the topic says.
  subroutine explain_materials(topic, markdown, lines, error)
    !> The topic of the command line
    character(len=*), intent(in) :: topic
    !> True: as tables for the manual
    logical, intent(in) :: markdown
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Set (usage) if there is no such material
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: table(:)

    allocate (lines(0))
    call library_lines(topic(min(len(material_topic) + 2, len(topic) + 1):), markdown, table)
    if (size(table) == 0) then
      call fail(error, exit_usage, 'There is no material '//topic(len(material_topic) + 2:)//'; the materials are '// &
                joined(words_of(library_names, ' '), ', ')//'.')
      return
    end if
    if (.not. markdown) call append(lines, '&material library names one of these; keys that the deck leaves out '// &
                                    'get its values, in the units of &case units. In SI:')
    lines = [lines, table]
    if (len(topic) > len(material_topic)) return
    call append(lines, '')
    call append(lines, 'Fracture energies of fibres, measured; they depend on the thickness of the block of plies:')
    if (markdown) call append(lines, '')
    call fibre_toughness_lines(markdown, table)
    lines = [lines, table]
  end subroutine explain_materials
end module material_explain
