!> Smooth ramps: a prescribed motion with such a ramp hardly excites vibrations (doc/theory/time_integration.md).
module smooth_starts
  use kinds, only: wp
  implicit none
  private
  public :: smooth_ramp, smooth_step

contains

  !> Step from 0 to 1 whose velocity and acceleration are 0 at both ends, 10 s^3 - 15 s^4 + 6 s^5, or a derivative.
  elemental real(wp) function smooth_step(s, order) result(value)
    !> Time over the duration of the ramp, 0 to 1
    real(wp), intent(in) :: s
    !> Order of the derivative, 0 to 2
    integer, intent(in) :: order

    value = 0
    if (s >= 1 .and. order == 0) value = 1
    if (s <= 0 .or. s >= 1) return
    select case (order)
    case (0)
      value = s**3*(10 - s*(15 - 6*s))
    case (1)
      value = 30*s**2*(1 - s)**2
    case default
      value = 60*s*(1 - s)*(1 - 2*s)
    end select
  end function smooth_step

  !> Ramp from 0 to 1 whose velocity rises as 3 s^2 - 2 s^3 and is then constant, or a derivative of it. Without a rise
  !> the velocity is constant from the beginning.
  elemental real(wp) function smooth_ramp(part, rise, order) result(value)
    !> Time over the duration of the run, 0 to 1, and fraction of the run in which the velocity rises
    real(wp), intent(in) :: part, rise
    !> Order of the derivative, 0 to 2
    integer, intent(in) :: order
    real(wp) :: s, velocity

    ! The rise covers half the distance of the full velocity.
    velocity = 1/(1 - rise/2)
    s = 1
    if (part < rise) s = max(part, 0.0_wp)/rise
    select case (order)
    case (0)
      value = velocity*(rise*s**3*(1 - s/2) + max(part - rise, 0.0_wp))
    case (1)
      value = velocity*s**2*(3 - 2*s)
    case default
      value = 0
      if (s < 1) value = velocity*6*s*(1 - s)/rise
    end select
  end function smooth_ramp
end module smooth_starts
