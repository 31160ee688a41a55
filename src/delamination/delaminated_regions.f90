!> Delaminated cells of one interface, and the released nodes.
module delaminated_regions
  use archives, only: archive_t
  use cell_lines, only: cell_line_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: nine_node_grid_t, cells_around
  use roundings, only: rounding
  implicit none
  private
  public :: delaminated_region_t, create_region

  !> Cells of a zone, intact or delaminated, within the grid of the model. Delaminated cells do not heal.
  type, extends(nine_node_grid_t) :: delaminated_region_t
    !> First and last column, then row, of the zone's cells
    integer :: columns(2) = 0, rows(2) = 0
    !> True where the interface is delaminated, (columns(1):columns(2), rows(1):rows(2))
    logical, allocatable :: delaminated(:, :)
  contains
    procedure :: in_zone
    procedure :: is_delaminated
    procedure :: released
    procedure :: release
    procedure :: visit
  end type delaminated_region_t

contains

  !> The region of a zone with the starter as its only delamination. The starter consists of the cells whose centre is
  !> in its square or circle; a starter smaller than a cell consists of the cells that touch its centre.
  pure function create_region(mesh, zone, starter, strip, round, at) result(self)
    type(layered_mesh_t), intent(in) :: mesh
    integer, intent(in) :: zone
    !> Side or diameter of the starter, of the full plate; 0: none
    real(wp), intent(in) :: starter
    !> First and last x of a starter across the zone's width; none unless the first is smaller
    real(wp), intent(in), optional :: strip(2)
    !> True: the starter is a circle
    logical, intent(in), optional :: round
    !> Centre of the starter, from the struck point; left out: there
    real(wp), intent(in), optional :: at(2)
    type(delaminated_region_t) :: self
    type(cell_line_t) :: line
    real(wp) :: centre(2)
    integer :: columns(2), rows(2), column

    self%cells = mesh%cells
    self%columns = mesh%zones(zone)%columns
    self%rows = mesh%zones(zone)%rows
    allocate (self%delaminated(self%columns(1):self%columns(2), self%rows(1):self%rows(2)), source=.false.)
    if (present(strip)) then
      line = mesh%along(1)%from(mesh%struck(1))
      associate (x => line%middles())
        do column = self%columns(1), self%columns(2)
          if (x(column) > strip(1) .and. x(column) < strip(2)) self%delaminated(column, :) = .true.
        end do
      end associate
    end if
    if (.not. starter > 0) return
    centre = mesh%struck
    if (present(at)) centre = centre + at
    line = mesh%along(1)%from(centre(1))
    columns = line%within(starter)
    line = mesh%along(2)%from(centre(2))
    rows = line%within(starter)
    columns = [max(columns(1), self%columns(1)), min(columns(2), self%columns(2))]
    rows = [max(rows(1), self%rows(1)), min(rows(2), self%rows(2))]
    self%delaminated(columns(1):columns(2), rows(1):rows(2)) = .true.
    if (.not. present(round)) return
    if (round) call keep_circle(self, mesh, centre, starter)
  end function create_region

  !> Reduces a square starter to the cells whose centre is in its circle, and those that touch the centre of the circle.
  pure subroutine keep_circle(self, mesh, centre, diameter)
    !> The region, with the square
    type(delaminated_region_t), intent(inout) :: self
    type(layered_mesh_t), intent(in) :: mesh
    !> Centre, and diameter of the circle
    real(wp), intent(in) :: centre(2), diameter
    real(wp) :: x(2), y(2)
    integer :: column, row

    do row = self%rows(1), self%rows(2)
      do column = self%columns(1), self%columns(2)
        x = mesh%along(1)%ends(column) - centre(1)
        y = mesh%along(2)%ends(row) - centre(2)
        if (norm2([sum(x), sum(y)]) < diameter) cycle
        if (.not. touches(x) .or. .not. touches(y)) self%delaminated(column, row) = .false.
      end do
    end do

  contains

    !> True if a cell touches the centre along one direction.
    pure logical function touches(edges)
      !> Edges of the cell, the centre at 0
      real(wp), intent(in) :: edges(2)
      real(wp) :: distance

      distance = rounding*diameter
      touches = edges(1) < distance .and. edges(2) > -distance
    end function touches
  end subroutine keep_circle

  !> True for a cell of the zone; false also for a cell outside the model.
  pure logical function in_zone(self, column, row)
    class(delaminated_region_t), intent(in) :: self
    !> Column and row of the cell
    integer, intent(in) :: column, row
    in_zone = column >= self%columns(1) .and. column <= self%columns(2) .and. &
              row >= self%rows(1) .and. row <= self%rows(2)
  end function in_zone

  !> True for a delaminated cell; false also outside the zone.
  pure logical function is_delaminated(self, column, row)
    class(delaminated_region_t), intent(in) :: self
    !> Column and row of the cell
    integer, intent(in) :: column, row

    is_delaminated = self%in_zone(column, row)
    if (is_delaminated) is_delaminated = self%delaminated(column, row)
  end function is_delaminated

  !> True if all cells around a node are delaminated, those of the model only. Nodes on the border of the zone are not
  !> released, as both layers share them, except on the free edges of doublers.
  pure logical function released(self, i, j, bonded)
    class(delaminated_region_t), intent(in) :: self
    !> Lines of nodes, 0 to twice the cells along x and y
    integer, intent(in) :: i, j
    !> True for the cells with doublers, (cells); absent or unallocated: an interface between plies of the laminate
    logical, allocatable, intent(in), optional :: bonded(:)
    integer :: columns(2), rows(2), column, row

    columns = cells_around(i, self%cells(1))
    rows = cells_around(j, self%cells(2))
    released = .false.
    do row = rows(1), rows(2)
      do column = columns(1), columns(2)
        if (is_bare(self%cell_at(column, row))) cycle
        if (.not. self%is_delaminated(column, row)) return
      end do
    end do
    released = .true.

  contains

    !> True for a cell without a doubler, where there is nothing to be released.
    pure logical function is_bare(cell)
      integer, intent(in) :: cell

      is_bare = .false.
      if (.not. present(bonded)) return
      if (allocated(bonded)) is_bare = .not. bonded(cell)
    end function is_bare
  end function released

  !> Delaminates a cell; no effect outside the zone.
  pure subroutine release(self, cell)
    class(delaminated_region_t), intent(inout) :: self
    !> Column and row of the cell
    integer, intent(in) :: cell(2)

    if (self%in_zone(cell(1), cell(2))) self%delaminated(cell(1), cell(2)) = .true.
  end subroutine release

  !> Saves or loads the region with the position of its zone.
  subroutine visit(self, archive, name)
    class(delaminated_region_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    !> Name of the region within the archive
    character(len=*), intent(in) :: name
    integer, allocatable :: places(:), flags(:)

    allocate (places, source=[self%cells, self%columns, self%rows])
    allocate (flags(0))
    if (.not. archive%loading) flags = merge(1, 0, reshape(self%delaminated, [size(self%delaminated)]))
    call archive%item(name//'/zone', places)
    call archive%item(name//'/delaminated', flags)
    if (.not. archive%loading) return
    if (size(places) /= 6) return
    if (size(flags) /= product(places([4, 6]) - places([3, 5]) + 1)) return
    self%cells = places(1:2)
    self%columns = places(3:4)
    self%rows = places(5:6)
    if (allocated(self%delaminated)) deallocate (self%delaminated)
    allocate (self%delaminated(self%columns(1):self%columns(2), self%rows(1):self%rows(2)))
    self%delaminated = reshape(flags == 1, shape(self%delaminated))
  end subroutine visit
end module delaminated_regions
