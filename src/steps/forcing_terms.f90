!> Forcing terms of the inexact Newton method: how far the linear system of each correction is solved (S. C. Eisenstat,
!> H. F. Walker, SIAM J. Sci. Comput. 17 (1996) 16-32, choice 2).
module forcing_terms
  use kinds, only: wp
  implicit none
  private
  public :: forcing_term

  !> Largest forcing term, and the factor of the squared ratio of the last residuals that gives the next one.
  real(wp), parameter :: max_forcing_term = 1.0e-3_wp, forcing_factor = 0.9_wp
  !> Part of the tolerance to which the last linear system is solved: more would gain nothing.
  real(wp), parameter :: tolerance_margin = 0.3_wp

contains

  !> Forcing term: reduction of the residual required of the next correction.
  pure real(wp) function forcing_term(tolerance, norm, before) result(left)
    !> Residual of equilibrium accepted, relative to the reference force
    real(wp), intent(in) :: tolerance
    !> Norm of the residual, and of that before the last correction; 0: there was none
    real(wp), intent(in) :: norm, before

    ! After a correction that closes contacts their forces may be a thousand times the reference force.
    left = max_forcing_term/max(1.0_wp, norm)
    if (norm < before) left = min(left, forcing_factor*(norm/before)**2)
    ! A residual within the tolerance may be left whole; it can be zero.
    associate (enough => tolerance_margin*tolerance)
      left = min(max(left, enough/max(norm, enough)), forcing_factor)
    end associate
  end function forcing_term
end module forcing_terms
