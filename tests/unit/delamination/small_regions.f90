!> Small meshes and regions given as pictures, for the tests of the front.
module small_regions
  use cell_lines, only: cell_line
  use delaminated_regions, only: delaminated_region_t, create_region
  use kinds, only: wp
  use interface_zones, only: zone_t
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: mesh_with_zone, drawn_region, released_nodes

contains

  !> A mesh of given edges with one zone; only the components that regions and fronts use are set.
  pure function mesh_with_zone(x_edges, y_edges, columns, rows) result(mesh)
    real(wp), intent(in) :: x_edges(:), y_edges(:)
    integer, intent(in) :: columns(2), rows(2)
    type(layered_mesh_t) :: mesh
    integer :: i, j

    mesh%along(1) = cell_line(x_edges)
    mesh%along(2) = cell_line(y_edges)
    mesh%cells = [size(x_edges) - 1, size(y_edges) - 1]
    mesh%zones = [zone_t(below_ply=1, columns=columns, rows=rows)]
    allocate (mesh%node_coordinates(2, product(2*mesh%cells + 1)))
    do j = 0, 2*mesh%cells(2)
      do i = 0, 2*mesh%cells(1)
        mesh%node_coordinates(:, mesh%node_at(i, j)) = [x_edges(i/2 + 1) + x_edges((i + 1)/2 + 1), &
                                                        y_edges(j/2 + 1) + y_edges((j + 1)/2 + 1)]/2
      end do
    end do
  end function mesh_with_zone

  !> A region whose zone is a complete mesh of unit cells; `picture` shows the rows from the top down, `#` is
  !> delaminated.
  subroutine drawn_region(picture, mesh, region)
    character(len=*), intent(in) :: picture(:)
    type(layered_mesh_t), intent(out) :: mesh
    type(delaminated_region_t), intent(out) :: region
    integer :: column, row, i

    mesh = mesh_with_zone([(real(i, wp), i=0, len(picture))], [(real(i, wp), i=0, size(picture))], &
                          [1, len(picture)], [1, size(picture)])
    region = create_region(mesh, 1, 0.0_wp)
    do row = 1, size(picture)
      do column = 1, len(picture)
        if (picture(size(picture) + 1 - row)(column:column) == '#') call region%release([column, row])
      end do
    end do
  end subroutine drawn_region

  !> Nodes whose faces are released, in ascending order.
  pure function released_nodes(region) result(nodes)
    type(delaminated_region_t), intent(in) :: region
    integer, allocatable :: nodes(:)
    integer :: i, j

    allocate (nodes(0))
    do j = 0, 2*region%cells(2)
      do i = 0, 2*region%cells(1)
        if (region%released(i, j)) nodes = [nodes, region%node_at(i, j)]
      end do
    end do
  end function released_nodes
end module small_regions
