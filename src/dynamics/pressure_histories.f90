!> How the pressure of the deck grows.
module pressure_histories
  use kinds, only: wp
  use dynamics_parameters, only: history_ramp
  use scenes, only: scene_t
  implicit none
  private
  public :: pressure_amplitude

contains

  !> Pressure at a time over its full value.
  pure real(wp) function pressure_amplitude(scene, time) result(amplitude)
    !> The scene
    type(scene_t), intent(in) :: scene
    !> Time
    real(wp), intent(in) :: time

    amplitude = 1
    if (scene%pressure%history == history_ramp) amplitude = time/scene%time%end
  end function pressure_amplitude
end module pressure_histories
