!> The initial state in the deck: rows of its table and their filling.
module initial_state_deck
  use deck_choices, only: code_of
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use initial_state_parameters, only: initial_state_t, motion_kept, motion_rest
  implicit none
  private
  public :: fill_initial_state

  !> Names that checks across groups use.
  character(len=*), parameter, public :: initial_state_group = 'initial_state', key_from = 'from', &
                                         key_cut_at = 'cut_at'
  character(len=group_row_length), parameter, public :: initial_state_group_row = &
    'initial_state | optional | Initial state from the checkpoint of another run, such as compression after impact.'
  character(len=key_row_length), parameter, public :: initial_state_rows(*) = [character(len=key_row_length) :: &
    'initial_state | from | text | 1 | - | required | not empty | &
      &Checkpoint NAME_restart.h5 of the other run; the path is relative to the working directory.', &
    'initial_state | motion | choice | 1 | - | ''rest'' | rest kept | &
      &Whether the plate starts at rest, or with the velocities of the checkpoint.', &
    'initial_state | cut_at | real | 2 | length | = its centre | any | &
      &Centre of a smaller plate in the coordinates of the plate from which it is cut.']

contains

  !> The initial state.
  subroutine fill_initial_state(settings, initial)
    type(settings_t), intent(in) :: settings
    type(initial_state_t), intent(inout) :: initial

    if (.not. settings%is_known(initial_state_group, key_from)) return
    initial%from = settings%text_of(initial_state_group, key_from)
    initial%motion = code_of(settings%text_of(initial_state_group, 'motion'), 'rest kept', [motion_rest, motion_kept])
    if (settings%is_given(initial_state_group, key_cut_at)) &
      initial%cut_at = settings%reals_of(initial_state_group, key_cut_at)
  end subroutine fill_initial_state
end module initial_state_deck
