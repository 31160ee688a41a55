!> Supports by rigs on a mesh.
!>
!> The edges of a rectangular window are lines of the mesh. The edge of a circular window crosses the cells: w is fixed
!> where it crosses their sides. (If w were fixed at the nearest nodes instead, which lie at several radii, the plate
!> would be almost clamped.) The face of a frame supports the nodes over it, and a clamp fixes the nearest node.
module rigs
  use kinds, only: wp
  use cell_grids, only: cell_grid_t
  use mesh_parameters, only: plate_t, symmetry_point
  use roundings, only: rounding
  use support_parameters, only: support_t, bearing_edge, window_rectangle, window_circle
  implicit none
  private
  public :: crossing_t, window_lines, nodes_on_frame, circle_crossings, clamp_nodes

  !> A point where the edge of a circular window crosses a side of a cell.
  type :: crossing_t
    !> The three of the cell's nine nodes on that side
    integer :: nodes(3) = 0
    !> Weights of their w
    real(wp) :: weights(3) = 0
  end type crossing_t

contains

  !> Coordinates along x or y of the edges of rectangular windows.
  pure function window_lines(supports, direction) result(lines)
    type(support_t), intent(in) :: supports(:)
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

  !> Nodes supported by a frame.
  pure function nodes_on_frame(grid, support) result(on_frame)
    class(cell_grid_t), intent(in) :: grid
    type(support_t), intent(in) :: support
    !> True where the frame supports the plate, (nodes)
    logical, allocatable :: on_frame(:)
    integer :: node

    on_frame = [(support%carries(grid%node_coordinates(:, node)), node=1, grid%nodes())]
  end function nodes_on_frame

  !> Points where a rig fixes w as the edge of its circular window crosses the sides of a cell. Each side belongs to the
  !> cell above it or to its right, a side at the border of the grid to its only cell.
  pure function circle_crossings(grid, support, cell) result(crossings)
    class(cell_grid_t), intent(in) :: grid
    type(support_t), intent(in) :: support
    integer, intent(in) :: cell
    type(crossing_t), allocatable :: crossings(:)
    integer :: place(2), nodes(9)

    allocate (crossings(0))
    if (support%shape /= window_circle .or. support%bearing /= bearing_edge) return
    place = grid%place_of(cell)
    nodes = grid%cell_nodes(cell)
    call add_crossings(grid, support%radius, nodes, [1, 4, 7], 2, crossings)
    call add_crossings(grid, support%radius, nodes, [1, 2, 3], 1, crossings)
    if (place(1) == grid%cells(1)) call add_crossings(grid, support%radius, nodes, [3, 6, 9], 2, crossings)
    if (place(2) == grid%cells(2)) call add_crossings(grid, support%radius, nodes, [7, 8, 9], 1, crossings)
  end function circle_crossings

  !> Adds the points where a circle crosses one side of a cell.
  pure subroutine add_crossings(grid, radius, nodes, side, along, crossings)
    class(cell_grid_t), intent(in) :: grid
    !> Radius of the circle
    real(wp), intent(in) :: radius
    !> Nodes of the cell
    integer, intent(in) :: nodes(9)
    !> Which of them lie on the side, in ascending order of coordinates
    integer, intent(in) :: side(3)
    !> Direction of the side: 1 for x, 2 for y
    integer, intent(in) :: along
    !> Receives the points
    type(crossing_t), allocatable, intent(inout) :: crossings(:)
    real(wp) :: square, xi
    integer :: sign

    associate (first => grid%node_coordinates(:, nodes(side(1))), last => grid%node_coordinates(:, nodes(side(3))))
      square = radius**2 - first(3 - along)**2
      if (square <= 0) return
      do sign = -1, 1, 2
        xi = (2*sign*sqrt(square) - first(along) - last(along))/(last(along) - first(along))
        if (xi < -1 .or. xi >= 1) cycle
        crossings = [crossings, crossing_t(side, [xi*(xi - 1)/2, 1 - xi**2, xi*(xi + 1)/2])]
      end do
    end associate
  end subroutine add_crossings

  !> Nodes at the clamps of a rig; clamps in parts that are not modelled are represented by their images. Of nodes at
  !> the same distance the one closest to the plate's centre is chosen, so that symmetric clamps have symmetric nodes.
  pure function clamp_nodes(grid, plate, support) result(nodes)
    class(cell_grid_t), intent(in) :: grid
    type(plate_t), intent(in) :: plate
    type(support_t), intent(in) :: support
    !> One node per clamp
    integer, allocatable :: nodes(:)
    real(wp) :: point(2), distances(grid%nodes()), radii(grid%nodes())
    integer :: i, node

    allocate (nodes(0))
    if (.not. allocated(support%clamps)) return
    radii = [(norm2(grid%node_coordinates(:, node)), node=1, size(radii))]
    do i = 1, size(support%clamps, 2)
      point = support%clamps(:, i)
      if (plate%symmetry == symmetry_point .and. point(1) < 0) point = -point
      where (grid%mirrored) point = abs(point)
      distances = [(norm2(grid%node_coordinates(:, node) - point), node=1, size(distances))]
      nodes = [nodes, minloc(radii, dim=1, mask=distances <= minval(distances) + rounding*maxval(radii))]
    end do
  end function clamp_nodes
end module rigs
