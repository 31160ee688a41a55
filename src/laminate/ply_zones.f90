!> Rectangles of the plate with other plies than its laminate: doublers, which are plies added on a face, and ply drops,
!> in which plies of the laminate are missing.
module ply_zones
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use material_parameters, only: material_t
  use mean_stiffnesses, only: sub_plies_of
  use plies, only: ply_t
  use ply_zone_parameters, only: back_face, doubler_t, front_face, ply_drop_t
  use ply_stacks, only: ply_stack_t, whole_stack
  use stacking, only: stacked_plies
  implicit none
  private
  public :: ply_zones_t

  !> All doublers and ply drops. Plies of doublers are numbered after those of the plate's laminate, doubler after
  !> doubler.
  type :: ply_zones_t
    !> Doublers; unallocated: none
    type(doubler_t), allocatable :: doublers(:)
    !> Ply drops; unallocated: none
    type(ply_drop_t), allocatable :: drops(:)
  contains
    procedure :: is_empty
    procedure :: at
    procedure :: plies
    procedure :: material
    procedure :: doubler_of
    procedure :: stations
    procedure :: images
    procedure :: find_stacks
    procedure :: find_combinations
    procedure :: everywhere
    procedure :: find_shares
    procedure :: laminate_of
    procedure :: stack
  end type ply_zones_t

