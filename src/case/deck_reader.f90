!> Reads a deck: scan, rules, parameters, checks of combinations. All faults are reported, none stops the reading.
module deck_reader
  use deck_accuracy, only: check_left_out
  use deck_cell_growth, only: check_cell_growth
  use deck_central_differences, only: choose_rows, find_stable_step
  use deck_contents, only: deck_t
  use deck_crack_bands, only: check_crack_bands
  use deck_cross_checks, only: check_across_groups
  use deck_explicit_checks, only: check_central_differences
  use deck_extents, only: check_sizes, check_extents
  use deck_fillings, only: fill_loads, fill_model, fill_steps, note_groups
  use deck_first_zones, only: check_left_out_zones, set_first_zones
  use deck_force_filters, only: check_force_filter
  use deck_group_checks, only: check_groups
  use deck_idle_keys, only: check_idle_keys
  use deck_initial_states, only: check_initial_state
  use deck_integrators, only: choose_integrator, needs_lengths
  use deck_interface_remarks, only: check_interfaces
  use deck_library, only: take_library
  use deck_mesh_lines, only: place_mesh_lines
  use deck_problems, only: problems_t
  use deck_process_zones, only: check_process_zones, set_flaws
  use deck_refinements, only: refine
  use deck_rules, only: resolve_settings
  use deck_scales, only: check_scales
  use deck_scanner, only: scan_t, scan_deck, max_bytes
  use deck_shear_remarks, only: check_correction
  use deck_slow_motion, only: check_softening_steps
  use deck_symmetries, only: note_symmetry
  use deck_table, only: load_deck_table
  use deck_units, only: check_units
  use deck_vocabulary, only: vocabulary_t
  use errors, only: error_t
  use files, only: read_whole_file
  use stepping_parameters, only: is_explicit
  implicit none
  private
  public :: deck_t, problems_t, read_deck, read_deck_text

contains

  !> Reads a deck from a file.
  subroutine read_deck(path, deck, problems)
    character(len=*), intent(in) :: path
    !> The deck, valid if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    type(error_t), allocatable :: error
    character(len=:), allocatable :: content

    call read_whole_file(path, max_bytes, content, error)
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
    !> The deck, valid if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    type(vocabulary_t) :: vocabulary
    type(scan_t) :: scan

    deck%source = source
    deck%text = content
    call problems%begin(source)
    call load_deck_table(vocabulary)
    call scan_deck(content, scan, problems)
    if (size(scan%blocks) == 0 .or. problems%is_full()) return
    call resolve_settings(scan, vocabulary, deck%settings, problems)
    if (problems%is_full()) return
    call take_library(deck%settings, problems)
    call note_groups(deck)
    call fill_model(deck, problems)
    call choose_integrator(deck)
    call check_left_out(deck%settings, needs_lengths(deck, problems), problems)
    call fill_loads(deck, problems)
    call fill_steps(deck)
    call refine(deck)
    call place_mesh_lines(deck, problems)
    call check_groups(deck, problems)
    call check_sizes(deck, problems)
    call check_across_groups(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call check_central_differences(deck, problems)
    call check_initial_state(deck, problems)
    call check_idle_keys(deck, vocabulary, problems)
    call check_left_out_zones(deck, problems)
    call set_first_zones(deck, problems)
    call check_extents(deck, problems)
    if (problems%errors() == 0) call check_cell_growth(deck, problems)
    call check_interfaces(deck, problems)
    call check_correction(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call find_stable_step(deck, problems)
    if (deck%setup%ply_damage%is_present) call check_crack_bands(deck, problems)
    call check_process_zones(deck, problems)
    call set_flaws(deck, problems)
    call check_scales(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping) .and. problems%errors() == 0) call choose_rows(deck)
    call check_force_filter(deck, problems)
    call check_softening_steps(deck, problems)
    call check_units(deck, vocabulary, problems)
    if (problems%errors() == 0) call note_symmetry(deck)
    deck%remarks = problems%remarks()
  end subroutine read_deck_text
end module deck_reader
