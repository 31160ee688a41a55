!> Contact of two delaminated surfaces at one node: pressure against gap, frictionless, theory (D11) to (D13).
!>
!> Both methods keep an estimate of the pressure, the multiplier, constant while the equations of motion are solved with
!> the pressure as a function of the gap. The outer loop sets the multiplier to this pressure until the gap is zero
!> wherever there is pressure. (Eq. 13a of the paper as a fixed-point iteration diverges for most stiffnesses.) A
!> converged state is the same for any stiffness and method.
!>
!> Eq. 12 as printed has a kink at gap 0, about which Newton's method oscillates for exponents above 1. Here the slope
!> of the pressure at gap 0 is the same on both sides, as the paper states ("first-order continuous"): the pressure is
!> then convex, and Newton's method converges monotonically.
module surface_contact
  use delamination_parameters, only: contact_augmented_lagrangian, contact_continuous_penalty, contact_none
  use kinds, only: wp
  implicit none
  private
  public :: contact_law_t, create_contact_law, contact_pressure, updated_multiplier, updated_decay, contact_residual

  !> Stiffness of the contact over the transverse stiffness of the layers. On random and plate-like compliance matrices
  !> of 40 nodes a ratio of 1 required 40 to over 80 factorizations, 100 about 5 multiplier updates and 10
  !> factorizations, 1000 to 1e6 2 to 5 updates and 4 to 10 factorizations (augmented Lagrangian; the continuous penalty
  !> with q = 1 the same updates and 4 to 14 factorizations, with q = 1.5 2 to 4 updates and 15 to 30).
  real(wp), parameter :: usual_stiffness = 1.0e3_wp
  !> The same for the augmented Lagrangian in steps in time, where pressures change little from step to step: the gaps
  !> are then so small that the first pressures found usually need no update. A factor of ten either way changes the
  !> cost of impacts by 1 to 12 % and the force by less than .001 % (doc/studies/solution_controls.md).
  real(wp), parameter :: moving_stiffness = 2.0e6_wp
  !> Product of the decay of the pressure and the mean gap (section 3.4 of the paper, theory (D13)).
  real(wp), parameter :: decay_factor = 1.5_wp
  !> Largest ratio of the slope of the exponential tail to the stiffness: the effect of round-off of the gap is still
  !> below the error of the pressures. A factor of ten either way has no effect (doc/studies/solution_controls.md).
  real(wp), parameter :: max_tail_slope = 1.0e5_wp
  !> Surfaces are open where the pressure is below this fraction of stiffness times gap. A factor of ten either way has
  !> no effect (doc/studies/solution_controls.md).
  real(wp), parameter :: open_fraction = 1.0e-9_wp

  !> Pressure against gap.
  type :: contact_law_t
    !> contact_augmented_lagrangian, contact_continuous_penalty or contact_none
    integer :: method = contact_augmented_lagrangian
    !> Transverse stiffness of the layers, pressure per length: through-thickness modulus over the thickness of the
    !> thinner layer
    real(wp) :: layer_stiffness = 0
    !> Pressure per length of penetration
    real(wp) :: stiffness = 0
    !> Exponent q of Eq. 12; 1 makes the pressure's slope continuous
    real(wp) :: exponent = 1
    !> Penetration at which the pressure of any exponent is stiffness times penetration
    real(wp) :: length = 1
  end type contact_law_t

