!> Choice of the stepper.
module stepper_choice
  use explicit_steppers, only: explicit_stepper_t
  use implicit_steppers, only: implicit_stepper_t
  use steppers, only: stepper_t
  use stepping_parameters, only: is_explicit, stepping_t
  implicit none
  private
  public :: choose_stepper

contains

  !> Makes a stepper of the kind that the parameters ask for, not started.
  subroutine choose_stepper(stepping, stepper)
    type(stepping_t), intent(in) :: stepping
    class(stepper_t), allocatable, intent(out) :: stepper

    if (is_explicit(stepping)) then
      allocate (explicit_stepper_t :: stepper)
    else
      allocate (implicit_stepper_t :: stepper)
    end if
  end subroutine choose_stepper
end module stepper_choice
