!> Constants of Newton's method and of the control of steps in a deck, for studies: rows of the hidden group &controls
!> and their filling.
module controls_deck
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use solution_controls, only: newton_controls_t, step_controls_t
  use stepping_parameters, only: stepping_t
  implicit none
  private
  public :: fill_controls

  !> Name that checks across groups use.
  character(len=*), parameter, public :: controls_group = 'controls'
  character(len=group_row_length), parameter, public :: controls_group_row = &
    'controls | hidden | Constants of the iteration, for studies of their effect; not for models.'
  character(len=key_row_length), parameter, public :: controls_rows(*) = [character(len=key_row_length) :: &
    'controls | max_forcing_term | real | 1 | - | 1e-3 | > 0, < 1 | &
      &Largest reduction of the residual required of a correction.', &
    'controls | forcing_factor | real | 1 | - | 0.9 | > 0, <= 1 | &
      &Factor of the squared ratio of the last residuals in the next forcing term.', &
    'controls | forcing_margin | real | 1 | - | 0.3 | > 0, <= 1 | &
      &Part of the tolerance to which the last linear system is solved.', &
    'controls | element_reduction | real | 1 | - | 1e-2 | > 0, <= 1 | &
      &Reduction of the residual below which element tangents are used.', &
    'controls | contact_share | real | 1 | - | 0.5 | > 0, <= 10 | &
      &Complementarity of contact over the tolerance of the residual.', &
    'controls | search_slope | real | 1 | - | 0.5 | > 0, < 1 | &
      &Directional derivative over its first value at which a line search ends.', &
    'controls | search_min_part | real | 1 | - | 0.1 | > 0, < 0.5 | &
      &Smallest part of a bracket of a line search.', &
    'controls | search_max_part | real | 1 | - | 0.9 | > 0.5, < 1 | &
      &Largest part of a bracket of a line search.', &
    'controls | search_trials | integer | 1 | - | 8 | >= 1, <= 100 | &
      &Trials of a line search.', &
    'controls | force_floor | real | 1 | - | 1e-6 | > 0, <= 1 | &
      &Reference force over the largest so far.', &
    'controls | last_digits | real | 1 | - | 32 | > 0, <= 1e6 | &
      &Multiples of the precision below which no residual is reduced.', &
    'controls | alternating_iterations | integer | 1 | - | 8 | >= 1, <= 1000 | &
      &Iterations of a load step after which every other correction is halved.', &
    'controls | dissipation_tolerance | real | 1 | - | 1e-2 | > 0, <= 1 | &
      &Relative tolerance of the energy that a load step dissipates.', &
    'controls | load_step_parts | integer | 1 | - | 1024 | >= 1, <= 1000000 | &
      &Parts into which a load step may be cut.', &
    'controls | ratio_near_growth | real | 1 | - | 0.8 | > 0, < 1 | &
      &Ratio of release rates from which fronts shorten steps.', &
    'controls | min_mass_ratio | real | 1 | - | 0.3 | > 0, <= 1 | &
      &Smaller over larger mass factor below which an operator is renewed.', &
    'controls | shortening_error | real | 1 | - | 2 | >= 1, <= 1000 | &
      &Error over its tolerance from which the next step is halved.', &
    'controls | rejection_error | real | 1 | - | 8 | >= 1, <= 1000 | &
      &Error over its tolerance from which a step is rejected.', &
    'controls | first_error | real | 1 | - | 4 | > 0, <= 1000 | &
      &Error of the first step over the cube of its part of the rise.', &
    'controls | allowed_in_impact | real | 1 | - | 0.125 | > 0, <= 1 | &
      &Error predicted of a longer step during an impact.', &
    'controls | allowed_after | real | 1 | - | 0.5 | > 0, <= 1 | &
      &Error predicted of a longer step after an impact.', &
    'controls | max_doublings | integer | 1 | - | 3 | >= 1, <= 20 | &
      &Doublings of a step at once.', &
    'controls | doublings_of_gear | integer | 1 | - | 1 | >= 1, <= 20 | &
      &Doublings at once with the method of Gear.', &
    'controls | equal_of_gear | integer | 1 | - | 4 | >= 1, <= 100 | &
      &Equal steps of the method of Gear before it doubles them.', &
    'controls | steady_in_impact | integer | 1 | - | 24 | >= 1, <= 1000 | &
      &Steps before one is lengthened during an impact.', &
    'controls | steady_after | integer | 1 | - | 8 | >= 1, <= 1000 | &
      &Steps before one is lengthened after an impact.', &
    'controls | allowed_damage_lag | real | 1 | - | 0.25 | > 0, <= 1 | &
      &Lag of damage from which steps are not doubled.', &
    'controls | first_parts | integer | 1 | - | 8 | >= 1, <= 1000 | &
      &Parts of the time to the first event.']

contains

  !> Constants, if the deck has the group.
  subroutine fill_controls(settings, stepping)
    type(settings_t), intent(in) :: settings
    type(stepping_t), intent(inout) :: stepping

    if (.not. settings%has_group(controls_group)) return
    call fill_newton(settings, stepping%equilibrium%controls)
    call fill_steps(settings, stepping%controls)
  end subroutine fill_controls

  !> Constants of Newton's method.
  subroutine fill_newton(s, controls)
    !> Keys in effect
    type(settings_t), intent(in) :: s
    type(newton_controls_t), intent(inout) :: controls

    controls%max_forcing_term = s%real_of(controls_group, 'max_forcing_term')
    controls%forcing_factor = s%real_of(controls_group, 'forcing_factor')
    controls%forcing_margin = s%real_of(controls_group, 'forcing_margin')
    controls%element_reduction = s%real_of(controls_group, 'element_reduction')
    controls%contact_share = s%real_of(controls_group, 'contact_share')
    controls%search_slope = s%real_of(controls_group, 'search_slope')
    controls%search_min_part = s%real_of(controls_group, 'search_min_part')
    controls%search_max_part = s%real_of(controls_group, 'search_max_part')
    controls%search_trials = s%integer_of(controls_group, 'search_trials')
    controls%force_floor = s%real_of(controls_group, 'force_floor')
    controls%last_digits = s%real_of(controls_group, 'last_digits')
    controls%alternating_iterations = s%integer_of(controls_group, 'alternating_iterations')
    controls%dissipation_tolerance = s%real_of(controls_group, 'dissipation_tolerance')
  end subroutine fill_newton

  !> Constants of the control of steps.
  subroutine fill_steps(s, controls)
    !> Keys in effect
    type(settings_t), intent(in) :: s
    type(step_controls_t), intent(inout) :: controls

    controls%load_step_parts = s%integer_of(controls_group, 'load_step_parts')
    controls%ratio_near_growth = s%real_of(controls_group, 'ratio_near_growth')
    controls%min_mass_ratio = s%real_of(controls_group, 'min_mass_ratio')
    controls%shortening_error = s%real_of(controls_group, 'shortening_error')
    controls%rejection_error = s%real_of(controls_group, 'rejection_error')
    controls%first_error = s%real_of(controls_group, 'first_error')
    controls%allowed_in_impact = s%real_of(controls_group, 'allowed_in_impact')
    controls%allowed_after = s%real_of(controls_group, 'allowed_after')
    controls%max_doublings = s%integer_of(controls_group, 'max_doublings')
    controls%doublings_of_gear = s%integer_of(controls_group, 'doublings_of_gear')
    controls%equal_of_gear = s%integer_of(controls_group, 'equal_of_gear')
    controls%steady_in_impact = s%integer_of(controls_group, 'steady_in_impact')
    controls%steady_after = s%integer_of(controls_group, 'steady_after')
    controls%allowed_damage_lag = s%real_of(controls_group, 'allowed_damage_lag')
    controls%first_parts = s%integer_of(controls_group, 'first_parts')
  end subroutine fill_steps
end module controls_deck
