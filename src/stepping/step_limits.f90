!> Limits of the step length by the integrators: largest step, and largest ratio to the previous step.
module step_limits
  use gear_integrator, only: largest_growth_ratio
  use impact_parameters, only: integrator_gear4
  use impactor_integrators, only: largest_safe_step
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use states, only: state_t
  use step_controllers, only: step_controller_t
  use stepping_parameters, only: stepping_t, is_error_controlled
  implicit none
  private
  public :: impactor_limit, growth_limit, has_gear

contains

  !> Longest step allowed by the impactor's integrator, as a binary fraction of the target step, so that small changes
  !> require no factorization.
  pure real(wp) function impactor_limit(plate, now, target) result(limit)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Target step
    real(wp), intent(in) :: target

    limit = huge(limit)
    if (.not. plate%setup%impactor%is_present) return
    limit = largest_safe_step(plate%setup%impactor, plate%setup%impactor%indentation, now%impact%indentation, &
                              now%impact%indentation%alpha, now%impact%impactor%velocity)
    if (limit < target) limit = target*2.0_wp**floor(log(limit/target)/log(2.0_wp))
  end function impactor_limit

  !> Largest ratio of a step to the previous one allowed by the integrators.
  pure real(wp) function growth_limit(plate, stepping, controller) result(ratio)
    type(composite_plate_t), intent(in) :: plate
    type(stepping_t), intent(in) :: stepping
    type(step_controller_t), intent(in) :: controller

    ratio = largest_growth_ratio
    if (.not. (is_error_controlled(stepping%adapt) .or. &
               plate%setup%has_crack_bands() .and. .not. stepping%adapt%on)) return
    ratio = 1024
    if (has_gear(plate)) ratio = merge(2, 1, controller%equal_steps >= stepping%controls%equal_of_gear)
  end function growth_limit

  !> True: Gear's method integrates the impactor's motion.
  pure logical function has_gear(plate)
    type(composite_plate_t), intent(in) :: plate

    has_gear = plate%setup%impactor%is_present .and. plate%setup%impactor%integrator == integrator_gear4
  end function has_gear
end module step_limits
