!> Growth of the loads over a run: load steps, or ramps in time.
module loading_parameters
  use kinds, only: wp
  implicit none
  private
  public :: loading_t

  !> Load steps, or ramps in time.
  type :: loading_t
    !> True: load steps, each an equilibrium without inertia; false: motion in time
    logical :: by_steps = .false.
    !> Number of equal load steps
    integer :: steps = 1
    !> Dissipated energy at which load steps end; 0: load control throughout
    real(wp) :: dissipation = 0
    !> Start of the loads of lines in time, and duration of their ramps
    real(wp) :: start = 0, ramp_time = 1
  end type loading_t
end module loading_parameters
