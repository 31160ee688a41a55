!> One point of a cohesive interface: traction against the jumps between its surfaces, damage, energies.
!>
!> Components are ordered as: two shears along the interface, opening. A negative opening counts as zero and is subject
!> to contact. Finite jumps of any size cause no overflow.
module cohesive_points
  use benzeggagh_kenane, only: toughness_gain
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use surface_friction, only: sliding_t
  use kinds, only: wp
  use linear_softening, only: damage_on_curve, fraction_growth
  use roundings, only: rounding
  implicit none
  private
  public :: cohesive_point_t, separation_t, cohesive_traction, separation_of, grown_damage, may_grow, point_class, &
            opened, undamaged_energy, stored_energy, mode_mixture, dissipated_fraction, damage_at_fraction

  !> Classes of points: undamaged, damaged without growth, with growing damage in this state, failed.
  integer, parameter, public :: point_intact = 0, point_damaged = 1, point_growing = 2, point_failed = 3

  !> History variables of a point of the interface, changed only when a step is accepted.
  type :: cohesive_point_t
    !> Damage d, the lost fraction of the stiffness: 0 intact, 1 failed
    real(wp) :: damage = 0
    !> Energy dissipated per area, e
    real(wp) :: dissipated = 0
    !> Friction of its surfaces
    type(sliding_t) :: sliding
  end type cohesive_point_t

  !> Position of a jump on the curve of traction against separation.
  type :: separation_t
    !> Largest component of the jumps, closing taken as zero
    real(wp) :: size = 0
    !> The jumps divided by this size
    real(wp) :: unit(3) = 0
    !> Energy per area of the undamaged interface under these normalised jumps, and its fraction of shear B
    real(wp) :: unit_energy = 0, shear_share = 0
    !> Toughness G_c of this mixture of modes
    real(wp) :: toughness = 0
    !> Jump over the jump at the onset, x, at most N
    real(wp) :: ratio = 0
  end type separation_t

