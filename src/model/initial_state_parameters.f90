!> Initial state of a load case.
module initial_state_parameters
  implicit none
  private
  public :: initial_state_t

  !> Initial velocities of the plate: zero, or those of the other run.
  integer, parameter, public :: motion_rest = 1, motion_kept = 2

  !> The initial state.
  type :: initial_state_t
    !> True: the run starts from the final state of another run
    logical :: is_inherited = .false.
    !> Checkpoint of the other run; unallocated: the plate is undamaged, flat and at rest
    character(len=:), allocatable :: from
    !> Moment at which the other run was stopped before its end, such as time 0.001; unallocated: it was complete
    character(len=:), allocatable :: stopped_at
    !> motion_rest or motion_kept
    integer :: motion = motion_rest
  end type initial_state_t
end module initial_state_parameters
