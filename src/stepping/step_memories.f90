!> Saved state of a stepper before a step, without the factored operator, so that the step can be repeated.
module step_memories
  use states, only: state_t
  use step_controllers, only: step_controller_t
  use step_errors, only: step_error_t
  use implicit_steps, only: implicit_steps_t
  implicit none
  private
  public :: step_memory_t, save_state

  !> A stepper before a step.
  type :: step_memory_t
    private
    !> The state
    type(state_t) :: now
    type(step_controller_t) :: controller
    !> The estimate of the error
    type(step_error_t) :: step_error
  contains
    procedure :: restore_state
  end type step_memory_t

contains

  !> Saves the stepper before a step.
  pure function save_state(stepper) result(self)
    !> The state accepted, the trial state and the step control
    class(implicit_steps_t), intent(in) :: stepper
    type(step_memory_t) :: self

    self%now = stepper%now
    self%controller = stepper%controller
    self%step_error = stepper%step_error
  end function save_state

  !> Restores the state before an accepted step, which counts as rejected.
  subroutine restore_state(self, stepper)
    !> The state saved before the step
    class(step_memory_t), intent(in) :: self
    !> The state accepted, the trial state and the step control
    class(implicit_steps_t), intent(inout) :: stepper

    stepper%now = self%now
    stepper%controller = self%controller
    stepper%step_error = self%step_error
    stepper%rejected = stepper%rejected + 1
    stepper%operator%ready = .false.
  end subroutine restore_state
end module step_memories
