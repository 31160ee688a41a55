!> Transfers a state to another mesh of the plate, or of a plate cut from it, theory (D14): an archive in memory that
!> maps fields.
!>
!> Motion is interpolated by the old elements at the new nodes. Quantities per area or volume are averaged over the area
!> of the new node or cell, so that integrals over the plate are conserved: the area of a node of nine-node cells is a
!> rectangle with the integrals of its shape functions as sides.
module mesh_transfers
  use field_mappings, only: field_mapping_t
  use kinds, only: wp
  use layer_transfers, only: layer_transfer_t
  use layered_meshes, only: layered_mesh_t
  use nine_node_grids, only: cells_around
  use line_overlaps, only: line_overlap_t, overlaps_of, overlaps_of_node_parts, overlaps_of_nodes
  implicit none
  private
  public :: mesh_transfer_t

  !> The archive: a state is saved to it, the archive is switched to another mesh, and the state is loaded from it. It
  !> has many components because it serves where the transfer to more layers does, with its maps.
  type, extends(layer_transfer_t) :: mesh_transfer_t
    !> The mesh saved, and the one to load
    type(layered_mesh_t), private :: old, new
    !> Origin of the new mesh in the coordinates of the old one
    real(wp) :: origin(2) = 0
    !> Overlaps of nodes and cells of the new mesh with those of the old one along x and y
    type(line_overlap_t), allocatable, private :: nodes_x(:), nodes_y(:), cells_x(:), cells_y(:)
    !> The same of the three parts of each cell of the new mesh that are assigned to its nodes
    type(line_overlap_t), allocatable, private :: parts_x(:), parts_y(:)
  contains
    procedure :: turn_to
    procedure :: field
  end type mesh_transfer_t

