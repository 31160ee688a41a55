!> The wall-clock limit of a run, which ends before it with a checkpoint.
module wall_limits
  use kinds, only: wp
  implicit none
  private
  public :: wall_limit_t

  !> Longest steps so far that are kept in reserve: the next one may take twice as long as any before, and the
  !> checkpoint takes its time too.
  real(wp), parameter :: reserve = 3
  !> Seconds for the start and end of the process: libraries take .1 s, a file system of a cluster some tenths more.
  real(wp), parameter :: outside = 2

  !> A limit, and what its reserve is measured by.
  type :: wall_limit_t
    !> Seconds granted; 0: as many as it takes
    real(wp) :: granted = 0
    !> Clock when they began
    real(wp) :: begun = 0
    !> Seconds of the longest step so far, its results included
    real(wp), private :: longest = 0
  contains
    !> Learns how long a step took.
    procedure :: note_step
    !> True if another step might take too long.
    procedure :: is_up
  end type wall_limit_t

contains

  !> Learns how long a step took.
  pure subroutine note_step(self, seconds)
    !> The limit
    class(wall_limit_t), intent(inout) :: self
    !> Seconds that a step took, its results included
    real(wp), intent(in) :: seconds

    self%longest = max(self%longest, seconds)
  end subroutine note_step

  !> True if another step might take too long.
  pure logical function is_up(self, now)
    !> The limit
    class(wall_limit_t), intent(in) :: self
    !> Clock now
    real(wp), intent(in) :: now

    is_up = self%granted > 0 .and. now - self%begun + reserve*self%longest + outside > &
            self%granted
  end function is_up
end module wall_limits
