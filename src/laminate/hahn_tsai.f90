!> Shear in the plane of a ply whose strain grows faster than its stress: s12/G12 + beta s12**3 (H. T. Hahn, S. W. Tsai,
!> Journal of Composite Materials 7 (1973) 102-118). Unloading leads back to the origin, so that what stiffness the
!> shear has lost stays lost.
module hahn_tsai
  use kinds, only: wp
  implicit none
  private
  public :: shear_coefficient, shear_loss, energy_of_loss

contains

  !> Coefficient beta with which a strength is reached at a strain; 0: the strain is not given, or shear is linear.
  elemental real(wp) function shear_coefficient(modulus, strength, strain) result(beta)
    !> G12, S12 and the shear strain at S12; 0: not given
    real(wp), intent(in) :: modulus, strength, strain

    beta = 0
    if (strain > 0 .and. strength > 0) beta = max(0.0_wp, (strain - strength/modulus)/strength**3)
  end function shear_coefficient

  !> Part of the shear modulus that a strain takes: 1 - s12/(G12 g12).
  elemental real(wp) function shear_loss(modulus, beta, strain) result(loss)
    !> G12 without loss and the coefficient
    real(wp), intent(in) :: modulus, beta
    !> Shear strain, not negative
    real(wp), intent(in) :: strain
    real(wp) :: scale, ratio

    loss = 0
    if (.not. (beta > 0 .and. strain > 0)) return
    ! The real root of ratio + ratio**3 = modulus strain/scale, by Cardano's formula without cancellation.
    scale = 1/sqrt(beta*modulus)
    ratio = 2/sqrt(3.0_wp)*sinh(asinh(1.5_wp*sqrt(3.0_wp)*modulus*strain/scale)/3)
    loss = ratio**2/(1 + ratio**2)
  end function shear_loss

  !> Energy per volume that a loss has taken: beta s12**4/4.
  elemental real(wp) function energy_of_loss(modulus, beta, loss) result(energy)
    !> G12 without loss and the coefficient
    real(wp), intent(in) :: modulus, beta
    !> Part of the modulus that is lost
    real(wp), intent(in) :: loss

    energy = 0
    if (beta > 0) energy = (loss/(1 - loss))**2/(4*modulus**2*beta)
  end function energy_of_loss
end module hahn_tsai
