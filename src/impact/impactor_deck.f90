!> The impactor of the deck: rows of its table and their filling.
module impactor_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use impact_parameters, only: impactor_parameters_t, integrator_gear4, integrator_trapezoidal, integrator_central, &
                               integrator_conserving
  implicit none
  private
  public :: fill_impactor, keys_of_motion

  !> Names that checks across groups use.
  character(len=*), parameter, public :: impactor_group = 'impactor', key_velocity = 'velocity', &
                                         key_radius = 'radius', key_gravity = 'gravity', key_at = 'at', &
                                         key_mass = 'mass', key_integrator = 'integrator', &
                                         key_travel = 'travel', key_rise = 'rise', key_energy = 'energy', &
                                         key_contact_area = 'contact_area'
  character(len=group_row_length), parameter, public :: impactor_group_row = &
    'impactor | optional | The rigid impactor, and the point that it strikes.'
  character(len=key_row_length), parameter, public :: impactor_rows(*) = [character(len=key_row_length) :: &
    'impactor | mass | real | 1 | mass | none | > 0 | &
      &Mass of the full impactor, also under symmetry; needed unless travel is given. | not travel | mass', &
    'impactor | velocity | real | 1 | length/time | = sqrt(2 energy/mass) | >= 0 | &
      &Speed towards the plate at first contact. | not travel | velocity', &
    'impactor | at | real | 2 | length | none | any | &
      &The struck point, from the plate''s centre (default); patch, core, zones and starters are centred on it.', &
    'impactor | energy | real | 1 | energy | none | >= 0 | &
      &Kinetic energy of the full impactor at first contact, instead of velocity. | not travel', &
    'impactor | travel | real | 1 | length | none | > 0 | &
      &Prescribed displacement of the impactor after first contact, at the end of load steps or of an explicit run.', &
    'impactor | rise | real | 1 | time | = end/4 | >= 0 | &
      &Time in which the prescribed velocity of the impactor rises smoothly to its constant value. | &
      &travel, not &static', &
    'impactor | radius | real | 1 | length | none | > 0 | &
      &Radius of the nose; needed if the contact stiffness k is not given. | | radius', &
    'impactor | contact_area | choice | 1 | - | ''patch'' | patch sphere | &
      &Area on which the contact force acts: the patch, or that in contact with a spherical nose, point by point.', &
    'impactor | gravity | real | 1 | length/time^2 | 0 | any | &
      &Acceleration of gravity along the impact, positive towards the plate. | not travel', &
    'impactor | integrator | choice | 1 | - | ''gear4'' | gear4 trapezoidal central conserving | &
      &Time integrator of the impactor. | not travel, not &time integrator = central_difference']

contains

  !> The impactor.
  subroutine fill_impactor(settings, impactor, problems)
    !> Keys in effect; receive the velocity for the energy
    type(settings_t), intent(inout) :: settings
    type(impactor_parameters_t), intent(inout) :: impactor
    type(problems_t), intent(inout) :: problems

    ! An impactor with prescribed travel needs no mass.
    if (settings%has_group(impactor_group) .and. .not. settings%is_given(impactor_group, key_travel) .and. &
        .not. settings%is_given(impactor_group, key_mass) .and. &
        are_clear(settings, problems, impactor_group, key_mass)) &
      call report(settings, problems, impactor_group, key_mass, 'is missing; allowed: 1 real value > 0.')
    call set_velocity_from_energy(settings, problems)
    impactor%travel = settings%real_of(impactor_group, key_travel)
    impactor%rise = settings%real_of(impactor_group, key_rise)
    impactor%mass = settings%real_of(impactor_group, key_mass)
    impactor%velocity = settings%real_of(impactor_group, key_velocity)
    impactor%radius = settings%real_of(impactor_group, key_radius)
    if (settings%is_known(impactor_group, key_at)) impactor%at = settings%reals_of(impactor_group, key_at)
    impactor%spreads = settings%text_of(impactor_group, key_contact_area) == 'sphere'
    if (impactor%spreads .and. .not. impactor%radius > 0 .and. &
        are_clear(settings, problems, impactor_group, key_radius)) &
      call report(settings, problems, impactor_group, key_radius, 'is missing; contact_area = ''sphere'' needs it.')
    impactor%gravity = settings%real_of(impactor_group, key_gravity)
    impactor%integrator = code_of(settings%text_of(impactor_group, key_integrator), &
                                  'gear4 trapezoidal central conserving', &
                                  [integrator_gear4, integrator_trapezoidal, integrator_central, integrator_conserving])
  end subroutine fill_impactor

  !> Computes the velocity from the energy, and reports if neither or both are given.
  subroutine set_velocity_from_energy(settings, problems)
    type(settings_t), intent(inout) :: settings
    type(problems_t), intent(inout) :: problems
    real(wp) :: mass, energy

    if (.not. settings%has_group(impactor_group)) return
    if (settings%is_given(impactor_group, key_travel)) return
    if (.not. settings%is_given(impactor_group, key_energy)) then
      if (.not. settings%is_given(impactor_group, key_velocity) .and. &
          are_clear(settings, problems, impactor_group, key_velocity//' '//key_energy)) &
        call report(settings, problems, impactor_group, key_velocity, 'is missing; give it, or the energy.')
    else if (settings%is_given(impactor_group, key_velocity)) then
      call report(settings, problems, impactor_group, key_energy, 'the velocity is given too; give one of them.')
    else if (settings%is_known(impactor_group, key_mass) .and. settings%is_known(impactor_group, key_energy)) then
      mass = settings%real_of(impactor_group, key_mass)
      energy = settings%real_of(impactor_group, key_energy)
      call settings%derive_numbers(impactor_group, key_velocity, [sqrt(2*energy/mass)])
    end if
  end subroutine set_velocity_from_energy

  !> Names of the keys of the impactor's velocity, separated by blanks.
  pure function keys_of_motion(settings) result(keys)
    type(settings_t), intent(in) :: settings
    character(len=:), allocatable :: keys

    keys = key_velocity//' '//key_energy
    if (settings%is_given(impactor_group, key_energy)) keys = keys//' '//key_mass
  end function keys_of_motion
end module impactor_deck
