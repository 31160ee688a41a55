!> Published materials for the terminal and for the manual.
module material_explain
  use fibre_toughnesses, only: fibre_toughness_lines
  use material_library, only: library_lines
  use text, only: append, line_t, lower_case
  implicit none
  private
  public :: explain_materials, is_material_topic

  !> Its name.
  character(len=*), parameter, public :: material_topic = 'materials'
  !> The command that prints them.
  character(len=*), parameter, public :: material_topic_sentence = &
    '`implam explain materials` lists published materials that a deck can name, with the source of each value.'

contains

  !> True for the name of the list of materials. A key of the deck has the same name.
  pure logical function is_material_topic(topic)
    !> The parsed command line
    character(len=*), intent(in) :: topic

    is_material_topic = lower_case(topic) == material_topic
  end function is_material_topic

  !> The materials with their values and sources.
  subroutine explain_materials(markdown, lines)
    !> True: as tables for the manual
    logical, intent(in) :: markdown
    !> The explanation
    type(line_t), allocatable, intent(out) :: lines(:)
    type(line_t), allocatable :: table(:)

    allocate (lines(0))
    if (.not. markdown) call append(lines, '&material library names one of these; keys that the deck leaves out '// &
                                    'get its values, in the units of &case units. In SI:')
    call library_lines(markdown, table)
    lines = [lines, table]
    call append(lines, '')
    call append(lines, 'Fracture energies of fibres, measured; they depend on the thickness of the block of plies:')
    if (markdown) call append(lines, '')
    call fibre_toughness_lines(markdown, table)
    lines = [lines, table]
  end subroutine explain_materials
end module material_explain
