!> Forcing terms of the inexact Newton method, theory (N3): reduction of the residual of the linear system in each
!> correction (S. C. Eisenstat, H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, choice 2).
module forcing_terms
  use kinds, only: wp
  use solution_controls, only: newton_controls_t
  implicit none
  private
  public :: forcing_term

contains

  !> Forcing term: reduction of the residual required of the next correction.
  pure real(wp) function forcing_term(controls, tolerance, norm, before) result(eta)
    !> Constants of Newton's method
    type(newton_controls_t), intent(in) :: controls
    !> Residual of equilibrium accepted, relative to the reference force
    real(wp), intent(in) :: tolerance
    !> Norm of the residual, and of that before the last correction; 0: there was none
    real(wp), intent(in) :: norm, before

    ! A correction that closes contacts can raise the residual to a thousand times the reference force.
    eta = controls%max_forcing_term/max(1.0_wp, norm)
    if (norm < before) eta = min(eta, controls%forcing_factor*(norm/before)**2)
    ! A residual within the tolerance needs no reduction; it may be zero.
    associate (target => controls%forcing_margin*tolerance)
      eta = min(max(eta, target/max(norm, target)), controls%forcing_factor)
    end associate
  end function forcing_term
end module forcing_terms
