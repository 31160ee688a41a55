!> Stiffness of a point of a cohesive interface: the derivative of its traction, and the diagonal that a factored
!> operator holds for it.
module cohesive_tangents
  use cohesive_laws, only: cohesive_law_t, stiffness_of
  use cohesive_points, only: cohesive_point_t, cohesive_reach_t, cohesive_reach, grown_damage, point_class, &
                             share_growth, point_growing, point_failed
  use kinds, only: wp
  implicit none
  private
  public :: operator_stiffness, traction_slopes, toughness_slopes, dissipation_slopes

contains

  !> Derivative of the traction: (1 - d) diag(K), where damage grows less (K v) (x) dd/dv with
  !> dd/dx = N/((N - 1) x**2) and dx/dv = (dY/Y - dG_c/G_c) x/2. Closing faces have no normal part. Unsymmetric is only
  !> growth in a mixed mode with G_Ic /= G_IIc.
  pure function traction_slopes(law, jumps, reach, old) result(slopes)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> Their place on the curve
    type(cohesive_reach_t), intent(in) :: reach
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Derivatives of each traction (row) by each jump (column)
    real(wp) :: slopes(3, 3)
    type(cohesive_point_t) :: new
    real(wp) :: stiffness(3), growth(3)
    integer :: i

    new%damage = grown_damage(law, reach, old)
    stiffness = stiffness_of(law)
    slopes = 0
    do i = 1, 3
      slopes(i, i) = (1 - new%damage)*stiffness(i)
    end do
    if (jumps(3) < 0) slopes(3, 3) = 0
    if (point_class(old, new) /= point_growing) return
    growth = damage_slopes(law, reach)
    do i = 1, 3
      slopes(:, i) = slopes(:, i) - stiffness*reach%unit*growth(i)
    end do
  end function traction_slopes

  !> Derivative of growing damage by the jumps over their size: with these nothing over- or underflows.
  pure function damage_slopes(law, reach) result(slopes)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Place of the jumps on the curve
    type(cohesive_reach_t), intent(in) :: reach
    !> Damage per jump over its size
    real(wp) :: slopes(3)

    slopes = stiffness_of(law)*reach%unit/reach%unit_energy - toughness_slopes(law, reach)/reach%toughness
    slopes = slopes*law%failure_ratio/(2*(law%failure_ratio - 1)*reach%ratio)
  end function damage_slopes

  !> Derivative of the energy dissipated, G_c (phi(d) - phi(d_old)): nothing unless damage grows.
  pure function dissipation_slopes(law, jumps, pressure, old) result(slopes)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> Contact pressure of the last accepted state
    real(wp), intent(in) :: pressure
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Energy per area by jump
    real(wp) :: slopes(3)
    type(cohesive_reach_t) :: reach
    type(cohesive_point_t) :: new
    real(wp) :: remainder

    slopes = 0
    reach = cohesive_reach(law, jumps, pressure)
    new%damage = grown_damage(law, reach, old)
    if (point_class(old, new) /= point_growing) return
    remainder = law%failure_ratio*(1 - new%damage) + new%damage
    slopes = toughness_slopes(law, reach)*share_growth(law, old%damage, new%damage) + &
             reach%toughness*law%failure_ratio/remainder**2*damage_slopes(law, reach)
    slopes = slopes/reach%size
  end function dissipation_slopes

  !> Derivative of the toughness by the jumps over their size: eta (G_II - G_I) B**eta (dS/S - dY/Y) with S the energy
  !> of shear, 0 where there is none.
  pure function toughness_slopes(law, reach) result(slopes)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Place of the jumps on the curve
    type(cohesive_reach_t), intent(in) :: reach
    !> Energy per area
    real(wp) :: slopes(3)
    real(wp) :: mixture, strengthening

    slopes = 0
    if (.not. reach%shear_share > 0) return
    mixture = reach%shear_share**law%mixing_exponent*(law%toughness_shear - law%toughness_opening)
    strengthening = reach%toughness/(law%toughness_opening + mixture)
    slopes = -stiffness_of(law)*reach%unit
    slopes(1:2) = slopes(1:2) + law%stiffness_shear*reach%unit(1:2)/reach%shear_share
    slopes = slopes*law%mixing_exponent*mixture*strengthening/reach%unit_energy
  end function toughness_slopes

  !> Diagonal for a factored operator, one value a class of point: K where intact, (1 - d) K where damaged, where it
  !> grows nothing along the jump and (1 - d) K across it, nothing once failed. Never negative. Whether the faces
  !> close makes no difference: contact comes on top.
  pure function operator_stiffness(law, jumps, pressure, old) result(diagonal)
    !> The law
    type(cohesive_law_t), intent(in) :: law
    !> Two shears and opening
    real(wp), intent(in) :: jumps(3)
    !> Contact pressure of the last accepted state
    real(wp), intent(in) :: pressure
    !> The point in the last accepted state
    type(cohesive_point_t), intent(in) :: old
    !> Pressure per jump
    real(wp) :: diagonal(3)
    type(cohesive_reach_t) :: reach
    type(cohesive_point_t) :: new
    integer :: class_of_point

    reach = cohesive_reach(law, jumps, pressure)
    new%damage = grown_damage(law, reach, old)
    class_of_point = point_class(old, new)
    diagonal = 0
    if (class_of_point == point_failed) return
    diagonal = (1 - new%damage)*stiffness_of(law)
    if (class_of_point == point_growing) &
      diagonal = diagonal*max(0.0_wp, 1 - reach%unit**2/sum(reach%unit**2))
  end function operator_stiffness
end module cohesive_tangents
