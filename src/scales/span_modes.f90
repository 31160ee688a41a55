!> Modes along one direction of a plate: those of a beam with the supports of its two edges.
module span_modes
  use beam_modes, only: beam_of, beam_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use roundings, only: rounding
  implicit none
  private
  public :: span_modes_t, modes_along, is_counted

  !> Modes of a beam along one direction of the plate.
  type :: span_modes_t
    type(beam_t) :: beam
    !> Its length
    real(wp) :: length = 0
    !> Numbers of the modes
    integer, allocatable :: number(:)
    !> Wave numbers
    real(wp), allocatable :: wave_number(:)
    !> Mean over the patch, of modes whose mean square is 1
    real(wp), allocatable :: mean(:)
    !> Root mean square slope
    real(wp), allocatable :: slope(:)
    !> Ratio of the mean square curvature to the mean square slope; 0 for a rigid motion
    real(wp), allocatable :: bending(:)
    !> Mean product of deflection and curvature, with the opposite sign, over the slope; 0 for a rigid motion
    real(wp), allocatable :: poisson(:)
    !> Length of a half wave of the mode that counts as one
    real(wp) :: half_wave = 0
  end type span_modes_t

  !> Largest number of modes along one direction; the deflection by higher ones is negligible for an estimate.
  integer, parameter :: max_modes = 300
  !> Modes along one direction are included if their half wave is no shorter than this fraction of the patch: for
  !> shorter ones, x > 2 pi, the load is (sin x/x)**2 < .026 times that of a point load, and the compliance decreases
  !> with the fourth power of the wave number.
  real(wp), parameter :: part_of_patch = 0.25_wp

contains

  !> Beam modes along one direction.
  pure function modes_along(length, edges, patch, place, is_held) result(modes)
    !> Length of the plate
    real(wp), intent(in) :: length
    !> Supports at both ends
    integer, intent(in) :: edges(2)
    !> Side of the loaded square
    real(wp), intent(in) :: patch
    !> Coordinate of its middle from that of the plate, over the length
    real(wp), intent(in) :: place
    !> True: modes are not coupled, so that a force in the middle excites symmetric ones only
    logical, intent(in) :: is_held
    type(span_modes_t) :: modes
    integer :: i, most

    modes%beam = beam_of(edges)
    modes%length = length
    most = min(max_modes, 4 + int(length/(2*part_of_patch*patch)))
    modes%number = [(i, i=1, min(max_modes, 2*most))]
    if (is_held .and. abs(place) <= rounding .and. modes%beam%is_symmetric(1)) modes%number = [(2*i - 1, i=1, most)]
    modes%wave_number = modes%beam%wave_number(modes%number)/length
    modes%mean = modes%beam%mean(modes%number, min(1.0_wp, patch/length), place)
    modes%slope = sqrt(modes%beam%mean_square_slope(modes%number))/length
    allocate (modes%bending(size(modes%number)), modes%poisson(size(modes%number)), source=0.0_wp)
    where (modes%wave_number > 0)
      modes%bending = (modes%wave_number**2/modes%slope)**2
      modes%poisson = modes%beam%slope_by_curvature(modes%number)/(length**2*modes%slope)
    end where
    modes%half_wave = length
    if (modes%wave_number(1) > 0) modes%half_wave = pi/modes%wave_number(1)
  end function modes_along

  !> True if a mode has a mean strain of lines that are held at both ends: symmetric ones, and those of a beam that is
  !> clamped at one end and simply supported at the other.
  pure logical function is_counted(modes, i)
    type(span_modes_t), intent(in) :: modes
    !> Index of the mode
    integer, intent(in) :: i

    is_counted = modes%beam%is_symmetric(modes%number(i)) .or. .not. modes%beam%is_symmetric(1)
  end function is_counted
end module span_modes
