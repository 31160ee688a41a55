!> The grid of nine-node cells over the modelled part of the plate, a rectangle.
module cell_grids
  use kinds, only: wp
  use cell_lines, only: cell_line_t, cell_line
  use mesh_parameters, only: plate_t, mesh_t, parts_of, is_halved, is_mirrored
  use gradings, only: graded_half_line, graded_line, cored_half_line, off_centre_line, core_elements, move_to_lines
  use nine_node_grids, only: nine_node_grid_t, last_line
  implicit none
  private
  public :: cell_grid_t, create_grid, cell_edges, cells_along, cells_from_struck, has_enough_elements, fewest_elements
  public :: needs_even_elements

  !> Cells and their nodes.
  type, extends(nine_node_grid_t) :: cell_grid_t
    !> Columns of cells along x, and rows along y
    type(cell_line_t) :: along(2)
    !> Coordinates of the nodes, (2, nodes), x fastest
    real(wp), allocatable :: node_coordinates(:, :)
    !> The struck point
    real(wp) :: struck(2) = 0
    !> Node there
    integer :: struck_node = 0
    !> Models that make up the full plate: 4 for a quarter
    integer :: multiplicity = 1
    !> True along directions in which the model begins at the plate's centre, and in which it is mirrored there
    logical :: halved(2) = .false., mirrored(2) = .false.
  contains
    procedure :: nodes
    procedure :: cell_sides
    procedure :: cell_area
    procedure :: in_patch
    procedure :: struck_side
    procedure :: turned_node
    procedure :: is_dependent
  end type cell_grid_t

