!> The mesh of the modelled part: a grid of cells, and over each cell the layers of plies that may separate there. Every
!> rank has the complete mesh, which is small compared with a factor.
module layered_meshes
  use interface_zones, only: zone_t
  use kinds, only: wp
  use mesh_parameters, only: plate_t, mesh_t
  use cell_grids, only: cell_grid_t, create_grid
  use nine_node_grids, only: cells_around
  implicit none
  private
  public :: layered_mesh_t, layer_t, create_mesh

  !> The plies between two interfaces, or a face: those of a cell's laminate whose positions in the order of the layers
  !> lie in a range.
  type :: layer_t
    !> Laminate of the cell, among the different ones of the plate
    integer :: laminate = 1
    !> First and last of them
    integer :: plies(2) = 0
  end type layer_t

  !> Cells, layers and the points (node and layer pairs) that carry five unknowns each. It has many components because a
  !> layered mesh has all those of the grid of cells.
  type, extends(cell_grid_t) :: layered_mesh_t
    !> Zones, from the struck face downwards
    type(zone_t), allocatable :: zones(:)
    !> Node of each point; points of a node are in order from the struck face downwards
    integer, allocatable :: point_node(:)
    !> First point of each node, (nodes + 1)
    integer, allocatable :: first_point(:)
    !> Zone whose interface separates a point from the point above it; 0: first point of a node
    integer, allocatable :: point_zone(:)
    !> Points of each element, (9, elements), tensor order
    integer, allocatable :: connectivity(:, :)
    !> Cell under each element
    integer, allocatable :: element_cell(:)
    !> First element of each cell, elements of a cell following each other downwards, (cells + 1)
    integer, allocatable :: first_element(:)
    !> Number of plies of the plate's laminate
    integer :: plies = 0
    !> Position of each ply of the plate in the order of the layers: its number, for one bonded rigidly to a face that
    !> of the outermost ply of the laminate there, for one bonded by an interface the next number beyond it
    integer, allocatable :: stations(:)
    !> The different layers of the plate
    type(layer_t), allocatable :: layers(:)
    !> Layer of each element, (elements)
    integer, allocatable :: element_layer(:)
  contains
    procedure :: points
    procedure :: elements
    procedure :: element_at
    procedure :: plies_of
    procedure :: is_top
    procedure :: is_below
    procedure :: lower_point
    procedure :: in_zone
    procedure :: is_bond
    procedure :: is_doubler
    procedure :: is_under_doubler
    !> Area of a zone, and length of its mean cell.
    procedure :: zone_area
    procedure :: mean_cell
    procedure :: master
  end type layered_mesh_t

