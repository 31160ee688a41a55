!> Load steps of a static analysis in the deck: rows of its table and their filling.
module static_deck
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use loading_parameters, only: loading_t
  implicit none
  private
  public :: fill_static

  !> Name that checks across groups use.
  character(len=*), parameter, public :: static_group = 'static', key_dissipation = 'dissipation'
  character(len=group_row_length), parameter, public :: static_group_row = &
    'static | optional | Quasi-static load steps under pressure and lines, or under the travel of an impactor.'
  character(len=key_row_length), parameter, public :: static_rows(*) = [character(len=key_row_length) :: &
    'static | steps | integer | 1 | - | 1 | >= 1, <= 100000 | &
      &Number of equal load steps.', &
    'static | dissipation | real | 1 | energy | none | > 0 | &
      &Energy dissipated by cohesive interfaces at the end of the run; it controls the steps as damage grows. | &
      &&delamination law = cohesive']

contains

  !> Fills in the load steps.
  subroutine fill_static(settings, loading)
    type(settings_t), intent(in) :: settings
    type(loading_t), intent(inout) :: loading

    loading%steps = settings%integer_of(static_group, 'steps')
    loading%dissipation = settings%real_of(static_group, key_dissipation)
  end subroutine fill_static
end module static_deck
