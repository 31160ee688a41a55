!> The part of a plate that another plate is cut from, and what of its nodes and cells lies in that part.
module plate_cuts
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use line_overlaps, only: node_bounds, parts_of
  use roundings, only: rounding
  implicit none
  private
  public :: plate_cut_t

  !> A rectangle along the plate's edges.
  type :: plate_cut_t
    !> Centre in the coordinates of the plate it is cut from
    real(wp) :: centre(2) = 0
    !> Sides along x and y
    real(wp) :: length(2) = 0
  contains
    procedure :: is_whole
    procedure :: lies_within
    procedure :: of_nodes
    procedure :: of_cells
  end type plate_cut_t

contains

  !> True if nothing is cut away.
  pure logical function is_whole(self, length)
    class(plate_cut_t), intent(in) :: self
    real(wp), intent(in) :: length(2)

    is_whole = all(abs(self%length - length) <= rounding*length)
  end function is_whole

  !> True if it lies within a plate.
  pure logical function lies_within(self, length)
    class(plate_cut_t), intent(in) :: self
    real(wp), intent(in) :: length(2)

    lies_within = all(self%length/2 + abs(self%centre) <= (0.5_wp + rounding)*length)
  end function lies_within

  !> Part of the area of each node inside of the cut.
  pure function of_nodes(self, mesh) result(parts)
    class(plate_cut_t), intent(in) :: self
    !> Mesh of the plate, or of its modelled part
    type(layered_mesh_t), intent(in) :: mesh
    !> 0 to 1, (nodes)
    real(wp) :: parts(mesh%nodes())
    real(wp), allocatable :: x(:, :), y(:, :)
    integer :: node, lines(2)

    x = both_parts(self, node_bounds(mesh%along(1)%bounds(), .false.), 1)
    y = both_parts(self, node_bounds(mesh%along(2)%bounds(), .false.), 2)
    do node = 1, size(parts)
      lines = mesh%lines_of(node) + 1
      parts(node) = part_of(mesh, x(:, lines(1)), y(:, lines(2)))
      ! On the line of point symmetry the area of a node includes that of its image.
      if (mesh%turned_node(node) > 0) parts(node) = sum(x(:, lines(1)))*sum(y(:, lines(2)))/4
    end do
  end function of_nodes

  !> Part of the area of each cell inside of the cut.
  pure function of_cells(self, mesh) result(parts)
    class(plate_cut_t), intent(in) :: self
    !> Mesh of the plate, or of its modelled part
    type(layered_mesh_t), intent(in) :: mesh
    !> 0 to 1, (cells)
    real(wp) :: parts(product(mesh%cells))
    real(wp), allocatable :: x(:, :), y(:, :)
    integer :: cell, place(2)

    x = both_parts(self, mesh%along(1)%bounds(), 1)
    y = both_parts(self, mesh%along(2)%bounds(), 2)
    do cell = 1, size(parts)
      place = mesh%place_of(cell)
      parts(cell) = part_of(mesh, x(:, place(1)), y(:, place(2)))
    end do
  end function of_cells

  !> Part of each interval of a line inside of the cut, and inside of the image of the cut on the other side of 0.
  pure function both_parts(self, bounds, direction) result(parts)
    class(plate_cut_t), intent(in) :: self
    !> Ascending bounds of the intervals
    real(wp), intent(in) :: bounds(:)
    integer, intent(in) :: direction
    !> 0 to 1, (2, intervals)
    real(wp) :: parts(2, size(bounds) - 1)

    associate (middle => self%centre(direction), half => self%length(direction)/2)
      parts(1, :) = parts_of(bounds, middle - half, middle + half)
      parts(2, :) = parts_of(bounds, -middle - half, -middle + half)
    end associate
  end function both_parts

  !> Part of a rectangle and of its images in the full plate: their mean.
  pure real(wp) function part_of(mesh, x, y) result(part)
    type(layered_mesh_t), intent(in) :: mesh
    !> Parts of its intervals along x and y, and of their images
    real(wp), intent(in) :: x(2), y(2)

    if (mesh%halved(1) .and. .not. mesh%mirrored(1)) then
      part = dot_product(x, y)/2
    else
      part = merge(sum(x)/2, x(1), mesh%halved(1))*merge(sum(y)/2, y(1), mesh%halved(2))
    end if
  end function part_of
end module plate_cuts
