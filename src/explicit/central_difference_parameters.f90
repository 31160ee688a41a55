!> Parameters of central differences in the deck.
module central_difference_parameters
  use kinds, only: wp
  implicit none
  private
  public :: central_difference_parameters_t

  !> Parameters of central differences.
  type :: central_difference_parameters_t
    !> Ratio of the step to the stable step
    real(wp) :: step_factor = 0.9_wp
    !> Mean factor of rotary inertia
    real(wp) :: mass_scaling = 1
    !> Largest step requested; 0: the stable step
    real(wp) :: longest = 0
    !> Duration of damping that brings the plate to rest before lines load it; 0: none
    real(wp) :: settle = 0
  contains
    procedure :: stable_step
  end type central_difference_parameters_t

contains

  !> Step for the highest frequency of a model.
  pure real(wp) function stable_step(self, frequency) result(step)
    class(central_difference_parameters_t), intent(in) :: self
    !> The angular frequency
    real(wp), intent(in) :: frequency

    step = self%step_factor*2/frequency
    if (self%longest > 0) step = min(step, self%longest)
  end function stable_step
end module central_difference_parameters
