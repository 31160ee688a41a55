!> The front of a delaminated region: the edges between delaminated and intact cells.
module delamination_fronts
  use delaminated_regions, only: delaminated_region_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: middle_line
  implicit none
  private
  public :: front_segment_t, find_front

  !> One edge of the front.
  type :: front_segment_t
    !> Column and row of the delaminated cell and of the intact one
    integer :: inside(2) = 0, outside(2) = 0
    !> Outward normal: along x (1) or y (2), and its sign
    integer :: direction = 0, sign = 0
    !> True at the border of the zone, where the delamination cannot grow
    logical :: at_border = .false.
    !> Nodes of the edge: first corner, middle and second corner, corners in ascending order of coordinates
    integer :: edge(3) = 0
    !> Length of the edge, and lengths of both cells across it
    real(wp) :: width = 0, ahead_length = 0, behind_length = 0
  end type front_segment_t

  !> Steps from a cell to its neighbours.
  integer, parameter :: neighbours(2, 4) = reshape([-1, 0, 1, 0, 0, -1, 0, 1], [2, 4])

contains

  !> All segments of a region's front, sorted by intact cell. Edges on the border of the model and on its symmetry lines
  !> are not part of the front.
  pure function find_front(region, mesh) result(segments)
    !> The delaminated cells
    type(delaminated_region_t), intent(in) :: region
    type(layered_mesh_t), intent(in) :: mesh
    type(front_segment_t), allocatable :: segments(:)
    integer :: column, row, side, inside(2)

    allocate (segments(0))
    do row = max(1, region%rows(1) - 1), min(region%cells(2), region%rows(2) + 1)
      do column = max(1, region%columns(1) - 1), min(region%cells(1), region%columns(2) + 1)
        if (region%is_delaminated(column, row)) cycle
        do side = 1, size(neighbours, 2)
          inside = [column, row] - neighbours(:, side)
          if (region%is_delaminated(inside(1), inside(2))) &
            segments = [segments, segment_between(region, mesh, inside, neighbours(:, side))]
        end do
      end do
    end do
  end function find_front

  !> The segment on one side of a delaminated cell.
  pure function segment_between(region, mesh, inside, step) result(segment)
    !> The delaminated cells
    type(delaminated_region_t), intent(in) :: region
    type(layered_mesh_t), intent(in) :: mesh
    !> Column and row of the delaminated cell
    integer, intent(in) :: inside(2)
    !> Step to the intact cell
    integer, intent(in) :: step(2)
    type(front_segment_t) :: segment
    integer :: place(2), along(2), line

    along = 1 - abs(step)
    segment%inside = inside
    segment%outside = inside + step
    segment%direction = merge(1, 2, step(1) /= 0)
    segment%sign = sum(step)
    segment%at_border = .not. region%in_zone(segment%outside(1), segment%outside(2))
    do line = 1, 3
      ! The line of nodes on the edge is next to that through the centre of the cell.
      place = middle_line(inside) + step + (line - 2)*along
      segment%edge(line) = region%node_at(place(1), place(2))
    end do
    segment%width = mesh%along(3 - segment%direction)%side(inside(3 - segment%direction))
    segment%behind_length = mesh%along(segment%direction)%side(inside(segment%direction))
    segment%ahead_length = mesh%along(segment%direction)%side(segment%outside(segment%direction))
  end function segment_between
end module delamination_fronts
