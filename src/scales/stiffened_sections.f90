!> Sections of a plate with stringers, doublers or ply drops and of the bays between its stringers, for their first
!> frequency before a run.
!>
!> The bending stiffness of the plies is that of strips in series along the bending, and in parallel across it, weighted
!> by the curvature and the deflection of the first mode of a beam with the supports of the plate. That of stringers is
!> distributed over the width, weighted by the deflection, eccentric as they are; the membrane forces of the resulting
!> section are zero (smeared stiffeners, M. Baruch and J. Singer, J. Mech. Eng. Sci. 5, 1963). Between stringers the
!> first mode is that of the plate without them, simply supported by them. doc/manual/stringer.md has its errors.
module stiffened_sections
  use beam_modes, only: beam_of, beam_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mean_stiffnesses, only: in_bending
  use mesh_parameters, only: edge_clamped, edge_free, edge_simple
  use packed_matrices, only: inverse, unpacked
  use ply_stacks, only: ply_stack_t
  use ply_zones, only: ply_zones_t
  use roundings, only: rounding
  use setups, only: setup_t
  use stacking, only: section_t, section_of
  use stringers, only: face_front, stringer_t
  implicit none
  private
  public :: bays_of, edges_across, free_bending, is_stiffened, plate_part_t, section_of_part, whole_part

  !> The plate, or a part of it between two stringers or between one and an edge.
  type :: plate_part_t
    !> Coordinates of its ends along x and y, (2, directions)
    real(wp) :: ends(2, 2) = 0
    !> Supports at x-min, x-max, y-min, y-max
    integer :: edges(4) = edge_simple
  contains
    procedure :: length
  end type plate_part_t

  !> What a mode is weighted by: the squares of its deflection or of its curvature.
  integer, parameter :: by_deflection = 1, by_curvature = 2
  !> Points in an interval at which the weight is evaluated, by the midpoint rule: their number changes no period by
  !> more than .1 %.
  integer, parameter :: samples = 20

