!> Parameters of doublers, which are plies added on a face of the laminate, and of ply drops, in which plies of it are
!> missing.
module ply_zone_parameters
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  implicit none
  private
  public :: ply_zone_t, doubler_t, ply_drop_t

  !> The faces of the laminate: the struck one, and the opposite one.
  integer, parameter, public :: front_face = 1, back_face = 2

  !> A rectangle.
  type :: ply_zone_t
    !> Its centre from the plate's centre, and its sides along x and y
    real(wp) :: at(2) = 0, size(2) = 0
  contains
    procedure :: contains => zone_contains
    procedure :: overlaps
    procedure :: edges
    procedure :: is_image_of
  end type ply_zone_t

  !> Plies bonded to a face of the laminate.
  type, extends(ply_zone_t) :: doubler_t
    !> Name
    character(len=:), allocatable :: name
    !> True: bonded by a cohesive interface; false: rigidly
    logical :: is_cohesive = .false.
    !> Face that they are on
    integer :: face = back_face
    !> The plies, from the struck face towards the back
    type(laminate_t) :: laminate
  contains
    procedure :: station
  end type doubler_t

  !> Plies of the laminate that are missing.
  type, extends(ply_zone_t) :: ply_drop_t
    !> Their numbers
    integer, allocatable :: plies(:)
    !> Face of the laminate that remains where it is; the plies on the other side of the missing ones move towards it
    integer :: flat_face = front_face
  end type ply_drop_t

contains

  !> True if a point lies within a zone.
  pure logical function zone_contains(self, point) result(contained)
    class(ply_zone_t), intent(in) :: self
    !> From the plate's centre
    real(wp), intent(in) :: point(2)

    contained = all(abs(point - self%at) < self%size/2)
  end function zone_contains

  !> Position of a doubler's plies in the order of the layers: that of the outermost ply of the laminate on its side, or
  !> with a cohesive interface the next number beyond it.
  pure integer function station(self, skin)
    class(doubler_t), intent(in) :: self
    !> Number of plies of the laminate
    integer, intent(in) :: skin

    station = merge(1, skin, self%face == front_face)
    if (self%is_cohesive) station = station + merge(-1, 1, self%face == front_face)
  end function station

  !> True if two zones have an area in common.
  pure logical function overlaps(self, other, distance)
    class(ply_zone_t), intent(in) :: self
    !> The other one
    class(ply_zone_t), intent(in) :: other
    !> Overlap that is round-off
    real(wp), intent(in) :: distance

    overlaps = all(abs(self%at - other%at) < (self%size + other%size)/2 - distance)
  end function overlaps

  !> True if a zone lies where the image of another one does.
  pure logical function is_image_of(self, other, signs, distance) result(alike)
    class(ply_zone_t), intent(in) :: self
    !> The other one
    class(ply_zone_t), intent(in) :: other
    integer, intent(in) :: signs(2)
    !> Difference of lengths that is round-off
    real(wp), intent(in) :: distance

    alike = all(abs(self%at*signs - other%at) <= distance) .and. all(abs(self%size - other%size) <= distance)
  end function is_image_of

  !> Coordinates of the two edges of a zone across a direction.
  pure function edges(self, direction)
    class(ply_zone_t), intent(in) :: self
    integer, intent(in) :: direction
    real(wp) :: edges(2)

    edges = self%at(direction) + [-self%size(direction), self%size(direction)]/2
  end function edges
end module ply_zone_parameters
