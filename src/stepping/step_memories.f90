!> What a step changes besides the factored operator, kept so that the step can be taken again.
module step_memories
  use states, only: state_t
  use step_controllers, only: step_controller_t
  use step_errors, only: step_error_t
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: step_memory_t, save_state

  !> A stepper before a step.
  type :: step_memory_t
    private
    !> The state
    type(state_t) :: now
    !> The controller
    type(step_controller_t) :: controller
    !> The estimate of the error
    type(step_error_t) :: step_error
  contains
    !> Takes an accepted step back.
    procedure :: restore_state
  end type step_memory_t

contains

  !> Keeps what the next step will change.
  pure function save_state(stepper) result(self)
    !> The stepper
    type(time_stepper_t), intent(in) :: stepper
    !> Its memory
    type(step_memory_t) :: self

    self%now = stepper%now
    self%controller = stepper%controller
    self%step_error = stepper%step_error
  end function save_state

  !> Takes an accepted step back; it counts as rejected.
  subroutine restore_state(self, stepper)
    !> The memory of the stepper before the step
    class(step_memory_t), intent(in) :: self
    !> The stepper
    type(time_stepper_t), intent(inout) :: stepper

    stepper%now = self%now
    stepper%controller = self%controller
    stepper%step_error = self%step_error
    stepper%rejected = stepper%rejected + 1
    stepper%operator%ready = .false.
  end subroutine restore_state
end module step_memories
