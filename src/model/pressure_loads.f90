!> The pressure of the deck, and its history.
module pressure_loads
  use kinds, only: wp
  implicit none
  private
  public :: pressure_t

  !> Histories of the pressure: constant from the start, or proportional to time up to `value` at the end.
  integer, parameter, public :: history_step = 1, history_ramp = 2
  !> Distributions of the pressure over the plate: uniform, or one half-sine along each side.
  integer, parameter, public :: distribution_uniform = 1, distribution_sine = 2

  !> Pressure on the struck face.
  type :: pressure_t
    !> True: the deck has a pressure
    logical :: is_present = .false.
    !> Force per area, positive along z
    real(wp) :: value = 0
    !> history_step or history_ramp
    integer :: history = history_step
    !> Duration of a ramp
    real(wp) :: ramp_time = 0
    !> distribution_uniform or distribution_sine
    integer :: distribution = distribution_uniform
  contains
    procedure :: amplitude
  end type pressure_t

contains

  !> Pressure at a time over its full value.
  elemental real(wp) function amplitude(self, time)
    class(pressure_t), intent(in) :: self
    real(wp), intent(in) :: time

    amplitude = 1
    if (self%history == history_ramp) amplitude = time/self%ramp_time
  end function amplitude
end module pressure_loads