contains

  !> Traction of trial jumps, and the history variables of the trial state.
  pure subroutine cohesive_traction(law, jumps, old, traction, new)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Force per area against the jumps; normal component zero in closing
    real(wp), intent(out) :: traction(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(out) :: new
    type(separation_t) :: separation

    new%damage = old%damage
    new%dissipated = old%dissipated
    if (may_grow(law, jumps, old)) then
      separation = separation_of(law, jumps)
      new%damage = grown_damage(law, separation, old)
      new%dissipated = old%dissipated + separation%toughness*fraction_growth(law%failure_ratio, old%damage, new%damage)
    end if
    traction = ((1 - new%damage)*stiffness_of(law))*opened(jumps)
  end subroutine cohesive_traction

  !> Position of jumps on the curve: x = sqrt(N Y/G_c), theory (D2).
  pure function separation_of(law, jumps) result(separation)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    !> Position on the curve
    type(separation_t) :: separation
    real(wp) :: size, s1, s2, n, shear, energy, share, unit_ratio, toughness

    ! Scalars, since arrays and components take five times as long.
    toughness = law%toughness_opening
    separation%toughness = toughness
    size = max(abs(jumps(1)), abs(jumps(2)), jumps(3))
    if (.not. size > 0) return
    s1 = jumps(1)/size
    s2 = jumps(2)/size
    n = max(jumps(3), 0.0_wp)/size
    shear = law%stiffness_shear*(s1**2 + s2**2)/2
    energy = shear + law%stiffness_opening*n**2/2
    share = shear/energy
    ! The power is the most expensive operation.
    if (share > 0 .and. abs(law%toughness_shear - law%toughness_opening) > 0) &
      toughness = toughness*(1 + toughness_gain(1.0_wp, law%toughness_shear/law%toughness_opening, &
                                                law%mixing_exponent, share))
    unit_ratio = sqrt(law%failure_ratio*energy/toughness)
    separation%size = size
    separation%unit = [s1, s2, n]
    separation%unit_energy = energy
    separation%shear_share = share
    separation%toughness = toughness
    ! No product beyond failure, where very large jumps would cause overflow. NaN is passed on.
    if (size >= law%failure_ratio/unit_ratio) then
      separation%ratio = law%failure_ratio
    else
      separation%ratio = size*unit_ratio
    end if
  end function separation_of

  !> False where trial jumps certainly do not increase the damage: N Y = x**2 G_c on the curve, and the toughness of a
  !> mixture of modes is at least that of the weaker pure mode. It saves the power of the mixture.
  pure logical function may_grow(law, jumps, old)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    real(wp) :: ratio

    may_grow = old%damage < 1
    ! The energy of larger jumps could exceed the range of numbers.
    if (.not. may_grow .or. any(abs(jumps) > sqrt(sqrt(huge(ratio))))) return
    associate (n => law%failure_ratio)
      ratio = n/(n - old%damage*(n - 1))
      may_grow = .not. n*undamaged_energy(law, jumps) &
                 < (1 - rounding)*min(law%toughness_opening, law%toughness_shear)*ratio**2
    end associate
  end function may_grow

  !> Damage with trial jumps, not decreasing, theory (D2).
  pure real(wp) function grown_damage(law, separation, old) result(damage)
    type(cohesive_law_t), intent(in) :: law
    !> Position of the jumps on the curve
    type(separation_t), intent(in) :: separation
    type(cohesive_point_t), intent(in) :: old

    damage = max(old%damage, damage_on_curve(separation%ratio, law%failure_ratio))
  end function grown_damage

  !> Class of a point from its damage in the last accepted and in the trial state.
  elemental integer function point_class(old, new) result(class_of_point)
    type(cohesive_point_t), intent(in) :: old
    !> The point with the trial jumps
    type(cohesive_point_t), intent(in) :: new

    class_of_point = point_intact
    if (new%damage > 0) class_of_point = point_damaged
    if (new%damage > old%damage) class_of_point = point_growing
    if (new%damage >= 1) class_of_point = point_failed
  end function point_class

  !> Jumps that enter the cohesive law.
  pure function opened(jumps) result(opening_jumps)
    real(wp), intent(in) :: jumps(3)
    !> The same with a closing jump set to zero
    real(wp) :: opening_jumps(3)

    opening_jumps = [jumps(1), jumps(2), max(jumps(3), 0.0_wp)]
  end function opened

  !> Energy per area of these jumps in an undamaged interface, Y.
  pure real(wp) function undamaged_energy(law, jumps) result(energy)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)

    energy = (law%stiffness_shear*(jumps(1)**2 + jumps(2)**2) + law%stiffness_opening*max(jumps(3), 0.0_wp)**2)/2
  end function undamaged_energy

  !> Recoverable energy per area, (1 - d) Y.
  pure real(wp) function stored_energy(law, jumps, point) result(energy)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    !> The point with these jumps
    type(cohesive_point_t), intent(in) :: point

    energy = 0
    if (point%damage < 1) energy = (1 - point%damage)*undamaged_energy(law, jumps)
  end function stored_energy

  !> Fraction of shear in the energy of the jumps, B; 0 without jumps.
  pure real(wp) function mode_mixture(law, jumps) result(share)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(separation_t) :: separation

    separation = separation_of(law, jumps)
    share = separation%shear_share
  end function mode_mixture

  !> Dissipated fraction of the toughness at a damage: phi(d) = d/(N (1 - d) + d), from 0 to 1, theory (D3).
  pure real(wp) function dissipated_fraction(law, damage) result(share)
    type(cohesive_law_t), intent(in) :: law
    !> d, from 0 to 1
    real(wp), intent(in) :: damage

    share = damage/(law%failure_ratio*(1 - damage) + damage)
  end function dissipated_fraction

  !> Damage for a dissipated fraction of the toughness: d = 1 - (1 - phi)/(1 + (N - 1) phi), theory (D14).
  pure real(wp) function damage_at_fraction(law, share) result(damage)
    type(cohesive_law_t), intent(in) :: law
    !> phi, from 0 to 1
    real(wp), intent(in) :: share

    damage = 1 - (1 - share)/(1 + (law%failure_ratio - 1)*share)
  end function damage_at_fraction
end module cohesive_points
