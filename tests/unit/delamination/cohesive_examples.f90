!> Cohesive laws for tests, jumps of a given mode, and derivatives by differences.
module cohesive_examples
  use cohesive_laws, only: cohesive_law_t, create_cohesive_law
  use cohesive_points, only: cohesive_point_t, cohesive_traction
  use kinds, only: wp
  implicit none
  private
  public :: tough_law, even_law, brittle_law, extreme_law, jumps_of, toughness_by_hand, grown_to, &
            traction_differences, differs_by

contains

  !> Toughnesses of IM7/8552 with moderate strengths: N = 346.
  pure type(cohesive_law_t) function tough_law() result(law)
    law = create_cohesive_law([280.0_wp, 790.0_wp], 1.75_wp, [27e6_wp, 60e6_wp], 0.0_wp, 90e9_wp, 1e-3_wp)
  end function tough_law

  !> One toughness for every mode.
  pure type(cohesive_law_t) function even_law() result(law)
    law = create_cohesive_law([600.0_wp, 600.0_wp], 1.75_wp, [27e6_wp, 40e6_wp], 4e14_wp, 0.0_wp, 0.0_wp)
  end function even_law

  !> The smallest admissible N, 20.
  pure type(cohesive_law_t) function brittle_law() result(law)
    law = create_cohesive_law([280.0_wp, 790.0_wp], 1.3_wp, [60e6_wp, 90e6_wp], 0.0_wp, 9e9_wp, 1e-2_wp)
  end function brittle_law

  !> N from 1e6 (case 0) down to 1e3 (case 3), a range of exponents.
  pure type(cohesive_law_t) function extreme_law(case) result(law)
    integer, intent(in) :: case
    real(wp), parameter :: exponents(0:3) = [0.3_wp, 0.97_wp, 1.75_wp, 7.3_wp]

    law = create_cohesive_law([280.0_wp, 790.0_wp], exponents(case), [27e6_wp, 60e6_wp], 13e17_wp*10.0_wp**(-case), &
                              0.0_wp, 0.0_wp)
  end function extreme_law

  !> Jumps of a magnitude, turned from opening towards shear.
  pure function jumps_of(size, degrees) result(jumps)
    real(wp), intent(in) :: size, degrees
    real(wp) :: jumps(3), angle

    angle = degrees*acos(-1.0_wp)/180
    jumps = size*[0.6_wp*sin(angle), -0.8_wp*sin(angle), cos(angle)]
  end function jumps_of

  !> Mixed-mode toughness for jumps that do not close, written out.
  pure real(wp) function toughness_by_hand(law, jumps) result(toughness)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    real(wp) :: shear, opening

    shear = law%stiffness_shear*(jumps(1)**2 + jumps(2)**2)
    opening = law%stiffness_opening*jumps(3)**2
    toughness = law%toughness_opening + (law%toughness_shear - law%toughness_opening)* &
                (shear/(shear + opening))**law%mixing_exponent
  end function toughness_by_hand

  !> A point after a history of these jumps.
  pure type(cohesive_point_t) function grown_to(law, jumps) result(point)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3)
    type(cohesive_point_t) :: fresh
    real(wp) :: unused(3)

    call cohesive_traction(law, jumps, fresh, unused, point)
  end function grown_to

  !> Derivatives of each traction (row) by each jump (column) by central differences.
  pure function traction_differences(law, jumps, old, step) result(slopes)
    type(cohesive_law_t), intent(in) :: law
    real(wp), intent(in) :: jumps(3), step
    type(cohesive_point_t), intent(in) :: old
    real(wp) :: slopes(3, 3), moved(3), above(3), below(3)
    type(cohesive_point_t) :: unused
    integer :: i

    do i = 1, 3
      moved = jumps
      moved(i) = jumps(i) + step
      call cohesive_traction(law, moved, old, above, unused)
      moved(i) = jumps(i) - step
      call cohesive_traction(law, moved, old, below, unused)
      slopes(:, i) = (above - below)/(2*step)
    end do
  end function traction_differences

  !> Largest difference of two matrices over the largest entry of the first; of a matrix of zeros the difference itself.
  pure real(wp) function differs_by(expected, found) result(difference)
    real(wp), intent(in) :: expected(3, 3), found(3, 3)

    difference = maxval(abs(found - expected))
    if (maxval(abs(expected)) > 0) difference = difference/maxval(abs(expected))
  end function differs_by
end module cohesive_examples