contains

  !> Lengths along x and y.
  pure function length(self)
    class(plate_part_t), intent(in) :: self
    real(wp) :: length(2)

    length = self%ends(2, :) - self%ends(1, :)
  end function length

  !> True: the plate is not that of one laminate.
  pure logical function is_stiffened(setup)
    type(setup_t), intent(in) :: setup

    is_stiffened = .not. setup%zones%is_empty()
    if (allocated(setup%stringers)) is_stiffened = is_stiffened .or. size(setup%stringers) > 0
  end function is_stiffened

  !> The span of the plate.
  pure function whole_part(span, edges) result(part)
    !> Lengths along x and y
    real(wp), intent(in) :: span(2)
    !> Supports of its edges
    integer, intent(in) :: edges(4)
    type(plate_part_t) :: part

    part%ends = reshape([-span(1), span(1), -span(2), span(2)]/2, [2, 2])
    part%edges = edges
  end function whole_part

  !> The bays between stringers from end to end of the span, and between them and its edges.
  pure function bays_of(setup, whole) result(bays)
    type(setup_t), intent(in) :: setup
    !> The span
    type(plate_part_t), intent(in) :: whole
    type(plate_part_t), allocatable :: bays(:)
    real(wp), allocatable :: lines(:)
    integer :: along, i

    allocate (bays(0))
    if (.not. allocated(setup%stringers)) return
    do along = 1, 2
      lines = through_lines(setup%stringers, whole, along)
      if (size(lines) == 2) cycle
      do i = 1, size(lines) - 1
        bays = [bays, whole]
        associate (bay => bays(size(bays)), across => 3 - along)
          bay%ends(:, across) = lines(i:i + 1)
          if (i > 1) bay%edges(2*across - 1) = edge_simple
          if (i < size(lines) - 1) bay%edges(2*across) = edge_simple
        end associate
      end do
    end do
  end function bays_of

  !> Coordinates of both edges of the span and of the stringers that cross it along a direction, ascending.
  pure function through_lines(stringers, whole, along) result(lines)
    type(stringer_t), intent(in) :: stringers(:)
    !> The span
    type(plate_part_t), intent(in) :: whole
    integer, intent(in) :: along
    real(wp), allocatable :: lines(:)
    real(wp) :: next
    integer :: i

    associate (ends => whole%ends(:, along), across => whole%ends(:, 3 - along))
      lines = [across(1)]
      do while (lines(size(lines)) < across(2))
        next = across(2)
        do i = 1, size(stringers)
          if (stringers(i)%along /= along .or. stringers(i)%ends(1) > ends(1) + rounding*(ends(2) - ends(1)) .or. &
              stringers(i)%ends(2) < ends(2) - rounding*(ends(2) - ends(1))) cycle
          if (stringers(i)%at > lines(size(lines))) next = min(next, stringers(i)%at)
        end do
        lines = [lines, next]
      end do
    end associate
  end function through_lines

  !> Section of a part with its stringers, with free membrane strains.
  pure function section_of_part(setup, part, with_stringers) result(section)
    type(setup_t), intent(in) :: setup
    type(plate_part_t), intent(in) :: part
    !> False: without stringers
    logical, intent(in) :: with_stringers
    type(section_t) :: section
    real(wp) :: series(2)
    integer :: i

    call find_mean(setup, part, section, series)
    if (with_stringers .and. allocated(setup%stringers)) then
      do i = 1, size(setup%stringers)
        call add_stringer(setup, part, setup%stringers(i), section)
      end do
    end if
    section%stiffness(13:18) = free_bending(section%stiffness)
    section%stiffness([13, 16]) = series*section%stiffness([13, 16])
  end function section_of_part

  !> Mean section of the plies of a part, and the ratio of the bending stiffness along x and y of strips in series,
  !> weighted by the mode, to that of the mean.
  pure subroutine find_mean(setup, part, section, series)
    type(setup_t), intent(in) :: setup
    type(plate_part_t), intent(in) :: part
    !> Mean, about the mid-plane of the laminate
    type(section_t), intent(out) :: section
    !> Along x and y
    real(wp), intent(out) :: series(2)
    type(section_t) :: here
    type(ply_stack_t) :: stack
    real(wp), allocatable :: x(:), y(:), moved_x(:), moved_y(:), bent_x(:), bent_y(:), compliance(:, :, :)
    real(wp) :: packed(6), bending(2)
    integer :: i, j

    x = lines_within(setup, part, 1)
    y = lines_within(setup, part, 2)
    moved_x = weights(x, part, 1, by_deflection)
    moved_y = weights(y, part, 2, by_deflection)
    bent_x = weights(x, part, 1, by_curvature)
    bent_y = weights(y, part, 2, by_curvature)
    allocate (compliance(size(moved_x), size(moved_y), 2))
    do j = 1, size(moved_y)
      do i = 1, size(moved_x)
        stack = setup%zones%stack(setup%laminate, setup%materials, &
                                  setup%zones%at([x(i) + x(i + 1), y(j) + y(j + 1)]/2))
        here = section_of(in_bending(stack%plies), setup%laminate%shear_correction)
        section%stiffness = section%stiffness + (x(i + 1) - x(i))*(y(j + 1) - y(j))/product(part%length())* &
                            here%stiffness
        section%mass = section%mass + moved_x(i)*moved_y(j)*here%mass
        packed = free_bending(here%stiffness)
        compliance(i, j, :) = 1/packed([1, 4])
      end do
    end do
    packed = free_bending(section%stiffness)
    bending = [sum(moved_y/matmul(bent_x, compliance(:, :, 1))), sum(moved_x/matmul(compliance(:, :, 2), bent_y))]
    series = bending/packed([1, 4])
  end subroutine find_mean

  !> Edges of zones within a part and its ends, ascending.
  pure function lines_within(setup, part, direction) result(lines)
    type(setup_t), intent(in) :: setup
    type(plate_part_t), intent(in) :: part
    integer, intent(in) :: direction
    real(wp), allocatable :: lines(:)

    associate (ends => part%ends(:, direction))
      lines = edges_across(setup%zones, setup%plate%length(direction), direction)
      lines = [ends(1), pack(lines, lines > ends(1) .and. lines < ends(2)), ends(2)]
    end associate
  end function lines_within

  !> Edges of the plate and of its zones across a direction, ascending.
  pure function edges_across(zones, length, direction) result(lines)
    type(ply_zones_t), intent(in) :: zones
    !> Length of the plate along the direction
    real(wp), intent(in) :: length
    integer, intent(in) :: direction
    real(wp), allocatable :: lines(:)
    real(wp), allocatable :: edges(:)
    integer :: i

    edges = [-length, length]/2
    if (allocated(zones%doublers)) edges = [edges, [(zones%doublers(i)%edges(direction), i=1, size(zones%doublers))]]
    if (allocated(zones%drops)) edges = [edges, [(zones%drops(i)%edges(direction), i=1, size(zones%drops))]]
    allocate (lines(0))
    do while (any(edges < huge(edges)))
      lines = [lines, minval(edges)]
      where (edges <= minval(edges)) edges = huge(edges)
    end do
  end function edges_across

  !> Shares of intervals in the integral of the square of the mode.
  pure function weights(lines, part, direction, of) result(shares)
    !> Ends of the intervals, ascending
    real(wp), intent(in) :: lines(:)
    type(plate_part_t), intent(in) :: part
    !> 1 for x, 2 for y; by_deflection or by_curvature
    integer, intent(in) :: direction, of
    real(wp) :: shares(size(lines) - 1)
    integer :: i, k

    do i = 1, size(shares)
      associate (step => (lines(i + 1) - lines(i))/samples)
        shares(i) = sum([(mode_square(part, direction, of, lines(i) + (k - 0.5_wp)*step), k=1, samples)])*step
      end associate
    end do
    shares = shares/sum(shares)
  end function weights

  !> Square of the first mode of a beam with the supports of a part, or of its curvature: that of clamped ends, a sine
  !> otherwise, and a rigid motion if both ends are free.
  pure real(wp) function mode_square(part, direction, of, at) result(square)
    type(plate_part_t), intent(in) :: part
    !> 1 for x, 2 for y; by_deflection or by_curvature
    integer, intent(in) :: direction, of
    real(wp), intent(in) :: at
    type(beam_t) :: beam
    real(wp) :: place

    associate (ends => part%ends(:, direction), edges => part%edges(2*direction - 1:2*direction))
      place = (at - sum(ends)/2)/(ends(2) - ends(1))
      if (all(edges == edge_clamped)) then
        beam = beam_of(edges)
        square = beam%derivative(1, place, merge(0, 2, of == by_deflection))**2
      else if (all(edges == edge_free)) then
        square = 1
      else
        square = cos(pi*place)**2
      end if
    end associate
  end function mode_square

  !> Adds a stringer, distributed over the part: its bending in its own plane, and its torsion. The twist is twice the
  !> second derivative that turns the stringer.
  pure subroutine add_stringer(setup, part, stringer, section)
    type(setup_t), intent(in) :: setup
    type(plate_part_t), intent(in) :: part
    type(stringer_t), intent(in) :: stringer
    type(section_t), intent(inout) :: section
    type(ply_stack_t) :: stack
    real(wp) :: share, height, point(2), lines(2)
    integer :: axial, shear

    associate (s => stringer%section, along => stringer%along, sides => part%length())
      point(along) = sum(stringer%ends)/2
      point(3 - along) = stringer%at
      lines = part%ends(:, 3 - along)
      share = (stringer%ends(2) - stringer%ends(1))/product(sides)* &
              mode_square(part, 3 - along, by_deflection, stringer%at)/mean_square(lines)
      stack = setup%zones%stack(setup%laminate, setup%materials, setup%zones%at(point))
      height = stack%plies(size(stack%plies))%z_bottom + s%eccentricity
      if (stringer%face == face_front) height = stack%plies(1)%z_top - s%eccentricity
      axial = merge(1, 4, along == 1)
      shear = merge(19, 21, along == 1)
      associate (k => section%stiffness)
        k(axial) = k(axial) + share*s%axial
        k(axial + 6) = k(axial + 6) + share*s%axial*height
        k(axial + 12) = k(axial + 12) + share*(s%bending + s%axial*height**2)
        k(18) = k(18) + share*s%torsion/4
        k(shear) = k(shear) + share*s%shear
      end associate
      section%mass = section%mass + share*[s%mass, s%mass*height, s%rotary + s%mass*height**2]
    end associate

  contains

    !> Mean square of the deflection across the stringer.
    pure real(wp) function mean_square(ends)
      !> Ends of the part
      real(wp), intent(in) :: ends(2)
      integer :: k

      mean_square = sum([(mode_square(part, 3 - stringer%along, by_deflection, ends(1) + (k - 0.5_wp)* &
                                      (ends(2) - ends(1))/samples), k=1, samples)])/samples
    end function mean_square
  end subroutine add_stringer

  !> Bending stiffness with free membrane strains, D - B inverse(A) B.
  pure function free_bending(stiffness) result(packed)
    !> A, B, D and S of a section
    real(wp), intent(in) :: stiffness(21)
    !> Packed as D
    real(wp) :: packed(6)
    real(wp) :: coupling(3, 3), d(3, 3)

    coupling = unpacked(stiffness(7:12))
    d = unpacked(stiffness(13:18)) - matmul(coupling, matmul(inverse(unpacked(stiffness(1:6))), coupling))
    packed = [d(1, 1), d(1, 2), d(1, 3), d(2, 2), d(2, 3), d(3, 3)]
  end function free_bending
end module stiffened_sections
