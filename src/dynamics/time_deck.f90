!> Time integration of the plate in the deck: rows of its table, filling and checks.
module time_deck
  use central_difference_parameters, only: central_difference_parameters_t
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use short_numbers, only: text_at_least
  use stepping_parameters, only: time_t, integrator_newmark, integrator_generalized_alpha, &
                                 integrator_central_difference
  use text, only: to_text
  implicit none
  private
  public :: fill_time, check_time, integrator_of

  !> Names that checks across groups use.
  character(len=*), parameter, public :: time_group = 'time', key_end = 'end', key_step = 'step', &
                                         key_mass_scaling = 'mass_scaling', key_integrator = 'integrator', &
                                         key_settle = 'settle', key_until = 'until', &
                                         key_longest_step = 'step_max'
  character(len=group_row_length), parameter, public :: time_group_row = &
    'time | settings | Time integration of the plate; needed unless the analysis is static.'
  character(len=key_row_length), parameter, public :: time_rows(*) = [character(len=key_row_length) :: &
    'time | end | real | 1 | time | = by &case accuracy, central differences: after the contact | > 0 | &
      &End of the run.', &
    'time | until | choice | 1 | - | ''end'' | end failure | &
      &failure: a compression by lines ends once the plate has failed (has_failed of the summary), at the latest at &
      &end.', &
    'time | step | real | 1 | time | = by &case accuracy, central differences: the stable one | > 0 | &
      &Initial time step, constant unless steps are adaptive; central differences limit it to the stable step.', &
    'time | step_min | real | 1 | time | = step/1024 | > 0 | &
      &Smallest step tried before giving up. | not integrator = central_difference', &
    'time | step_max | real | 1 | time | = step, end with &adapt rule=''local_error'' | > 0 | &
      &Largest step taken with &adapt. | not integrator = central_difference, &adapt on = .true.', &
    'time | wall_limit | real | 1 | s | none | > 0 | &
      &Wall-clock seconds by which the run ends with a checkpoint; --wall-limit overrides it.', &
    'time | integrator | choice | 1 | - | = by the deck | newmark generalized_alpha central_difference | &
      &Time integrator of the plate; left out, central_difference where plies or interfaces soften.', &
    'time | beta | real | 1 | - | 0.25 | > 0, <= 1 | &
      &Newmark''s beta; 2 beta >= gamma keeps every step stable. | integrator = newmark', &
    'time | gamma | real | 1 | - | 0.5 | >= 0.5, <= 1 | &
      &Newmark''s gamma; above 0.5 it adds numerical damping. | integrator = newmark', &
    'time | rho_inf | real | 1 | - | = 1, with &delamination 0.5, with a front 0 | >= 0, <= 1 | &
      &Spectral radius of generalised-alpha at infinite frequency: 1 no damping, 0 most. | &
      &integrator = generalized_alpha', &
    'time | step_factor | real | 1 | - | 0.9 | > 0, <= 1 | &
      &Step of central differences over the stable step. | integrator = central_difference', &
    'time | mass_scaling | real | 1 | - | = up to 10, limited by its effect on bending waves | >= 1, <= 1000 | &
      &Mean factor of rotary inertia for central differences, larger in short elements; w is not scaled. 1: none. | &
      &integrator = central_difference', &
    'time | settle | real | 1 | time | 0 | >= 0 | &
    &Time in which a plate is damped to rest: before lines load it or, with &initial_state, an impactor; and after an &
    &impact. | &
      &integrator = central_difference, not &impactor travel']

  !> Largest number of steps of a run: with twenty iterations each, the number of iterations still fits a default
  !> integer, up to 2.1e9.
  real(wp), parameter, public :: max_steps = 1.0e8_wp

contains

  !> Time integration of the plate.
  subroutine fill_time(settings, rho_infinity, grows, time, central)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    !> Default of the spectral radius at infinite frequency
    real(wp), intent(in) :: rho_infinity
    !> True: by default the step may become larger than the first
    logical, intent(in) :: grows
    type(time_t), intent(inout) :: time
    !> Receives the parameters of central differences
    type(central_difference_parameters_t), intent(inout) :: central

    associate (s => settings)
      time%end = s%real_of(time_group, key_end)
      time%step = s%real_of(time_group, key_step)
      time%ends_at_failure = code_of(s%text_of(time_group, key_until), 'end failure', [0, 1]) == 1
      time%wall_limit = s%real_of(time_group, 'wall_limit')
      time%integrator = integrator_of(s)
      central%step_factor = s%real_of(time_group, 'step_factor')
      central%mass_scaling = s%real_of(time_group, key_mass_scaling)
      central%settle = s%real_of(time_group, key_settle)
      central%longest = time%step
      if (time%integrator == integrator_central_difference) return
      if (.not. s%is_given(time_group, 'step_min')) &
        call s%derive(time_group, 'step_min', to_text(time%step/1024), .false.)
      if (.not. s%is_given(time_group, 'step_max')) call s%derive(time_group, 'step_max', to_text(merge(time%end, &
        time%step, grows)), .false.)
      time%step_min = s%real_of(time_group, 'step_min')
      time%step_max = s%real_of(time_group, 'step_max')
      time%beta = s%real_of(time_group, 'beta')
      time%gamma = s%real_of(time_group, 'gamma')
      if (.not. s%is_given(time_group, 'rho_inf')) &
        call s%derive(time_group, 'rho_inf', to_text(rho_infinity), .false.)
      time%rho_infinity = s%real_of(time_group, 'rho_inf')
    end associate
  end subroutine fill_time

  !> The integrator of the plate chosen in the deck.
  pure integer function integrator_of(settings) result(integrator)
    type(settings_t), intent(in) :: settings

    integrator = code_of(settings%text_of(time_group, key_integrator), &
                         'newmark generalized_alpha central_difference', &
                         [integrator_newmark, integrator_generalized_alpha, integrator_central_difference])
  end function integrator_of

  !> Checks the lengths of steps against each other, and the parameters of the integrator.
  subroutine check_time(settings, time, problems)
    type(settings_t), intent(in) :: settings
    !> Time integration
    type(time_t), intent(in) :: time
    type(problems_t), intent(inout) :: problems

    if (time%step > 0 .and. time%end > 0 .and. clear('step end')) then
      if (time%step > time%end) then
        call report(settings, problems, time_group, 'step', 'is longer than the run; allowed: up to end = '// &
                  to_text(time%end)//'.')
      else if (time%end > max_steps*time%step) then
        call report(settings, problems, time_group, 'step', 'makes more than '//to_text(max_steps)//' steps; '// &
                  'allowed: from '//text_at_least(time%end/max_steps)//'.')
      end if
    end if
    if (time%integrator == integrator_central_difference) return
    if (time%step_min > time%step .and. clear('step step_min')) call report(settings, problems, time_group, &
                                                                            'step_min', &
      'is larger than the first step; allowed: up to step = '//to_text(time%step)//'.')
    if (time%step_max < time%step .and. clear('step step_max')) call report(settings, problems, time_group, &
                                                                            'step_max', &
      'is smaller than the first step; allowed: from step = '//to_text(time%step)//'.')
    if (.not. clear(key_integrator)) return
    if (time%integrator == integrator_newmark .and. 2*time%beta < time%gamma .and. clear('beta gamma')) &
      call report(settings, problems, time_group, 'beta', &
                  'the plate''s motion would be unstable; allowed: from gamma/2 = '//to_text(time%gamma/2)//'.')

  contains

    !> True: none of some keys has a fault.
    logical function clear(keys)
      !> Names of keys, separated by blanks
      character(len=*), intent(in) :: keys

      clear = are_clear(settings, problems, time_group, keys)
    end function clear
  end subroutine check_time
end module time_deck
