!> The impactor's integrators in time: Gear's method, the trapezoidal rule, central differences and one that conserves
!> energy.
!>
!> Every integrator gives the displacement at the end of a step as an affine function of the one unknown contact force
!> of the step, w_end = w_free - compliance*force, theory (F2). Which force this is depends on the integrator, see
!> `takes_mean_force`.
module impactor_integrators
  use gear_integrator, only: advance_gear4, gear4_slope, gear4_limit
  use impact_parameters, only: impactor_parameters_t, indentation_law_t, integrator_gear4, &
                               integrator_trapezoidal, integrator_central, integrator_conserving
  use impactors, only: impactor_t
  use kinds, only: wp
  use tan_sun_indentation, only: indentation_t, stiffening
  implicit none
  private
  public :: takes_mean_force, predict, advance, largest_safe_step

  !> Largest omega*step of the integrators other than Gear's, theory (F4), for accuracy, not stability: with at least
  !> six steps per contact the error of the rebound velocity is one per cent.
  real(wp), parameter, public :: resolution_limit = 0.5_wp

contains

  !> Whether the unknown force of a step is the mean over the indentation passed in the step
  !> (work divided by change of indentation) instead of the force at the end of the step.
  pure logical function takes_mean_force(parameters)
    !> Integrator
    type(impactor_parameters_t), intent(in) :: parameters

    takes_mean_force = parameters%integrator == integrator_conserving
  end function takes_mean_force

  !> Displacement at the end of a step as an affine function of the step's unknown force.
  pure subroutine predict(parameters, impactor, dt, w_free, compliance)
    !> Mass, gravity, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    !> State at the start of the step
    type(impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> Displacement at the end of the step for a zero force
    real(wp), intent(out) :: w_free
    !> Decrease of that displacement per unit of force
    real(wp), intent(out) :: compliance
    type(impactor_t) :: free

    free = advance(parameters, impactor, dt, 0.0_wp, 0.0_wp)
    w_free = free%displacement
    select case (parameters%integrator)
    case (integrator_trapezoidal)
      compliance = dt**2/(4*parameters%mass)
    case (integrator_central)
      compliance = 0
    case (integrator_conserving)
      compliance = dt**2/(2*parameters%mass)
    case default
      compliance = (gear4_slope(impactor, dt)*dt)**2/parameters%mass
    end select
  end subroutine predict

  !> The impactor at the end of a step.
  pure function advance(parameters, impactor, dt, step_force, force_end) result(next)
    !> Mass, gravity, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    !> State at the start of the step
    type(impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> The force of the step, see `takes_mean_force`
    real(wp), intent(in) :: step_force
    !> Contact force at the end of the step
    real(wp), intent(in) :: force_end
    !> State at the end
    type(impactor_t) :: next
    real(wp) :: start, finish

    next = impactor
    start = parameters%gravity - impactor%force/parameters%mass
    finish = parameters%gravity - step_force/parameters%mass
    select case (parameters%integrator)
    case (integrator_trapezoidal)
      next%velocity = impactor%velocity + 0.5_wp*dt*(start + finish)
      next%displacement = impactor%displacement + 0.5_wp*dt*(impactor%velocity + next%velocity)
    case (integrator_central)
      next%velocity = impactor%velocity + 0.5_wp*dt*(start + finish)
      next%displacement = impactor%displacement + dt*(impactor%velocity + 0.5_wp*dt*start)
    case (integrator_conserving)
      next%velocity = impactor%velocity + dt*finish
      next%displacement = impactor%displacement + 0.5_wp*dt*(impactor%velocity + next%velocity)
    case default
      call advance_gear4(parameters%gravity, dt, finish, next)
    end select
    next%force = force_end
  end function advance

  !> Largest step for which omega*step is below the limit of the impactor's integrator at every indentation that the
  !> step may reach.
  pure real(wp) function largest_safe_step(parameters, law, state, alpha, approach) result(step)
    !> Mass, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    type(indentation_law_t), intent(in) :: law
    type(indentation_t), intent(in) :: state
    !> Indentation at the start of the step
    real(wp), intent(in) :: alpha
    !> Rate of indentation at the start of the step, positive: closing
    real(wp), intent(in) :: approach
    real(wp) :: limit, rate, depth

    step = huge(step)
    limit = resolution_limit
    if (parameters%integrator == integrator_gear4) limit = gear4_limit
    ! omega**2 = rate*sqrt(alpha); a bound from either part of alpha + approach*step, then both
    rate = 1.5_wp*law%k*stiffening(law, state)/parameters%mass
    depth = max(alpha, 0.0_wp)
    if (depth > 0) step = limit/sqrt(rate*sqrt(depth))
    if (approach > 0) then
      step = min(step, (limit**2/(rate*sqrt(approach)))**0.4_wp)
      step = limit/sqrt(rate*sqrt(depth + approach*step))
      step = max(step, -alpha/approach)
    end if
  end function largest_safe_step
end module impactor_integrators
