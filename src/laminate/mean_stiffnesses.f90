!> Plies whose moduli along the fibres in tension and in compression differ, theory (M22) to (M24).
!>
!> The mean stress along the fibres of a sub-ply of an element decides: in compression its mean strains act on a
!> stiffness with E1c. Deviations from the mean keep E1. As the coupling compliance nu12/E1 is that of tension, the
!> stress and the energy are equal with both moduli where the stress is zero, and force and energy derive from one
!> potential. The section against the mean strains of an element is thus a sum of constant contributions of its
!> compressed sub-plies.
module mean_stiffnesses
  use kinds, only: wp
  use plies, only: ply_t, elasticity_t, reduced_stiffness, in_plane_stiffness
  implicit none
  private
  public :: mean_change, sub_ply_middle, mean_strains_at, sub_plies_of, in_bending, bending_error_of

  !> Values of a change: stiffness against mean strains A, B, D, then Nxx to Mxy of the stress-free strains with it, and
  !> their energy per area.
  integer, parameter, public :: change_values = 25
  !> Increase of the error of bending by a sub-ply at the neutral axis, where the number of sub-plies is odd: at most a
  !> quarter for E1c down to .6 E1, for any number.
  real(wp), parameter :: odd_number = 1.25_wp
  !> Largest number of sub-plies of a ply.
  integer, parameter :: max_sub_plies = 1000

contains

  !> Modulus of a beam of unidirectional plies in pure bending (S. Timoshenko, Strength of Materials, part II, 1941):
  !> 4 E1 E1c/(sqrt(E1) + sqrt(E1c))**2. It is exactly E1 where both are equal.
  elemental real(wp) function bending_modulus(elasticity) result(modulus)
    type(elasticity_t), intent(in) :: elasticity

    modulus = elasticity%e1
    if (abs(elasticity%compression - 1) > 0) &
      modulus = 4*modulus*elasticity%compression/(1 + sqrt(elasticity%compression))**2
  end function bending_modulus

  !> A ply with its modulus in bending, for estimates of plates whose plies are in tension on one side of the mid-plane
  !> and in compression on the other.
  elemental function in_bending(ply) result(same)
    type(ply_t), intent(in) :: ply
    !> The ply with one modulus
    type(ply_t) :: same
    real(wp) :: ratio

    same = ply
    ratio = bending_modulus(ply%elasticity)/ply%elasticity%e1
    same%elasticity%e1 = bending_modulus(ply%elasticity)
    same%elasticity%nu12 = ratio*ply%elasticity%nu12
    same%elasticity%compression = 1
  end function in_bending

  !> Relative error of the bending stiffness of a unidirectional laminate by the thickness of the sub-plies of a ply.
  elemental real(wp) function bending_error_of(ply, thickness) result(error)
    type(ply_t), intent(in) :: ply
    !> Thickness of the laminate
    real(wp), intent(in) :: thickness

    associate (c => ply%elasticity)
      error = odd_number*abs(c%e1 - c%e1*c%compression)/(2*bending_modulus(c)) &
              *((ply%z_bottom - ply%z_top)/(thickness*ply%sub_plies))**2
    end associate
  end function bending_error_of

  !> Number of sub-plies of a ply for an error of the bending stiffness: in a unidirectional laminate in pure bending,
  !> half of the sub-plies have the modulus E1 for their deviations where E1c would be right, theory (M24).
  elemental integer function sub_plies_of(ply, thickness, error) result(number)
    type(ply_t), intent(in) :: ply
    !> Thickness of the laminate
    real(wp), intent(in) :: thickness
    real(wp), intent(in) :: error
    real(wp) :: excess

    associate (c => ply%elasticity)
      excess = odd_number*abs(c%e1 - c%e1*c%compression)/(2*bending_modulus(c))
    end associate
    number = ceiling(min(real(max_sub_plies, wp), (ply%z_bottom - ply%z_top)/thickness*sqrt(excess/error)))
    number = max(1, number)
  end function sub_plies_of

  !> Height of the mid-plane of a sub-ply.
  pure real(wp) function sub_ply_middle(ply, number) result(z)
    type(ply_t), intent(in) :: ply
    !> Number of the sub-ply, from the top
    integer, intent(in) :: number

    z = (ply%z_top + ply%z_bottom)/2
    if (ply%sub_plies > 1) z = ply%z_top + (number - 0.5_wp)/ply%sub_plies*(ply%z_bottom - ply%z_top)
  end function sub_ply_middle

  !> Strains along and across the fibres at a height, without stress-free strains.
  pure function mean_strains_at(ply, strains, z) result(mean)
    type(ply_t), intent(in) :: ply
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy
    real(wp), intent(in) :: strains(6)
    !> The height
    real(wp), intent(in) :: z
    real(wp) :: mean(2)

    associate (c => ply%cosine, s => ply%sine, e => strains(1:3) + z*strains(4:6))
      mean = [c*c*e(1) + s*s*e(2) + c*s*e(3), s*s*e(1) + c*c*e(2) - c*s*e(3)] - ply%free_strain(:2)
    end associate
  end function mean_strains_at

  !> Change of the section against mean strains by other constants of a sub-ply.
  pure function mean_change(ply, from, to, z) result(change)
    !> The ply, for its angle, thickness and stress-free strains
    type(ply_t), intent(in) :: ply
    !> Constants for deviations from the mean, and for the mean
    type(elasticity_t), intent(in) :: from, to
    !> Height of the sub-ply's mid-plane
    real(wp), intent(in) :: z
    !> Stiffness, resultants of the stress-free strains, energy
    real(wp) :: change(change_values)
    real(wp) :: q(4), stress(2), thickness

    thickness = (ply%z_bottom - ply%z_top)/ply%sub_plies
    change(1:6) = thickness*(in_plane_stiffness(ply, to) - in_plane_stiffness(ply, from))
    change(7:12) = z*change(1:6)
    change(13:18) = z*change(7:12)
    q = thickness*(reduced_stiffness(to) - reduced_stiffness(from))
    associate (c => ply%cosine, s => ply%sine, free => ply%free_strain(:2))
      stress = [q(1)*free(1) + q(2)*free(2), q(2)*free(1) + q(3)*free(2)]
      change(19:21) = [c*c*stress(1) + s*s*stress(2), s*s*stress(1) + c*c*stress(2), c*s*(stress(1) - stress(2))]
      change(22:24) = z*change(19:21)
      change(25) = dot_product(stress, free)/2
    end associate
  end function mean_change
end module mean_stiffnesses
