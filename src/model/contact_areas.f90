!> Contact area of a spherical nose, theory (F9): the deck's patch, and points around it where the plate is close to the
!> nose's surface.
!>
!> At the edge of a Hertzian contact the separation of the undeformed surfaces is half the indentation larger than at
!> first contact (K. L. Johnson, Contact Mechanics, 1985, section 4.2). The pressure is proportional to the difference
!> from that separation, as on an elastic foundation (section 4.3): on a flat plate up to Hertz's radius, farther where
!> the plate bends around the nose. On the patch it is uniform, with its mean value.
module contact_areas
  use communicators, only: communicator_t
  use kinds, only: wp
  use rank_totals, only: total_of
  implicit none
  private
  public :: contact_area_t, new_contact_area

  !> Additional separation of the surfaces at the edge of a Hertzian contact, relative to the indentation: its radius a
  !> is sqrt(R alpha), and the nose rises by a**2/(2 R) there.
  real(wp), parameter, public :: edge_gap = 0.5_wp
  !> Weight relative to the largest from which a point counts as in contact: at the end of contact the weights decrease
  !> to zero. It only affects the area reported.
  real(wp), parameter :: min_weight = 1.0e-3_wp

  !> Struck face and nose.
  type :: contact_area_t
    !> Weights of the deck's patch, whose product with w is its mean deflection, (local points); ghosts zero
    real(wp), allocatable :: under(:)
    !> Area of each point outside the patch within reach of the nose, (local points); ghosts zero
    real(wp), allocatable :: beside(:)
    !> Height of the nose's surface above its tip, (local points)
    real(wp), allocatable :: rise(:)
    !> Area of the modelled part of the patch
    real(wp) :: area = 0
  contains
    !> Weights of the force distribution.
    procedure :: weights
    !> Area under pressure.
    procedure :: touched
  end type contact_area_t

contains

  !> A nose over a patch.
  pure function new_contact_area(under, area, beside, distance, radius) result(self)
    !> Weights of the patch, (local points), and area of its modelled part
    real(wp), intent(in) :: under(:), area
    !> Area of each point outside the patch, and its distance from the struck point, (local points)
    real(wp), intent(in) :: beside(:), distance(:)
    !> Radius of the nose
    real(wp), intent(in) :: radius
    !> The nose
    type(contact_area_t) :: self

    self%under = under
    self%area = area
    self%beside = merge(beside, 0.0_wp, distance < radius)
    self%rise = radius - sqrt(max(0.0_wp, radius**2 - distance**2))
  end function new_contact_area

  !> Weights of the force distribution, with the sum 1 over the modelled part. Collective.
  function weights(self, communicator, deflection, indentation)
    !> The nose
    class(contact_area_t), intent(in) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Deflection of the struck face, (local points)
    real(wp), intent(in) :: deflection(:)
    !> Indentation; not positive: the patch alone is loaded
    real(wp), intent(in) :: indentation
    !> (local points); ghosts zero
    real(wp), allocatable :: weights(:)
    real(wp), allocatable :: apart(:), pressure(:)
    real(wp) :: least, parts(2)

    weights = self%under
    if (.not. indentation > 0) return
    apart = deflection + self%rise
    least = -minval(apart, mask=self%under > 0 .or. self%beside > 0)
    call communicator%maximum(least)
    pressure = max(0.0_wp, edge_gap*indentation - least - apart)
    parts = [self%area*total_of(communicator, self%under*pressure), total_of(communicator, self%beside*pressure)]
    ! If the indentation is below the round-off of the deflections, all weights may be zero.
    if (sum(parts) > 0) weights = (parts(1)*self%under + self%beside*pressure)/sum(parts)
  end function weights

  !> Area under pressure in the modelled part. Collective.
  real(wp) function touched(self, communicator, weights)
    !> The nose
    class(contact_area_t), intent(in) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Weights of the force distribution, (local points)
    real(wp), intent(in) :: weights(:)
    real(wp) :: largest

    largest = maxval(weights)
    call communicator%maximum(largest)
    touched = self%area + total_of(communicator, pack(self%beside, weights > min_weight*largest))
  end function touched
end module contact_areas
