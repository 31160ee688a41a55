!> In-situ strengths of the matrix, theory (M15) to (M17): plies of another angle constrain its cracks, the more so the
!> thinner the block of plies with the crack (P. P. Camanho, C. G. Davila, S. T. Pinho, L. Iannucci, P. Robinson,
!> Composites Part A 37 (2006) 165-176).
module in_situ_strengths
  use kinds, only: wp
  use mathematical_constants, only: pi
  use material_parameters, only: material_t
  use matrix_exposures, only: matrix_strengths_t, matrix_strengths
  use plies, only: ply_t
  use ply_blocks, only: block_of, block_thickness
  use ply_damage_parameters, only: ply_damage_t, criteria_puck, matrix_tension, matrix_compression
  implicit none
  private
  public :: strengths_in_place, material_in_place, crack_strengths

  !> Factor of the stress intensity at a crack that reaches a free face, and the corresponding factor of the strength of
  !> a thin block at a face, 2/1.12 as printed.
  real(wp), parameter :: at_free_face = 1.12_wp, thin_at_face = 1.79_wp

contains

  !> Material of a ply with the strengths of its failure criteria: in-situ strengths if the deck requests them. A block
  !> that is the complete laminate has no neighbours; its strengths are those of the material.
  pure function material_in_place(plies, ply, materials, damage) result(material)
    type(ply_t), intent(in) :: plies(:)
    integer, intent(in) :: ply
    type(material_t), intent(in) :: materials(:)
    !> True: in-situ strengths
    type(ply_damage_t), intent(in) :: damage
    type(material_t) :: material
    real(wp) :: strengths(2)
    logical :: at_face(2)

    material = materials(plies(ply)%material)
    at_face = block_of(plies, ply) == [1, size(plies)]
    if (.not. damage%in_situ .or. all(at_face)) return
    strengths = strengths_in_place(material, block_thickness(plies, ply), any(at_face))
    material%yt = strengths(1)
    material%s12 = strengths(2)
  end function material_in_place

  !> Strengths of a ply in the criterion for cracks along its fibres, on all planes.
  pure function crack_strengths(plies, ply, materials, damage) result(strengths)
    type(ply_t), intent(in) :: plies(:)
    integer, intent(in) :: ply
    type(material_t), intent(in) :: materials(:)
    !> True: in-situ strengths
    type(ply_damage_t), intent(in) :: damage
    type(matrix_strengths_t) :: strengths

    strengths = matrix_strengths(material_in_place(plies, ply, materials, damage), criteria_puck)
  end function crack_strengths

  !> In-situ strengths of a block of plies.
  pure function strengths_in_place(material, thickness, at_face) result(strengths)
    !> Its material, with strengths and fracture energies
    type(material_t), intent(in) :: material
    !> Its thickness
    real(wp), intent(in) :: thickness
    !> True: it has neighbours on one side only
    logical, intent(in) :: at_face
    !> YT and S12
    real(wp) :: strengths(2)
    real(wp) :: compliance, opening, shear

    associate (m => material)
      compliance = 2*(1/m%e2 - (m%nu12*m%e2/m%e1)**2/m%e1)
      opening = sqrt(m%toughness(matrix_tension)/(pi*thickness*compliance))
      ! phi of the paper by Camanho et al. for a block at a face: the first value is that of a thick block, for which
      ! S12 is unchanged, the second that of a thin one.
      shear = max(6*m%s12**2/m%g12 + 9*m%shear_beta*m%s12**4, 24*m%toughness(matrix_compression)/(pi*thickness))
      strengths(1) = merge(max(m%yt, thin_at_face*opening), sqrt(2.0_wp)*max(at_free_face*m%yt, 2*opening), at_face)
      if (.not. at_face) shear = 2*shear
      strengths(2) = sqrt(shear*m%g12/(3*(1 + sqrt(1 + m%shear_beta*shear*m%g12**2))))
    end associate
  end function strengths_in_place
end module in_situ_strengths
