!> Central differences, as the deck gives them.
module central_difference_parameters
  use kinds, only: wp
  implicit none
  private
  public :: central_difference_parameters_t

  !> How steps are taken.
  type :: central_difference_parameters_t
    !> Part of the stable step that is taken
    real(wp) :: step_factor = 0.9_wp
    !> Factor of in-plane and rotary inertia
    real(wp) :: mass_scaling = 1
    !> Longest step wanted; 0: the stable one decides
    real(wp) :: longest = 0
    !> Time in which damping brings the plate to rest before lines load it; 0: nothing is damped
    real(wp) :: settle = 0
  end type central_difference_parameters_t
end module central_difference_parameters
