!> Growth criterion of an interface: energy release rate over toughness (Eq. 7 of the paper), with one toughness or with
!> the mixed-mode one of M. L. Benzeggagh and M. Kenane, Composites Science and Technology 56 (1996) 439-449; theory
!> (D1).
module benzeggagh_kenane
  use delamination_parameters, only: delamination_t
  use kinds, only: wp
  implicit none
  private
  public :: toughness_gain, critical_release_rate, release_ratio

contains

  !> Toughness of a mixture of modes minus that of opening, (G_IIc - G_Ic) B**eta, for fronts and for cohesive laws.
  elemental real(wp) function toughness_gain(opening, shear, exponent, share) result(gain)
    !> Toughness of pure opening and of pure shear
    real(wp), intent(in) :: opening, shear
    !> Exponent eta
    real(wp), intent(in) :: exponent
    !> Fraction B of shear in the energy
    real(wp), intent(in) :: share

    gain = share**exponent*(shear - opening)
  end function toughness_gain

  !> Critical energy release rate of a mixture of modes: G_c, or G_Ic + (G_IIc - G_Ic) (G_shear/G)**eta.
  pure real(wp) function critical_release_rate(delamination, modes) result(critical)
    !> Toughnesses of the interface
    type(delamination_t), intent(in) :: delamination
    !> Energy release rates G_I, G_II, G_III, not negative; only their ratios matter, zero rates count as opening
    real(wp), intent(in) :: modes(3)
    real(wp) :: shear

    critical = delamination%toughness
    if (critical > 0) return
    shear = 0
    if (sum(modes) > 0) shear = sum(modes(2:3))/sum(modes)
    associate (d => delamination)
      critical = d%toughness_opening + toughness_gain(d%toughness_opening, d%toughness_shear, d%mixing_exponent, shear)
    end associate
  end function critical_release_rate

  !> Energy release rate over the critical one: growth above 1.
  pure real(wp) function release_ratio(delamination, modes) result(ratio)
    !> Toughnesses of the interface
    type(delamination_t), intent(in) :: delamination
    !> Energy release rates G_I, G_II, G_III, none negative
    real(wp), intent(in) :: modes(3)
    ratio = sum(modes)/critical_release_rate(delamination, modes)
  end function release_ratio
end module benzeggagh_kenane
