!> The cells along one direction of the rectangle: rows or columns, whose edges are known to the mesh only.
module cell_lines
  use kinds, only: wp
  use lagrange9, only: line_values
  use roundings, only: rounding
  implicit none
  private
  public :: cell_line_t, cell_line

  !> Tolerance of round-off of an extent, in cells: far above 1e-16, and extents are compared in whole cells.
  real(wp), parameter :: rounding_of_cells = 1.0e-6_wp

  !> Cells one after the other.
  type :: cell_line_t
    !> Ascending coordinates, (cells + 1)
    real(wp), allocatable, private :: edges(:)
  contains
    procedure :: bounds
    procedure :: from
    procedure :: turned
    procedure :: cells
    procedure :: ends
    procedure :: side
    procedure :: sides
    procedure :: middles
    procedure :: span
    procedure :: within
    procedure :: extent_of
    procedure :: widened
    procedure :: touching
    procedure :: locate
    procedure :: nearest_node
    procedure :: place_of_node
    procedure :: share_of_node
    procedure :: nodes_near
    procedure :: cells_beyond
    procedure :: with_image
    procedure :: is_equal
    procedure :: distance_of
    procedure :: longest_within
    procedure :: mean_side
  end type cell_line_t

contains

  !> Cells between edges.
  pure function cell_line(edges) result(line)
    !> Ascending coordinates
    real(wp), intent(in) :: edges(:)
    type(cell_line_t) :: line

    line%edges = edges
  end function cell_line

  !> Edges of the cells, for the mesh itself.
  pure function bounds(self)
    class(cell_line_t), intent(in) :: self
    real(wp) :: bounds(size(self%edges))

    bounds = self%edges
  end function bounds

  !> The same cells, with coordinates from another origin.
  pure function from(self, origin) result(line)
    class(cell_line_t), intent(in) :: self
    !> Its coordinate
    real(wp), intent(in) :: origin
    type(cell_line_t) :: line

    line%edges = self%edges - origin
  end function from

  !> The cells in the opposite direction.
  pure function turned(self) result(line)
    class(cell_line_t), intent(in) :: self
    type(cell_line_t) :: line

    line%edges = -self%edges(size(self%edges):1:-1)
  end function turned

  !> Number of cells.
  pure integer function cells(self)
    class(cell_line_t), intent(in) :: self

    cells = size(self%edges) - 1
  end function cells

  !> Coordinates of the ends of a cell.
  pure function ends(self, cell)
    class(cell_line_t), intent(in) :: self
    integer, intent(in) :: cell
    real(wp) :: ends(2)

    ends = self%edges(cell:cell + 1)
  end function ends

  !> Side of a cell.
  pure real(wp) function side(self, cell)
    class(cell_line_t), intent(in) :: self
    integer, intent(in) :: cell

    side = self%edges(cell + 1) - self%edges(cell)
  end function side

  !> Sides of all cells.
  pure function sides(self)
    class(cell_line_t), intent(in) :: self
    real(wp) :: sides(size(self%edges) - 1)

    sides = self%edges(2:) - self%edges(:size(sides))
  end function sides

  !> Middles of all cells.
  pure function middles(self)
    class(cell_line_t), intent(in) :: self
    real(wp) :: middles(size(self%edges) - 1)

    middles = (self%edges(2:) + self%edges(:size(middles)))/2
  end function middles

  !> Ends of a range of cells; left out: of all.
  pure function span(self, range)
    class(cell_line_t), intent(in) :: self
    !> First and last cell
    integer, intent(in), optional :: range(2)
    real(wp) :: span(2)

    span = self%edges([1, size(self%edges)])
    if (present(range)) span = self%edges([range(1), range(2) + 1])
  end function span

  !> First and last cell whose centre is within an extent centred on the origin; at least those that touch the origin.
  pure function within(self, extent) result(range)
    class(cell_line_t), intent(in) :: self
    !> Full extent
    real(wp), intent(in) :: extent
    !> First and last cell
    integer :: range(2)
    logical :: taken(size(self%edges) - 1)
    real(wp) :: distance
    integer :: cells, cell

    cells = size(taken)
    associate (edges => self%edges)
      distance = rounding*(edges(cells + 1) - edges(1))
      ! A centre exactly on the border counts as outside, by a tolerance that does not depend on units.
      taken = abs(edges(:cells) + edges(2:)) < extent - distance .or. &
              (edges(:cells) < distance .and. edges(2:) > -distance)
    end associate
    range = [findloc(taken, .true., dim=1), cells]
    do cell = range(1), cells
      if (taken(cell)) range(2) = cell
    end do
  end function within

  !> Extent of the entire cells within an extent centred on the origin, on the full plate.
  pure real(wp) function extent_of(self, extent) result(taken)
    class(cell_line_t), intent(in) :: self
    !> Requested full extent
    real(wp), intent(in) :: extent
    integer :: range(2)

    range = self%within(extent)
    associate (edges => self%edges)
      taken = edges(range(2) + 1) - edges(range(1))
      ! A model that begins at the plate's centre and is struck there contains half of the extent.
      if (edges(1) > -rounding*edges(size(edges))) taken = 2*taken
    end associate
  end function extent_of

  !> Extent widened on each side by a number of cells of the size of its outermost ones: by fewer cells where their size
  !> increases with the distance, but by at least one if there is one.
  pure real(wp) function widened(self, extent, cells, least) result(wider)
    class(cell_line_t), intent(in) :: self
    !> The extent to be widened, centred on the origin
    real(wp), intent(in) :: extent
    !> Cells on each side
    integer, intent(in) :: cells
    !> Smallest length of the extension, rounded up to cells
    real(wp), intent(in), optional :: least
    real(wp) :: reach, side
    integer :: range(2), last

    associate (edges => self%edges)
      last = size(edges) - 1
      range = self%within(extent)
      side = edges(range(2) + 1) - edges(range(2))
      ! In a model that begins at the struck point, the first cell of the range is the innermost one.
      if (edges(1) < -rounding_of_cells*edges(last + 1)) side = min(side, edges(range(1) + 1) - edges(range(1)))
      reach = extent/2 + (cells - rounding_of_cells)*side
      if (present(least)) reach = max(reach, extent/2 + least*(1 - rounding_of_cells))
      range = [max(1, range(1) - 1), min(last, range(2) + 1)]
      do while (range(1) > 1 .and. edges(range(1)) > -reach)
        range(1) = range(1) - 1
      end do
      do while (range(2) < last .and. edges(range(2) + 1) < reach)
        range(2) = range(2) + 1
      end do
      wider = 2*max(-edges(range(1)), edges(range(2) + 1))
    end associate
  end function widened

  !> Cell that contains a coordinate, or both adjacent cells if the coordinate is an edge.
  pure function touching(self, at) result(cells)
    class(cell_line_t), intent(in) :: self
    !> The coordinate, on the plate
    real(wp), intent(in) :: at
    !> One or two
    integer, allocatable :: cells(:)
    real(wp) :: same
    integer :: cell

    associate (edges => self%edges)
      same = rounding*(edges(size(edges)) - edges(1))
      cells = [(cell, cell=max(1, count(edges < at - same)), min(size(edges) - 1, count(edges <= at + same)))]
    end associate
  end function touching

  !> Cell of a coordinate, and the quadratic shape functions there.
  pure subroutine locate(self, coordinate, cell, shapes)
    class(cell_line_t), intent(in) :: self
    !> The coordinate
    real(wp), intent(in) :: coordinate
    integer, intent(out) :: cell
    !> One value per node
    real(wp), intent(out) :: shapes(3)

    associate (edges => self%edges)
      cell = max(1, min(size(edges) - 1, count(edges <= coordinate)))
      shapes = line_values((2*coordinate - edges(cell) - edges(cell + 1))/(edges(cell + 1) - edges(cell)))
    end associate
  end subroutine locate

  !> Line of nodes next to a coordinate, from 0.
  pure integer function nearest_node(self, at) result(node)
    class(cell_line_t), intent(in) :: self
    real(wp), intent(in) :: at
    integer :: k

    node = minloc([(abs(self%place_of_node(k) - at), k=0, 2*size(self%edges) - 2)], dim=1) - 1
  end function nearest_node

  !> Coordinate of a line of nodes.
  pure real(wp) function place_of_node(self, node) result(place)
    class(cell_line_t), intent(in) :: self
    !> Index of the line, from 0
    integer, intent(in) :: node

    place = (self%edges(node/2 + 1) + self%edges((node + 1)/2 + 1))/2
  end function place_of_node

  !> Fraction of the length of all cells that is assigned to a node, by Simpson's rule.
  pure real(wp) function share_of_node(self, node) result(share)
    class(cell_line_t), intent(in) :: self
    !> Index of the node, from 0
    integer, intent(in) :: node
    integer :: cell, cells

    associate (edges => self%edges)
      cells = size(edges) - 1
      cell = node/2
      share = 0
      if (modulo(node, 2) == 1) then
        share = 4*(edges(cell + 2) - edges(cell + 1))
      else
        if (cell > 0) share = edges(cell + 1) - edges(cell)
        if (cell < cells) share = share + edges(cell + 2) - edges(cell + 1)
      end if
      share = share/(6*(edges(cells + 1) - edges(1)))
    end associate
  end function share_of_node

  !> Lines of nodes that may lie within a distance of an interval, from 0.
  pure function nodes_near(self, ends, distance) result(lines)
    class(cell_line_t), intent(in) :: self
    !> The interval
    real(wp), intent(in) :: ends(2)
    real(wp), intent(in) :: distance
    !> First and last
    integer :: lines(2)

    associate (edges => self%edges)
      lines(1) = 2*max(0, count(edges <= ends(1) - distance) - 1)
      lines(2) = 2*min(size(edges) - 1, count(edges < ends(2) + distance))
    end associate
  end function nodes_near

  !> Number of cells that end beyond a coordinate.
  pure integer function cells_beyond(self, at) result(cells)
    class(cell_line_t), intent(in) :: self
    real(wp), intent(in) :: at

    cells = count(self%edges > at)
  end function cells_beyond

  !> Cells that begin at 0, and their image.
  pure function with_image(self) result(line)
    class(cell_line_t), intent(in) :: self
    type(cell_line_t) :: line

    line%edges = [-self%edges(size(self%edges):2:-1), self%edges]
  end function with_image

  !> True: two lines have the same cells.
  pure logical function is_equal(self, other, tolerance)
    class(cell_line_t), intent(in) :: self
    !> The other line
    type(cell_line_t), intent(in) :: other
    !> Largest distance of equal edges
    real(wp), intent(in) :: tolerance

    is_equal = size(self%edges) == size(other%edges)
    if (is_equal) is_equal = all(abs(self%edges - other%edges) <= tolerance)
  end function is_equal

  !> Distance of a coordinate from the next edge of a cell; 0 below the first one.
  pure real(wp) function distance_of(self, at) result(distance)
    class(cell_line_t), intent(in) :: self
    real(wp), intent(in) :: at

    distance = 0
    if (at > self%edges(1)) distance = minval(abs(self%edges - at))
  end function distance_of

  !> Longest side of the cells within an extent centred on the origin.
  pure real(wp) function longest_within(self, extent) result(longest)
    class(cell_line_t), intent(in) :: self
    !> Full extent
    real(wp), intent(in) :: extent
    real(wp) :: sides(size(self%edges) - 1)
    integer :: range(2)

    sides = self%sides()
    range = self%within(extent)
    longest = maxval(sides(range(1):range(2)))
  end function longest_within

  !> Mean side of the cells within a distance of the origin, parts of cells included.
  pure real(wp) function mean_side(self, distance) result(side)
    class(cell_line_t), intent(in) :: self
    real(wp), intent(in) :: distance
    real(wp) :: within(size(self%edges) - 1)

    associate (n => size(self%edges))
      within = max(0.0_wp, min(self%edges(2:), distance) - max(self%edges(:n - 1), -distance))
    end associate
    side = sum(within)/sum(within/self%sides())
  end function mean_side
end module cell_lines
