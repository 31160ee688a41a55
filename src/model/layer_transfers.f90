!> Transfers a state from a model to one of the same setup with more layers: an archive in memory that maps fields from
!> points and elements to those of the new model. Points and elements without origin keep their initial values.
module layer_transfers
  use archives, only: archive_t
  use communicators, only: communicator_t
  use field_mappings, only: field_mapping_t
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  implicit none
  private
  public :: layer_transfer_t

  !> One item of any type, as a table of reals, which represent every integer exactly.
  type :: stored_item_t
    !> Its name
    character(len=:), allocatable :: name
    !> Its values; a field is in global order
    real(wp), allocatable :: values(:, :)
  end type stored_item_t

  !> The archive: a state is saved to it, the archive is switched to another mesh, and the state is loaded from it.
  type, extends(archive_t) :: layer_transfer_t
    !> The ranks
    type(communicator_t) :: communicator
    !> Point of the mesh saved for each point, and element for each element, of the mesh loaded; 0: none
    integer, allocatable :: point_origin(:), element_origin(:)
    !> True for elements of the mesh loaded that have fewer plies than their origin
    logical, allocatable :: is_split(:)
    !> Directions along x and y that are reversed at the origin of each point, (2, points), and element, (2, elements)
    logical, allocatable :: point_turned(:, :), element_turned(:, :)
    !> Plies of the plate
    integer :: plies = 0
    !> The items, the first ones of the list
    type(stored_item_t), allocatable :: kept(:)
    !> Their number
    integer :: items = 0
  contains
    procedure :: turn_to
    procedure :: broadcast
    procedure :: real_item
    procedure :: integer_item
    procedure :: logical_item
    procedure :: reals_item
    procedure :: integers_item
    procedure :: table_item
    procedure :: field
    procedure :: keep
    procedure :: find
    procedure :: keep_field
  end type layer_transfer_t

