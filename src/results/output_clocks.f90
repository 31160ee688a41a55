!> Output times, at which steps end exactly. Almost equal times are one event, since a step over their difference would
!> be too short: fronts would continue to grow in it.
module output_clocks
  use kinds, only: wp
  use archives, only: archive_t
  implicit none
  private
  public :: clock_t, next_event, shown_time

  !> Distance of two events, relative to their time, up to which it is round-off: multiples of an interval have one of
  !> 1e-16.
  real(wp), parameter :: rounding = 1.0e-12_wp

  !> A clock with events at multiples of an interval.
  type :: clock_t
    !> Interval; 0: no events
    real(wp) :: interval = 0
    !> Events so far
    integer :: strikes = 0
  contains
    procedure :: next
    procedure :: strikes_at
    procedure :: visit
    procedure, private :: margin
  end type clock_t

contains

  !> Time of the next event: the earliest of some clocks, or the end if it coincides with it.
  pure real(wp) function next_event(clocks, end, closest) result(event)
    type(clock_t), intent(in) :: clocks(:)
    real(wp), intent(in) :: end
    !> Distance up to which events coincide, >= 0
    real(wp), intent(in) :: closest
    integer :: i

    event = end
    do i = 1, size(clocks)
      if (clocks(i)%next() < end - clocks(i)%margin(closest)) event = min(event, clocks(i)%next())
    end do
  end function next_event

  !> A time with twelve digits: sums of steps and products of intervals have round-off, as in 0.00042500000000000003.
  pure real(wp) function shown_time(time)
    !> The time, or load factor
    real(wp), intent(in) :: time
    character(len=20) :: digits

    write (digits, '(es20.11e3)') time
    read (digits, *) shown_time
  end function shown_time

  !> Time of the next event; huge without one.
  pure real(wp) function next(self)
    class(clock_t), intent(in) :: self

    next = huge(next)
    if (self%interval > 0) next = self%interval*(self%strikes + 1)
  end function next

  !> Distance up to which the next event of the clock coincides with another one; at most half an interval, so that no
  !> event is lost.
  pure real(wp) function margin(self, closest)
    class(clock_t), intent(in) :: self
    !> Distance up to which events coincide, >= 0
    real(wp), intent(in) :: closest

    margin = 0
    if (self%interval > 0) margin = max(min(closest, self%interval/2), rounding*self%next())
  end function margin

  !> True if the next event of the clock coincides with the event reached; the clock then advances.
  logical function strikes_at(self, event, closest)
    class(clock_t), intent(inout) :: self
    !> Time of the event, from `next_event`
    real(wp), intent(in) :: event
    !> Distance up to which events coincide, >= 0
    real(wp), intent(in) :: closest

    strikes_at = self%next() <= event + self%margin(closest)
    if (strikes_at) self%strikes = self%strikes + 1
  end function strikes_at

  !> Saves or loads the clock.
  subroutine visit(self, archive, name)
    class(clock_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    !> Name of the clock
    character(len=*), intent(in) :: name

    call archive%item('clock/'//name, self%strikes)
  end subroutine visit
end module output_clocks