contains

  !> True if there are no zones.
  pure logical function is_empty(self)
    class(ply_zones_t), intent(in) :: self

    is_empty = size(self%at([0.0_wp, 0.0_wp])) == 0
  end function is_empty

  !> The zones at a point.
  pure function at(self, point) result(here)
    class(ply_zones_t), intent(in) :: self
    !> From the plate's centre
    real(wp), intent(in) :: point(2)
    !> True: the point lies within it; doublers, then ply drops
    logical, allocatable :: here(:)
    integer :: i

    allocate (here(0))
    if (allocated(self%doublers)) here = [(self%doublers(i)%contains(point), i=1, size(self%doublers))]
    if (allocated(self%drops)) here = [here, [(self%drops(i)%contains(point), i=1, size(self%drops))]]
  end function at

  !> Number of plies of all doublers.
  pure integer function plies(self)
    class(ply_zones_t), intent(in) :: self
    integer :: i

    plies = 0
    if (.not. allocated(self%doublers)) return
    do i = 1, size(self%doublers)
      plies = plies + size(self%doublers(i)%laminate%material)
    end do
  end function plies

  !> Doubler of a ply; 0: there is none.
  pure integer function doubler_of(self, ply) result(doubler)
    class(ply_zones_t), intent(in) :: self
    !> Number of the ply, counted from the first one of the first doubler
    integer, intent(in) :: ply
    integer :: last

    doubler = 0
    if (ply < 1 .or. .not. allocated(self%doublers)) return
    last = 0
    do doubler = 1, size(self%doublers)
      last = last + size(self%doublers(doubler)%laminate%material)
      if (ply <= last) return
    end do
    doubler = 0
  end function doubler_of

  !> Position of each ply of all doublers in the order of the layers, in the order of their numbers.
  pure function stations(self, skin)
    class(ply_zones_t), intent(in) :: self
    !> Number of plies of the laminate
    integer, intent(in) :: skin
    integer, allocatable :: stations(:)
    integer :: i

    allocate (stations(0))
    if (.not. allocated(self%doublers)) return
    do i = 1, size(self%doublers)
      associate (doubler => self%doublers(i))
        stations = [stations, spread(doubler%station(skin), 1, size(doubler%laminate%material))]
      end associate
    end do
  end function stations

  !> Ply at the image of each ply's place: plies of a doubler have numbers of their own, and other ones at its image.
  pure function images(self, skin, signs, distance) result(image)
    class(ply_zones_t), intent(in) :: self
    !> Number of plies of the laminate
    integer, intent(in) :: skin
    integer, intent(in) :: signs(2)
    !> Difference of lengths that is round-off
    real(wp), intent(in) :: distance
    !> Its number, of each ply of the plate
    integer :: image(skin + self%plies())
    integer, allocatable :: first(:)
    integer :: i, k, ply

    image = [(ply, ply=1, size(image))]
    if (.not. allocated(self%doublers)) return
    allocate (first(size(self%doublers) + 1))
    first(1) = skin + 1
    do i = 1, size(self%doublers)
      first(i + 1) = first(i) + size(self%doublers(i)%laminate%material)
    end do
    do i = 1, size(self%doublers)
      do k = 1, size(self%doublers)
        ! Doublers on one face do not overlap.
        if (self%doublers(i)%face /= self%doublers(k)%face) cycle
        if (self%doublers(i)%is_image_of(self%doublers(k), signs, distance)) &
          image(first(i):first(i + 1) - 1) = [(ply, ply=first(k), first(k + 1) - 1)]
      end do
    end do
  end function images

  !> Indices of the materials of the plies of all doublers, in the order of their numbers.
  pure function material(self) result(indices)
    class(ply_zones_t), intent(in) :: self
    integer, allocatable :: indices(:)
    integer :: i

    allocate (indices(0))
    if (.not. allocated(self%doublers)) return
    do i = 1, size(self%doublers)
      if (allocated(self%doublers(i)%laminate%material)) indices = [indices, self%doublers(i)%laminate%material]
    end do
  end function material

  !> The different stacks of points of the plate, that of the laminate alone first, and the stack of each point.
  pure subroutine find_stacks(self, laminate, materials, points, stacks, stack_of)
    class(ply_zones_t), intent(in) :: self
    type(laminate_t), intent(in) :: laminate
    type(material_t), intent(in) :: materials(:)
    !> The points, (2, points)
    real(wp), intent(in) :: points(:, :)
    !> One of each kind
    type(ply_stack_t), allocatable, intent(out) :: stacks(:)
    !> Number of the stack of each point
    integer, allocatable, intent(out) :: stack_of(:)
    logical, allocatable :: known(:, :)
    integer :: number

    call self%find_combinations(points, known, stack_of)
    allocate (stacks(size(known, 2)))
    do number = 1, size(stacks)
      stacks(number) = self%stack(laminate, materials, known(:, number))
    end do
  end subroutine find_stacks

  !> The different combinations of zones at points of the plate, that without any first, and the one of each point.
  pure subroutine find_combinations(self, points, known, combination_of)
    class(ply_zones_t), intent(in) :: self
    !> The points, (2, points)
    real(wp), intent(in) :: points(:, :)
    !> True for the zones of a combination, (zones, combinations)
    logical, allocatable, intent(out) :: known(:, :)
    !> Number of that of each point
    integer, allocatable, intent(out) :: combination_of(:)
    logical, allocatable :: here(:)
    integer :: point, number

    allocate (known(size(self%at([0.0_wp, 0.0_wp])), 1), source=.false.)
    allocate (combination_of(size(points, 2)), source=1)
    if (self%is_empty()) return
    do point = 1, size(points, 2)
      here = self%at(points(:, point))
      do number = 1, size(known, 2)
        if (all(known(:, number) .eqv. here)) exit
      end do
      combination_of(point) = number
      if (number > size(known, 2)) known = reshape([known, here], [size(here), number])
    end do
  end subroutine find_combinations

  !> The different combinations of zones, that without any first, and their shares of the plate's area.
  pure subroutine find_shares(self, length, known, shares)
    class(ply_zones_t), intent(in) :: self
    real(wp), intent(in) :: length(2)
    !> True for the zones of a combination, (zones, combinations)
    logical, allocatable, intent(out) :: known(:, :)
    !> Of each
    real(wp), allocatable, intent(out) :: shares(:)
    real(wp), allocatable :: x(:), y(:), points(:, :), areas(:)
    integer, allocatable :: combination_of(:)
    integer :: i, j

    x = lines_of(self, length, 1)
    y = lines_of(self, length, 2)
    points = reshape([(([x(i) + x(i + 1), y(j) + y(j + 1)]/2, i=1, size(x) - 1), j=1, size(y) - 1)], &
                     [2, (size(x) - 1)*(size(y) - 1)])
    areas = [(((x(i + 1) - x(i))*(y(j + 1) - y(j)), i=1, size(x) - 1), j=1, size(y) - 1)]/product(length)
    call self%find_combinations(points, known, combination_of)
    shares = [(sum(areas, mask=combination_of == i), i=1, size(known, 2))]
  end subroutine find_shares

  !> Coordinates of the plate's and all zones' edges, ascending.
  pure function lines_of(self, length, direction) result(lines)
    type(ply_zones_t), intent(in) :: self
    real(wp), intent(in) :: length(2)
    integer, intent(in) :: direction
    real(wp), allocatable :: lines(:)
    real(wp), allocatable :: edges(:)
    integer :: i, k

    edges = [-length(direction), length(direction)]/2
    if (allocated(self%doublers)) edges = [edges, [(self%doublers(i)%edges(direction), i=1, size(self%doublers))]]
    if (allocated(self%drops)) edges = [edges, [(self%drops(i)%edges(direction), i=1, size(self%drops))]]
    allocate (lines(0))
    do i = 1, size(edges)
      k = minloc(edges, dim=1)
      lines = [lines, edges(k)]
      edges(k) = huge(edges)
    end do
  end function lines_of

  !> The plies where some zones are as a laminate of their own, from the struck face.
  pure function laminate_of(self, skin, here) result(laminate)
    class(ply_zones_t), intent(in) :: self
    !> The plate's laminate
    type(laminate_t), intent(in) :: skin
    !> True for those at the place, doublers first
    logical, intent(in) :: here(:)
    type(laminate_t) :: laminate
    logical :: kept(size(skin%material))
    integer :: i, doublers

    laminate = skin
    kept = .true.
    doublers = 0
    if (allocated(self%doublers)) doublers = size(self%doublers)
    do i = doublers + 1, size(here)
      if (here(i)) kept(self%drops(i - doublers)%plies) = .false.
    end do
    if (.not. all(kept)) then
      laminate%material = pack(skin%material, kept)
      laminate%angle = pack(skin%angle, kept)
      laminate%thickness = pack(skin%thickness, kept)
    end if
    do i = 1, doublers
      if (.not. here(i)) cycle
      associate (added => self%doublers(i)%laminate)
        if (self%doublers(i)%face == front_face) then
          laminate%material = [added%material, laminate%material]
          laminate%angle = [added%angle, laminate%angle]
          laminate%thickness = [added%thickness, laminate%thickness]
        else
          laminate%material = [laminate%material, added%material]
          laminate%angle = [laminate%angle, added%angle]
          laminate%thickness = [laminate%thickness, added%thickness]
        end if
      end associate
    end do
  end function laminate_of

  !> Zones of which some cover any plate, and the others none.
  pure function everywhere(self, here) result(zones)
    class(ply_zones_t), intent(in) :: self
    !> True for those that do, doublers first
    logical, intent(in) :: here(:)
    type(ply_zones_t) :: zones
    integer :: i, doublers

    if (allocated(self%doublers)) zones%doublers = self%doublers
    if (allocated(self%drops)) zones%drops = self%drops
    doublers = 0
    if (allocated(zones%doublers)) doublers = size(zones%doublers)
    do i = 1, doublers
      zones%doublers(i)%at = 0
      zones%doublers(i)%size = merge(huge(1.0_wp), 0.0_wp, here(i))
    end do
    do i = doublers + 1, size(here)
      zones%drops(i - doublers)%at = 0
      zones%drops(i - doublers)%size = merge(huge(1.0_wp), 0.0_wp, here(i))
    end do
  end function everywhere

  !> The plies where some zones are. Heights are those from the mid-plane of the plate's laminate; numbers of the plies
  !> of doublers follow those of the laminate.
  pure function stack(self, laminate, materials, here)
    class(ply_zones_t), intent(in) :: self
    type(laminate_t), intent(in) :: laminate
    type(material_t), intent(in) :: materials(:)
    !> True for those at the place
    logical, intent(in) :: here(:)
    type(ply_stack_t) :: stack
    type(ply_t), allocatable :: skin(:), above(:), below(:)
    integer, allocatable :: number(:), numbers_above(:), numbers_below(:)
    integer :: i, k, next, doublers, outer(2)

    doublers = 0
    if (allocated(self%doublers)) doublers = size(self%doublers)
    skin = stacked_plies(laminate, materials)
    number = [(i, i=1, size(skin))]
    next = size(skin) + 1
    if (allocated(self%drops)) call drop_plies(self%drops, here(doublers + 1:), laminate%bending_error, skin, number)
    allocate (above(0), below(0), numbers_above(0), numbers_below(0))
    outer = [1, size(laminate%material)]
    do i = 1, doublers
      associate (doubler => self%doublers(i))
        if (here(i) .and. doubler%face == front_face) then
          above = added(doubler, materials, skin(1)%z_top)
          outer(1) = doubler%station(size(laminate%material))
          numbers_above = [(next + k, k=0, size(above) - 1)]
        else if (here(i)) then
          below = added(doubler, materials, skin(size(skin))%z_bottom)
          outer(2) = doubler%station(size(laminate%material))
          numbers_below = [(next + k, k=0, size(below) - 1)]
        end if
        next = next + size(doubler%laminate%material)
      end associate
    end do
    stack = whole_stack([numbers_above, number, numbers_below], [above, skin, below], laminate%shear_correction, &
                        [spread(outer(1), 1, size(above)), number, spread(outer(2), 1, size(below))])
  end function stack

  !> Takes away the plies that are missing; the others close the gaps, and those with E1c are divided for the thickness
  !> left.
  pure subroutine drop_plies(drops, here, bending_error, plies, number)
    type(ply_drop_t), intent(in) :: drops(:)
    !> True for those at the place
    logical, intent(in) :: here(:)
    !> Error of the bending stiffness by these plies
    real(wp), intent(in) :: bending_error
    type(ply_t), allocatable, intent(inout) :: plies(:)
    !> Their numbers
    integer, allocatable, intent(inout) :: number(:)
    logical :: kept(size(plies))
    real(wp) :: thickness(size(plies)), z
    integer :: i, flat_face

    if (.not. any(here)) return
    kept = .true.
    flat_face = front_face
    do i = 1, size(drops)
      if (.not. here(i)) cycle
      kept(drops(i)%plies) = .false.
      flat_face = drops(i)%flat_face
    end do
    thickness = plies%z_bottom - plies%z_top
    z = plies(1)%z_top
    if (flat_face == back_face) z = plies(size(plies))%z_bottom - sum(thickness, mask=kept)
    do i = 1, size(plies)
      if (.not. kept(i)) cycle
      plies(i)%z_top = z
      z = z + thickness(i)
      plies(i)%z_bottom = z
    end do
    number = pack(number, kept)
    plies = pack(plies, kept)
    plies%sub_plies = sub_plies_of(plies, sum(thickness, mask=kept), bending_error)
  end subroutine drop_plies

  !> Plies of a doubler on a face at a height.
  pure function added(doubler, materials, height) result(plies)
    type(doubler_t), intent(in) :: doubler
    type(material_t), intent(in) :: materials(:)
    !> Of the face
    real(wp), intent(in) :: height
    type(ply_t), allocatable :: plies(:)
    real(wp) :: shift

    plies = stacked_plies(doubler%laminate, materials)
    shift = height - plies(1)%z_top
    if (doubler%face == front_face) shift = height - plies(size(plies))%z_bottom
    plies%z_top = plies%z_top + shift
    plies%z_bottom = plies%z_bottom + shift
  end function added
end module ply_zones
