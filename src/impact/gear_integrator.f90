!> Gear's method for the impactor: the backward differentiation formula of fourth order, with coefficients for steps of
!> unequal length, theory (F3) (Eq. 6 of the paper if they are equal).
module gear_integrator
  use impactors, only: impactor_t, past => past_points
  use kinds, only: wp
  implicit none
  private
  public :: gear4_weights, gear4_slope, advance_gear4

  !> Largest ratio of a step to the one before: with steps that keep growing, variable-step BDF4 is
  !> zero-stable up to 1.28; at 1.2 its largest parasitic root is 0.86.
  real(wp), parameter, public :: largest_growth_ratio = 1.19_wp
  !> Largest omega*step of this method. For undamped oscillation the amplitude grows as (omega*step)**6: by 2.1e-5 per
  !> step at 0.2, 1.3e-3 at 0.4, 11 % at 1, and at most 19 %, at 1.86. At 0.2 the amplitude over a contact (omega*time =
  !> 4, about 20 steps) has an error of at most 4e-4.
  real(wp), parameter, public :: gear4_limit = 0.2_wp

contains

  !> Weights of the fourth-order backward differentiation formula for unequal steps,
  !> y_end = sum(weights*past values) + slope*dt*y'_end.
  pure subroutine gear4_weights(dt, past_step, weights, slope)
    !> Next step
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

  !> Weight of the derivative in the next gear4 step.
  pure real(wp) function gear4_slope(impactor, dt) result(slope)
    !> State at the start of the step
    type(impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
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
    !> State, advanced by the step
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

  !> Sets the stored states to an exact free flight, at the spacing of the first step.
  pure subroutine assume_free_flight(gravity, dt, impactor)
    !> Acceleration of gravity
    real(wp), intent(in) :: gravity
    !> First step
    real(wp), intent(in) :: dt
    !> State; receives stored states
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
end module gear_integrator
