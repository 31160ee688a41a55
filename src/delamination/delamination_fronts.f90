!> The front of a delaminated region: the edges between delaminated and intact cells.
module delamination_fronts
  use delaminated_regions, only: delaminated_region_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: first_line, middle_line, last_line
  implicit none
  private
  public :: front_segment_t, find_front

  !> One edge of the front. Across it lie three lines of nodes: through its first corner, its middle
  !> and its second corner, corners in ascending order of coordinates.
  type :: front_segment_t
    !> Column and row of the delaminated cell and of the intact one
    integer :: inside(2) = 0, outside(2) = 0
    !> Outward normal: along x (1) or y (2), and its sign
    integer :: direction = 0, sign = 0
    !> True where the zone ends: the delamination cannot grow here
    logical :: at_border = .false.
    !> Nodes of the edge, one for each line
    integer :: edge(3) = 0
    !> Nodes one and two behind the edge, in the delaminated cell, (2, 3 lines)
    integer :: behind(2, 3) = 0
    !> Nodes one and two ahead of the edge, in the intact cell, (2, 3 lines)
    integer :: ahead(2, 3) = 0
    !> Length of the edge, and lengths of both cells across it
    real(wp) :: width = 0, ahead_length = 0, behind_length = 0
    !> Part of the forces at `edge` and at `ahead(1, :)` that belongs to this segment
    real(wp) :: edge_share(3) = 0, ahead_share(3) = 0
  end type front_segment_t

contains

  !> All segments of a region's front; those into the same intact cell follow each other. Edges on the
  !> model's own border and on its symmetry lines are no front.
  pure function find_front(region, mesh) result(segments)
    !> The delaminated cells
    type(delaminated_region_t), intent(in) :: region
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> The segments
    type(front_segment_t), allocatable :: segments(:)
    integer :: pass, found, column, row, direction, sign, inside(2)

    do pass = 1, 2
      found = 0
      do row = max(1, region%rows(1) - 1), min(region%cells(2), region%rows(2) + 1)
        do column = max(1, region%columns(1) - 1), min(region%cells(1), region%columns(2) + 1)
          if (region%is_delaminated(column, row)) cycle
          do direction = 1, 2
            do sign = -1, 1, 2
              inside = [column, row]
              inside(direction) = inside(direction) - sign
              if (.not. region%is_delaminated(inside(1), inside(2))) cycle
              found = found + 1
              if (pass == 2) segments(found) = segment_between(region, mesh, inside, direction, sign)
            end do
          end do
        end do
      end do
      if (pass == 1) allocate (segments(found))
    end do
    call share_forces(region, segments)
  end function find_front

  !> The segment on one side of a delaminated cell, without its shares.
  pure function segment_between(region, mesh, inside, direction, sign) result(segment)
    !> The delaminated cells
    type(delaminated_region_t), intent(in) :: region
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Column and row of the delaminated cell
    integer, intent(in) :: inside(2)
    !> Outward normal: along x (1) or y (2), and its sign
    integer, intent(in) :: direction, sign
    !> The segment
    type(front_segment_t) :: segment
    integer :: place(2), step(2), along(2), line

    step = 0
    step(direction) = sign
    along = 1 - abs(step)
    segment%inside = inside
    segment%outside = inside + step
    segment%direction = direction
    segment%sign = sign
    segment%at_border = .not. region%in_zone(segment%outside(1), segment%outside(2))
    do line = 1, 3
      ! The edge is one line further than the middle of the cell.
      place = middle_line(inside) + step + (line - 2)*along
      segment%edge(line) = region%node_at(place(1), place(2))
      segment%behind(1, line) = region%node_at(place(1) - step(1), place(2) - step(2))
      segment%behind(2, line) = region%node_at(place(1) - 2*step(1), place(2) - 2*step(2))
      segment%ahead(1, line) = region%node_at(place(1) + step(1), place(2) + step(2))
      segment%ahead(2, line) = region%node_at(place(1) + 2*step(1), place(2) + 2*step(2))
    end do
    segment%width = cell_length(mesh, inside, 3 - direction)
    segment%behind_length = cell_length(mesh, inside, direction)
    segment%ahead_length = cell_length(mesh, segment%outside, direction)
  end function segment_between

  !> Length of a cell along x (1) or y (2).
  pure real(wp) function cell_length(mesh, cell, direction) result(length)
    !> The mesh
    type(layered_mesh_t), intent(in) :: mesh
    !> Column and row
    integer, intent(in) :: cell(2)
    !> Direction
    integer, intent(in) :: direction
    ! Bounds of the edges are asked for, as they need not start at 0.
    integer :: first

    if (direction == 1) then
      first = lbound(mesh%x_edges, 1) + cell(1) - 1
      length = mesh%x_edges(first + 1) - mesh%x_edges(first)
    else
      first = lbound(mesh%y_edges, 1) + cell(2) - 1
      length = mesh%y_edges(first + 1) - mesh%y_edges(first)
    end if
  end function cell_length

  !> Shares the force of a node among the segments in proportion to their widths: nodes of the edge
  !> among the segments that meet there; nodes ahead among the segments that have them ahead, unless
  !> they lie on the front themselves, where the force belongs to that part of the front.
  !> Every force is then given away once, and on a straight front each segment gets what a uniform
  !> line load gives it: 1/6, 4/6 and 1/6 of its width. A symmetry line or the model's border has one
  !> segment only, which gets the whole of the model's own (half) force.
  pure subroutine share_forces(region, segments)
    !> The delaminated cells
    type(delaminated_region_t), intent(in) :: region
    !> All segments of the front
    type(front_segment_t), intent(inout) :: segments(:)
    real(wp), allocatable :: edge_widths(:), ahead_widths(:)
    integer :: first, last, s

    ! One line of cells around the zone, so that the nodes ahead of its border are covered too.
    first = region%node_at(0, first_line(max(1, region%rows(1) - 1)))
    last = region%node_at(last_line(region%cells(1)), last_line(min(region%cells(2), region%rows(2) + 1)))
    allocate (edge_widths(first:last), ahead_widths(first:last), source=0.0_wp)
    do s = 1, size(segments)
      associate (segment => segments(s))
        edge_widths(segment%edge) = edge_widths(segment%edge) + segment%width
        ahead_widths(segment%ahead(1, :)) = ahead_widths(segment%ahead(1, :)) + segment%width
      end associate
    end do
    do s = 1, size(segments)
      associate (segment => segments(s))
        segment%edge_share = segment%width/edge_widths(segment%edge)
        segment%ahead_share = segment%width/ahead_widths(segment%ahead(1, :))
        where (edge_widths(segment%ahead(1, :)) > 0) segment%ahead_share = 0
      end associate
    end do
  end subroutine share_forces
end module delamination_fronts
