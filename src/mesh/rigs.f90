!> Where rigs hold the plate on a mesh.
!>
!> The edges of a rectangular window are lines of the mesh. Those of a circular one run through the cells, and the
!> node nearer to the circle bears on each line of nodes that it cuts: its mean radius is right, and the error falls
!> with the first power of the cells. A clamp holds the node nearest to it.
module rigs
  use kinds, only: wp
  use cell_grids, only: cell_grid_t
  use mesh_parameters, only: plate_t, symmetry_point
  use nine_node_grids, only: last_line
  use support_parameters, only: support_t, bearing_edge, window_none, window_rectangle
  implicit none
  private
  public :: window_lines, nodes_on_frame, clamp_nodes, clamp_share

contains

  !> Coordinates along x or y of the edges of rectangular windows.
  pure function window_lines(supports, direction) result(lines)
    !> The rigs
    type(support_t), intent(in) :: supports(:)
    !> 1 for x, 2 for y
    integer, intent(in) :: direction
    !> Both edges of each
    real(wp), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(supports)
      if (supports(i)%shape /= window_rectangle) cycle
      lines = [lines, -supports(i)%window(direction)/2, supports(i)%window(direction)/2]
    end do
  end function window_lines

  !> Nodes that a frame bears: those over its face, or of these the ones beside its window.
  pure function nodes_on_frame(grid, support) result(borne)
    !> The grid
    class(cell_grid_t), intent(in) :: grid
    !> The rig
    type(support_t), intent(in) :: support
    !> True where the frame bears the plate, (nodes)
    logical, allocatable :: borne(:)
    logical :: rests(grid%nodes())
    integer :: node, nearby(4), found

    allocate (borne(grid%nodes()), source=.false.)
    if (support%shape == window_none) return
    do node = 1, size(rests)
      call find_neighbours(grid, node, nearby, found)
      rests(node) = rests_there(grid, support, node, nearby(:found))
    end do
    borne = rests
    if (support%bearing /= bearing_edge) return
    do node = 1, size(rests)
      call find_neighbours(grid, node, nearby, found)
      borne(node) = rests(node) .and. .not. all(rests(nearby(:found)))
    end do
    ! A corner of a rectangular window touches nothing but the frame, yet is part of its edge.
    if (support%shape == window_rectangle) borne = borne .or. rests .and. at_edge(grid, support)
  end function nodes_on_frame

  !> Nodes on the edge of a rectangular window.
  pure function at_edge(grid, support)
    !> The grid
    class(cell_grid_t), intent(in) :: grid
    !> The rig
    type(support_t), intent(in) :: support
    !> True there, (nodes)
    logical :: at_edge(grid%nodes())
    integer :: node

    at_edge = [(abs(support%beyond(grid%node_coordinates(:, node))) <= 1.0e-9_wp*maxval(support%window), &
                node=1, size(at_edge))]
  end function at_edge

  !> True if a frame bears a node: it lies over the frame, and none that is nearer to the edge does so in its place; or
  !> it is nearer to the edge than one that does.
  pure logical function rests_there(grid, support, node, nearby) result(rests)
    !> The grid
    class(cell_grid_t), intent(in) :: grid
    !> The rig
    type(support_t), intent(in) :: support
    !> Node
    integer, intent(in) :: node
    !> Nodes beside it on its lines
    integer, intent(in) :: nearby(:)
    real(wp) :: here, there
    integer :: i

    here = support%beyond(grid%node_coordinates(:, node))
    rests = here >= -1.0e-9_wp*maxval([support%window, support%radius])
    if (rests .or. support%shape == window_rectangle) return
    do i = 1, size(nearby)
      there = support%beyond(grid%node_coordinates(:, nearby(i)))
      rests = rests .or. there > 0 .and. -here < there
    end do
  end function rests_there

  !> Nodes beside a node on its two lines of nodes.
  pure subroutine find_neighbours(grid, node, nearby, found)
    !> The grid
    class(cell_grid_t), intent(in) :: grid
    !> Node
    integer, intent(in) :: node
    !> The nodes beside it, (found of 4)
    integer, intent(out) :: nearby(4)
    !> Their number
    integer, intent(out) :: found
    integer :: lines(2), next(2), direction, side

    lines = grid%lines_of(node)
    found = 0
    do direction = 1, 2
      do side = -1, 1, 2
        next = lines
        next(direction) = next(direction) + side
        if (next(direction) < 0 .or. next(direction) > last_line(grid%cells(direction))) cycle
        found = found + 1
        nearby(found) = grid%node_at(next(1), next(2))
      end do
    end do
  end subroutine find_neighbours

  !> Nodes that the clamps of a rig hold, those in parts of the plate that are not modelled by their images.
  pure function clamp_nodes(grid, plate, support) result(nodes)
    !> The grid
    class(cell_grid_t), intent(in) :: grid
    !> Plate and symmetry
    type(plate_t), intent(in) :: plate
    !> The rig
    type(support_t), intent(in) :: support
    !> A node a clamp
    integer, allocatable :: nodes(:)
    real(wp) :: point(2), distances(grid%nodes())
    integer :: i, node

    allocate (nodes(0))
    if (.not. allocated(support%clamps)) return
    do i = 1, size(support%clamps, 2)
      point = support%clamps(:, i)
      if (plate%symmetry == symmetry_point .and. point(1) < 0) point = -point
      where (grid%mirrored) point = abs(point)
      distances = [(norm2(grid%node_coordinates(:, node) - point), node=1, size(distances))]
      nodes = [nodes, minloc(distances, dim=1)]
    end do
  end function clamp_nodes

  !> Part of a clamp's stiffness that the model has, as each of the plate's clamps is listed and has its image in every
  !> part of the plate.
  pure real(wp) function clamp_share(grid)
    !> The grid
    class(cell_grid_t), intent(in) :: grid

    clamp_share = 1.0_wp/grid%multiplicity
  end function clamp_share
end module rigs
