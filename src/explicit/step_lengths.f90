!> Lengths of the present and the previous step, and the damping between them.
module step_lengths
  use element_batches, only: lanes
  use kinds, only: wp
  implicit none
  private
  public :: step_lengths_t, commensurate_step, allow_for, lengthening_ratio

  !> Allowance for an increase of a frequency before it is found again: in 16 steps a slope changes by less than
  !> velocity times time over element length, far below a hundredth.
  real(wp), parameter :: frequency_reserve = 1.01_wp
  !> Ratio of the present to the allowed frequency below which the latter is reduced, and of the present to the longest
  !> step below which steps are lengthened: steps are up to a fifth shorter than necessary.
  real(wp), parameter :: lengthening_ratio = 0.8_wp

  !> A step and the one before it.
  type :: step_lengths_t
    !> Length of the step, and of the one before; 0: there was none
    real(wp) :: now = 0, last = 0
    !> Factor by which damping has multiplied the velocities of the step before
    real(wp) :: kept = 1
  contains
    procedure :: mean
    procedure :: work
    procedure :: work_in_lanes
  end type step_lengths_t

contains

  !> Time between the mid-step velocities of both steps.
  pure real(wp) function mean(self)
    class(step_lengths_t), intent(in) :: self

    mean = (self%now + self%last)/2
  end function mean

  !> Additional displacement over which the force R at the end of a step does work when the step length changes. The
  !> kinetic energy at whole steps, v M v/2 + h R v/2, changes by R (h_mean (v_old + v)/2 + h v/2) - h_old R_old
  !> v_old/2; for equal steps this is R dq + (R - R_old) dq_old/2.
  elemental real(wp) function shift(self, before, after)
    class(step_lengths_t), intent(in) :: self
    !> Change of the coordinate in the step before, and in this step
    real(wp), intent(in) :: before, after

    shift = 0
    if (.not. abs(self%now - self%last) > 0) return
    shift = -after/self%now
    if (self%last > 0) shift = shift + before/self%last
    shift = (self%now - self%last)/4*shift
  end function shift

  !> Decrease of the kinetic energy at whole steps by a force R on a coordinate q: R dq + (R - R_old) dq_old/2, and the
  !> work over the additional displacement.
  elemental real(wp) function work(self, force, force_before, change, change_before)
    class(step_lengths_t), intent(in) :: self
    !> Force in this step and in the one before
    real(wp), intent(in) :: force, force_before
    !> Change of the coordinate in this step and, reduced by damping, in the one before
    real(wp), intent(in) :: change, change_before

    work = force*(change + shift(self, change_before, change)) + (force - force_before)*change_before/2
  end function work

  !> The same for the lanes of a batch: here the elemental function is expanded and vectorized.
  pure function work_in_lanes(self, force, force_before, change, change_before) result(works)
    class(step_lengths_t), intent(in) :: self
    !> As in `work`
    real(wp), dimension(lanes), intent(in) :: force, force_before, change, change_before
    real(wp) :: works(lanes)

    works = work(self, force, force_before, change, change_before)
  end function work_in_lanes

  !> Changes the frequency that the step allows for where the present one exceeds it or is far below: steps of
  !> alternating length excite the highest modes.
  pure subroutine allow_for(frequency, allowed)
    !> The present frequency
    real(wp), intent(in) :: frequency
    !> The one allowed for
    real(wp), intent(inout) :: allowed

    if (frequency > allowed .or. frequency < lengthening_ratio*allowed) allowed = frequency_reserve*frequency
  end subroutine allow_for

  !> Longest step, not longer than a bound, of which an integer number equals a time.
  pure real(wp) function commensurate_step(time, longest) result(step)
    !> The time, and the longest step
    real(wp), intent(in) :: time, longest
    real(wp) :: steps

    steps = aint(time/longest)
    if (steps*longest < time*(1 - 1.0e-9_wp)) steps = steps + 1
    step = time/max(1.0_wp, steps)
  end function commensurate_step
end module step_lengths
