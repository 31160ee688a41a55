!> Stiffness of a point of a cohesive interface: derivative of its traction, and its diagonal in a factored operator.
module cohesive_tangents
  use benzeggagh_kenane, only: toughness_gain
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, separation_t, separation_of, grown_damage, point_class, &
                             point_growing, point_failed
  use kinds, only: wp
  use linear_softening, only: fraction_growth
  implicit none
  private
  public :: operator_stiffness, traction_slopes, toughness_slopes, dissipation_slopes

contains

  !> Derivative of the traction: (1 - d) diag(K) and, where damage grows, minus (K v) (x) dd/dv, with dd/dx = N/((N - 1)
  !> x**2) and dx/dv = (dY/Y - dG_c/G_c) x/2. Closed surfaces have no normal part. It is unsymmetric for growth in a
  !> mixed mode with G_Ic /= G_IIc.
  pure function traction_slopes(law, jumps, separation, old) result(slopes)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    !> Their position on the curve
    type(separation_t), intent(in) :: separation
    type(cohesive_point_t), intent(in) :: old
    !> Derivatives of each traction (row) with respect to each jump (column)
    real(wp) :: slopes(3, 3)
    type(cohesive_point_t) :: new
    real(wp) :: stiffness(3), growth(3)
    integer :: i

    new%damage = grown_damage(law, separation, old)
    stiffness = stiffness_of(law)
    slopes = 0
    do i = 1, 3
      slopes(i, i) = (1 - new%damage)*stiffness(i)
    end do
    if (jumps(3) < 0) slopes(3, 3) = 0
    if (point_class(old, new) /= point_growing) return
    growth = damage_slopes(law, separation)
    do i = 1, 3
      slopes(:, i) = slopes(:, i) - stiffness*separation%unit*growth(i)
    end do
  end function traction_slopes

  !> Derivative of growing damage with respect to the jumps over their size, which avoids overflow and underflow.
  pure function damage_slopes(law, separation) result(slopes)
    type(cohesive_law_t), intent(in) :: law
    !> Position of the jumps on the curve
    type(separation_t), intent(in) :: separation
    !> Damage per jump over its size
    real(wp) :: slopes(3)

    slopes = stiffness_of(law)*separation%unit/separation%unit_energy - toughness_slopes(law, &
      separation)/separation%toughness
    slopes = slopes*law%failure_ratio/(2*(law%failure_ratio - 1)*separation%ratio)
  end function damage_slopes

  !> Derivative of the dissipated energy G_c (phi(d) - phi(d_old)); zero unless damage grows.
  pure function dissipation_slopes(law, jumps, old) result(slopes)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Energy per area by jump
    real(wp) :: slopes(3)
    type(separation_t) :: separation
    type(cohesive_point_t) :: new
    real(wp) :: remainder

    slopes = 0
    separation = separation_of(law, jumps)
    new%damage = grown_damage(law, separation, old)
    if (point_class(old, new) /= point_growing) return
    remainder = law%failure_ratio*(1 - new%damage) + new%damage
    slopes = toughness_slopes(law, separation)*fraction_growth(law%failure_ratio, old%damage, new%damage) + &
             separation%toughness*law%failure_ratio/remainder**2*damage_slopes(law, separation)
    slopes = slopes/separation%size
  end function dissipation_slopes

  !> Derivative of the toughness with respect to the jumps over their size: eta (G_II - G_I) B**eta (dS/S - dY/Y) with
  !> the energy of shear S; 0 without shear.
  pure function toughness_slopes(law, separation) result(slopes)
    type(cohesive_law_t), intent(in) :: law
    !> Position of the jumps on the curve
    type(separation_t), intent(in) :: separation
    !> Energy per area
    real(wp) :: slopes(3)
    real(wp) :: mixture, strengthening

    slopes = 0
    if (.not. separation%shear_share > 0) return
    mixture = toughness_gain(law%toughness_opening, law%toughness_shear, law%mixing_exponent, separation%shear_share)
    strengthening = separation%toughness/(law%toughness_opening + mixture)
    slopes = -stiffness_of(law)*separation%unit
    slopes(1:2) = slopes(1:2) + law%stiffness_shear*separation%unit(1:2)/separation%shear_share
    slopes = slopes*law%mixing_exponent*mixture*strengthening/separation%unit_energy
  end function toughness_slopes

  !> Diagonal for a factored operator, constant within a class of points: K if undamaged, (1 - d) K if damaged; with
  !> growing damage 0 in the direction of the jump and (1 - d) K normal to it; 0 after failure. It is not negative and
  !> does not depend on closing: contact is added separately.
  pure function operator_stiffness(law, jumps, old) result(diagonal)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: diagonal(3)
    type(separation_t) :: separation
    type(cohesive_point_t) :: new
    integer :: class_of_point

    separation = separation_of(law, jumps)
    new%damage = grown_damage(law, separation, old)
    class_of_point = point_class(old, new)
    diagonal = 0
    if (class_of_point == point_failed) return
    diagonal = (1 - new%damage)*stiffness_of(law)
    if (class_of_point == point_growing) &
      diagonal = diagonal*max(0.0_wp, 1 - separation%unit**2/sum(separation%unit**2))
  end function operator_stiffness
end module cohesive_tangents
