!> The pressure of the deck: rows of its table, filling and checks.
module pressure_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use pressure_loads, only: pressure_t, history_step, history_ramp, distribution_uniform, distribution_sine
  implicit none
  private
  public :: fill_pressure, check_pressure

  !> Names that checks across groups use.
  character(len=*), parameter, public :: pressure_group = 'pressure', key_history = 'history'
  character(len=group_row_length), parameter, public :: pressure_group_row = &
    'pressure | optional | Pressure on the struck face.'
  character(len=key_row_length), parameter, public :: pressure_rows(*) = [character(len=key_row_length) :: &
    'pressure | value | real | 1 | pressure | required | any | &
      &Force per area, positive along z, as the impact.', &
    'pressure | history | choice | 1 | - | ''step'' | step ramp | &
      &step: constant from the start; ramp: in proportion to time up to the end. | not &static', &
    'pressure | distribution | choice | 1 | - | ''uniform'' | uniform sine | &
      &Uniform, or one half-sine along each side.']

contains

  !> Fills in the pressure; a ramp ends with the run.
  subroutine fill_pressure(settings, end_time, pressure)
    type(settings_t), intent(in) :: settings
    !> End of the run
    real(wp), intent(in) :: end_time
    type(pressure_t), intent(inout) :: pressure

    pressure%value = settings%real_of(pressure_group, 'value')
    pressure%history = code_of(settings%text_of(pressure_group, key_history), 'step ramp', [history_step, history_ramp])
    pressure%distribution = code_of(settings%text_of(pressure_group, 'distribution'), 'uniform sine', &
                                    [distribution_uniform, distribution_sine])
    pressure%ramp_time = end_time
  end subroutine fill_pressure

  !> Remarks on a pressure without effect.
  subroutine check_pressure(settings, pressure, problems)
    type(settings_t), intent(in) :: settings
    type(pressure_t), intent(in) :: pressure
    type(problems_t), intent(inout) :: problems

    if (settings%is_known(pressure_group, 'value') .and. abs(pressure%value) <= 0) &
      call remark(settings, problems, pressure_group, 'value', 'a pressure of 0 is no load.')
  end subroutine check_pressure
end module pressure_deck
