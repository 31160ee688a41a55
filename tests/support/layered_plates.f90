!> Setups of plates with one interface, and the delamination of their cells, for tests.
module layered_plates
  use kinds, only: wp
  use contact_and_ties, only: contact_and_ties_t
  use delamination_parameters, only: contact_none
  use material_parameters, only: material_t
  use mesh_parameters, only: edge_free, edge_clamped, symmetry_none, symmetry_quarter
  use composite_plates, only: composite_plate_t
  use plate_options, only: kinematics_linear
  use setups, only: setup_t
  implicit none
  private
  public :: strip, disc, release_cells

contains

  !> A strip along x, clamped at its far end, with linear strains; its first ply is the upper arm.
  pure function strip(materials, angles, thickness, below_ply, length, width, elements) result(setup)
    !> Materials, of which all plies have the first
    type(material_t), intent(in) :: materials(:)
    !> Angle and thickness of each ply
    real(wp), intent(in) :: angles(:), thickness(:)
    !> Plies of the upper arm
    integer, intent(in) :: below_ply
    !> Length and width
    real(wp), intent(in) :: length, width
    !> Cells along the strip, an even number
    integer, intent(in) :: elements
    !> The setup
    type(setup_t) :: setup

    setup = layered(materials, angles, thickness, below_ply)
    setup%plate%length = [length, width]
    setup%plate%edges = [edge_free, edge_clamped, edge_free, edge_free]
    setup%plate%symmetry = symmetry_none
    setup%mesh%elements = [elements, 1]
    setup%delaminations%zone(1) = 2*length
    setup%delaminations%zone(2) = 2*width
  end function strip

  !> A quarter of a clamped square of two equal plies, loaded on a square patch at its centre.
  pure function disc(material, thickness, side, patch, elements) result(setup)
    !> The material
    type(material_t), intent(in) :: material
    !> Thickness, side, and side of the patch
    real(wp), intent(in) :: thickness, side, patch
    !> Cells along half a side
    integer, intent(in) :: elements
    !> The setup
    type(setup_t) :: setup

    setup = layered([material], [0.0_wp, 0.0_wp], [thickness, thickness]/2, 1)
    setup%plate%length = side
    setup%plate%edges = edge_clamped
    setup%plate%symmetry = symmetry_quarter
    setup%mesh%elements = elements
    setup%mesh%patch = patch
    setup%mesh%grading = 1
    setup%delaminations%zone(1) = 0.9_wp*side
    setup%delaminations%zone(2) = 0.9_wp*side
  end function disc

  !> A laminate with one interface, all intact.
  pure function layered(materials, angles, thickness, below_ply) result(setup)
    !> Materials, of which all plies have the first
    type(material_t), intent(in) :: materials(:)
    !> Angle and thickness of each ply
    real(wp), intent(in) :: angles(:), thickness(:)
    !> Plies above the interface
    integer, intent(in) :: below_ply
    !> The setup, without plate and mesh
    type(setup_t) :: setup

    setup%mesh%kinematics = kinematics_linear
    allocate (setup%materials, source=materials)
    allocate (setup%laminate%material(size(angles)), source=1)
    allocate (setup%laminate%angle, source=angles)
    allocate (setup%laminate%thickness, source=thickness)
    setup%loading%by_steps = .true.
    setup%pressure%is_present = .true.
    allocate (setup%delaminations(1))
    setup%delaminations%below_ply = below_ply
    setup%delaminations%toughness = 1
    setup%delaminations%contact = contact_none
  end function layered

  !> Delaminates the cells of a range of columns and rows whose centres are within a radius of the origin.
  subroutine release_cells(plate, contact, columns, rows, radius)
    type(composite_plate_t), intent(in) :: plate
    !> Delaminated cells
    type(contact_and_ties_t), intent(inout) :: contact
    !> Columns and rows, first and last
    integer, intent(in) :: columns(2), rows(2)
    !> The radius
    real(wp), intent(in) :: radius
    integer, allocatable :: nodes(:)
    integer :: i, j

    do j = rows(1), rows(2)
      do i = columns(1), columns(2)
        nodes = plate%mesh%cell_nodes(plate%mesh%cell_at(i, j))
        if (norm2(plate%mesh%node_coordinates(:, nodes(5))) < radius) call contact%regions(1)%release([i, j])
      end do
    end do
    call contact%free_jumps(plate)
  end subroutine release_cells
end module layered_plates
