!> Contact of two delaminated faces at one node: pressure against gap, frictionless.
!>
!> Both methods hold an estimate of the pressure, the multiplier, while the equations of motion are solved
!> with the pressure's dependence on the gap; the outer loop then takes the pressure found as the next
!> multiplier until the gap closes exactly where there is pressure. (Eq. 13a of the paper taken as a fixed
!> point diverges for most stiffnesses.) A converged state is the same for any stiffness and method.
module face_contact
  use delamination_parameters, only: contact_augmented_lagrangian, contact_continuous_penalty, contact_none
  use kinds, only: wp
  implicit none
  private
  public :: contact_law_t, create_contact_law, contact_pressure, updated_multiplier, pressure_decay

  !> Stiffness of the contact over the transverse stiffness of the layers. On random and plate-like
  !> compliances of 40 nodes a factor of 1 left 40 to over 80 factorisations, 100 about 5 multiplier updates
  !> and 10 factorisations, 1000 to 1e6 2 to 5 updates and 4 to 10 (augmented Lagrangian; the continuous
  !> penalty with q = 1 the same updates and 4 to 14). With q = 1.5 most cases had not converged after 80 updates.
  real(wp), parameter :: stiffness_factor = 1.0e6_wp
  !> Decay of the pressure times the mean gap (section 3.4 of the paper).
  real(wp), parameter :: decay_factor = 1.5_wp
  !> A pressure below this part of stiffness times gap is none: the faces are clearly open.
  real(wp), parameter :: open_fraction = 1.0e-9_wp

  !> Pressure against gap.
  type :: contact_law_t
    !> contact_augmented_lagrangian, contact_continuous_penalty or contact_none
    integer :: method = contact_augmented_lagrangian
    !> Pressure per length of penetration
    real(wp) :: stiffness = 0
    !> Exponent q of Eq. 12; 1 makes the pressure's slope continuous
    real(wp) :: exponent = 1
    !> Penetration at which the pressure of any exponent is stiffness times penetration
    real(wp) :: length = 1
    !> Least decay beta of the pressure with an open gap, 1/length (Eq. 12)
    real(wp) :: decay = 0
  end type contact_law_t

contains

  !> A law for an interface.
  pure function create_contact_law(method, exponent, transverse_stiffness, thickness) result(law)
    !> contact_augmented_lagrangian, contact_continuous_penalty or contact_none
    integer, intent(in) :: method
    !> Exponent q of Eq. 12
    real(wp), intent(in) :: exponent
    !> Transverse stiffness of the layers: modulus across the plies over the thickness of the thinner layer
    real(wp), intent(in) :: transverse_stiffness
    !> Thickness of the thinner layer
    real(wp), intent(in) :: thickness
    !> The law, its decay not yet set
    type(contact_law_t) :: law

    law%method = method
    law%exponent = exponent
    law%stiffness = stiffness_factor*transverse_stiffness
    law%length = thickness
  end function create_contact_law

  !> Decay of the pressure that suits the open gaps (section 3.4 of the paper, where it is printed as
  !> proportional to the mean gap; it is inversely so).
  pure real(wp) function pressure_decay(mean_gap) result(decay)
    !> Mean of the gaps that are open; 0: none is
    real(wp), intent(in) :: mean_gap

    decay = 0
    if (mean_gap > tiny(mean_gap)*decay_factor) decay = decay_factor/mean_gap
  end function pressure_decay

  !> Pressure and its derivative by the gap. Pressure never pulls.
  elemental subroutine contact_pressure(law, gap, multiplier, pressure, slope)
    !> The law
    type(contact_law_t), intent(in) :: law
    !> Gap, positive when open
    real(wp), intent(in) :: gap
    !> Estimate of the pressure, not negative
    real(wp), intent(in) :: multiplier
    !> Pressure
    real(wp), intent(out) :: pressure
    !> Derivative of the pressure by the gap, not positive
    real(wp), intent(out) :: slope

    if (law%method == contact_continuous_penalty) then
      call continuous_pressure(law, gap, multiplier, pressure, slope)
    else if (law%method == contact_none) then
      pressure = 0
      slope = 0
    else
      pressure = max(0.0_wp, multiplier - law%stiffness*gap)
      slope = merge(-law%stiffness, 0.0_wp, pressure > 0)
    end if
  end subroutine contact_pressure

  !> Eq. 12, with an exponential tail where the gap is open. With the exponent 1 the slopes on both sides
  !> of the closed gap are made equal by the larger of the two stiffnesses, k and beta times multiplier.
  elemental subroutine continuous_pressure(law, gap, multiplier, pressure, slope)
    !> The law
    type(contact_law_t), intent(in) :: law
    !> Gap, positive when open
    real(wp), intent(in) :: gap
    !> Estimate of the pressure, not negative
    real(wp), intent(in) :: multiplier
    !> Pressure
    real(wp), intent(out) :: pressure
    !> Derivative of the pressure by the gap, not positive
    real(wp), intent(out) :: slope
    real(wp) :: closing

    closing = law%decay*multiplier
    if (law%exponent == 1) closing = max(closing, law%stiffness)
    if (gap >= 0) then
      pressure = 0
      slope = 0
      if (.not. closing*gap < -log(tiny(gap))*multiplier) return
      pressure = multiplier*exp(-closing*gap/multiplier)
      slope = -closing*pressure/multiplier
    else if (law%exponent == 1) then
      pressure = multiplier - closing*gap
      slope = -closing
    else
      pressure = multiplier + law%stiffness*law%length*(-gap/law%length)**law%exponent
      slope = -law%exponent*law%stiffness*(-gap/law%length)**(law%exponent - 1)
    end if
  end subroutine continuous_pressure

  !> The next multiplier: the pressure found, or nothing where the faces are clearly open.
  elemental real(wp) function updated_multiplier(law, gap, multiplier) result(updated)
    !> The law
    type(contact_law_t), intent(in) :: law
    !> Gap that was found with the multiplier
    real(wp), intent(in) :: gap
    !> Multiplier it was found with
    real(wp), intent(in) :: multiplier
    real(wp) :: slope

    call contact_pressure(law, gap, multiplier, updated, slope)
    if (updated < open_fraction*law%stiffness*gap) updated = 0
  end function updated_multiplier
end module face_contact