contains

  !> Switches from saving to loading, and computes the overlaps of both meshes. Section stiffnesses are computed again,
  !> not mapped.
  subroutine turn_to(self, old, new)
    class(mesh_transfer_t), intent(inout) :: self
    !> The mesh saved, and the one to load
    type(layered_mesh_t), intent(in) :: old, new
    integer :: zone

    self%loading = .true.
    self%old = old
    self%new = new
    allocate (self%point_origin(new%points()), source=1)
    allocate (self%element_origin(new%elements()), source=1)
    allocate (self%is_split(new%elements()), source=.true.)
    self%cells_x = overlaps_of(new%along(1)%bounds() + self%origin(1), old%along(1)%bounds(), old%halved(1))
    self%cells_y = overlaps_of(new%along(2)%bounds() + self%origin(2), old%along(2)%bounds(), old%halved(2))
    self%nodes_x = overlaps_of_nodes(new%along(1), new%halved(1), self%origin(1), old%along(1), old%halved(1))
    self%nodes_y = overlaps_of_nodes(new%along(2), new%halved(2), self%origin(2), old%along(2), old%halved(2))
    if (.not. any([(allocated(new%zones(zone)%bonded), zone=1, size(new%zones))])) return
    self%parts_x = overlaps_of_node_parts(new%along(1), self%origin(1), old%along(1), old%halved(1))
    self%parts_y = overlaps_of_node_parts(new%along(2), self%origin(2), old%along(2), old%halved(2))
  end subroutine turn_to

  !> Visits a field over points or elements; its length shows which, as there are always more points. Collective
  !> when saving.
  subroutine field(self, name, columns, global_columns, value, mapping)
    class(mesh_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    real(wp), intent(inout) :: value(:, :)
    type(field_mapping_t), intent(in) :: mapping
    integer :: item, i

    if (.not. self%loading) then
      call self%keep_field(name, columns, global_columns, value)
      return
    end if
    item = self%find(name)
    associate (saved => self%kept(item)%values)
      do i = 1, size(columns)
        if (global_columns /= self%new%points()) then
          call find_in_cells(self, saved, columns(i), mapping, value(:, i))
        else if (mapping%is_motion) then
          value(:, i) = motion_at(self, saved, columns(i), mapping)
        else if (self%new%is_bond(columns(i))) then
          call find_at_bond(self, saved, columns(i), mapping, value(:, i))
        else
          call find_at_node(self, saved, columns(i), mapping, value(:, i))
        end if
      end do
    end associate
  end subroutine field

  !> Motion of the old elements at a point.
  pure function motion_at(self, saved, point, mapping) result(motion)
    class(mesh_transfer_t), intent(in) :: self
    !> Unknowns of the old points, (5, points)
    real(wp), intent(in) :: saved(:, :)
    !> Point of the new mesh
    integer, intent(in) :: point
    !> Signs in images
    type(field_mapping_t), intent(in) :: mapping
    real(wp) :: motion(5)
    real(wp) :: at(2), shapes(3, 2)
    integer :: place(2), i, j
    logical :: turned(2)

    associate (old => self%old)
      at = self%new%node_coordinates(:, self%new%point_node(point)) + self%origin
      turned = old%halved .and. at < 0
      if (turned(1) .and. .not. old%mirrored(1)) turned(2) = .true.
      where (turned) at = -at
      do i = 1, 2
        call old%along(i)%locate(at(i), place(i), shapes(:, i))
      end do
      motion = 0
      do j = 1, 3
        do i = 1, 3
          motion = motion + shapes(i, 1)*shapes(j, 2)* &
                   unknowns_at(old, saved, old%node_at(2*place(1) + i - 3, 2*place(2) + j - 3), &
                               self%new%point_zone(point), self%new%is_under_doubler(self%new%point_node(point)))
        end do
      end do
    end associate
    motion = mapping%signs(5, turned)*motion
  end function motion_at

  !> Unknowns of the layer below a zone at a node, with zero jumps where layers are not separate.
  pure function unknowns_at(mesh, saved, node, zone, is_under_doubler) result(unknowns)
    type(layered_mesh_t), intent(in) :: mesh
    !> Unknowns of all points, (5, points)
    real(wp), intent(in) :: saved(:, :)
    !> Node, and zone; 0: the first layer
    integer, intent(in) :: node, zone
    !> Whether the first layer is a doubler; if not, it is the laminate also where a doubler ends at the node
    logical, intent(in) :: is_under_doubler
    real(wp) :: unknowns(5)
    integer :: above

    unknowns = saved(:, mesh%first_point(node))
    if (zone == 0 .and. mesh%is_under_doubler(node) .and. .not. is_under_doubler) then
      associate (lower => saved(:, mesh%first_point(node) + 1), z => mesh%zones(1)%height)
        unknowns = [unknowns(1:2) + lower(1:2) + z*(unknowns(4:5) - lower(4:5)), unknowns(3) + lower(3), lower(4:5)]
      end associate
    end if
    do above = zone, 1, -1
      if (mesh%lower_point(node, above) == 0) cycle
      unknowns = saved(:, mesh%lower_point(node, above))
      exit
    end do
    if (above /= zone) unknowns(1:3) = 0
  end function unknowns_at

  !> Means over the area of a node; where the old mesh has no such layer, the present value is used.
  pure subroutine find_at_node(self, saved, point, mapping, values)
    class(mesh_transfer_t), intent(in) :: self
    !> Values of the old points, (rows, points)
    real(wp), intent(in) :: saved(:, :)
    !> Point of the new mesh
    integer, intent(in) :: point
    !> Signs in images
    type(field_mapping_t), intent(in) :: mapping
    !> Its values
    real(wp), intent(inout) :: values(:)
    real(wp), allocatable :: terms(:, :), weights(:)
    integer :: lines(2), place(2), i, j, n, from
    logical :: turned(2)

    lines = self%new%lines_of(self%new%point_node(point)) + 1
    associate (x => self%nodes_x(lines(1)), y => self%nodes_y(lines(2)), old => self%old, &
               zone => self%new%point_zone(point))
      allocate (terms(size(values), size(x%length)*size(y%length)), weights(size(x%length)*size(y%length)))
      n = 0
      do j = 1, size(y%length)
        do i = 1, size(x%length)
          n = n + 1
          call find_image(self, x, y, i, j, 2*old%cells + 1, place, turned)
          weights(n) = x%length(i)*y%length(j)
          terms(:, n) = values
          associate (node => old%node_at(place(1) - 1, place(2) - 1))
            from = old%first_point(node)
            if (zone > 0) from = old%lower_point(node, zone)
          end associate
          if (from > 0) terms(:, n) = mapping%signs(size(values), turned)*saved(:, from)
        end do
      end do
    end associate
    values = mean_of(terms, weights)
  end subroutine find_at_node

  !> Means over the area of a node at the bond of a doubler: over the cells with the doubler only.
  subroutine find_at_bond(self, saved, point, mapping, values)
    class(mesh_transfer_t), intent(in) :: self
    !> Values of the old points, (rows, points)
    real(wp), intent(in) :: saved(:, :)
    !> Point of the new mesh
    integer, intent(in) :: point
    !> Signs in images
    type(field_mapping_t), intent(in) :: mapping
    !> Its values
    real(wp), intent(inout) :: values(:)
    real(wp), allocatable :: terms(:, :), weights(:)
    integer :: node, zone, cells(2, 2), row, column

    node = self%new%point_node(point)
    zone = self%new%point_zone(point)
    allocate (terms(size(values), 0), weights(0))
    associate (lines => self%new%lines_of(node))
      cells(:, 1) = cells_around(lines(1), self%new%cells(1))
      cells(:, 2) = cells_around(lines(2), self%new%cells(2))
      do row = cells(1, 2), cells(2, 2)
        do column = cells(1, 1), cells(2, 1)
          if (.not. self%new%in_zone(zone, self%new%cell_at(column, row))) cycle
          ! Parts of cell c are 3 c - 2 to 3 c, the lines of its nodes 2 c - 2 to 2 c.
          call add_part(self%parts_x(lines(1) + column), self%parts_y(lines(2) + row))
        end do
      end do
    end associate
    if (size(weights) > 0) values = mean_of(terms, weights)

  contains

    !> Adds the area in common of a part of a cell and the nodes of the old mesh.
    subroutine add_part(x, y)
      !> Overlaps along x and y
      type(line_overlap_t), intent(in) :: x, y
      real(wp) :: term(size(values))
      integer :: i, j, from, place(2)
      logical :: turned(2)

      do j = 1, size(y%length)
        do i = 1, size(x%length)
          call find_image(self, x, y, i, j, 2*self%old%cells + 1, place, turned)
          from = self%old%lower_point(self%old%node_at(place(1) - 1, place(2) - 1), zone)
          if (from == 0) cycle
          term = mapping%signs(size(term), turned)*saved(:, from)
          terms = reshape([terms, term], [size(values), size(weights) + 1])
          weights = [weights, x%length(i)*y%length(j)]
        end do
      end do
    end subroutine add_part
  end subroutine find_at_bond

  !> Means over the area of a cell; for quantities per ply, also between layers that differ.
  pure subroutine find_in_cells(self, saved, element, mapping, values)
    class(mesh_transfer_t), intent(in) :: self
    !> Values of the old elements, (rows, elements)
    real(wp), intent(in) :: saved(:, :)
    !> Element of the new mesh
    integer, intent(in) :: element
    !> Rows per ply, and signs in images
    type(field_mapping_t), intent(in) :: mapping
    !> Its values
    real(wp), intent(inout) :: values(:)
    real(wp), allocatable :: terms(:, :), weights(:)
    integer :: cell(2), place(2), i, j, n, ply, rows
    logical :: turned(2)

    cell = self%new%place_of(self%new%element_cell(element))
    rows = size(values)
    if (mapping%is_per_ply) rows = size(values)/size(self%new%stations)
    associate (x => self%cells_x(cell(1)), y => self%cells_y(cell(2)), old => self%old, &
               range => self%new%plies_of(element))
      allocate (terms(size(values), size(x%length)*size(y%length)), weights(size(x%length)*size(y%length)))
      n = 0
      do j = 1, size(y%length)
        do i = 1, size(x%length)
          n = n + 1
          call find_image(self, x, y, i, j, old%cells, place, turned)
          weights(n) = x%length(i)*y%length(j)
          terms(:, n) = saved(:, old%element_at(old%cell_at(place(1), place(2)), range(1)))
          if (.not. mapping%is_per_ply) terms(:, n) = mapping%signs(rows, turned)*terms(:, n)
          if (.not. mapping%is_per_ply) cycle
          do ply = 1, size(self%new%stations)
            associate (first => (ply - 1)*rows + 1, last => ply*rows, station => self%new%stations(ply))
              if (station >= range(1) .and. station <= range(2)) &
                terms(first:last, n) = saved(first:last, old%element_at(old%cell_at(place(1), place(2)), station))
              terms(first:last, n) = mapping%signs(rows, turned)*terms(first:last, n)
            end associate
          end do
        end do
      end do
    end associate
    values = mean_of(terms, weights)
  end subroutine find_in_cells

  !> Position of intervals of x and y in the part of the plate modelled by the old mesh.
  pure subroutine find_image(self, x, y, i, j, intervals, place, turned)
    class(mesh_transfer_t), intent(in) :: self
    !> Overlaps of an interval with those of the old mesh along x and y
    type(line_overlap_t), intent(in) :: x, y
    !> Which of them
    integer, intent(in) :: i, j
    !> Number of intervals of the old mesh along x and y
    integer, intent(in) :: intervals(2)
    !> The position, from 1
    integer, intent(out) :: place(2)
    !> Directions with reversed sign there
    logical, intent(out) :: turned(2)

    place = [x%interval(i), y%interval(j)]
    turned = [x%turned(i), y%turned(j)]
    if (.not. turned(1) .or. self%old%mirrored(1)) return
    ! Half of a plate with point symmetry.
    turned(2) = .true.
    place(2) = intervals(2) + 1 - place(2)
  end subroutine find_image

  !> Weighted means, limited to the range of the terms, so that the mean of equal terms is exact.
  pure function mean_of(terms, weights) result(means)
    !> The terms, (rows, terms)
    real(wp), intent(in) :: terms(:, :)
    !> Their weights
    real(wp), intent(in) :: weights(:)
    !> (rows)
    real(wp) :: means(size(terms, 1))

    associate (least => minval(terms, 2))
      means = min(maxval(terms, 2), least + matmul(terms - spread(least, 2, size(weights)), weights)/sum(weights))
    end associate
  end function mean_of
end module mesh_transfers
