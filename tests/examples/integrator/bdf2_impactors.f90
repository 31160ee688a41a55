!> Impactor by the second-order backward difference with coefficients for unequal steps: one earlier value, stable for
!> any step, and dissipative.
module bdf2_impactors
  use archives, only: archive_t
  use impact_parameters, only: impactor_parameters_t
  use impactors, only: impactor_t
  use kinds, only: wp
  implicit none
  private
  public :: bdf2_impactor_t, new_bdf2_impactor, bdf2_predict, bdf2_advance

  !> The impactor with the value before the last step.
  type, extends(impactor_t) :: bdf2_impactor_t
    !> Length of the last step; 0: no step yet, after free flight
    real(wp) :: last_step = 0
    !> Displacement and velocity at its start
    real(wp) :: last_displacement = 0, last_velocity = 0
  contains
    !> Saves or loads the state
    procedure :: visit
  end type bdf2_impactor_t

contains

  !> The impactor at first contact.
  pure function new_bdf2_impactor(parameters) result(impactor)
    !> Velocity
    type(impactor_parameters_t), intent(in) :: parameters
    !> Its state
    type(bdf2_impactor_t) :: impactor

    impactor%velocity = parameters%velocity
  end function new_bdf2_impactor

  !> Displacement at the end of a step as an affine function of the force at its end.
  pure subroutine bdf2_predict(parameters, impactor, dt, w_free, compliance)
    !> Mass, gravity
    type(impactor_parameters_t), intent(in) :: parameters
    !> State at the start of the step
    type(bdf2_impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> Displacement at the end for a zero force, and its decrease per unit of force
    real(wp), intent(out) :: w_free, compliance
    type(bdf2_impactor_t) :: free
    real(wp) :: weights(2), slope

    free = bdf2_advance(parameters, impactor, dt, 0.0_wp)
    w_free = free%displacement
    call bdf2_weights(dt, impactor%last_step, weights, slope)
    compliance = (slope*dt)**2/parameters%mass
  end subroutine bdf2_predict

  !> The impactor at the end of a step.
  pure function bdf2_advance(parameters, impactor, dt, force) result(next)
    !> Mass, gravity
    type(impactor_parameters_t), intent(in) :: parameters
    !> State at the start
    type(bdf2_impactor_t), intent(in) :: impactor
    !> Step
    real(wp), intent(in) :: dt
    !> Contact force at the end
    real(wp), intent(in) :: force
    !> State at the end
    type(bdf2_impactor_t) :: next
    type(bdf2_impactor_t) :: before
    real(wp) :: weights(2), slope

    before = impactor
    if (.not. before%last_step > 0) then
      ! An exact free flight before the first step.
      before%last_velocity = impactor%velocity - parameters%gravity*dt
      before%last_displacement = impactor%displacement - dt*(impactor%velocity - 0.5_wp*parameters%gravity*dt)
    end if
    call bdf2_weights(dt, impactor%last_step, weights, slope)
    next = impactor
    next%force = force
    next%velocity = weights(1)*before%velocity + weights(2)*before%last_velocity &
                    + slope*dt*(parameters%gravity - force/parameters%mass)
    next%displacement = weights(1)*before%displacement + weights(2)*before%last_displacement + slope*dt*next%velocity
    next%last_step = dt
    next%last_displacement = before%displacement
    next%last_velocity = before%velocity
  end function bdf2_advance

  !> Weights of y_end = sum of weights*y + slope*dt*y'_end for unequal steps: exact for parabolas.
  pure subroutine bdf2_weights(dt, last_step, weights, slope)
    !> The next step, and the last one; 0: as long as the next
    real(wp), intent(in) :: dt, last_step
    !> Weights of the current and of the previous value
    real(wp), intent(out) :: weights(2)
    !> Weight of the derivative
    real(wp), intent(out) :: slope
    real(wp) :: age

    age = 2
    if (last_step > 0) age = 1 + last_step/dt
    slope = age/(1 + age)
    weights = [age, -1/age]*slope/(age - 1)
  end subroutine bdf2_weights

  !> Saves or loads the state with the earlier value: a restarted run continues as without interruption.
  subroutine visit(self, archive)
    !> The state
    class(bdf2_impactor_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call self%impactor_t%visit(archive)
    call archive%item('impactor/last_step', self%last_step)
    call archive%item('impactor/last_displacement', self%last_displacement)
    call archive%item('impactor/last_velocity', self%last_velocity)
  end subroutine visit
end module bdf2_impactors
