!> The wall-clock limit of a run, which ends before it with a checkpoint.
module wall_limits
  use kinds, only: wp
  implicit none
  private
  public :: wall_limit_t

  !> Reserve before the limit, in durations of the longest step so far: two for the next step, which may take longer,
  !> and one for the checkpoint.
  real(wp), parameter :: reserve = 3
  !> Seconds for the start and end of the process: libraries take .1 s, a file system of a cluster some tenths more.
  real(wp), parameter :: outside = 2

  !> A limit with the data of its reserve.
  type :: wall_limit_t
    !> Permitted seconds; 0: no limit
    real(wp) :: granted = 0
    !> Clock at their start
    real(wp) :: begun = 0
    !> Duration of the longest step so far in seconds, including output
    real(wp), private :: longest = 0
  contains
    procedure :: note_step
    procedure :: is_up
  end type wall_limit_t

contains

  !> Stores the duration of a step.
  pure subroutine note_step(self, seconds)
    class(wall_limit_t), intent(inout) :: self
    !> Duration of a step in seconds, including output
    real(wp), intent(in) :: seconds

    self%longest = max(self%longest, seconds)
  end subroutine note_step

  !> True if another step might exceed the limit.
  pure logical function is_up(self, now)
    class(wall_limit_t), intent(in) :: self
    real(wp), intent(in) :: now

    is_up = self%granted > 0 .and. now - self%begun + reserve*self%longest + outside > &
            self%granted
  end function is_up
end module wall_limits
