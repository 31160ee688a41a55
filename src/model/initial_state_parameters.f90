!> Initial state of a load case.
module initial_state_parameters
  use kinds, only: wp
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
    !> Time that the other run reached and that of its end; in load steps from 0 to 1
    real(wp) :: reached = 0, end = 0
    !> motion_rest or motion_kept
    integer :: motion = motion_rest
    !> Centre of a smaller plate in the plate it is cut from
    real(wp) :: cut_at(2) = 0
  end type initial_state_t
end module initial_state_parameters
