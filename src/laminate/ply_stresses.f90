!> Stresses of one ply in its material axes from the strains of the plate, theory (M1) and (M2).
!>
!> In-plane stresses are those of the ply's own strain, exx + z kxx and so on. The transverse shear stresses are
!> averages over the ply, by equilibrium (see `ply_shear`): in a plate of one ply the true peak is 3/2 of them.
module ply_stresses
  use kinds, only: wp
  use plies, only: ply_t, elasticity_t, reduced_stiffness, compressed, is_bimodular, uniaxial_strain
  implicit none
  private
  public :: ply_stress, middle_stress, face_stresses

contains

  !> Stresses of a ply at a height.
  pure function ply_stress(ply, elasticity, strains, shear, z) result(stress)
    !> The ply, for its angle and its stress-free strains
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy
    real(wp), intent(in) :: strains(6)
    !> Transverse shear stresses tau_xz, tau_yz of the ply
    real(wp), intent(in) :: shear(2)
    !> Distance from the laminate's mid-plane
    real(wp), intent(in) :: z
    !> s11, s22, s12, s13, s23
    real(wp) :: stress(5)
    real(wp) :: in_plane(3), along, across, distortion, q(4)

    in_plane = strains(1:3) + z*strains(4:6)
    associate (c => ply%cosine, s => ply%sine)
      along = c*c*in_plane(1) + s*s*in_plane(2) + c*s*in_plane(3) - ply%free_strain(1)
      across = s*s*in_plane(1) + c*c*in_plane(2) - c*s*in_plane(3) - ply%free_strain(2)
      distortion = 2*c*s*(in_plane(2) - in_plane(1)) + (c*c - s*s)*in_plane(3) - ply%free_strain(3)
      if (.not. is_bimodular(elasticity)) then
        q = reduced_stiffness(elasticity)
      else if (uniaxial_strain(elasticity, [along, across]) < 0) then
        q = reduced_stiffness(compressed(elasticity))
      else
        q = reduced_stiffness(elasticity)
      end if
      stress(1) = q(1)*along + q(2)*across
      stress(2) = q(2)*along + q(3)*across
      stress(3) = q(4)*distortion
      stress(4) = c*shear(1) + s*shear(2)
      stress(5) = c*shear(2) - s*shear(1)
    end associate
  end function ply_stress

  !> Stresses in the mid-plane of a ply, which are also its averages over the thickness.
  pure function middle_stress(ply, elasticity, strains, shear) result(stress)
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Strains and transverse shear stresses as in ply_stress
    real(wp), intent(in) :: strains(6), shear(2)
    !> s11, s22, s12, s13, s23
    real(wp) :: stress(5)

    stress = ply_stress(ply, elasticity, strains, shear, (ply%z_top + ply%z_bottom)/2)
  end function middle_stress

  !> Stresses on both faces of a ply, where the in-plane ones are largest.
  pure function face_stresses(ply, elasticity, strains, shear) result(stresses)
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Strains and transverse shear stresses as in ply_stress
    real(wp), intent(in) :: strains(6), shear(2)
    !> s11, s22, s12, s13, s23 at the top (column 1) and at the bottom (column 2)
    real(wp) :: stresses(5, 2)

    stresses(:, 1) = ply_stress(ply, elasticity, strains, shear, ply%z_top)
    stresses(:, 2) = ply_stress(ply, elasticity, strains, shear, ply%z_bottom)
  end function face_stresses
end module ply_stresses
