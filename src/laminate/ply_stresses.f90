!> Stresses of one ply in its material axes from the strains of the plate.
!>
!> In-plane stresses are those of the ply's own strain, exx + z kxx and so on. The transverse shear stresses are the
!> ply's shear moduli times one shear strain for the whole thickness, as in the paper; with the strain of
!> mean_shear_strain they add up to the shear force Q = S gamma of the plate. They are averages: at the free faces
!> they do not vanish, and in a homogeneous plate the true peak is 3/2 of them.
module ply_stresses
  use kinds, only: wp
  use packed_matrices, only: inverse_of_two
  use plies, only: ply_t, elasticity_t, reduced_stiffness, shear_stiffness
  implicit none
  private
  public :: ply_stress, middle_stress, face_stresses, mean_shear_strain

contains

  !> Stresses of a ply at a height.
  pure function ply_stress(ply, elasticity, strains, z) result(stress)
    !> The ply, for its angle and its strains without stress
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy; transverse shear gxz, gyz
    real(wp), intent(in) :: strains(8)
    !> Distance from the laminate's mid-plane
    real(wp), intent(in) :: z
    !> s11, s22, s12, s13, s23
    real(wp) :: stress(5)
    real(wp) :: in_plane(3), along, across, shear, q(4)

    in_plane = strains(1:3) + z*strains(4:6)
    q = reduced_stiffness(elasticity)
    associate (c => ply%cosine, s => ply%sine)
      along = c*c*in_plane(1) + s*s*in_plane(2) + c*s*in_plane(3) - ply%free_strain(1)
      across = s*s*in_plane(1) + c*c*in_plane(2) - c*s*in_plane(3) - ply%free_strain(2)
      shear = 2*c*s*(in_plane(2) - in_plane(1)) + (c*c - s*s)*in_plane(3)
      stress(1) = q(1)*along + q(2)*across
      stress(2) = q(2)*along + q(3)*across
      stress(3) = q(4)*shear
      stress(4) = elasticity%g13*(c*strains(7) + s*strains(8))
      stress(5) = elasticity%g23*(c*strains(8) - s*strains(7))
    end associate
  end function ply_stress

  !> Stresses in the mid-plane of a ply, which are also its averages over the thickness.
  pure function middle_stress(ply, elasticity, strains) result(stress)
    !> The ply
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Strains as in ply_stress
    real(wp), intent(in) :: strains(8)
    !> s11, s22, s12, s13, s23
    real(wp) :: stress(5)

    stress = ply_stress(ply, elasticity, strains, (ply%z_top + ply%z_bottom)/2)
  end function middle_stress

  !> Stresses on both faces of a ply, where the in-plane ones are largest.
  pure function face_stresses(ply, elasticity, strains) result(stresses)
    !> The ply
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> Strains as in ply_stress
    real(wp), intent(in) :: strains(8)
    !> s11, s22, s12, s13, s23 at the top (column 1) and at the bottom (column 2)
    real(wp) :: stresses(5, 2)

    stresses(:, 1) = ply_stress(ply, elasticity, strains, ply%z_top)
    stresses(:, 2) = ply_stress(ply, elasticity, strains, ply%z_bottom)
  end function face_stresses

  !> Shear strain that, the same in every ply, gives stresses which add up to the shear force of the section:
  !> (sum of G dz)**-1 S gamma, that is 5/6 gamma with the factor 5/6.
  pure function mean_shear_strain(plies, elasticity, stiffness, shear_strain) result(mean)
    !> Plies of the section
    type(ply_t), intent(in) :: plies(:)
    !> Their present elastic constants
    type(elasticity_t), intent(in) :: elasticity(:)
    !> Stiffness of the section, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> gxz, gyz of the plate
    real(wp), intent(in) :: shear_strain(2)
    !> gxz, gyz to take the stresses from
    real(wp) :: mean(2)
    real(wp) :: uncorrected(3), flexibility(3), force(2)
    integer :: i

    uncorrected = 0
    do i = 1, size(plies)
      uncorrected = uncorrected + shear_stiffness(plies(i), elasticity(i))*(plies(i)%z_bottom - plies(i)%z_top)
    end do
    flexibility = inverse_of_two(uncorrected)
    force = [dot_product(stiffness(19:20), shear_strain), dot_product(stiffness(20:21), shear_strain)]
    mean = [dot_product(flexibility(1:2), force), dot_product(flexibility(2:3), force)]
  end function mean_shear_strain
end module ply_stresses
