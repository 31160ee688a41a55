!> The rigid impactor, m w'' = m g - F with w positive towards the plate (Eq. 2 of the paper with
!> the sign of this program), and its time integrators.
!>
!> Every integrator gives the displacement at the end of a step as an affine function of the one
!> unknown contact force of the step, w_end = w_free - compliance*force. What that force means is
!> told by `takes_mean_force`.
module impactors
  use archives, only: archive_t
  use impact_parameters, only: impactor_parameters_t, indentation_law_t, integrator_gear4, &
                               integrator_trapezoidal, integrator_central, integrator_conserving
  use tan_sun_hertz_indentation, only: indentation_t, stiffening
  use kinds, only: wp
  implicit none
  private
  public :: impactor_t, new_impactor, takes_mean_force, predict, advance, largest_safe_step, &
            impactor_energy, gear4_weights

  !> Largest ratio of a step to the one before: with steps that keep growing, variable-step BDF4 is
  !> zero-stable up to 1.28; at 1.2 its largest parasitic root is 0.86.
  real(wp), parameter, public :: largest_growth_ratio = 1.19_wp
  !> Largest omega*step of gear4. For undamped oscillation its principal root grows as
  !> (omega*step)**6: 2.1e-5 a step at 0.2, 1.3e-3 at 0.4, 11 % at 1, worst 19 % at 1.86. At 0.2 the
  !> amplitude of a whole contact (omega*time = 4, some 20 steps) is off by 4e-4 at most.
  real(wp), parameter, public :: gear4_limit = 0.2_wp
  !> Largest omega*step of the other integrators, which are stable far beyond, so that a contact is seen at all:
  !> some six steps a contact at least, where the rebound is still right to a per cent.
  real(wp), parameter, public :: resolution_limit = 0.5_wp
  !> Past points that gear4 needs before the current one
  integer, parameter :: past = 3

  !> What evolves of the impactor; changes only when a step is accepted.
  type :: impactor_t
    !> Displacement, positive towards the plate, 0 at first touch
    real(wp) :: displacement = 0
    !> Velocity
    real(wp) :: velocity = 0
    !> Contact force at the end of the last step
    real(wp) :: force = 0
    !> True once `gear4` has a history of its own; before that it assumes free flight
    logical :: has_history = .false.
    !> Lengths of the last steps, latest first
    real(wp) :: past_step(past) = 0
    !> Displacements before those steps
    real(wp) :: past_displacement(past) = 0
    !> Velocities before those steps
    real(wp) :: past_velocity(past) = 0
  contains
    !> Saves or loads the state
    procedure :: visit => visit_impactor
  end type impactor_t

