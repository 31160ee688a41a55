!> What a stepper through time or load keeps from step to step.
module steppers
  use kinds, only: wp
  use central_differences, only: central_difference_t
  use models, only: model_t
  use newmark_integrators, only: plate_integrator_t
  use states, only: state_t
  use step_controllers, only: step_controller_t
  use step_errors, only: step_error_t
  use stepping_parameters, only: stepping_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: stepper_t

  !> All that evolves during a run, and how steps are taken.
  type :: stepper_t
    !> The state reached
    type(state_t), allocatable :: now
    !> The factored operator
    type(tangent_operator_t) :: operator
    !> The step controller
    type(step_controller_t) :: controller
    !> Error estimate of steps
    type(step_error_t) :: step_error
    !> Last error relative to its tolerance, and the lag of damage in the last step relative to its limit
    real(wp) :: error = 0, damage_lag = 0
    !> True: the error of the last step exceeds the tolerance at the shortest step
    logical :: errs = .false.
    !> Integrator of the plate
    type(plate_integrator_t) :: integrator
    !> How steps are taken
    type(stepping_t) :: stepping
    !> Factorizations and solves when the present step was begun
    integer :: factorizations_at_start = 0, solves_at_start = 0
    !> Rejected steps
    integer :: rejected = 0
    !> Number of unconstrained unknowns
    integer :: unknowns = 0
    !> The trial state
    type(state_t), allocatable :: trial
    !> Central differences; unallocated: steps are implicit
    type(central_difference_t), allocatable :: explicit
  contains
    !> Smallest step worth trying.
    procedure :: smallest_step
    !> Energy to be dissipated per time.
    procedure :: energy_rate
    !> Time of a step by dissipation over that of one by load.
    procedure :: step_scale
  end type stepper_t

contains

  !> Smallest step worth trying.
  pure real(wp) function smallest_step(self, model) result(step)
    !> The stepper
    class(stepper_t), intent(in) :: self
    type(model_t), intent(in) :: model

    step = merge(1.0_wp/(1024*self%stepping%static_steps), self%stepping%time%step_min, model%setup%has_static)
  end function smallest_step

  !> Energy that is to be dissipated per time from now on, so that at the end it is what the deck asks for.
  pure real(wp) function energy_rate(self)
    !> The stepper
    class(stepper_t), intent(in) :: self

    energy_rate = max(0.0_wp, self%stepping%dissipation - self%now%ledger%delamination)/(1 - self%now%time)
  end function energy_rate

  !> Time of a step that dissipates its part of the energy asked for, over that of a step taken by load; 1 for these.
  pure real(wp) function step_scale(self)
    !> The stepper
    class(stepper_t), intent(in) :: self

    step_scale = 1
    if (self%now%path%by_dissipation) step_scale = self%stepping%dissipation/self%energy_rate()
  end function step_scale
end module steppers
