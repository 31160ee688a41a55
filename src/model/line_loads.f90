!> Lines across the plate that support, move or load it: supports and loads of specimens.
module line_loads
  use kinds, only: wp
  use smooth_starts, only: smooth_ramp, smooth_step
  implicit none
  private
  public :: line_load_t

  !> Direction in which a line runs: along x at one y, or along y at one x.
  integer, parameter, public :: along_x = 1, along_y = 2
  !> Histories of a line's value: proportional to the load factor, or constant from the start.
  integer, parameter, public :: line_ramp = 1, line_fixed = 2
  !> Layer of a line that acts on all layers.
  integer, parameter, public :: all_layers = 0

  !> Distance from the plate's edge, over its length, up to which a line lies on it: below the digits of a deck, above
  !> round-off.
  real(wp), parameter :: at_end = 1.0e-6_wp

  !> One line.
  type :: line_load_t
    !> Coordinate of the line: x if it runs along y, y if it runs along x; the plate's centre is at 0
    real(wp) :: at = 0
    !> along_x or along_y
    integer :: direction = along_y
    !> Layer acted on, 1 the uppermost, or all_layers
    integer :: layer = all_layers
    !> Component of the motion, 1 to 5: u, v, w, theta_x, theta_y
    integer :: component = 3
    !> True: `value` is a displacement or rotation of the line; false: the total force or moment
    logical :: prescribed = .false.
    !> Full value
    real(wp) :: value = 0
    !> line_ramp or line_fixed
    integer :: history = line_ramp
    !> Rise of its motion or load, relative to the run; 0: at once
    real(wp) :: rise = 0
  contains
    procedure :: motion_at
    procedure :: precedes
    procedure :: at_factor
    procedure :: slope
    procedure :: is_end
  end type line_load_t

contains

  !> Value at a load factor.
  elemental real(wp) function at_factor(self, load_factor) result(value)
    class(line_load_t), intent(in) :: self
    real(wp), intent(in) :: load_factor

    if (self%rise > 0) then
      value = self%value*merge(smooth_ramp(load_factor, self%rise, 0), smooth_step(load_factor/self%rise, 0), &
                               self%history == line_ramp)
    else
      value = self%value*merge(load_factor, 1.0_wp, self%history == line_ramp)
    end if
  end function at_factor

  !> Value at a time, and its first and second time derivative.
  pure function motion_at(self, time, end) result(values)
    class(line_load_t), intent(in) :: self
    !> The time, and the end of the run
    real(wp), intent(in) :: time, end
    !> Value, velocity and acceleration
    real(wp) :: values(3)
    integer :: k

    values = [self%at_factor(time/end), 0.0_wp, 0.0_wp]
    if (self%rise > 0 .and. self%history == line_ramp) then
      values(2:) = [(self%value*smooth_ramp(time/end, self%rise, k)/end**k, k=1, 2)]
    else if (self%rise > 0) then
      values(2:) = [(self%value*smooth_step(time/end/self%rise, k)/(self%rise*end)**k, k=1, 2)]
    else if (self%history == line_ramp) then
      values(2) = self%value/end
    end if
  end function motion_at

  !> True: its displacement is applied before a run in time.
  elemental logical function precedes(self)
    class(line_load_t), intent(in) :: self

    precedes = self%prescribed .and. self%history == line_fixed .and. .not. self%rise > 0 .and. abs(self%value) > 0
  end function precedes

  !> Change of the value with the load factor.
  elemental real(wp) function slope(self)
    class(line_load_t), intent(in) :: self

    slope = 0
    if (self%history == line_ramp) slope = self%value
  end function slope

  !> True: it constrains or displaces an end of the plate in its plane, in tension or compression.
  pure logical function is_end(self, length)
    class(line_load_t), intent(in) :: self
    real(wp), intent(in) :: length(2)
    integer :: normal

    normal = merge(1, 2, self%direction == along_y)
    is_end = self%prescribed .and. self%layer == all_layers .and. self%component == normal .and. &
             abs(abs(self%at) - length(normal)/2) <= at_end*length(normal)
  end function is_end
end module line_loads
