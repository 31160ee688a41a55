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
  end type central_difference_parameters_t
end module central_difference_parameters
