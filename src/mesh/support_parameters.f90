!> Parameters of rigs under the plate in the deck: frames with a window, and clamps at points.
module support_parameters
  use kinds, only: wp
  use roundings, only: rounding
  implicit none
  private
  public :: support_t, max_supports

  !> Shapes of a window.
  integer, parameter, public :: window_none = 0, window_rectangle = 1, window_circle = 2
  !> Bearing of a frame: the edge of its window, or all of its face.
  integer, parameter, public :: bearing_edge = 1, bearing_face = 2
  !> Largest number of supports of a plate: each has a column of its own in the history.
  integer, parameter :: max_supports = 3

  !> One rig. The plate lies on the frame with the face opposite to the struck one.
  type :: support_t
    !> Shape of the window; window_none: there are clamps only
    integer :: shape = window_none
    !> Lengths of a rectangular window along x and y, centred on the plate
    real(wp) :: window(2) = 0
    !> Radius of a circular window, centred on the plate
    real(wp) :: radius = 0
    !> bearing_edge or bearing_face, at the ends of the window along x and at its sides along y
    integer :: bearing = bearing_edge, sides = bearing_edge
    !> True: the plate may lift off the frame
    logical :: unilateral = .false.
    !> Points from the plate's centre at which it is clamped, (2, clamps)
    real(wp), allocatable :: clamps(:, :)
    !> Force per displacement of a clamp along u, v and w; 0: rigid
    real(wp) :: clamp_stiffness = 0
    !> Force with which a clamp presses the plate on the frame below it; 0: no limit
    real(wp) :: clamp_force = 0
  contains
    procedure :: beyond
    procedure :: carries
  end type support_t

contains

  !> Distance of a point from the window's edge, positive over the frame, negative within the window.
  pure real(wp) function beyond(self, point) result(distance)
    !> A rig with a frame
    class(support_t), intent(in) :: self
    !> Coordinates from the plate's centre
    real(wp), intent(in) :: point(2)

    if (self%shape == window_circle) then
      distance = norm2(point) - self%radius
    else
      distance = maxval(abs(point) - self%window/2)
    end if
  end function beyond

  !> True where the frame supports the plate: over its face, which includes the corners beside a window, or only on the
  !> edge of a rectangular window. The edge of a circle crosses the sides of cells and supports no node.
  pure logical function carries(self, point)
    class(support_t), intent(in) :: self
    !> Coordinates from the plate's centre
    real(wp), intent(in) :: point(2)
    real(wp) :: beyond(2), distance
    logical :: on_end, on_side

    carries = .false.
    if (self%shape == window_none) return
    distance = rounding*maxval([self%window, self%radius])
    if (self%shape == window_circle) then
      carries = self%bearing == bearing_face .and. self%beyond(point) >= -distance
      return
    end if
    beyond = abs(point) - self%window/2
    on_end = self%bearing == bearing_face .or. all(beyond <= distance)
    on_side = self%sides == bearing_face .or. all(beyond <= distance)
    carries = beyond(1) >= -distance .and. on_end .or. beyond(2) >= -distance .and. on_side
  end function carries
end module support_parameters