contains

  !> The impactor at first touch.
  pure function new_impactor(parameters) result(impactor)
    !> Mass, velocity, gravity, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    !> Its state
    type(impactor_t) :: impactor

    impactor%velocity = parameters%velocity
  end function new_impactor

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
    !> Fall of that displacement per unit of force
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

  !> The impactor at the end of a step; the state at its start is left alone.
  pure function advance(parameters, impactor, dt, step_force, force_end) result(next)
    !> Mass, gravity, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    !> State at the start of the step
    type(impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> The force of the step, as `takes_mean_force` tells
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

  !> Largest step with which the impactor's integrator follows the contact: omega*step stays below its limit at
  !> every indentation the step may reach.
  pure function largest_safe_step(parameters, law, state, alpha, approach) result(step)
    !> Mass, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    !> Indentation law
    type(indentation_law_t), intent(in) :: law
    !> Committed state of the contact
    type(indentation_t), intent(in) :: state
    !> Indentation at the start of the step
    real(wp), intent(in) :: alpha
    !> Rate of indentation at the start of the step, positive: closing
    real(wp), intent(in) :: approach
    !> Step
    real(wp) :: step
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

  !> Kinetic energy and potential of gravity.
  pure function impactor_energy(parameters, impactor) result(energy)
    !> Mass, gravity
    type(impactor_parameters_t), intent(in) :: parameters
    !> State
    type(impactor_t), intent(in) :: impactor
    !> Energy; the potential is 0 at zero displacement
    real(wp) :: energy

    energy = parameters%mass*(0.5_wp*impactor%velocity**2 - parameters%gravity*impactor%displacement)
  end function impactor_energy

  !> Weights of the fourth-order backward differentiation formula for unequal steps,
  !> y_end = sum(weights*past values) + slope*dt*y'_end (Eq. 6 of the paper if they are equal).
  pure subroutine gear4_weights(dt, past_step, weights, slope)
    !> The coming step
    real(wp), intent(in) :: dt
    !> The three steps before it, latest first
    real(wp), intent(in) :: past_step(past)
    !> Weights of the current and the three past values, latest first
    real(wp), intent(out) :: weights(past + 1)
    !> Weight of the derivative
    real(wp), intent(out) :: slope
    real(wp) :: age(past + 1)
    integer :: i, j

    age(1) = 1
    do i = 1, past
      age(i + 1) = age(i) + past_step(i)/dt
    end do
    slope = 1/sum(1/age)
    weights = slope/age
    do i = 1, past + 1
      do j = 1, past + 1
        if (j /= i) weights(i) = weights(i)*age(j)/(age(j) - age(i))
      end do
    end do
  end subroutine gear4_weights

  !> Weight of the derivative in the coming gear4 step.
  pure function gear4_slope(impactor, dt) result(slope)
    !> State at the start of the step
    type(impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> Weight
    real(wp) :: slope
    real(wp) :: weights(past + 1), steps(past)

    steps = dt
    if (impactor%has_history) steps = impactor%past_step
    call gear4_weights(dt, steps, weights, slope)
  end function gear4_slope

  !> One gear4 step of {w, v}.
  pure subroutine advance_gear4(gravity, dt, acceleration, impactor)
    !> Acceleration of gravity
    real(wp), intent(in) :: gravity
    !> Step
    real(wp), intent(in) :: dt
    !> Acceleration at the end of the step
    real(wp), intent(in) :: acceleration
    !> State to be moved on
    type(impactor_t), intent(inout) :: impactor
    real(wp) :: weights(past + 1), slope, w(past + 1), v(past + 1)

    if (.not. impactor%has_history) call assume_free_flight(gravity, dt, impactor)
    call gear4_weights(dt, impactor%past_step, weights, slope)
    w = [impactor%displacement, impactor%past_displacement]
    v = [impactor%velocity, impactor%past_velocity]
    impactor%velocity = dot_product(weights, v) + slope*dt*acceleration
    impactor%displacement = dot_product(weights, w) + slope*dt*impactor%velocity
    impactor%past_displacement = w(:past)
    impactor%past_velocity = v(:past)
    impactor%past_step = [dt, impactor%past_step(:past - 1)]
  end subroutine advance_gear4

  !> Gives the impactor the history of an exact free flight, at the spacing of the first step.
  pure subroutine assume_free_flight(gravity, dt, impactor)
    !> Acceleration of gravity
    real(wp), intent(in) :: gravity
    !> First step
    real(wp), intent(in) :: dt
    !> State to be given a history
    type(impactor_t), intent(inout) :: impactor
    real(wp) :: age
    integer :: i

    impactor%has_history = .true.
    impactor%past_step = dt
    do i = 1, past
      age = i*dt
      impactor%past_velocity(i) = impactor%velocity - gravity*age
      impactor%past_displacement(i) = impactor%displacement - age*(impactor%velocity - 0.5_wp*gravity*age)
    end do
  end subroutine assume_free_flight

  !> Saves or loads the state.
  subroutine visit_impactor(self, archive)
    !> The state
    class(impactor_t), intent(inout) :: self
    !> Where the state is saved to or loaded from
    class(archive_t), intent(inout) :: archive
    integer :: i
    character :: number

    call archive%item('impactor/displacement', self%displacement)
    call archive%item('impactor/velocity', self%velocity)
    call archive%item('impactor/force', self%force)
    call archive%item('impactor/has_history', self%has_history)
    do i = 1, past
      write (number, '(i1)') i
      call archive%item('impactor/past_step_'//number, self%past_step(i))
      call archive%item('impactor/past_displacement_'//number, self%past_displacement(i))
      call archive%item('impactor/past_velocity_'//number, self%past_velocity(i))
    end do
  end subroutine visit_impactor
end module impactors
