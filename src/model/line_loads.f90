!> Lines across the plate that hold it, move it or press on it, as the deck gives them: supports and loads of specimens.
module line_loads
  use kinds, only: wp
  implicit none
  private
  public :: line_load_t

  !> Direction in which a line runs: along x at one y, or along y at one x.
  integer, parameter, public :: along_x = 1, along_y = 2
  !> Histories of a line's value: in proportion to the load factor, or there from the start.
  integer, parameter, public :: line_ramp = 1, line_fixed = 2
  !> Layer of a line that acts on all layers.
  integer, parameter, public :: all_layers = 0

  !> One line.
  type :: line_load_t
    !> Coordinate of the line: x if it runs along y, y if it runs along x; the struck point is at 0
    real(wp) :: at = 0
    !> along_x or along_y
    integer :: direction = along_y
    !> Layer acted on, 1 the uppermost, or all_layers
    integer :: layer = all_layers
    !> Component of the motion, 1 to 5: u, v, w, theta_x, theta_y
    integer :: component = 3
    !> True: `value` is a displacement or rotation of the line; false: a force or moment on the whole of it
    logical :: prescribed = .false.
    !> Full value
    real(wp) :: value = 0
    !> line_ramp or line_fixed
    integer :: history = line_ramp
  contains
    !> Value at a load factor.
    procedure :: at_factor
    !> Change of the value with the load factor.
    procedure :: slope
  end type line_load_t

contains

  !> Value at a load factor.
  elemental real(wp) function at_factor(self, load_factor) result(value)
    !> The line
    class(line_load_t), intent(in) :: self
    !> Ramps over their full values
    real(wp), intent(in) :: load_factor

    value = self%value
    if (self%history == line_ramp) value = self%value*load_factor
  end function at_factor

  !> Change of the value with the load factor.
  elemental real(wp) function slope(self)
    !> The line
    class(line_load_t), intent(in) :: self

    slope = 0
    if (self%history == line_ramp) slope = self%value
  end function slope
end module line_loads
