!> Matrix cracks of adjacent plies as flaws of a cohesive interface (doc/theory/interfaces.md, flaws beside cracked
!> plies): within a distance of a crack the strengths are reduced, at the same toughness.
!>
!> The law of a damaged point is not changed, so that its dissipated energy remains consistent.
module interface_flaws
  use archives, only: archive_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use field_mappings, only: area_field
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use composite_plates, only: composite_plate_t
  use roundings, only: rounding
  implicit none
  private
  public :: reachable_cells, weaken_beside, visit_flaws

contains

  !> Reduces the strengths of the undamaged points of an interface near cracks of a ply. With mirror symmetry the image
  !> of a cracked cell is farther away than the cell itself and need not be considered; with point symmetry cells beyond
  !> the cut are images of cells of the modelled part.
  pure subroutine weaken_beside(interfaces, plate, zone, cracked, reach, part)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: zone
    !> True for cells of the mesh in which the ply has cracked, on all ranks
    logical, intent(in) :: cracked(:)
    !> Distance from a crack within which strengths are reduced
    real(wp), intent(in) :: reach
    !> Strength factor beside cracks
    real(wp), intent(in) :: part
    integer :: cell

    associate (mesh => plate%mesh)
      do cell = 1, size(cracked)
        if (.not. cracked(cell)) cycle
        associate (place => mesh%place_of(cell))
          associate (x => mesh%along(1)%ends(place(1)), y => mesh%along(2)%ends(place(2)))
            call weaken_around(interfaces, plate, zone, x, y, reach, part)
            if (mesh%halved(1) .and. .not. mesh%mirrored(1)) &
              call weaken_around(interfaces, plate, zone, -x([2, 1]), -y([2, 1]), reach, part)
          end associate
        end associate
      end do
    end associate
  end subroutine weaken_beside

  !> Reduces the strengths of the undamaged points of an interface within a distance of a rectangle.
  pure subroutine weaken_around(interfaces, plate, zone, x, y, reach, part)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: zone
    !> Ends of the rectangle
    real(wp), intent(in) :: x(2), y(2)
    !> The distance
    real(wp), intent(in) :: reach
    !> Strength factor beside cracks
    real(wp), intent(in) :: part
    integer :: i, j, columns(2), rows(2), node, local

    associate (mesh => plate%mesh)
      columns = mesh%along(1)%nodes_near(x, (1 + rounding)*reach)
      rows = mesh%along(2)%nodes_near(y, (1 + rounding)*reach)
      do j = rows(1), rows(2)
        do i = columns(1), columns(2)
          node = mesh%node_at(i, j)
          if (mesh%lower_point(node, zone) == 0) cycle
          local = plate%distribution%local(mesh%lower_point(node, zone))
          if (local == 0 .or. local > plate%distribution%owned) cycle
          if (plate%zone(local) /= zone) cycle
          if (interfaces%strength(local) <= part .or. interfaces%points(local)%damage > 0) cycle
          associate (place => mesh%node_coordinates(:, node))
            if (norm2([distance(place(1), x), distance(place(2), &
                                                       y)]) <= (1 + rounding)*reach) interfaces%strength(local) = part
          end associate
        end do
      end do
    end associate
  end subroutine weaken_around

  !> Cells of the mesh within the distance of a zone in which a crack affects its interface.
  pure function reachable_cells(mesh, zone, reach) result(reachable)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: zone
    !> Distance from a crack within which strengths are reduced
    real(wp), intent(in) :: reach
    !> (cells)
    logical :: reachable(product(mesh%cells))
    real(wp) :: x(2), y(2), zone_x(2), zone_y(2), distance
    integer :: cell, place(2)

    distance = (1 + rounding)*reach
    zone_x = mesh%along(1)%span(mesh%zones(zone)%columns)
    zone_y = mesh%along(2)%span(mesh%zones(zone)%rows)
    do cell = 1, size(reachable)
      place = mesh%place_of(cell)
      x = mesh%along(1)%ends(place(1))
      y = mesh%along(2)%ends(place(2))
      reachable(cell) = x(2) + distance >= zone_x(1) .and. x(1) - distance <= zone_x(2) .and. &
                        y(2) + distance >= zone_y(1) .and. y(1) - distance <= zone_y(2)
      ! With point symmetry only cells near the cut have an image within the distance.
      if (mesh%halved(1) .and. .not. mesh%mirrored(1)) reachable(cell) = reachable(cell) .or. x(1) <= distance
    end do
  end function reachable_cells

  !> Distance of a coordinate from an interval.
  pure real(wp) function distance(x, ends)
    !> The coordinate, and the ends of the interval
    real(wp), intent(in) :: x, ends(2)

    distance = max(0.0_wp, ends(1) - x, x - ends(2))
  end function distance

  !> Saves or loads.
  subroutine visit_flaws(interfaces, archive, plate)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: fields(:, :)

    if (.not. allocated(interfaces%strength)) return
    allocate (fields(3, size(interfaces%strength)))
    fields(1, :) = interfaces%strength
    fields(2, :) = interfaces%opening
    fields(3, :) = merge(1.0_wp, 0.0_wp, interfaces%by_energy)
    call plate%visit_points(archive, 'cohesive/law', fields, area_field)
    if (.not. archive%loading) return
    interfaces%strength = fields(1, :)
    interfaces%opening = fields(2, :)
    ! Means of points of another mesh: most of them.
    interfaces%by_energy = fields(3, :) > 0.5_wp
  end subroutine visit_flaws
end module interface_flaws
