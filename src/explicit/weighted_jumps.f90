!> Jumps of interfaces at whole steps as weighted means of four.
!>
!> With the traction k J_n the stiffness of an interface would limit the step; with k J_(n+1) a spring dissipates k
!> dJ**2 in each step. Instead the traction is k times a mean of J_(n+1), J_n, J_(n-1) and J_(n-2), theory (T9), which
!> differs from J_n by terms of second order. The polynomial of the weights has the roots -r, -r and -q, so that motions
!> of springs too stiff for the step decay by a factor r per step, and slow motions dissipate in proportion to the third
!> power of the step. The conditions are derived in doc/theory/time_integration.md.
module weighted_jumps
  use element_batches, only: lanes
  use kinds, only: wp
  implicit none
  private
  public :: memory, newest, past_weights, past_jumps, past_openings

  !> Factor per step by which motions of stiff springs decay, the spectral radius. With 0.5 and 0.8 instead of 0.9
  !> `energy_algorithmic` is up to 3 and 1.5 times larger, with the same areas and forces
  !> (doc/studies/central_differences.md).
  real(wp), parameter :: r = 0.9_wp
  !> The third root, which gives weights without a first moment
  real(wp), parameter :: q = (1 - r)/(2*r)
  !> Weights of the jumps at the end of the step, at its start, and at the starts of the two steps before
  real(wp), parameter :: weights(0:3) = [1.0_wp, 2*r + q, r**2 + 2*r*q, r**2*q]/((1 + r)**2*(1 + q))
  !> Weight of the jumps at the end of the step
  real(wp), parameter :: newest = weights(0)
  !> Contribution of earlier jumps to the weighted mean: factor of the jump at the start of the step, and minus those of
  !> its changes in the two steps before
  real(wp), parameter :: past_weights(3) = [1 - weights(0), weights(2) + weights(3), weights(3)]
  !> Number of steps whose forces depend on a jump
  integer, parameter :: memory = size(weights)

contains

  !> Contribution of earlier jumps to the weighted mean.
  pure function past_jumps(start, change, earlier) result(past)
    !> Jump at the start of the step, its change in the step before, and its change in the step before that
    real(wp), dimension(lanes), intent(in) :: start, change, earlier
    !> One for each lane
    real(wp) :: past(lanes)

    past = past_weights(1)*start - past_weights(2)*change - past_weights(3)*earlier
  end function past_jumps

  !> The same for openings. Negative openings are carried by contact and do not contribute.
  pure function past_openings(start, change, earlier) result(past)
    !> Opening at the start of the step, its change in the step before, and its change in the step before that
    real(wp), dimension(lanes), intent(in) :: start, change, earlier
    !> One for each lane
    real(wp) :: past(lanes)

    past = weights(1)*max(0.0_wp, start) + weights(2)*max(0.0_wp, start - change) &
           + weights(3)*max(0.0_wp, start - change - earlier)
  end function past_openings
end module weighted_jumps
