!> Linear softening of stress over strain, from the onset of damage to failure, theory (M11).
module linear_softening
  use kinds, only: wp
  use ply_damage_parameters, only: fibre_tension
  implicit none
  private
  public :: softening_t, linear_softening_of, more_damaged, damage_at, damage_on_curve, dissipated_by, &
            fraction_growth, weights_of_signs

  !> Smallest ratio N of failure strain to onset strain: at 1 the stress would drop at once, and a longer element would
  !> snap back. At 1.25 the softening modulus is four times the elastic modulus. The check warns that such elements
  !> dissipate too much energy.
  real(wp), parameter, public :: min_ratio = 1.25_wp

  !> A linear softening law.
  type :: softening_t
    !> Exposure f, the strain relative to that at the onset
    real(wp) :: exposure = 0
    !> Strain at failure over that at the onset, N
    real(wp) :: ratio = huge(1.0_wp)
    !> Total energy dissipated per volume
    real(wp) :: energy = 0
    !> Mode to which the energy is assigned
    integer :: mode = fibre_tension
  end type softening_t

contains

  !> Fractions of tension and compression in the root mean square of a strain. They are those of two halves of the ply
  !> with the same mean and mean square, and change smoothly where the mean changes its sign.
  pure function weights_of_signs(mean, size) result(weights)
    !> Mean and root mean square
    real(wp), intent(in) :: mean, size
    !> Of tension and compression; their squares add up to 1
    real(wp) :: weights(2)
    real(wp) :: middle, spread

    weights = [1, 0]
    if (.not. size > tiny(size)) return
    middle = max(-1.0_wp, min(1.0_wp, mean/size))
    spread = sqrt(1 - middle**2)
    weights(1) = sqrt((max(0.0_wp, middle + spread)**2 + max(0.0_wp, middle - spread)**2)/2)
    weights(2) = sqrt((max(0.0_wp, -middle + spread)**2 + max(0.0_wp, -middle - spread)**2)/2)
  end function weights_of_signs

  !> The softening law with the larger damage.
  pure function more_damaged(signs)
    !> Tension and compression
    type(softening_t), intent(in) :: signs(2)
    type(softening_t) :: more_damaged

    more_damaged = signs(1)
    if (damage_at(signs(2)) > damage_at(signs(1))) more_damaged = signs(2)
  end function more_damaged

  !> Softening law of a mode, from the exposure and the strain energy of the undamaged material.
  pure function linear_softening_of(exposure, energy, toughness, length, mode) result(softening)
    !> Undamaged stress relative to the onset
    real(wp), intent(in) :: exposure
    !> Strain energy per volume of the undamaged material
    real(wp), intent(in) :: energy
    !> Energy per area of crack
    real(wp), intent(in) :: toughness
    !> Length of the element across the crack
    real(wp), intent(in) :: length
    !> The mode
    integer, intent(in) :: mode
    type(softening_t) :: softening

    softening%mode = mode
    softening%exposure = exposure
    if (.not. exposure > 1) return
    softening%ratio = max(min_ratio, toughness/length/(energy/exposure**2))
    softening%energy = softening%ratio*(energy/exposure**2)
  end function linear_softening_of

  !> Damage of a softening law.
  pure real(wp) function damage_at(softening) result(damage)
    type(softening_t), intent(in) :: softening

    damage = damage_on_curve(softening%exposure, softening%ratio)
  end function damage_at

  !> Damage between onset and failure: d = N (x - 1)/(x (N - 1)).
  pure real(wp) function damage_on_curve(x, ratio) result(damage)
    !> Strain or jump over that at the onset, and N, its value at failure
    real(wp), intent(in) :: x, ratio

    damage = 0
    if (x >= ratio) then
      damage = 1
    else if (x > 1) then
      damage = min(1.0_wp, ratio*(x - 1)/(x*(ratio - 1)))
    end if
  end function damage_on_curve

  !> Energy per volume dissipated by growing damage on a linear softening branch; 0: no growth.
  pure real(wp) function dissipated_by(softening, part, damage_from, damage_to) result(energy)
    type(softening_t), intent(in) :: softening
    !> Factor of the energy of the law, at most 1
    real(wp), intent(in) :: part
    !> Damage before and after
    real(wp), intent(in) :: damage_from, damage_to

    energy = 0
    if (damage_to > damage_from) energy = part*softening%energy*fraction_growth(softening%ratio, damage_from, damage_to)
  end function dissipated_by

  !> Increment of the dissipated fraction d/(N (1 - d) + d) with the damage, without cancellation for small increments.
  pure real(wp) function fraction_growth(ratio, damage_from, damage_to) result(growth)
    !> N
    real(wp), intent(in) :: ratio
    !> Damage before and after
    real(wp), intent(in) :: damage_from, damage_to
    real(wp) :: from, to

    from = ratio*(1 - damage_from) + damage_from
    to = ratio*(1 - damage_to) + damage_to
    growth = ratio*(damage_to - damage_from)/(from*to)
  end function fraction_growth
end module linear_softening
