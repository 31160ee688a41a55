!> Decks of one group, for the tests of the folder that defines its rows.
module deck_groups
  use deck_problems, only: problems_t
  use deck_rules, only: resolve_settings
  use deck_scanner, only: scan_t, scan_deck
  use deck_settings, only: settings_t
  use deck_vocabulary, only: vocabulary_t, load_vocabulary
  implicit none
  private
  public :: read_group

contains

  !> Keys in effect of a text that is checked with the rows of one group.
  subroutine read_group(content, group_row, key_rows, settings, problems)
    character(len=*), intent(in) :: content, group_row, key_rows(:)
    type(settings_t), intent(out) :: settings
    type(problems_t), intent(out) :: problems
    type(vocabulary_t) :: vocabulary
    type(scan_t) :: scan

    call problems%begin('deck')
    call load_vocabulary([group_row], key_rows, vocabulary)
    call scan_deck(content, scan, problems)
    call resolve_settings(scan, vocabulary, settings, problems)
  end subroutine read_group
end module deck_groups
