!> Plate by the alpha method of H. M. Hilber, T. J. R. Hughes and R. L. Taylor, Earthquake Engineering and Structural
!> Dynamics 5 (1977) 283-292: a member of the family of four coefficients, so it is defined by these.
module hht_integrators
  use kinds, only: wp
  use newmark_integrators, only: plate_integrator_t
  implicit none
  private
  public :: hht_integrator

contains

  !> The integrator with a damping, 0 (none) to 1/3.
  pure function hht_integrator(alpha) result(integrator)
    !> Weight of the forces at the start of the step
    real(wp), intent(in) :: alpha
    !> Coefficients
    type(plate_integrator_t) :: integrator

    integrator%alpha_m = 0
    integrator%alpha_f = alpha
    integrator%gamma = 0.5_wp + alpha
    integrator%beta = (1 + alpha)**2/4
  end function hht_integrator
end module hht_integrators
