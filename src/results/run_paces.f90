!> How fast a run goes at present, and the time that it has left at that pace. Steps after damage may cost a multiple of
!> those before, so that a mean over the whole run would mislead for long.
module run_paces
  use kinds, only: wp
  implicit none
  private
  public :: run_pace_t

  !> Seconds over which the pace is taken at least, and twice that at most: long beside the scatter of single steps.
  real(wp), parameter :: window = 10

  !> Two marks on the way, of which the older one is what the present is compared with.
  type :: run_pace_t
    private
    !> Clock in seconds, and what of the run is done, steps or time: at the older mark, and at the newer
    real(wp) :: older(2) = 0, newer(2) = 0
  contains
    !> Begins, or goes on after a restart.
    procedure :: start
    !> Notes how far the run is.
    procedure :: note
    !> Seconds left.
    procedure :: left
  end type run_pace_t

contains

  !> Begins, or goes on after a restart.
  pure subroutine start(self, clock, done)
    !> The pace
    class(run_pace_t), intent(inout) :: self
    !> Clock, s, and what is done
    real(wp), intent(in) :: clock, done

    self%older = [clock, done]
    self%newer = self%older
  end subroutine start

  !> Notes how far the run is.
  pure subroutine note(self, clock, done)
    !> The pace
    class(run_pace_t), intent(inout) :: self
    !> Clock, s, and what is done
    real(wp), intent(in) :: clock, done

    if (clock - self%newer(1) < window) return
    self%older = self%newer
    self%newer = [clock, done]
  end subroutine note

  !> Seconds left if the rest goes as fast as the last part did; negative: not known yet.
  pure real(wp) function left(self, clock, done, rest)
    !> The pace
    class(run_pace_t), intent(in) :: self
    !> Clock, s, what is done, and what is not yet
    real(wp), intent(in) :: clock, done, rest

    left = -1
    if (done > self%older(2)) left = (clock - self%older(1))*max(0.0_wp, rest)/(done - self%older(2))
  end function left
end module run_paces
