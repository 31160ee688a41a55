!> From a stacking sequence to the stiffness and mass of a section of the plate, theory (P4) to (P7), or of a layer of
!> some of its plies.
module stacking
  use kinds, only: wp
  use laminate_parameters, only: laminate_t, shear_energy
  use material_parameters, only: material_t, first_alike
  use mean_stiffnesses, only: sub_plies_of
  use plies, only: ply_t, elasticity_t, elasticity_of, set_angle, in_plane_stiffness, shear_stiffness
  use transverse_shear, only: layer_stiffness_from_energy, shear_stiffness_from_energy
  implicit none
  private
  public :: section_t, stacked_plies, section_of, section_stiffness, layer_stiffness, in_plane_section, section_mass

  !> A section of the laminate, or of a layer of it, per unit of area; z from the mid-plane of the whole laminate.
  type :: section_t
    !> A(11, 12, 16, 22, 26, 66), B and D likewise, S(xz-xz, xz-yz, yz-yz)
    real(wp) :: stiffness(21) = 0
    !> Integrals of density, density z and density z**2
    real(wp) :: mass(3) = 0
  end type section_t

contains

  !> Plies of a laminate, from the struck face down. Materials with equal constants are one.
  pure function stacked_plies(laminate, materials) result(plies)
    !> Stacking sequence
    type(laminate_t), intent(in) :: laminate
    !> Materials that it refers to
    type(material_t), intent(in) :: materials(:)
    !> The plies with their positions
    type(ply_t), allocatable :: plies(:)
    real(wp) :: z
    integer :: i

    allocate (plies(size(laminate%material)))
    z = -sum(laminate%thickness)/2
    do i = 1, size(plies)
      plies(i)%material = first_alike(materials, laminate%material(i))
      plies(i)%elasticity = elasticity_of(materials(plies(i)%material))
      plies(i)%density = materials(plies(i)%material)%density
      call set_angle(plies(i), laminate%angle(i))
      plies(i)%z_top = z
      z = z + laminate%thickness(i)
      plies(i)%z_bottom = z
    end do
    plies%sub_plies = sub_plies_of(plies, sum(laminate%thickness), laminate%bending_error)
  end function stacked_plies

  !> Section of a range of plies without damage.
  pure function section_of(plies, shear_correction) result(section)
    !> Neighbouring plies: all of the laminate or those of one layer
    type(ply_t), intent(in) :: plies(:)
    integer, intent(in) :: shear_correction
    !> Their stiffness and mass
    type(section_t) :: section

    section%stiffness = section_stiffness(plies, plies%elasticity, shear_correction)
    section%mass = section_mass(plies)
  end function section_of

  !> Stiffness of a range of plies whose elastic constants may have been reduced. Allocates nothing.
  pure function section_stiffness(plies, elasticity, shear_correction) result(stiffness)
    !> Neighbouring plies: all of the laminate or those of one layer
    type(ply_t), intent(in) :: plies(:)
    !> Present elastic constants of these plies
    type(elasticity_t), intent(in) :: elasticity(:)
    integer, intent(in) :: shear_correction
    !> Packed as in section_t
    real(wp) :: stiffness(21)
    real(wp) :: z(0:size(plies)), in_plane(6, size(plies)), shear(3, size(plies))
    integer :: i

    stiffness(1:18) = in_plane_section(plies, elasticity)
    stiffness(19:21) = 0
    z(0) = plies(1)%z_top
    do i = 1, size(plies)
      in_plane(:, i) = in_plane_stiffness(plies(i), elasticity(i))
      shear(:, i) = shear_stiffness(plies(i), elasticity(i))
      z(i) = plies(i)%z_bottom
      stiffness(19:21) = stiffness(19:21) + shear(:, i)*(plies(i)%z_bottom - plies(i)%z_top)
    end do
    if (shear_correction == shear_energy) then
      stiffness(19:21) = shear_stiffness_from_energy(z, in_plane, shear)
    else
      stiffness(19:21) = stiffness(19:21)*5/6
    end if
  end function section_stiffness

  !> Stiffness of a layer of some of a laminate's plies, whose elastic constants may have been reduced. Within the
  !> laminate the faces of a layer carry shear stress: with shear_energy its stiffness is that of the laminate's
  !> equilibrium, theory (P6). It would vanish for a layer in which those stresses cancel; below sqrt(epsilon) of the
  !> stiffness with free faces, with which solutions still have half of their digits, the latter is used.
  pure function layer_stiffness(plies, elasticity, first, last, shear_correction) result(stiffness)
    type(ply_t), intent(in) :: plies(:)
    !> Present elastic constants of the plies of the layer
    type(elasticity_t), intent(in) :: elasticity(:)
    !> First and last ply of the layer
    integer, intent(in) :: first, last
    integer, intent(in) :: shear_correction
    !> Packed as in section_t
    real(wp) :: stiffness(21)
    real(wp) :: z(0:size(plies)), in_plane(6, size(plies)), shear(3, size(plies)), within(3), excess(3)
    integer :: i

    stiffness = section_stiffness(plies(first:last), elasticity, shear_correction)
    if (shear_correction /= shear_energy .or. last - first + 1 == size(plies)) return
    z(0) = plies(1)%z_top
    z(1:) = plies%z_bottom
    do i = 1, size(plies)
      if (i < first .or. i > last) then
        in_plane(:, i) = in_plane_stiffness(plies(i), plies(i)%elasticity)
        shear(:, i) = shear_stiffness(plies(i), plies(i)%elasticity)
      else
        in_plane(:, i) = in_plane_stiffness(plies(i), elasticity(i - first + 1))
        shear(:, i) = shear_stiffness(plies(i), elasticity(i - first + 1))
      end if
    end do
    within = layer_stiffness_from_energy(z, in_plane, shear, first, last)
    excess = within - sqrt(epsilon(within))*stiffness(19:21)
    if (min(excess(1), excess(3), excess(1)*excess(3) - excess(2)**2) > 0) stiffness(19:21) = within
  end function layer_stiffness

  !> Stiffness of a range of plies against membrane strains and curvatures.
  pure function in_plane_section(plies, elasticity) result(stiffness)
    !> Neighbouring plies: all of the laminate or those of one layer
    type(ply_t), intent(in) :: plies(:)
    !> Present elastic constants of these plies
    type(elasticity_t), intent(in) :: elasticity(:)
    !> A, B, D, packed as in section_t
    real(wp) :: stiffness(18)
    real(wp) :: in_plane(6), thickness
    integer :: i

    stiffness = 0
    do i = 1, size(plies)
      associate (top => plies(i)%z_top, bottom => plies(i)%z_bottom)
        in_plane = in_plane_stiffness(plies(i), elasticity(i))
        thickness = bottom - top
        stiffness(1:6) = stiffness(1:6) + in_plane*thickness
        stiffness(7:12) = stiffness(7:12) + in_plane*(thickness*(bottom + top)/2)
        stiffness(13:18) = stiffness(13:18) + in_plane*(thickness*(bottom**2 + bottom*top + top**2)/3)
      end associate
    end do
  end function in_plane_section

  !> Mass of a range of plies.
  pure function section_mass(plies) result(mass)
    !> Neighbouring plies: all of the laminate or those of one layer
    type(ply_t), intent(in) :: plies(:)
    !> Integrals of density, density z and density z**2
    real(wp) :: mass(3)

    associate (top => plies%z_top, bottom => plies%z_bottom)
      mass(1) = sum(plies%density*(bottom - top))
      mass(2) = sum(plies%density*(bottom - top)*(bottom + top))/2
      mass(3) = sum(plies%density*(bottom - top)*(bottom**2 + bottom*top + top**2))/3
    end associate
  end function section_mass
end module stacking
