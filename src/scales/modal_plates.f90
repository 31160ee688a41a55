!> A struck plate, represented by its modes, for estimates before a run.
!>
!> The modes are Navier's modes of a simply supported orthotropic Mindlin plate with rotary inertia, with the rotations
!> condensed out. Other supports are approximated: between clamped edges, and between a clamped and a simply supported
!> one, modes are those of beams (Rayleigh's method), a plate held at one edge only is replaced by a longer or shorter
!> one with the same first frequency, and free opposite edges have cosines, with the rigid-body motion. A curved plate
!> has the additional stiffness of its membrane forces.
module modal_plates
  use beam_modes, only: clamped_beam_mean, clamped_beam_number, clamped_beam_slope
  use curved_modes, only: membrane_mode, shallow_shape_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mesh_parameters, only: edge_free, edge_simple, edge_clamped
  use roundings, only: rounding
  implicit none
  private
  public :: modal_plate_t, modal_plate_of, reduced

  !> Modes that a force distributed over a patch excites.
  type :: modal_plate_t
    !> Circular frequency of each mode
    real(wp), allocatable :: frequency(:)
    !> Square of the mean of the mode over the patch divided by its modal mass, 1/mass
    real(wp), allocatable :: weight(:)
    !> Wave numbers along x and y, (2, modes)
    real(wp), allocatable :: wave_number(:, :)
    !> Deflection of the patch per force by all modes that are not listed, quasi-static
    real(wp) :: rest = 0
  end type modal_plate_t

  !> Length of a simply supported plate over that of a plate with other supports at a pair of edges and the same first
  !> frequency, if bending along this length prevails: beams have it at 9.870 (simply supported), 3.516 (clamped and
  !> free) and, the first bending mode of one hinged at its support, 15.42 times sqrt(EI/(rho A))/a**2.
  real(wp), parameter :: lengthened_cantilever = 1.68_wp, shortened_hinged = 0.8_wp
  !> Largest number of modes along one direction; the deflection by higher ones is negligible for an estimate.
  integer, parameter :: max_modes = 300
  !> Modes along one direction are included if their half wave is no shorter than this fraction of the patch: for
  !> shorter ones, x > 2 pi, the load is (sin x/x)**2 < .026 times that of a point load, and the compliance decreases
  !> with the fourth power of the wave number.
  real(wp), parameter :: part_of_patch = 0.25_wp

contains

  !> Modes of a plate up to a frequency, and the static compliance of all higher modes.
  pure function modal_plate_of(length, edges, stiffness, mass, patch, cutoff, shape, place) result(plate)
    real(wp), intent(in) :: length(2)
    !> Supports at x-min, x-max, y-min, y-max
    integer, intent(in) :: edges(4)
    !> Section stiffness, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> Integrals of density, density z and density z**2
    real(wp), intent(in) :: mass(3)
    !> Side of the loaded square
    real(wp), intent(in) :: patch
    !> Circular frequency up to which modes are listed
    real(wp), intent(in) :: cutoff
    !> Shape without stress; flat if absent
    type(shallow_shape_t), intent(in), optional :: shape
    !> Coordinates of the middle of the square from that of the plate; in the middle if absent
    real(wp), intent(in), optional :: place(2)
    type(modal_plate_t) :: plate
    real(wp), allocatable :: x(:, :), y(:, :)
    real(wp), allocatable :: frequency(:), weight(:), wave_number(:, :)
    real(wp) :: condensed(2), extent(2), at(2), this
    integer :: i, j, found

    at = 0
    if (present(place)) at = max(-0.5_wp, min(0.5_wp, place/length))
    x = modes_along(length(1), edges(1:2), patch, at(1))
    y = modes_along(length(2), edges(3:4), patch, at(2))
    allocate (frequency(size(x, 2)*size(y, 2)), weight(size(x, 2)*size(y, 2)), wave_number(2, size(x, 2)*size(y, 2)))
    extent = length*[length_factor(edges(1:2)), length_factor(edges(3:4))]
    found = 0
    do j = 1, size(y, 2)
      do i = 1, size(x, 2)
        condensed = condensed_mode(x(1, i), y(1, j), x(3, i)*y(3, j), stiffness, mass)
        if (present(shape)) condensed = condensed + &
          [1.0_wp, mass(1)]*membrane_mode(shape, stiffness(1:6), [x(1, i), y(1, j)], extent, &
                                           [x(4, i), y(4, j)] > 0)
        this = x(2, i)*y(2, j)/condensed(2)
        if (condensed(1) > cutoff**2*condensed(2)) then
          plate%rest = plate%rest + this*condensed(2)/condensed(1)
        else
          found = found + 1
          frequency(found) = sqrt(condensed(1)/condensed(2))
          weight(found) = this
          wave_number(:, found) = [x(1, i), y(1, j)]
        end if
      end do
    end do
    plate%frequency = frequency(:found)
    plate%weight = weight(:found)
    plate%wave_number = wave_number(:, :found)
  end function modal_plate_of

  !> Wave numbers along one direction, the squares of the modes' means over the patch over their norms, the mean square
  !> of their slopes over the square of the wave number, and 1 for those that are symmetric about the middle. A force in
  !> the middle excites these only. A plate that is held at one end is replaced by a longer or shorter one struck in its
  !> middle.
  pure function modes_along(length, edges, patch, place) result(modes)
    !> Length of the plate
    real(wp), intent(in) :: length
    !> Supports at both ends
    integer, intent(in) :: edges(2)
    !> Side of the loaded square
    real(wp), intent(in) :: patch
    !> Coordinate of its middle from that of the plate, over the length
    real(wp), intent(in) :: place
    !> Wave number; square of the mean over the norm, 1/length; of the slopes; symmetry, (4, modes)
    real(wp), allocatable :: modes(:, :)
    integer, allocatable :: number(:)
    real(wp) :: extent
    integer :: i, most

    extent = length*length_factor(edges)
    most = min(max_modes, 4 + int(extent/(2*part_of_patch*patch)))
    number = [(2*i - 1, i=1, most)]
    if (is_propped(edges) .or. edges(1) == edges(2) .and. abs(place) > rounding) &
      number = [(i, i=1, min(max_modes, 2*most))]
    allocate (modes(4, size(number)), source=1.0_wp)
    modes(4, :) = modulo(number, 2)
    if (all(edges == edge_clamped)) then
      modes(1, :) = clamped_beam_number(number)/length
      modes(2, :) = clamped_beam_mean(number, min(1.0_wp, patch/length), place)**2/length
      modes(3, :) = clamped_beam_slope(number)
      return
    else if (is_propped(edges)) then
      ! Half of a clamped beam of twice the length, from its middle on.
      modes(1, :) = clamped_beam_number(2*number)/(2*length)
      modes(2, :) = clamped_beam_mean(2*number, min(1.0_wp, patch/length)/2, &
                                      (0.5_wp + merge(place, -place, edges(1) == edge_simple))/2)**2/length
      modes(3, :) = clamped_beam_slope(2*number)
      modes(4, :) = 1
      return
    end if
    if (all(edges == edge_free)) number = number - 1
    modes(1, :) = number*pi/extent
    modes(2, :) = 2*mean_of_wave(number, all(edges == edge_free), patch/extent, place)**2/extent
    where (number == 0) modes(2, :) = modes(2, :)/2
  end function modes_along

  !> Mean of a sine or cosine over a part of the length.
  elemental real(wp) function mean_of_wave(number, cosine, part, place) result(mean)
    !> Number of half waves
    integer, intent(in) :: number
    !> True: its extremes, not its zeros, are at both ends
    logical, intent(in) :: cosine
    !> Length of the part, and coordinate of its middle from that of the wave, over the length
    real(wp), intent(in) :: part, place
    real(wp) :: half

    half = number*pi*part/2
    mean = sin(number*pi*(place + 0.5_wp))
    if (cosine) mean = cos(number*pi*(place + 0.5_wp))
    if (half > 0) mean = mean*sin(half)/half
  end function mean_of_wave

  !> Whether one end is clamped and the other simply supported.
  pure logical function is_propped(edges)
    !> Supports at both ends
    integer, intent(in) :: edges(2)

    is_propped = any(edges == edge_clamped) .and. any(edges == edge_simple)
  end function is_propped

  !> Length of the equivalent simply supported (or free) plate over that of one with other supports.
  pure real(wp) function length_factor(edges) result(factor)
    !> Supports at both ends
    integer, intent(in) :: edges(2)

    factor = 1
    if (all(edges == edge_clamped)) then
      factor = pi/clamped_beam_number(1)
    else if (is_propped(edges)) then
      factor = 2*pi/clamped_beam_number(2)
    else if (any(edges == edge_clamped) .and. any(edges == edge_free)) then
      factor = lengthened_cantilever
    else if (any(edges == edge_simple) .and. any(edges == edge_free)) then
      factor = shortened_hinged
    end if
  end function length_factor

  !> Stiffness and mass of a mode per area, for its deflection. The rotations are condensed statically; their inertia is
  !> that of the slope. In Rayleigh's quotient of a thin plate, D11 a**4 + 2 (D12 + 2 D66) c a**2 b**2 + D22 b**4, the
  !> product c of the mean square slopes multiplies Poisson's and the twisting stiffness.
  pure function condensed_mode(a, b, slopes, stiffness, mass) result(condensed)
    !> Wave numbers along x and y
    real(wp), intent(in) :: a, b
    !> Product of the mean square slopes along x and y over the squares of the wave numbers
    real(wp), intent(in) :: slopes
    !> Section stiffness, packed as in section_t
    real(wp), intent(in) :: stiffness(21)
    !> Integrals of density, density z and density z**2
    real(wp), intent(in) :: mass(3)
    !> Stiffness and mass
    real(wp) :: condensed(2)
    real(wp) :: k22, k23, k33, det, turn(2), shear(2), poisson, twist

    poisson = slopes*stiffness(14)
    twist = slopes*stiffness(18)
    shear = [stiffness(19)*a, stiffness(21)*b]
    k22 = stiffness(13)*a**2 + twist*b**2 + stiffness(19)
    k23 = (poisson + twist)*a*b
    k33 = twist*a**2 + stiffness(16)*b**2 + stiffness(21)
    det = k22*k33 - k23**2
    turn = [k33*shear(1) - k23*shear(2), k22*shear(2) - k23*shear(1)]/det
    condensed(1) = stiffness(19)*a**2 + stiffness(21)*b**2 - dot_product(shear, turn)
    condensed(2) = mass(1) + mass(3)*dot_product(turn, turn)
  end function condensed_mode

  !> The plate with its modes up to a lower frequency; the other modes contribute their static compliance.
  pure function reduced(plate, cutoff) result(fewer)
    type(modal_plate_t), intent(in) :: plate
    !> Circular frequency, > 0
    real(wp), intent(in) :: cutoff
    !> The same with fewer modes
    type(modal_plate_t) :: fewer
    logical :: kept(size(plate%frequency))
    integer :: i

    kept = plate%frequency <= cutoff
    fewer%frequency = pack(plate%frequency, kept)
    fewer%weight = pack(plate%weight, kept)
    fewer%wave_number = plate%wave_number(:, pack([(i, i=1, size(kept))], kept))
    fewer%rest = plate%rest + sum(pack(plate%weight, .not. kept)/pack(plate%frequency, .not. kept)**2)
  end function reduced
end module modal_plates
