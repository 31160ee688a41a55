!> Strain gauges on the surfaces of the plate, given in the deck.
module gauges
  use kinds, only: wp
  implicit none
  private
  public :: gauge_t

  !> Surfaces: the struck one and the one opposite to it.
  integer, parameter, public :: face_front = 1, face_back = 2

  !> One gauge.
  type :: gauge_t
    !> Point from the plate's centre
    real(wp) :: at(2) = 0
    !> face_front or face_back
    integer :: face = face_front
    !> Direction from x, degrees
    real(wp) :: angle = 0
  end type gauge_t
end module gauges
