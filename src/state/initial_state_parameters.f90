!> The state that a run begins from, as the deck gives it.
module initial_state_parameters
  implicit none
  private
  public :: initial_state_t

  !> What of the plate's motion is taken: nothing, or its velocities.
  integer, parameter, public :: motion_rest = 1, motion_kept = 2

  !> The state that another run has left.
  type :: initial_state_t
    !> Checkpoint of that run; unallocated: the plate begins undamaged, flat and at rest
    character(len=:), allocatable :: from
    !> motion_rest or motion_kept
    integer :: motion = motion_rest
  end type initial_state_t
end module initial_state_parameters
