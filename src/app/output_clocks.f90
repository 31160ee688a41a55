!> Output times: steps land on them exactly.
module output_clocks
  use kinds, only: wp
  use archives, only: archive_t
  implicit none
  private
  public :: clock_t

  !> A clock that strikes at every multiple of an interval.
  type :: clock_t
    !> Interval; 0: the clock never strikes
    real(wp) :: interval = 0
    !> Strikes so far
    integer :: impact_coupling = 0
  contains
    !> Time of the next strike.
    procedure :: next
    !> True, once, when a strike has been reached.
    procedure :: strikes_at
    !> Saves or loads the clock.
    procedure :: visit
  end type clock_t

contains

  !> Time of the next strike; huge if there is none.
  pure real(wp) function next(self)
    !> The clock
    class(clock_t), intent(in) :: self

    next = huge(next)
    if (self%interval > 0) next = self%interval*(self%impact_coupling + 1)
  end function next

  !> True if the next strike has been reached, which is then past.
  logical function strikes_at(self, time)
    !> The clock
    class(clock_t), intent(inout) :: self
    !> Time reached
    real(wp), intent(in) :: time

    strikes_at = time >= self%next()*(1 - 1.0e-12_wp)
    if (strikes_at) self%impact_coupling = self%impact_coupling + 1
  end function strikes_at

  !> Saves or loads the clock.
  subroutine visit(self, archive, name)
    !> The clock
    class(clock_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    !> Name of the clock
    character(len=*), intent(in) :: name

    call archive%item('clock/'//name, self%impact_coupling)
  end subroutine visit
end module output_clocks
