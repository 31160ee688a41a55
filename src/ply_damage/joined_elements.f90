!> Elements on both sides of a line through the struck point or of a symmetry line. Their strains are equal, so that
!> plies would fail in both at once, with two crack bands instead of one. For damage they are treated as one element
!> with the width of both and one damage per ply, computed from the strains of both. With mirror symmetry an element and
!> its image have one damage in any case. With point symmetry the element beyond the cut is the image of an element on
!> the other side of the centre.
!>
!> Permanent shear strains are not localised, and mirror images have opposite ones: each element has its own, and the
!> common damage depends on the mean square of the elastic strains.
!> Elements that an earlier impact has damaged differently are separated (`separated_elements`).
module joined_elements
  use archives, only: archive_t
  use column_exchanges, only: column_exchange_t, new_column_exchange
  use crack_bands, only: band_state_t, band_strains_t, crack_band_t, flow_band
  use element_batches, only: batch_of, first_element, lanes
  use field_mappings, only: area_field
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use composite_plates, only: composite_plate_t
  use plies, only: ply_t
  use ply_strains, only: strain_moments_t, moment_values, strains_of_ply, moments_from
  implicit none
  private
  public :: joined_elements_t, find_joined_elements, find_elastic_strains

  !> Largest number of elements with a common state
  integer, parameter :: most = 4

  !> Elements that share their state with others, of this rank and of all.
  type :: joined_elements_t
    !> True along x and y for an element of this rank joined with that beyond its side, (2, elements)
    logical, allocatable :: joined(:, :)
    !> True for elements of this rank that do not share their state as their damage differs, (elements)
    logical, allocatable, private :: separated(:)
    !> Batches of this rank with elements that share their state with others
    logical, allocatable :: concerned(:)
    !> Number of each element of this rank among all that share their state; 0: it does not, (elements)
    integer, allocatable, private :: number(:)
    !> Numbers of the joined elements, ascending, then zeros, (most, numbers)
    integer, allocatable, private :: parts(:, :)
    !> Area of each, (numbers)
    real(wp), allocatable, private :: area(:)
    !> Moments of the strains of each, a bound of its strains, and, where shear strains may be permanent, mean squares
    !> of the elastic shear strains of its plies in their order, (moment_values + 1 + plies, numbers)
    real(wp), allocatable, private :: moments(:, :)
    !> Number of means: of moments, and of plies
    integer :: values = moment_values
    !> Sends the strains of elements joined across ranks
    type(column_exchange_t), private :: across
  contains
    procedure :: shares
    procedure :: accumulate_strains
    procedure :: exchange
    procedure :: differences
    procedure :: separate
    procedure :: visit
    procedure :: means_of
    procedure :: joined_bounds
    procedure :: joined_moments
  end type joined_elements_t

