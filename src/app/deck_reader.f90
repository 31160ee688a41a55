!> Reads a deck: scan, rules, parameters, checks across groups. All faults are told, none stops the reading.
module deck_reader
  use deck_checks, only: check_deck
  use deck_contents, only: deck_t
  use deck_extents, only: check_extents
  use deck_filling, only: fill_case, fill_plate, fill_loads, fill_control
  use deck_damage, only: fill_damage
  use deck_laminate, only: fill_materials, fill_laminate
  use deck_output, only: fill_output
  use deck_problems, only: problems_t
  use deck_rules, only: settle
  use deck_scanner, only: scan_t, scan_deck, most_bytes
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use errors, only: error_t
  use files, only: read_whole_file
  implicit none
  private
  public :: deck_t, problems_t, read_deck, read_deck_text

contains

  !> Reads a deck from a file.
  subroutine read_deck(path, deck, problems)
    !> Path of the file
    character(len=*), intent(in) :: path
    !> The deck; only to be used if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    !> All faults and remarks
    type(problems_t), intent(out) :: problems
    type(error_t), allocatable :: error
    character(len=:), allocatable :: content

    call read_whole_file(path, most_bytes, content, error)
    if (allocated(error)) then
      call problems%begin(path)
      call problems%cannot_read(error%message)
      deck%source = path
      deck%text = ''
    else
      call read_deck_text(content, path, deck, problems)
    end if
  end subroutine read_deck

  !> Reads a deck from a text.
  subroutine read_deck_text(content, source, deck, problems)
    !> Text of the deck
    character(len=*), intent(in) :: content
    !> Path or name that messages begin with
    character(len=*), intent(in) :: source
    !> The deck; only to be used if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    !> All faults and remarks
    type(problems_t), intent(out) :: problems
    type(vocabulary_t) :: vocabulary
    type(scan_t) :: scan

    deck%source = source
    deck%text = content
    call problems%begin(source)
    call load_deck_table(vocabulary)
    call scan_deck(content, scan, problems)
    if (size(scan%blocks) == 0 .or. problems%is_full()) return
    call settle(scan, vocabulary, deck%settings, problems)
    if (problems%is_full()) return
    call fill_case(deck)
    call fill_plate(deck)
    call fill_materials(deck, problems)
    call fill_laminate(deck, problems)
    call fill_loads(deck)
    call fill_control(deck)
    call fill_damage(deck, problems)
    call fill_output(deck, problems)
    call check_deck(deck, problems)
    call check_extents(deck, problems)
  end subroutine read_deck_text
end module deck_reader
