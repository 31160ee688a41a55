!> Common lengths of the intervals of two divisions of one line, where intervals are cells or the parts of cells
!> assigned to their nodes; theory (D14). A line halved by symmetry is continued on the other side of the cut by its
!> image.
module line_overlaps
  use cell_lines, only: cell_line_t
  use kinds, only: wp
  use roundings, only: rounding
  implicit none
  private
  public :: line_overlap_t, node_bounds, overlaps_of, overlaps_of_nodes, overlaps_of_node_parts, parts_of, unfolded

  !> Intervals of the other division that have a length in common with an interval.
  type :: line_overlap_t
    !> Their numbers, from 1
    integer, allocatable :: interval(:)
    !> True: the interval is an image
    logical, allocatable :: turned(:)
    !> Lengths in common
    real(wp), allocatable :: length(:)
  end type line_overlap_t

  !> Fraction of a cell's side that is assigned to each node at its ends: the integral of its quadratic shape function.
  real(wp), parameter :: end_part = 1.0_wp/6.0_wp

contains

  !> Bounds of the parts of a line that are assigned to its nodes, (nodes + 1). For a line that begins on a cut, the
  !> part of the first node includes its image.
  pure function node_bounds(edges, halved) result(bounds)
    !> Edges of the cells, ascending
    real(wp), intent(in) :: edges(:)
    !> True: the line begins on a cut at 0
    logical, intent(in) :: halved
    !> Ascending
    real(wp) :: bounds(2*size(edges))
    real(wp) :: ends(size(edges) - 1)

    associate (low => edges(:size(edges) - 1), high => edges(2:))
      ends = end_part*(high - low)
      bounds(1) = edges(1)
      bounds(2:2*size(ends):2) = low + ends
      bounds(3:2*size(ends) + 1:2) = high - ends
      bounds(size(bounds)) = edges(size(edges))
    end associate
    if (halved) bounds(1) = -bounds(2)
  end function node_bounds

  !> Bounds of a line and of its image.
  pure function unfolded(bounds, halved) result(whole)
    !> Ascending bounds of intervals, from 0 if halved
    real(wp), intent(in) :: bounds(:)
    !> True: the line begins on a cut at 0
    logical, intent(in) :: halved
    !> Those of the whole line
    real(wp), allocatable :: whole(:)

    whole = bounds
    if (halved) whole = [-bounds(size(bounds):2:-1), 0.0_wp, bounds(2:)]
  end function unfolded

  !> Overlaps of the intervals of one division of a line with those of another.
  pure function overlaps_of(bounds, others, halved) result(overlaps)
    !> Ascending bounds of the intervals, and of those of the other division; the latter from 0 if halved
    real(wp), intent(in) :: bounds(:), others(:)
    !> True: the other division begins on a cut at 0 and is continued by its image
    logical, intent(in) :: halved
    !> (intervals)
    type(line_overlap_t) :: overlaps(size(bounds) - 1)
    real(wp), allocatable :: whole(:)
    integer, allocatable :: numbers(:)
    integer :: i, k, images

    whole = unfolded(others, halved)
    images = merge(size(others) - 1, 0, halved)
    do i = 1, size(overlaps)
      associate (common => min(bounds(i + 1), whole(2:)) - max(bounds(i), whole(:size(whole) - 1)))
        numbers = pack([(k, k=1, size(common))], common > rounding*(bounds(i + 1) - bounds(i)))
        overlaps(i)%length = common(numbers)
      end associate
      overlaps(i)%turned = numbers <= images
      overlaps(i)%interval = merge(images + 1 - numbers, numbers - images, overlaps(i)%turned)
    end do
  end function overlaps_of

  !> Overlaps of the parts of cells that are assigned to the nodes of a line with those of another.
  pure function overlaps_of_nodes(line, begins_on_cut, origin, others, halved) result(overlaps)
    !> The line, and the other one
    type(cell_line_t), intent(in) :: line, others
    !> True: the line begins on a cut at 0
    logical, intent(in) :: begins_on_cut
    !> Origin of the line in the coordinates of the other one
    real(wp), intent(in) :: origin
    !> True: the other line begins on a cut at 0 and is continued by its image
    logical, intent(in) :: halved
    !> (nodes)
    type(line_overlap_t), allocatable :: overlaps(:)
    real(wp), allocatable :: bounds(:)
    real(wp) :: ends(2)

    bounds = node_bounds(others%bounds(), halved)
    ends = others%span()
    bounds(1) = ends(1)
    overlaps = overlaps_of(node_bounds(line%bounds(), begins_on_cut) + origin, bounds, halved)
  end function overlaps_of_nodes

  !> Overlaps of the three parts of each cell of a line, which are assigned to its nodes, with the parts of cells
  !> assigned to the nodes of another line.
  pure function overlaps_of_node_parts(line, origin, others, halved) result(overlaps)
    !> The line, and the other one
    type(cell_line_t), intent(in) :: line, others
    !> Origin of the line in the coordinates of the other one
    real(wp), intent(in) :: origin
    !> True: the other line begins on a cut at 0 and is continued by its image
    logical, intent(in) :: halved
    !> (3*cells)
    type(line_overlap_t), allocatable :: overlaps(:)
    real(wp), allocatable :: bounds(:), nodes(:), edges(:)
    real(wp) :: ends(2)
    integer :: cells

    edges = line%bounds()
    cells = size(edges) - 1
    nodes = node_bounds(edges, .false.)
    allocate (bounds(3*cells + 1))
    bounds(1::3) = edges
    bounds(2::3) = nodes(2:2*cells:2)
    bounds(3::3) = nodes(3:2*cells + 1:2)
    nodes = node_bounds(others%bounds(), halved)
    ends = others%span()
    nodes(1) = ends(1)
    overlaps = overlaps_of(bounds + origin, nodes, halved)
  end function overlaps_of_node_parts

  !> Part of each interval between two coordinates.
  pure function parts_of(bounds, low, high) result(parts)
    !> Ascending bounds of the intervals
    real(wp), intent(in) :: bounds(:)
    !> The coordinates
    real(wp), intent(in) :: low, high
    !> 0 to 1, (intervals)
    real(wp) :: parts(size(bounds) - 1)

    associate (begins => bounds(:size(parts)), ends => bounds(2:))
      parts = max(0.0_wp, min(ends, high) - max(begins, low))/(ends - begins)
    end associate
  end function parts_of
end module line_overlaps
