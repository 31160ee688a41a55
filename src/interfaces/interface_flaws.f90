!> Matrix cracks of adjacent plies as flaws of a cohesive interface (doc/theory/interfaces.md, flaws beside cracked
!> plies): within a distance of a crack the strengths are reduced, at the same toughness.
!>
!> The law of a damaged point is not changed, so that its dissipated energy remains consistent.
module interface_flaws
  use archives, only: archive_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use models, only: model_t
  use roundings, only: rounding
  implicit none
  private
  public :: reachable_cells, weaken_beside, visit_flaws

contains

  !> Reduces the strengths of the undamaged points of an interface near cracks of a ply. With mirror symmetry the image
  !> of a cracked cell is farther away than the cell itself and need not be considered; with point symmetry cells beyond
  !> the cut are images of cells of the modelled part.
  pure subroutine weaken_beside(interfaces, model, zone, cracked, reach, part)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> True for cells of the mesh in which the ply has cracked, on all ranks
    logical, intent(in) :: cracked(:)
    !> Distance from a crack within which strengths are reduced
    real(wp), intent(in) :: reach
    !> Strength factor beside cracks
    real(wp), intent(in) :: part
    integer :: cell

    associate (mesh => model%mesh)
      do cell = 1, size(cracked)
        if (.not. cracked(cell)) cycle
        associate (place => mesh%place_of(cell))
          associate (x => mesh%x_edges(place(1):place(1) + 1), y => mesh%y_edges(place(2):place(2) + 1))
            call weaken_around(interfaces, model, zone, x, y, reach, part)
            if (mesh%halved(1) .and. .not. mesh%mirrored(1)) &
              call weaken_around(interfaces, model, zone, -x([2, 1]), -y([2, 1]), reach, part)
          end associate
        end associate
      end do
    end associate
  end subroutine weaken_beside

  !> Reduces the strengths of the undamaged points of an interface within a distance of a rectangle.
  pure subroutine weaken_around(interfaces, model, zone, x, y, reach, part)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> Ends of the rectangle
    real(wp), intent(in) :: x(2), y(2)
    !> The distance
    real(wp), intent(in) :: reach
    !> Strength factor beside cracks
    real(wp), intent(in) :: part
    integer :: i, j, columns(2), rows(2), node, local

    associate (mesh => model%mesh)
      columns = lines_within(mesh%x_edges, x, reach)
      rows = lines_within(mesh%y_edges, y, reach)
      do j = rows(1), rows(2)
        do i = columns(1), columns(2)
          node = mesh%node_at(i, j)
          if (mesh%lower_point(node, zone) == 0) cycle
          local = model%distribution%local(mesh%lower_point(node, zone))
          if (local == 0 .or. local > model%distribution%owned) cycle
          if (model%zone(local) /= zone) cycle
          if (interfaces%strength(local) <= part .or. interfaces%points(local)%damage > 0) cycle
          associate (place => mesh%node_coordinates(:, node))
            if (norm2([distance(place(1), x), distance(place(2), &
                                                       y)]) <= (1 + rounding)*reach) interfaces%strength(local) = part
          end associate
        end do
      end do
    end associate
  end subroutine weaken_around

  !> Lines of nodes that may lie within a distance of an interval, from 0.
  pure function lines_within(edges, ends, reach) result(lines)
    !> Edges of the cells, ascending
    real(wp), intent(in) :: edges(:)
    !> The interval
    real(wp), intent(in) :: ends(2)
    !> The distance
    real(wp), intent(in) :: reach
    !> First and last
    integer :: lines(2)

    lines(1) = 2*max(0, count(edges <= ends(1) - (1 + rounding)*reach) - 1)
    lines(2) = 2*min(size(edges) - 1, count(edges < ends(2) + (1 + rounding)*reach))
  end function lines_within

  !> Cells of the mesh within the distance of a zone in which a crack affects its interface.
  pure function reachable_cells(mesh, zone, reach) result(reachable)
    type(layered_mesh_t), intent(in) :: mesh
    !> Index of the zone
    integer, intent(in) :: zone
    !> Distance from a crack within which strengths are reduced
    real(wp), intent(in) :: reach
    !> (cells)
    logical :: reachable(product(mesh%cells))
    logical :: near(mesh%cells(1)), beside_cut(mesh%cells(1))
    real(wp) :: distance
    integer :: row, first

    distance = (1 + rounding)*reach
    associate (columns => mesh%zones(zone)%columns, rows => mesh%zones(zone)%rows, x => mesh%x_edges, y => mesh%y_edges)
      near = x(2:) + distance >= x(columns(1)) .and. x(:size(near)) - distance <= x(columns(2) + 1)
      ! With point symmetry only cells near the cut have an image within the distance.
      beside_cut = mesh%halved(1) .and. .not. mesh%mirrored(1) .and. x(:size(near)) <= distance
      do row = 1, mesh%cells(2)
        first = (row - 1)*size(near)
        reachable(first + 1:first + size(near)) = beside_cut
        if (y(row + 1) + distance >= y(rows(1)) .and. y(row) - distance <= y(rows(2) + 1)) &
          reachable(first + 1:first + size(near)) = near .or. beside_cut
      end do
    end associate
  end function reachable_cells

  !> Distance of a coordinate from an interval.
  pure real(wp) function distance(x, ends)
    !> The coordinate, and the ends of the interval
    real(wp), intent(in) :: x, ends(2)

    distance = max(0.0_wp, ends(1) - x, x - ends(2))
  end function distance

  !> Saves or loads.
  subroutine visit_flaws(interfaces, archive, model)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    real(wp), allocatable :: fields(:, :)

    if (.not. allocated(interfaces%strength)) return
    allocate (fields(3, size(interfaces%strength)))
    fields(1, :) = interfaces%strength
    fields(2, :) = interfaces%opening
    fields(3, :) = merge(1.0_wp, 0.0_wp, interfaces%by_energy)
    associate (partition => model%distribution)
      call archive%field('cohesive/law', partition%points(:partition%owned), model%mesh%points(), fields)
    end associate
    if (.not. archive%loading) return
    interfaces%strength = fields(1, :)
    interfaces%opening = fields(2, :)
    ! Means of points of another mesh: most of them.
    interfaces%by_energy = fields(3, :) > 0.5_wp
  end subroutine visit_flaws
end module interface_flaws