contains

  !> Builds the grid of the modelled part.
  pure subroutine create_grid(plate, mesh, self)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    class(cell_grid_t), intent(inout) :: self
    integer :: direction

    self%multiplicity = parts_of(plate%symmetry)
    self%halved = is_halved(plate%symmetry)
    self%mirrored = is_mirrored(plate%symmetry)
    self%struck = mesh%struck
    self%cells = mesh%elements
    do direction = 1, 2
      self%along(direction) = cells_along(plate, mesh, direction)
    end do
    call place_nodes(self)
  end subroutine create_grid

  !> Cells along x or y.
  pure function cells_along(plate, mesh, direction) result(line)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction
    type(cell_line_t) :: line

    line = cell_line(cell_edges(plate, mesh, direction))
  end function cells_along

  !> Cells along x or y, with coordinates from the struck point.
  pure function cells_from_struck(plate, mesh, direction) result(line)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction
    type(cell_line_t) :: line

    line = cells_along(plate, mesh, direction)
    line = line%from(mesh%struck(direction))
  end function cells_from_struck

  !> Edges of the cells along x or y.
  pure function cell_edges(plate, mesh, direction) result(edges)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction
    !> Ascending coordinates, (0:cells)
    real(wp), allocatable :: edges(:)
    logical :: halved(2)
    integer :: half

    allocate (edges(0:mesh%elements(direction)))
    halved = is_halved(plate%symmetry)
    if (abs(mesh%struck(direction)) > 0) then
      edges(:) = off_centre_line(plate%length(direction), mesh%elements(direction), mesh%patch, mesh%grading, &
                                 mesh%core(direction), mesh%cell, mesh%struck(direction))
    else if (mesh%cell > 0) then
      half = merge(0, mesh%elements(direction)/2, halved(direction))
      edges(half:) = cored_half_line(plate%length(direction)/2, mesh%elements(direction) - half, mesh%patch/2, &
                                     mesh%grading, mesh%core(direction)/2, mesh%cell)
      edges(:half) = -edges(2*half:half:-1)
    else if (halved(direction)) then
      edges(:) = graded_half_line(plate%length(direction)/2, mesh%elements(direction), mesh%patch/2, mesh%grading)
    else
      edges(:) = graded_line(plate%length(direction), mesh%elements(direction), mesh%patch, mesh%grading)
    end if
    if (direction == 1 .and. allocated(mesh%x_lines)) call take(mesh%x_lines)
    if (direction == 2 .and. allocated(mesh%y_lines)) call take(mesh%y_lines)

  contains

    !> Moves edges to required lines. The border of the core is kept unless a line is within half a cell of it: it then
    !> moves to that line, as a narrow row of cells between them would limit the step.
    pure subroutine take(lines)
      real(wp), intent(in) :: lines(:)
      real(wp) :: kept(5)
      integer :: i

      kept = mesh%struck(direction) + [-mesh%patch, 0.0_wp, mesh%patch, -mesh%core(direction), mesh%core(direction)]/2
      do i = 4, 5
        if (any(abs(lines - kept(i)) < mesh%cell/2)) kept(i) = mesh%struck(direction)
      end do
      call move_to_lines(edges, kept, lines)
    end subroutine take
  end function cell_edges

  !> True if the elements along x or y suffice for the loaded patch, the core and the plate around them.
  pure logical function has_enough_elements(plate, mesh, direction) result(enough)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction

    associate (number => mesh%elements(direction))
      enough = number >= fewest_elements(plate, mesh, direction)
      if (needs_even_elements(plate, mesh, direction)) enough = enough .and. modulo(number, 2) == 0
    end associate
  end function has_enough_elements

  !> Smallest number of elements along x or y for the loaded patch, the core and the plate around them: the mesh around
  !> a struck point has at least one element outside of them on each side. Beside the middle and without a core the
  !> elements on the patch are as long as those of the mesh.
  pure integer function fewest_elements(plate, mesh, direction) result(fewest)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction
    logical :: halved(2)
    integer :: parts

    halved = is_halved(plate%symmetry)
    parts = merge(1, 2, halved(direction))
    associate (number => mesh%elements(direction), patch => mesh%patch, length => plate%length(direction))
      if (mesh%cell > 0) then
        fewest = parts*(1 + sum(core_elements(patch/2, mesh%core(direction)/2, mesh%cell)))
      else if (abs(mesh%struck(direction)) > 0) then
        fewest = parts*(1 + sum(core_elements(patch/2, 0.0_wp, length/max(number, 1))))
      else
        fewest = merge(3, 1, parts == 2 .and. patch > 0 .and. patch < length)
      end if
    end associate
  end function fewest_elements

  !> True: the core is in the middle, with equal numbers of elements on both sides.
  pure logical function needs_even_elements(plate, mesh, direction) result(even)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: direction
    logical :: halved(2)

    halved = is_halved(plate%symmetry)
    even = mesh%cell > 0 .and. .not. abs(mesh%struck(direction)) > 0 .and. .not. halved(direction)
  end function needs_even_elements

  !> Nodes at the edges and centres of the cells. The struck node is on the line closest to the struck point; every
  !> valid mesh has a line through this point.
  pure subroutine place_nodes(self)
    !> The grid, with its edges known
    class(cell_grid_t), intent(inout) :: self
    real(wp) :: x(0:last_line(self%cells(1))), y(0:last_line(self%cells(2)))
    integer :: i, j

    call edges_and_middles(self%along(1)%bounds(), x)
    call edges_and_middles(self%along(2)%bounds(), y)
    allocate (self%node_coordinates(2, size(x)*size(y)))
    do j = 0, size(y) - 1
      do i = 0, size(x) - 1
        self%node_coordinates(:, self%node_at(i, j)) = [x(i), y(j)]
      end do
    end do
    self%struck_node = self%node_at(minloc(abs(x - self%struck(1)), dim=1) - 1, &
                                    minloc(abs(y - self%struck(2)), dim=1) - 1)
  end subroutine place_nodes

  !> Coordinates of the cells' edges with their middles in between.
  pure subroutine edges_and_middles(edges, coordinates)
    !> Edges, (0:cells)
    real(wp), intent(in) :: edges(0:)
    !> Edges and middles, one per line of nodes
    real(wp), intent(out) :: coordinates(0:)

    coordinates(0::2) = edges
    coordinates(1::2) = (edges(:size(edges) - 2) + edges(1:))/2
  end subroutine edges_and_middles

  !> Number of nodes.
  pure integer function nodes(self)
    class(cell_grid_t), intent(in) :: self
    nodes = size(self%node_coordinates, 2)
  end function nodes

  !> Sides of a cell along x and y.
  pure function cell_sides(self, place) result(sides)
    class(cell_grid_t), intent(in) :: self
    !> Column and row, from 1
    integer, intent(in) :: place(2)
    !> Along x and y
    real(wp) :: sides(2)

    sides = [self%along(1)%side(place(1)), self%along(2)%side(place(2))]
  end function cell_sides

  !> Area of a cell.
  pure real(wp) function cell_area(self, place) result(area)
    class(cell_grid_t), intent(in) :: self
    !> Column and row, from 1
    integer, intent(in) :: place(2)

    area = product(self%cell_sides(place))
  end function cell_area

  !> Image of a node on the cut line of point symmetry: the image of (0, y) is (0, -y). Both have the same w; in-plane
  !> displacements and rotations have the opposite sign. The centre is its own image; other nodes have no image, 0.
  pure integer function turned_node(self, node) result(image)
    class(cell_grid_t), intent(in) :: self
    integer, intent(in) :: node
    integer :: lines(2)

    image = 0
    if (.not. self%halved(1) .or. self%mirrored(1)) return
    lines = self%lines_of(node)
    if (lines(1) == 0) image = self%node_at(0, last_line(self%cells(2)) - lines(2))
  end function turned_node

  !> True for a dependent node: its image has the lower number and determines its motion.
  pure logical function is_dependent(self, node)
    class(cell_grid_t), intent(in) :: self
    integer, intent(in) :: node

    is_dependent = self%turned_node(node) > node
  end function is_dependent

  !> True where a cell lies under the loaded patch.
  pure logical function in_patch(self, cell, patch)
    class(cell_grid_t), intent(in) :: self
    integer, intent(in) :: cell
    !> Side of the patch
    real(wp), intent(in) :: patch
    integer :: nodes(9)

    nodes = self%cell_nodes(cell)
    in_patch = all(abs(self%node_coordinates(:, nodes(5)) - self%struck) < patch/2)
  end function in_patch

  !> Along x and y: -1 where the lower side of a cell lies on the line through the struck point normal to that
  !> direction, 1 where its upper side does, 0 elsewhere.
  pure function struck_side(self, place) result(side)
    class(cell_grid_t), intent(in) :: self
    !> Column and row, from 1
    integer, intent(in) :: place(2)
    !> Along x and y
    integer :: side(2)
    real(wp) :: distance(2, 2)
    integer :: direction

    do direction = 1, 2
      associate (cells => self%along(direction))
        distance(direction, :) = abs(cells%ends(place(direction)) - self%struck(direction))/cells%side(place(direction))
      end associate
    end do
    side = merge(-1, merge(1, 0, distance(:, 2) < 1e-6_wp), distance(:, 1) < 1e-6_wp)
  end function struck_side
end module cell_grids
