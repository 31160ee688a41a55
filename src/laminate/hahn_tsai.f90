!> Nonlinear in-plane shear of a ply, theory (M18) to (M20): the strain is s12/G12 + beta s12**3 (H. T. Hahn, S. W.
!> Tsai, Journal of Composite Materials 7 (1973) 102-118). Unloading either leads back to the origin, so that the loss
!> of shear stiffness is permanent, or has the initial modulus, so that beta s12**3 remains as a permanent strain.
module hahn_tsai
  use kinds, only: wp
  implicit none
  private
  public :: shear_coefficient, shear_loss, energy_of_loss, shear_flow, energy_of_flow

contains

  !> Coefficient beta with which the strength is reached at a given strain; 0: the strain is not given, or shear is
  !> linear.
  elemental real(wp) function shear_coefficient(modulus, strength, strain) result(beta)
    !> G12, S12 and the shear strain at S12; 0: not given
    real(wp), intent(in) :: modulus, strength, strain

    beta = 0
    if (strain > 0 .and. strength > 0) beta = max(0.0_wp, (strain - strength/modulus)/strength**3)
  end function shear_coefficient

  !> Fraction of the shear modulus lost at a strain: 1 - s12/(G12 g12).
  elemental real(wp) function shear_loss(modulus, beta, strain) result(loss)
    !> G12 without loss and the coefficient
    real(wp), intent(in) :: modulus, beta
    !> Shear strain, not negative
    real(wp), intent(in) :: strain
    real(wp) :: scale, ratio

    loss = 0
    if (.not. (beta > 0 .and. strain > 0)) return
    scale = 1/sqrt(beta*modulus)
    ratio = cubic_root(modulus*strain/scale)
    loss = ratio**2/(1 + ratio**2)
  end function shear_loss

  !> Root x of x + x**3 = sum, by Cardano's formula without cancellation.
  elemental real(wp) function cubic_root(sum) result(root)
    !> Not negative
    real(wp), intent(in) :: sum

    root = 2/sqrt(3.0_wp)*sinh(asinh(1.5_wp*sqrt(3.0_wp)*sum)/3)
  end function cubic_root

  !> Permanent shear strain after a strain, by isotropic hardening: elastic with the initial modulus up to the stress
  !> (p/beta)**(1/3) in either direction, where p is the sum of the magnitudes of all previous changes of the permanent
  !> strain; beyond it along the curve. Return mapping by backward Euler, exact for shear in one direction.
  elemental subroutine shear_flow(modulus, beta, strain, permanent, accumulated)
    !> G12 and the coefficient, above 0
    real(wp), intent(in) :: modulus, beta
    !> Shear strain
    real(wp), intent(in) :: strain
    !> Permanent strain with its sign, and the sum p of the magnitudes of its changes
    real(wp), intent(inout) :: permanent, accumulated
    real(wp) :: trial, scale, growth

    trial = abs(strain - permanent)
    ! Elastic if beta (G trial)**3 <= p; no root is needed.
    if (beta*(modulus*trial)**3 <= accumulated) return
    ! The stress t at which t/G + beta t**3 = trial + p.
    scale = 1/sqrt(beta*modulus)
    growth = max(0.0_wp, trial - scale*cubic_root(modulus*(trial + accumulated)/scale)/modulus)
    permanent = permanent + sign(growth, strain - permanent)
    accumulated = accumulated + growth
  end subroutine shear_flow

  !> Energy per volume dissipated by permanent strains: the integral of (p/beta)**(1/3) over p.
  elemental real(wp) function energy_of_flow(beta, accumulated) result(energy)
    !> The coefficient, above 0
    real(wp), intent(in) :: beta
    !> Sum p of the magnitudes of the changes of the permanent strain
    real(wp), intent(in) :: accumulated

    energy = 0.75_wp*accumulated*(accumulated/beta)**(1/3.0_wp)
  end function energy_of_flow

  !> Energy per volume dissipated by a loss of the modulus: beta s12**4/4.
  elemental real(wp) function energy_of_loss(modulus, beta, loss) result(energy)
    !> G12 without loss and the coefficient
    real(wp), intent(in) :: modulus, beta
    !> Lost fraction of the modulus
    real(wp), intent(in) :: loss

    energy = 0
    if (beta > 0) energy = (loss/(1 - loss))**2/(4*modulus**2*beta)
  end function energy_of_loss
end module hahn_tsai
