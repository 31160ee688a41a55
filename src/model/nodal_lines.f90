!> Lines of nodes of the mesh across the plate, and the nodes' fractions of their length.
module nodal_lines
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: edges_of, node_line, place_of_node, simpson_weight

contains

  !> Edges of the cells along x or y.
  pure function edges_of(mesh, direction) result(edges)
    type(layered_mesh_t), intent(in) :: mesh
    !> 1 for x, 2 for y
    integer, intent(in) :: direction
    !> Ascending
    real(wp), allocatable :: edges(:)

    if (direction == 1) then
      edges = mesh%x_edges
    else
      edges = mesh%y_edges
    end if
  end function edges_of

  !> Line of nodes next to a coordinate, from 0.
  pure integer function node_line(edges, at) result(line)
    !> Edges of the cells
    real(wp), intent(in) :: edges(:)
    !> The coordinate
    real(wp), intent(in) :: at
    integer :: k

    line = minloc([(abs(place_of_node(edges, k) - at), k=0, 2*size(edges) - 2)], dim=1) - 1
  end function node_line

  !> Coordinate of a line of nodes.
  pure real(wp) function place_of_node(edges, line) result(place)
    !> Edges of the cells
    real(wp), intent(in) :: edges(:)
    !> Index of the line, from 0
    integer, intent(in) :: line

    place = (edges(line/2 + 1) + edges((line + 1)/2 + 1))/2
  end function place_of_node

  !> Fraction of the length of a line of nodes that is assigned to a node.
  pure real(wp) function simpson_weight(edges, line) result(weight)
    !> Edges of the cells along it
    real(wp), intent(in) :: edges(:)
    !> Index of the node, from 0
    integer, intent(in) :: line
    integer :: cell, cells

    cells = size(edges) - 1
    cell = line/2
    weight = 0
    if (modulo(line, 2) == 1) then
      weight = 4*(edges(cell + 2) - edges(cell + 1))
    else
      if (cell > 0) weight = edges(cell + 1) - edges(cell)
      if (cell < cells) weight = weight + edges(cell + 2) - edges(cell + 1)
    end if
    weight = weight/(6*(edges(cells + 1) - edges(1)))
  end function simpson_weight
end module nodal_lines