contains

  !> Finds the elements that share their state with others. Collective.
  function find_joined_elements(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(joined_elements_t) :: self
    integer, allocatable :: numbers(:), parts(:, :)
    logical, allocatable :: joined(:, :), mine(:)
    integer :: element

    associate (mesh => plate%mesh, elements => plate%distribution%elements)
      allocate (parts(most, mesh%elements()), joined(2, mesh%elements()), numbers(mesh%elements()))
      do element = 1, mesh%elements()
        call find_parts(plate, element, parts(:, element), joined(:, element))
      end do
      numbers = unpack([(element, element=1, size(numbers))], parts(2, :) > 0, 0)
      call number_them(numbers)
      self%joined = joined(:, elements)
      allocate (self%separated(size(elements)), source=.false.)
      self%number = numbers(elements)
      allocate (self%parts(most, maxval(numbers)), self%area(maxval(numbers)))
      do element = 1, size(numbers)
        if (numbers(element) == 0) cycle
        self%parts(:, numbers(element)) = merge(numbers(max(parts(:, element), 1)), 0, parts(:, element) > 0)
        self%area(numbers(element)) = mesh%cell_area(mesh%place_of(mesh%element_cell(element)))
      end do
    end associate
    if (plate%setup%ply_damage%permanent_shear) self%values = moment_values &
      + maxval([(size(plate%layup%laminates(element)%plies), element=1, size(plate%layup%laminates))])
    allocate (self%moments(self%values + 1, size(self%area)), source=0.0_wp)
    allocate (self%concerned(plate%elements%batches), source=.false.)
    do element = 1, size(self%number)
      if (self%number(element) > 0) self%concerned(batch_of(element)) = .true.
    end do
    allocate (mine(size(self%area)), source=.false.)
    mine(pack(self%number, self%number > 0)) = .true.
    self%across = new_column_exchange(plate%communicator, mine, self%parts)
  end function find_joined_elements

  !> Replaces the non-zero entries by consecutive numbers.
  pure subroutine number_them(numbers)
    !> Entries; zeros are unchanged
    integer, intent(inout) :: numbers(:)
    integer :: i, last

    last = 0
    do i = 1, size(numbers)
      if (numbers(i) == 0) cycle
      last = last + 1
      numbers(i) = last
    end do
  end subroutine number_them

  !> The modelled elements joined with an element, including itself, ascending, then zeros, and the axes along which it
  !> is joined beyond its side. Elements with other layers are not joined.
  pure subroutine find_parts(plate, element, parts, joined)
    type(composite_plate_t), intent(in) :: plate
    !> Element of the mesh
    integer, intent(in) :: element
    !> Elements of the mesh
    integer, intent(out) :: parts(most)
    !> Along x and y
    logical, intent(out) :: joined(2)
    integer :: places(2, most), range(2), direction, known, i, other

    associate (mesh => plate%mesh)
      range = mesh%plies_of(element)
      places(:, 1) = mesh%place_of(mesh%element_cell(element))
      joined = mesh%struck_side(places(:, 1)) /= 0 .and. (mesh%halved .or. plate%setup%impactor%is_present)
      known = 1
      do direction = 1, 2
        if (.not. joined(direction) .or. mesh%mirrored(direction)) cycle
        do i = 1, known
          places(:, known + i) = place_beyond(mesh, places(:, i), direction)
        end do
        known = 2*known
      end do
      parts = 0
      do i = 1, known
        other = mesh%element_at(mesh%cell_at(places(1, i), places(2, i)), range(1))
        if (.not. have_same_plies(plate, mesh%element_layer(element), mesh%element_layer(other))) then
          parts = 0
          joined = .false.
          return
        end if
        call insert(parts, other)
      end do
    end associate
  end subroutine find_parts

  !> True if two layers have the same plies within the same laminates. Those of a doubler and its image have other
  !> numbers. Where strengths depend on the place, other doublers may have other strengths.
  pure logical function have_same_plies(plate, a, b) result(same)
    type(composite_plate_t), intent(in) :: plate
    !> Numbers of the layers
    integer, intent(in) :: a, b
    integer :: first, second

    same = a == b
    if (same) return
    first = plate%mesh%layers(a)%laminate
    second = plate%mesh%layers(b)%laminate
    same = all(plate%mesh%layers(a)%plies == plate%mesh%layers(b)%plies) .and. &
           size(plate%layup%stacks(a)%plies) == size(plate%layup%stacks(b)%plies) .and. &
           plate%layup%are_alike(first, second)
    if (same .and. plate%setup%ply_damage%weibull_modulus > 0) same = plate%layup%are_images(first, second)
  end function have_same_plies

  !> Position of the modelled cell that lies, itself or its image, beyond a cell's side on a line through the struck
  !> point.
  pure function place_beyond(mesh, place, direction) result(beyond)
    type(layered_mesh_t), intent(in) :: mesh
    !> Column and row of the cell
    integer, intent(in) :: place(2), direction
    !> Column and row
    integer :: beyond(2), side(2)

    beyond = place
    if (mesh%halved(direction)) then
      beyond(3 - direction) = mesh%cells(3 - direction) + 1 - place(3 - direction)
    else
      side = mesh%struck_side(place)
      beyond(direction) = place(direction) + side(direction)
    end if
  end function place_beyond

  !> Inserts an element once into an ascending list padded with zeros.
  pure subroutine insert(list, element)
    !> The list
    integer, intent(inout) :: list(most)
    integer, intent(in) :: element
    integer :: smaller

    if (any(list == element)) return
    smaller = count(list > 0 .and. list < element)
    list(smaller + 2:) = list(smaller + 1:most - 1)
    list(smaller + 1) = element
  end subroutine insert

  !> True where an element shares its state with others.
  pure logical function shares(self, element)
    class(joined_elements_t), intent(in) :: self
    integer, intent(in) :: element

    shares = self%number(element) > 0
  end function shares

  !> Stores an element's strains.
  pure subroutine accumulate_strains(self, element, values, bound, plies, bands, states)
    class(joined_elements_t), intent(inout) :: self
    !> Element of this rank that shares its state
    integer, intent(in) :: element
    !> Its strains, from `strain_moments`
    real(wp), intent(in) :: values(moment_values)
    !> Upper bound of the strains of its plies
    real(wp), intent(in) :: bound
    !> Its plies
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    !> Their last accepted states
    type(band_state_t), intent(in) :: states(:)
    type(band_strains_t) :: strains
    type(band_state_t) :: state
    integer :: ply

    associate (column => self%moments(:, self%number(element)))
      column(:moment_values) = values
      column(moment_values + 1) = bound
      if (size(column) == moment_values + 1) return
      do ply = 1, size(plies)
        strains = strains_of_ply(plies(ply), moments_from(values))
        state = states(ply)
        call flow_band(bands(ply), strains, state)
        column(moment_values + 1 + ply) = strains%shear_square
      end do
    end associate
  end subroutine accumulate_strains

  !> Sends the strains of elements joined across ranks. Collective.
  subroutine exchange(self)
    class(joined_elements_t), intent(inout) :: self

    call self%across%update(self%moments)
  end subroutine exchange

  !> Difference between the largest and the smallest value of a quantity among each element and those joined with it.
  !> Collective.
  function differences(self, quantity)
    class(joined_elements_t), intent(inout) :: self
    !> Of each element of this rank
    real(wp), intent(in) :: quantity(:)
    !> 0 for an element that shares its state with no other
    real(wp) :: differences(size(quantity))
    integer :: element

    do element = 1, size(quantity)
      if (self%shares(element)) self%moments(1, self%number(element)) = quantity(element)
    end do
    call self%exchange()
    differences = 0
    do element = 1, size(quantity)
      if (.not. self%shares(element)) cycle
      associate (parts => self%parts(:, self%number(element)))
        differences(element) = maxval(self%moments(1, pack(parts, parts > 0))) &
                               - minval(self%moments(1, pack(parts, parts > 0)))
      end associate
    end do
  end function differences

  !> Separates an element from those joined with it, which must be separated as well.
  pure subroutine separate(self, element)
    class(joined_elements_t), intent(inout) :: self
    integer, intent(in) :: element

    self%separated(element) = .true.
    self%number(element) = 0
    self%joined(:, element) = .false.
  end subroutine separate

  !> Saves or loads which elements are separated.
  subroutine visit(self, archive, plate, separated)
    class(joined_elements_t), intent(in) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    !> Receives them, (elements)
    logical, intent(out) :: separated(:)
    real(wp) :: fields(1, size(separated))

    fields(1, :) = merge(1.0_wp, 0.0_wp, self%separated)
    call archive%field('ply_failure/separated', plate%distribution%elements, plate%mesh%elements(), fields, area_field)
    separated = fields(1, :) > 0
  end subroutine visit

  !> Means of an element and those joined with it, over their total area, for the elastic strains of its plies.
  pure function means_of(self, element, values) result(means)
    class(joined_elements_t), intent(in) :: self
    !> Element of this rank that shares its state
    integer, intent(in) :: element
    !> Number of the leading values: 6 mean strains, all moments with `moment_values`, those of plies with `self%values`
    integer, intent(in) :: values
    !> The means, without the bound of strains
    real(wp) :: means(values)
    real(wp) :: total
    integer :: i, last

    means = 0
    total = 0
    last = min(values, moment_values)
    associate (parts => self%parts(:, self%number(element)))
      do i = 1, most
        if (parts(i) == 0) exit
        associate (column => self%moments(:, parts(i)), area => self%area(parts(i)))
          means(:last) = means(:last) + column(:last)*area
          means(last + 1:) = means(last + 1:) + column(last + 2:values + 1)*area
          total = total + area
        end associate
      end do
    end associate
    means = means/total
  end function means_of

  !> Elastic strains of a ply of an element with those joined with it, and the permanent shear strain of this element.
  pure subroutine find_elastic_strains(place, ply, band, moments, joined, means, state, strains)
    !> Place of the ply among those of the element
    integer, intent(in) :: place
    type(ply_t), intent(in) :: ply
    !> Its law
    type(crack_band_t), intent(in) :: band
    !> Strains of the element, and means of it and those joined with it
    type(strain_moments_t), intent(in) :: moments, joined
    !> The result of `means_of`; absent: there are no others
    real(wp), intent(in), optional :: means(:)
    !> The ply in the last accepted state; receives its permanent strain
    type(band_state_t), intent(inout) :: state
    !> The elastic strains
    type(band_strains_t), intent(out) :: strains
    type(band_strains_t) :: own

    strains = strains_of_ply(ply, joined)
    if (.not. band%permanent_shear) return
    if (.not. present(means)) then
      call flow_band(band, strains, state)
      return
    end if
    own = strains_of_ply(ply, moments)
    call flow_band(band, own, state)
    strains%shear_square = means(moment_values + place)
  end subroutine find_elastic_strains

  !> Upper bounds of the strains of all plies of a batch, and of all elements with a common state.
  pure function joined_bounds(self, b, bounds) result(joined)
    class(joined_elements_t), intent(in) :: self
    integer, intent(in) :: b
    !> Of each element
    real(wp), intent(in) :: bounds(lanes)
    real(wp) :: joined(lanes)
    integer :: lane, i

    joined = bounds
    if (.not. self%concerned(b)) return
    do lane = 1, min(lanes, size(self%number) - first_element(b) + 1)
      if (.not. self%shares(first_element(b) + lane - 1)) cycle
      associate (parts => self%parts(:, self%number(first_element(b) + lane - 1)))
        joined(lane) = self%moments(moment_values + 1, parts(1))
        do i = 2, most
          if (parts(i) > 0) joined(lane) = max(joined(lane), self%moments(moment_values + 1, parts(i)))
        end do
      end associate
    end do
  end function joined_bounds

  !> Moments of the strains of a batch, means over all elements with a common state.
  pure function joined_moments(self, b, moments) result(joined)
    class(joined_elements_t), intent(in) :: self
    integer, intent(in) :: b
    !> Of each element, from `strain_moments`
    real(wp), intent(in) :: moments(lanes, moment_values)
    real(wp) :: joined(lanes, moment_values)
    integer :: lane

    joined = moments
    if (.not. self%concerned(b)) return
    do lane = 1, min(lanes, size(self%number) - first_element(b) + 1)
      if (.not. self%shares(first_element(b) + lane - 1)) cycle
      joined(lane, :) = self%means_of(first_element(b) + lane - 1, moment_values)
    end do
  end function joined_moments
end module joined_elements