contains

  !> Builds the mesh of the modelled part.
  pure function create_mesh(plate, mesh, plies, zones, laminates, stations) result(self)
    type(plate_t), intent(in) :: plate
    type(mesh_t), intent(in) :: mesh
    !> Number of plies of the plate's laminate
    integer, intent(in) :: plies
    !> Layered rectangles, from the struck face downwards
    type(zone_t), intent(in) :: zones(:)
    !> Laminate of each cell among the different ones of the plate; absent: there is one
    integer, intent(in), optional :: laminates(:)
    !> Position of each ply of the plate in the order of the layers; absent: its number
    integer, intent(in), optional :: stations(:)
    type(layered_mesh_t) :: self
    integer :: ply

    call create_grid(plate, mesh, self)
    self%zones = zones
    self%plies = plies
    self%stations = [(ply, ply=1, plies)]
    if (present(stations)) self%stations = stations
    call number_points(self)
    if (present(laminates)) then
      call build_elements(self, laminates)
    else
      call build_elements(self, spread(1, 1, product(self%cells)))
    end if
  end function create_mesh

  !> Gives a node an additional point for each zone that contains it; on the border of a zone both layers share the
  !> point, so that their displacements are continuous without a constraint.
  pure subroutine number_points(self)
    !> The mesh, with its nodes placed
    type(layered_mesh_t), intent(inout) :: self
    integer :: node, zone, points

    allocate (self%first_point(self%nodes() + 1))
    points = 0
    do node = 1, self%nodes()
      self%first_point(node) = points + 1
      points = points + 1
      do zone = 1, size(self%zones)
        if (inside_zone(self, zone, node)) points = points + 1
      end do
    end do
    self%first_point(self%nodes() + 1) = points + 1
    allocate (self%point_node(points), self%point_zone(points))
    points = 0
    do node = 1, self%nodes()
      points = points + 1
      self%point_node(points) = node
      self%point_zone(points) = 0
      do zone = 1, size(self%zones)
        if (.not. inside_zone(self, zone, node)) cycle
        points = points + 1
        self%point_node(points) = node
        self%point_zone(points) = zone
      end do
    end do
  end subroutine number_points

  !> True if every cell around a node belongs to a zone; the model's own border counts as inside.
  pure logical function inside_zone(self, zone, node) result(inside)
    type(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: zone
    integer, intent(in) :: node
    integer :: lines(2), columns(2), rows(2), column, row

    lines = self%lines_of(node)
    if (allocated(self%zones(zone)%bonded)) then
      columns = cells_around(lines(1), self%cells(1))
      rows = cells_around(lines(2), self%cells(2))
      inside = any([((self%in_zone(zone, self%cell_at(column, row)), column=columns(1), columns(2)), &
                     row=rows(1), rows(2))])
      return
    end if
    inside = within(cells_around(lines(1), self%cells(1)), self%zones(zone)%columns) .and. &
             within(cells_around(lines(2), self%cells(2)), self%zones(zone)%rows)
  end function inside_zone

  !> True if a range of cells is part of another.
  pure logical function within(range, whole)
    !> First and last cell
    integer, intent(in) :: range(2)
    !> First and last cell of the other
    integer, intent(in) :: whole(2)

    within = range(1) >= whole(1) .and. range(2) <= whole(2)
  end function within

  !> One element for each layer over each cell.
  pure subroutine build_elements(self, laminates)
    !> The mesh, with its points numbered
    type(layered_mesh_t), intent(inout) :: self
    !> Laminate of each cell
    integer, intent(in) :: laminates(:)
    integer :: pass, cell, elements, zone, range(2)

    allocate (self%layers(0))
    do pass = 1, 2
      elements = 0
      do cell = 1, product(self%cells)
        range = [1, self%plies]
        if (pass == 2) self%first_element(cell) = elements + 1
        do zone = 1, size(self%zones) + 1
          range(2) = max(self%plies, range(1))
          if (zone <= size(self%zones)) then
            if (.not. self%in_zone(zone, cell)) cycle
            range(2) = self%zones(zone)%below_ply
            range(1) = min(range(1), range(2))
          end if
          elements = elements + 1
          if (pass == 1) cycle
          self%element_cell(elements) = cell
          call find_layer(self, layer_t(laminates(cell), range), self%element_layer(elements))
          self%connectivity(:, elements) = layer_points(self, cell, range(1))
          range(1) = range(2) + 1
        end do
      end do
      if (pass == 1) allocate (self%connectivity(9, elements), self%element_cell(elements), &
                               self%element_layer(elements), self%first_element(product(self%cells) + 1))
    end do
    self%first_element(product(self%cells) + 1) = elements + 1
  end subroutine build_elements

  !> Number of a layer among the different ones; a new one is added.
  pure subroutine find_layer(self, layer, number)
    type(layered_mesh_t), intent(inout) :: self
    type(layer_t), intent(in) :: layer
    !> Its number
    integer, intent(out) :: number

    do number = 1, size(self%layers)
      if (self%layers(number)%laminate == layer%laminate .and. all(self%layers(number)%plies == layer%plies)) return
    end do
    self%layers = [self%layers, layer]
  end subroutine find_layer

  !> Element of a cell whose layer contains a ply; the lowest one for a ply below all of them.
  pure integer function element_at(self, cell, ply) result(element)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: cell
    integer, intent(in) :: ply

    element = self%first_element(cell)
    do while (self%layers(self%element_layer(element))%plies(2) < ply)
      if (element + 1 == self%first_element(cell + 1)) exit
      element = element + 1
    end do
  end function element_at

  !> Smallest and largest number of the plies of an element's layer.
  pure function plies_of(self, element) result(range)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: element
    integer :: range(2)

    range = self%layers(self%element_layer(element))%plies
  end function plies_of

  !> True for an element whose layer has the struck face.
  elemental logical function is_top(self, element)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: element

    is_top = self%first_element(self%element_cell(element)) == element
  end function is_top

  !> True for an element whose upper face is the interface of a zone.
  elemental logical function is_below(self, element, zone)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: element
    integer, intent(in) :: zone

    is_below = .not. self%is_top(element) .and. &
               self%layers(self%element_layer(element))%plies(1) - 1 == self%zones(zone)%below_ply
  end function is_below

  !> True for a cell of a zone.
  pure logical function in_zone(self, zone, cell)
    class(layered_mesh_t), intent(in) :: self
    !> Index of the zone, and cell
    integer, intent(in) :: zone, cell

    if (allocated(self%zones(zone)%bonded)) then
      in_zone = self%zones(zone)%bonded(cell)
    else
      in_zone = self%zones(zone)%covers(self%place_of(cell))
    end if
  end function in_zone

  !> True for a point whose upper face is the bond of a doubler.
  pure logical function is_bond(self, point)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: point

    is_bond = self%point_zone(point) > 0
    if (is_bond) is_bond = allocated(self%zones(self%point_zone(point))%bonded)
  end function is_bond

  !> True for a point of the layer of a doubler: below its bond on the back, above it on the struck face.
  pure logical function is_doubler(self, point)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: point

    is_doubler = self%is_bond(point)
    if (is_doubler) then
      is_doubler = self%zones(self%point_zone(point))%below_ply > 0
    else if (self%point_zone(point) == 0) then
      is_doubler = self%is_under_doubler(self%point_node(point))
    end if
  end function is_doubler

  !> True for a node with a doubler bonded to the struck face by an interface.
  pure logical function is_under_doubler(self, node)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: node

    is_under_doubler = self%first_point(node) + 1 < self%first_point(node + 1)
    if (is_under_doubler) is_under_doubler = self%zones(self%point_zone(self%first_point(node) + 1))%below_ply == 0
  end function is_under_doubler

  !> Point of a node in the layer below a zone's interface; 0: the node has none.
  pure integer function lower_point(self, node, zone) result(point)
    class(layered_mesh_t), intent(in) :: self
    !> Node, and index of the zone
    integer, intent(in) :: node, zone

    do point = self%first_point(node) + 1, self%first_point(node + 1) - 1
      if (self%point_zone(point) == zone) return
    end do
    point = 0
  end function lower_point

  !> Master point of a point on the cut line of point symmetry; 0: it is independent.
  pure integer function master(self, point)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: point

    master = 0
    associate (node => self%point_node(point))
      if (self%is_dependent(node)) master = self%first_point(self%turned_node(node)) + point - self%first_point(node)
    end associate
  end function master

  !> Points of the layer that begins with a ply: at each node the lowest point not below that ply's top.
  pure function layer_points(self, cell, first_ply) result(points)
    type(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: cell
    !> First ply of the layer
    integer, intent(in) :: first_ply
    !> Points, tensor order
    integer :: points(9)
    integer :: nodes(9), a, point

    nodes = self%cell_nodes(cell)
    do a = 1, 9
      points(a) = self%first_point(nodes(a))
      do point = points(a) + 1, self%first_point(nodes(a) + 1) - 1
        if (self%zones(self%point_zone(point))%below_ply < first_ply) points(a) = point
      end do
    end do
  end function layer_points

  !> Number of points.
  pure integer function points(self)
    class(layered_mesh_t), intent(in) :: self
    points = size(self%point_node)
  end function points

  !> Number of elements.
  pure integer function elements(self)
    class(layered_mesh_t), intent(in) :: self
    elements = size(self%element_cell)
  end function elements

  !> Area of a zone in the modelled part.
  pure real(wp) function zone_area(self, zone) result(area)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: zone
    integer :: cell

    if (allocated(self%zones(zone)%bonded)) then
      area = 0
      do cell = 1, product(self%cells)
        if (self%in_zone(zone, cell)) area = area + self%cell_area(self%place_of(cell))
      end do
      return
    end if
    associate (x => self%along(1)%span(self%zones(zone)%columns), y => self%along(2)%span(self%zones(zone)%rows))
      area = (x(2) - x(1))*(y(2) - y(1))
    end associate
  end function zone_area

  !> Length of the mean cell of a zone: the root of its mean area.
  pure real(wp) function mean_cell(self, zone) result(length)
    class(layered_mesh_t), intent(in) :: self
    integer, intent(in) :: zone

    if (allocated(self%zones(zone)%bonded)) then
      length = sqrt(self%zone_area(zone)/max(1, count(self%zones(zone)%bonded)))
      return
    end if
    associate (range => self%zones(zone))
      length = sqrt(self%zone_area(zone) &
                    /product([range%columns(2) - range%columns(1), range%rows(2) - range%rows(1)] + 1))
    end associate
  end function mean_cell
end module layered_meshes