contains

  !> A law for an interface.
  pure function create_contact_law(method, exponent, transverse_stiffness, thickness, moving) result(law)
    !> contact_augmented_lagrangian, contact_continuous_penalty or contact_none
    integer, intent(in) :: method
    !> Exponent q of Eq. 12
    real(wp), intent(in) :: exponent
    !> Transverse stiffness of the layers: through-thickness modulus over the thickness of the thinner layer
    real(wp), intent(in) :: transverse_stiffness
    !> Thickness of the thinner layer
    real(wp), intent(in) :: thickness
    !> True for steps in time, false for load steps
    logical, intent(in) :: moving
    type(contact_law_t) :: law

    law%method = method
    law%exponent = exponent
    law%layer_stiffness = transverse_stiffness
    law%stiffness = usual_stiffness*transverse_stiffness
    if (moving .and. method == contact_augmented_lagrangian) law%stiffness = moving_stiffness*transverse_stiffness
    law%length = thickness
  end function create_contact_law

  !> Decay for given gaps: 1.5 over the mean gap weighted by the pressures (section 3.4 of the paper prints it as
  !> proportional to the mean gap). The unweighted mean is dominated by widely open surfaces; with it most pressures had
  !> not converged after 80 updates. The weighted mean decreases as surfaces under pressure close, and 2 to 6 updates
  !> suffice, in load steps and in steps in time. A new step starts with the slope of the tail equal to the contact
  !> stiffness.
  elemental real(wp) function updated_decay(law, gaps, pressures, largest_pressure, converged) result(decay)
    type(contact_law_t), intent(in) :: law
    !> Sums over the surfaces of area times pressure times size of the gap, and of area times pressure
    real(wp), intent(in) :: gaps, pressures
    !> Largest pressure
    real(wp), intent(in) :: largest_pressure
    !> True: the pressures agree with the gaps, the step has converged
    logical, intent(in) :: converged

    decay = 0
    if (.not. largest_pressure > 0) return
    decay = law%stiffness/largest_pressure
    if (converged) return
    decay = max_tail_slope*decay
    if (gaps*decay > decay_factor*pressures) decay = decay_factor*pressures/gaps
  end function updated_decay

  !> Violation of complementarity: the smaller of the pressure and the pressure that would close the gap by compression
  !> of the layers.
  elemental real(wp) function contact_residual(law, gap, pressure) result(mismatch)
    type(contact_law_t), intent(in) :: law
    !> Gap, positive when open
    real(wp), intent(in) :: gap
    !> Pressure, not negative
    real(wp), intent(in) :: pressure

    mismatch = abs(min(pressure, law%layer_stiffness*gap))
  end function contact_residual

  !> Pressure and its derivative with respect to the gap. The pressure is not negative.
  elemental subroutine contact_pressure(law, decay, gap, multiplier, pressure, slope)
    type(contact_law_t), intent(in) :: law
    !> Decay beta of the pressure with an open gap, 1/length (Eq. 12); the augmented Lagrangian has none
    real(wp), intent(in) :: decay
    !> Gap, positive when open
    real(wp), intent(in) :: gap
    !> Estimate of the pressure, not negative
    real(wp), intent(in) :: multiplier
    !> Pressure
    real(wp), intent(out) :: pressure
    !> Derivative of the pressure with respect to the gap, not positive
    real(wp), intent(out) :: slope

    if (law%method == contact_continuous_penalty) then
      call continuous_pressure(law, decay, gap, multiplier, pressure, slope)
    else if (law%method == contact_none) then
      pressure = 0
      slope = 0
    else
      pressure = max(0.0_wp, multiplier - law%stiffness*gap)
      slope = merge(-law%stiffness, 0.0_wp, pressure > 0)
    end if
  end subroutine contact_pressure

  !> Eq. 12, with an exponential tail where the gap is open. The slope at the closed gap is beta times multiplier
  !> on both sides, with the exponent 1 the larger of it and of k.
  elemental subroutine continuous_pressure(law, decay, gap, multiplier, pressure, slope)
    type(contact_law_t), intent(in) :: law
    !> Decay beta
    real(wp), intent(in) :: decay
    !> Gap, positive when open
    real(wp), intent(in) :: gap
    !> Estimate of the pressure, not negative
    real(wp), intent(in) :: multiplier
    !> Pressure
    real(wp), intent(out) :: pressure
    !> Derivative of the pressure with respect to the gap, not positive
    real(wp), intent(out) :: slope
    real(wp) :: closing

    closing = decay*multiplier
    if (law%exponent == 1) closing = max(closing, law%stiffness)
    if (gap >= 0) then
      pressure = 0
      slope = 0
      if (.not. closing*gap < -log(tiny(gap))*multiplier) return
      pressure = multiplier*exp(-closing*gap/multiplier)
      slope = -closing*pressure/multiplier
    else
      pressure = multiplier - closing*gap
      slope = -closing
      if (law%exponent == 1) return
      pressure = pressure + law%stiffness*law%length*(-gap/law%length)**law%exponent
      slope = slope - law%exponent*law%stiffness*(-gap/law%length)**(law%exponent - 1)
    end if
  end subroutine continuous_pressure

  !> The next multiplier: the pressure found, or zero where the surfaces are open.
  elemental real(wp) function updated_multiplier(law, gap, pressure) result(updated)
    type(contact_law_t), intent(in) :: law
    !> Gap
    real(wp), intent(in) :: gap
    !> Pressure found with the gap
    real(wp), intent(in) :: pressure

    updated = pressure
    if (updated < open_fraction*law%stiffness*gap) updated = 0
  end function updated_multiplier
end module surface_contact
