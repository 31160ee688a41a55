!> The impactor of the deck: rows of its table and their filling.
module impactor_deck
  use deck_choices, only: code_of
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use impact_parameters, only: impactor_parameters_t, integrator_gear4, integrator_trapezoidal, integrator_central, &
                               integrator_conserving
  implicit none
  private
  public :: fill_impactor

  !> Names that checks across groups use.
  character(len=*), parameter, public :: impactor_group = 'impactor', key_velocity = 'velocity', &
                                         key_radius = 'radius', key_gravity = 'gravity', key_mass = 'mass'
  !> Row of the group.
  character(len=group_row_length), parameter, public :: impactor_group_row = &
    'impactor | optional | The rigid impactor that strikes the middle of the plate.'
  !> Rows of the keys.
  character(len=key_row_length), parameter, public :: impactor_rows(*) = [character(len=key_row_length) :: &
    'impactor | mass | real | 1 | mass | required | > 0 | &
      &Mass of the whole impactor, also under symmetry.', &
    'impactor | velocity | real | 1 | length/time | required | >= 0 | &
      &Speed towards the plate at first touch.', &
    'impactor | radius | real | 1 | length | none | > 0 | &
      &Radius of the nose; needed if the contact stiffness k isn''t given.', &
    'impactor | gravity | real | 1 | length/time^2 | 0 | any | &
      &Acceleration of gravity along the impact, positive towards the plate.', &
    'impactor | integrator | choice | 1 | - | ''gear4'' | gear4 trapezoidal central conserving | &
      &Time integrator of the impactor.']

contains

  !> The impactor.
  subroutine fill_impactor(settings, impactor)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> Receives them
    type(impactor_parameters_t), intent(inout) :: impactor

    impactor%mass = settings%real_of(impactor_group, key_mass)
    impactor%velocity = settings%real_of(impactor_group, key_velocity)
    impactor%radius = settings%real_of(impactor_group, key_radius)
    impactor%gravity = settings%real_of(impactor_group, key_gravity)
    impactor%integrator = code_of(settings%text_of(impactor_group, 'integrator'), &
                                  'gear4 trapezoidal central conserving', &
                                  [integrator_gear4, integrator_trapezoidal, integrator_central, integrator_conserving])
  end subroutine fill_impactor
end module impactor_deck
