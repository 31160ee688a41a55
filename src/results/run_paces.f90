!> Present speed of a run, and the remaining time at that speed. Steps after damage may cost a multiple of those before,
!> so that a mean over the run would be misleading.
module run_paces
  use kinds, only: wp
  implicit none
  private
  public :: run_pace_t

  !> Shortest time in seconds over which the speed is measured, at most twice: long compared with the scatter of single
  !> steps.
  real(wp), parameter :: window = 10

  !> Two marks of progress; the older one is the reference of the present speed.
  type :: run_pace_t
    private
    !> Clock in seconds and completed steps or time, at the older and at the newer mark
    real(wp) :: older(2) = 0, newer(2) = 0
  contains
    procedure :: start
    procedure :: note
    procedure :: left
  end type run_pace_t

contains

  !> Starts, also after a restart.
  pure subroutine start(self, clock, done)
    class(run_pace_t), intent(inout) :: self
    !> Clock, s, and completed part
    real(wp), intent(in) :: clock, done

    self%older = [clock, done]
    self%newer = self%older
  end subroutine start

  !> Stores the progress of the run.
  pure subroutine note(self, clock, done)
    class(run_pace_t), intent(inout) :: self
    !> Clock, s, and completed part
    real(wp), intent(in) :: clock, done

    if (clock - self%newer(1) < window) return
    self%older = self%newer
    self%newer = [clock, done]
  end subroutine note

  !> Remaining seconds at the present speed; negative: not known yet.
  pure real(wp) function left(self, clock, done, rest)
    class(run_pace_t), intent(in) :: self
    !> Clock, s, completed and remaining part
    real(wp), intent(in) :: clock, done, rest

    left = -1
    if (done > self%older(2)) left = (clock - self%older(1))*max(0.0_wp, rest)/(done - self%older(2))
  end function left
end module run_paces