contains

  !> Switches from saving to loading, and finds the origins of points and elements. Zones of the new mesh contain those
  !> of the old one, so that every saved point has a target. Parts of the plate modelled only by the new mesh originate
  !> from their images in the old one.
  subroutine turn_to(self, old, new)
    class(layer_transfer_t), intent(inout) :: self
    !> The mesh saved, and the one to load
    type(layered_mesh_t), intent(in) :: old, new
    integer :: point, element, place(2)
    logical :: turned(2)

    self%loading = .true.
    allocate (self%point_origin(new%points()), self%element_origin(new%elements()), self%is_split(new%elements()))
    allocate (self%point_turned(2, new%points()), self%element_turned(2, new%elements()))
    self%plies = size(new%stations)
    do point = 1, size(self%point_origin)
      place = new%lines_of(new%point_node(point))
      call find_image(old, new, 0, place, turned)
      associate (node => old%node_at(place(1), place(2)), zone => new%point_zone(point))
        self%point_origin(point) = old%first_point(node)
        if (zone > 0) self%point_origin(point) = old%lower_point(node, zone)
      end associate
      self%point_turned(:, point) = turned
    end do
    do element = 1, size(self%element_origin)
      place = new%place_of(new%element_cell(element))
      call find_image(old, new, 1, place, turned)
      associate (plies => new%plies_of(element), origin => self%element_origin(element))
        origin = old%element_at(place(1) + (place(2) - 1)*old%cells(1), plies(1))
        self%is_split(element) = any(old%plies_of(origin) /= plies)
      end associate
      self%element_turned(:, element) = turned
    end do
  end subroutine turn_to

  !> Finds the position of a line of nodes or a cell, or of its image, in the part of the plate modelled by another
  !> mesh.
  pure subroutine find_image(old, new, first, place, turned)
    !> The other mesh, and the mesh of the position
    type(layered_mesh_t), intent(in) :: old, new
    !> Number of the first: 0 for lines of nodes, 1 for cells
    integer, intent(in) :: first
    !> The position; on return that of its image
    integer, intent(inout) :: place(2)
    !> Directions with reversed sign there
    logical, intent(out) :: turned(2)
    integer :: middle(2), last(2)

    turned = .false.
    middle = 0
    where (old%halved .and. .not. new%halved) middle = old%cells
    last = old%cells
    if (first == 0) middle = 2*middle
    if (first == 0) last = 2*last
    place = place - middle
    turned = place < first
    where (turned) place = 2*first - 1 - place
    if (first == 0) then
      where (turned) place = place + 1
    end if
    if (turned(1) .and. .not. old%mirrored(1)) then
      ! Half of a plate with point symmetry.
      turned(2) = .true.
      place(2) = last(2) + first - place(2)
    end if
  end subroutine find_image

  !> Stores an item.
  subroutine keep(self, name, values)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> Its values
    real(wp), intent(in) :: values(:, :)
    type(stored_item_t), allocatable :: longer(:)

    if (.not. allocated(self%kept)) allocate (self%kept(64))
    if (self%items == size(self%kept)) then
      allocate (longer(2*self%items))
      longer(:self%items) = self%kept
      call move_alloc(longer, self%kept)
    end if
    self%items = self%items + 1
    self%kept(self%items)%name = name
    self%kept(self%items)%values = values
  end subroutine keep

  !> Index of an item; it exists, as states of one setup consist of the same items.
  pure integer function find(self, name) result(item)
    class(layer_transfer_t), intent(in) :: self
    character(len=*), intent(in) :: name

    do item = 1, self%items
      if (self%kept(item)%name == name) return
    end do
  end function find

  !> Copies the items of an archive that only rank 0 has saved to every rank. Collective.
  subroutine broadcast(self, communicator)
    class(layer_transfer_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    integer :: item, extents(2)
    real(wp), allocatable :: list(:)

    call communicator%broadcast(self%items)
    if (.not. communicator%is_root()) allocate (self%kept(self%items))
    do item = 1, self%items
      associate (kept => self%kept(item))
        call communicator%broadcast_text(kept%name)
        if (communicator%is_root()) then
          extents = shape(kept%values)
          list = reshape(kept%values, [size(kept%values)])
        end if
        call communicator%broadcast(extents)
        if (.not. communicator%is_root()) list = spread(0.0_wp, 1, product(extents))
        call communicator%broadcast(list)
        kept%values = reshape(list, extents)
      end associate
    end do
  end subroutine broadcast

  !> Visits one real.
  subroutine real_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), intent(inout) :: value

    if (self%loading) then
      value = self%kept(self%find(name))%values(1, 1)
    else
      call self%keep(name, reshape([value], [1, 1]))
    end if
  end subroutine real_item

  !> Visits one integer.
  subroutine integer_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(inout) :: value
    real(wp) :: number

    number = value
    call self%real_item(name, number)
    value = nint(number)
  end subroutine integer_item

  !> Visits one logical.
  subroutine logical_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    logical, intent(inout) :: value
    integer :: number

    number = merge(1, 0, value)
    call self%integer_item(name, number)
    value = number == 1
  end subroutine logical_item

  !> Visits a list of reals.
  subroutine reals_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: value(:)

    if (self%loading) then
      value = self%kept(self%find(name))%values(:, 1)
    else
      call self%keep(name, reshape(value, [size(value), 1]))
    end if
  end subroutine reals_item

  !> Visits a list of integers.
  subroutine integers_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, allocatable, intent(inout) :: value(:)
    real(wp), allocatable :: numbers(:)

    if (.not. self%loading) numbers = value
    call self%reals_item(name, numbers)
    value = nint(numbers)
  end subroutine integers_item

  !> Visits a table of reals.
  subroutine table_item(self, name, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    real(wp), allocatable, intent(inout) :: value(:, :)

    if (self%loading) then
      value = self%kept(self%find(name))%values
    else
      call self%keep(name, value)
    end if
  end subroutine table_item

  !> Visits a field over points or elements; its length shows which, as there are always more points. Collective
  !> when saving.
  subroutine field(self, name, columns, global_columns, value, mapping)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    real(wp), intent(inout) :: value(:, :)
    type(field_mapping_t), intent(in) :: mapping

    if (.not. self%loading) then
      call self%keep_field(name, columns, global_columns, value)
    else if (global_columns == size(self%point_origin)) then
      call copy_columns(self%kept(self%find(name))%values, self%point_origin(columns), self%point_turned(:, columns), 1)
    else
      call copy_columns(self%kept(self%find(name))%values, self%element_origin(columns), &
                        self%element_turned(:, columns), merge(self%plies, 1, mapping%is_per_ply))
    end if

  contains

    !> Copies the columns that have an origin.
    subroutine copy_columns(saved, origins, turned, blocks)
      !> Values of the old points or elements
      real(wp), intent(in) :: saved(:, :)
      !> Origin of each column; 0: none
      integer, intent(in) :: origins(:)
      !> Reversed directions at the origins, (2, columns)
      logical, intent(in) :: turned(:, :)
      !> Number of blocks of rows
      integer, intent(in) :: blocks
      integer :: i, first, rows

      rows = size(saved, 1)/blocks
      do i = 1, size(origins)
        if (origins(i) == 0) cycle
        do first = 1, size(saved, 1), max(rows, 1)
          associate (last => first + rows - 1)
            value(first:last, i) = mapping%signs(rows, turned(:, i))*saved(first:last, origins(i))
          end associate
        end do
      end do
    end subroutine copy_columns
  end subroutine field

  !> Stores a field of all ranks. Collective.
  subroutine keep_field(self, name, columns, global_columns, value)
    class(layer_transfer_t), intent(inout) :: self
    character(len=*), intent(in) :: name
    !> Global columns of the leading columns of `value`, which this rank owns
    integer, intent(in) :: columns(:)
    !> Number of columns of the global field
    integer, intent(in) :: global_columns
    !> The field
    real(wp), intent(in) :: value(:, :)
    real(wp), allocatable :: whole(:, :)

    allocate (whole(size(value, 1), global_columns), source=0.0_wp)
    whole(:, columns) = value(:, :size(columns))
    call self%communicator%sum(whole)
    call self%keep(name, whole)
  end subroutine keep_field
end module layer_transfers
