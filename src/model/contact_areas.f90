!> Points of the struck face within reach of a spherical nose, theory (F12). They are listed in the order of the mesh on
!> every rank, so that the contact is identical on any number of ranks.
module contact_areas
  use communicators, only: communicator_t
  use kinds, only: wp
  use listed_points, only: listed_points_t
  use nose_contacts, only: nose_t, new_nose
  implicit none
  private
  !> Weight relative to the largest from which a point counts as in contact: at the end of contact the weights decrease
  !> to zero. It only affects the area reported.
  real(wp), parameter :: min_weight = 1.0e-3_wp
  public :: contact_area_t, new_contact_area

  !> Struck face and nose.
  type :: contact_area_t
    !> Nose over the points
    type(nose_t) :: nose
    type(listed_points_t) :: points
  contains
    procedure :: first_contact
    procedure :: area_of
  end type contact_area_t

contains

  !> A nose over the points of a mesh.
  pure function new_contact_area(radius, area, distance, local) result(self)
    !> Radius of the nose
    real(wp), intent(in) :: radius
    !> Area of each point on the full plate, 0 outside the struck face, and its distance from the struck point
    real(wp), intent(in) :: area(:), distance(:)
    !> Index of each point among those that this rank owns, or 0
    integer, intent(in) :: local(:)
    type(contact_area_t) :: self
    logical :: is_reached(size(area))

    is_reached = area > 0 .and. distance < radius
    self%nose = new_nose(radius, pack(area, is_reached), pack(distance, is_reached))
    self%points%local = pack(local, is_reached)
  end function new_contact_area

  !> Position of the nose's tip at first contact. Collective.
  real(wp) function first_contact(self, communicator, w)
    class(contact_area_t), intent(in) :: self
    type(communicator_t), intent(in) :: communicator
    !> Deflection of the struck face, (local points)
    real(wp), intent(in) :: w(:)

    first_contact = self%nose%first_contact(self%points%gathered(communicator, w))
  end function first_contact

  !> Area of the points with a weight, on the full plate. Collective.
  real(wp) function area_of(self, communicator, weights) result(area)
    class(contact_area_t), intent(in) :: self
    type(communicator_t), intent(in) :: communicator
    !> (local points)
    real(wp), intent(in) :: weights(:)
    real(wp), allocatable :: listed(:)

    listed = self%points%gathered(communicator, weights)
    area = sum(self%nose%area, mask=listed > min_weight*maxval(listed))
  end function area_of
end module contact_areas
