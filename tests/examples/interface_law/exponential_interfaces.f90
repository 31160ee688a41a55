!> Exponential cohesive law of M. Ortiz and A. Pandolfi, International Journal for Numerical Methods in Engineering 44
!> (1999) 1267-1282: traction rises and falls smoothly with one effective jump, and unloads linearly to the origin.
!>
!> Jumps and tractions are in the order of the unknowns of a lower layer: two shears, opening. Closing faces are left
!> to contact.
module exponential_interfaces
  use kinds, only: wp
  implicit none
  private
  public :: exponential_law_t, interface_point_t, traction_of, secant_stiffness, stored_energy, dissipated_energy

  !> Base of the natural logarithm.
  real(wp), parameter :: e = exp(1.0_wp)

  !> The law of one interface.
  type :: exponential_law_t
    !> Toughness G_c, energy per area
    real(wp) :: toughness = 0
    !> Largest traction in pure opening
    real(wp) :: strength = 0
    !> Weight of shears in the effective jump
    real(wp) :: shear_weight = 1
  end type exponential_law_t

  !> History variables of a point; changed only when a step is accepted.
  type :: interface_point_t
    !> Largest effective jump so far over the jump at the strength
    real(wp) :: reach = 0
  end type interface_point_t

contains

  !> Traction of trial jumps, the trial history variables of the point, and the derivative of the traction.
  pure subroutine traction_of(law, jumps, old, traction, new, tangent)
    !> The law
    type(exponential_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point in the last accepted state
    type(interface_point_t), intent(in) :: old
    !> Traction: force per area that resists the jumps
    real(wp), intent(out) :: traction(3)
    !> The point with these jumps
    type(interface_point_t), intent(out) :: new
    !> Derivative of the traction by the jumps, symmetric
    real(wp), intent(out) :: tangent(3, 3)
    real(wp) :: weighted(3), stiffness(3), jump
    integer :: i

    weighted = weights(law, jumps)*jumps
    jump = sqrt(dot_product(weighted, jumps))
    new%reach = max(old%reach, jump/jump_at_strength(law))
    stiffness = secant_stiffness(law, new)*weights(law, jumps)
    traction = stiffness*jumps
    tangent = 0
    do i = 1, 3
      tangent(i, i) = stiffness(i)
    end do
    if (.not. new%reach > old%reach) return
    ! Loading: the secant stiffness decreases with the jump.
    do i = 1, 3
      tangent(:, i) = tangent(:, i) - secant_stiffness(law, new)*weighted*weighted(i)/(jump*jump_at_strength(law))
    end do
  end subroutine traction_of

  !> Traction over effective jump in unloading to the origin: the contribution of a point to the operator's diagonal.
  pure real(wp) function secant_stiffness(law, point) result(stiffness)
    !> The law
    type(exponential_law_t), intent(in) :: law
    !> The point
    type(interface_point_t), intent(in) :: point

    stiffness = e*law%strength/jump_at_strength(law)*exp(-point%reach)
  end function secant_stiffness

  !> Energy per area that the jumps would return.
  pure real(wp) function stored_energy(law, jumps, point) result(energy)
    !> The law
    type(exponential_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(interface_point_t), intent(in) :: point

    energy = secant_stiffness(law, point)*sum(weights(law, jumps)*jumps**2)/2
  end function stored_energy

  !> Energy per area that the point has dissipated: all work so far less the stored energy.
  pure real(wp) function dissipated_energy(law, point) result(energy)
    !> The law
    type(exponential_law_t), intent(in) :: law
    !> The point
    type(interface_point_t), intent(in) :: point

    energy = law%toughness*(1 - (1 + point%reach + point%reach**2/2)*exp(-point%reach))
  end function dissipated_energy

  !> Effective jump at which the traction is largest: the area under the curve is the toughness.
  pure real(wp) function jump_at_strength(law) result(jump)
    !> The law
    type(exponential_law_t), intent(in) :: law

    jump = law%toughness/(e*law%strength)
  end function jump_at_strength

  !> Weight of the square of each jump; zero for a closed opening.
  pure function weights(law, jumps) result(values)
    !> The law
    type(exponential_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> The weights
    real(wp) :: values(3)

    values = [law%shear_weight, law%shear_weight, merge(1.0_wp, 0.0_wp, jumps(3) > 0)]
  end function weights
end module exponential_interfaces
