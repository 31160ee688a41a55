!> Contact area of the impactor in central differences: the patch of the deck, or the contact area of a nose.
!>
!> The points are listed in the order of the mesh on every rank, so that mean deflection and force distribution are
!> identical on any number of ranks. The contact of a nose is that with the deflection at the end of each step
!> (`nose_contacts`): a lagged distribution would add energy to the motion.
module struck_patches
  use archives, only: archive_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use listed_points, only: listed_points_t
  use nose_contacts, only: nose_contact_t, nose_t
  implicit none
  private
  public :: struck_patch_t, create_struck_patch

  !> The points within reach.
  type :: struck_patch_t
    type(listed_points_t) :: points
    !> Weights of the force distribution, their increase with the local depth, and inverse inertia of w, (reached)
    real(wp), allocatable :: weights(:), slopes(:), inverse(:)
    !> Force relative to that of a flat face with the same indentation, and area under pressure
    real(wp) :: gain = 1, area = 0
    !> Offset of the deflection under the impactor: minus that at first contact, and minus the depth of an earlier dent
    real(wp) :: offset = 0
    !> The nose; unallocated: the patch
    type(nose_t), allocatable, private :: nose
  contains
    procedure :: find_deflections
    procedure :: find_indentation
    procedure :: touch
    procedure :: visit
  end type struck_patch_t

contains

  !> The points within reach of the impactor. Collective.
  function create_struck_patch(model) result(self)
    type(model_t), intent(in) :: model
    type(struck_patch_t) :: self
    real(wp) :: weights(model%plate%mesh%points())
    integer, allocatable :: reached(:)
    integer :: i

    if (allocated(model%nose)) then
      self%nose = model%nose%nose
      self%points = model%nose%points
      allocate (self%weights(size(self%points%local)), source=0.0_wp)
    else
      weights = 0
      associate (partition => model%plate%distribution)
        weights(partition%points(:partition%owned)) = model%patch%weights(:partition%owned)
        call model%plate%communicator%sum(weights)
        reached = pack([(i, i=1, size(weights))], abs(weights) > 0)
        self%points%local = partition%local(reached)
        where (self%points%local > partition%owned) self%points%local = 0
      end associate
      self%weights = weights(reached)
    end if
    self%slopes = 0*self%weights
  end function create_struck_patch

  !> Deflections of the points and that of the struck point, the same on every rank: one message. Collective.
  subroutine find_deflections(self, plate, displacement, w, struck)
    class(struck_patch_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> (reached)
    real(wp), intent(out) :: w(:)
    !> At the struck point
    real(wp), intent(out) :: struck
    real(wp) :: list(size(w) + 1)
    type(listed_points_t) :: points

    points%local = [self%points%local, plate%struck%point]
    list = points%gathered(plate%communicator, displacement(3, :))
    w = list(:size(w))
    struck = list(size(list))
  end subroutine find_deflections

  !> Indentation at a position of the impactor: from the mean deflection of the patch, or by the contact of the nose,
  !> with which the force distribution changes.
  pure subroutine find_indentation(self, w, position, indentation)
    class(struck_patch_t), intent(inout) :: self
    !> Their deflections, (reached)
    real(wp), intent(in) :: w(:)
    !> Displacement of the impactor
    real(wp), intent(in) :: position
    !> The indentation
    real(wp), intent(out) :: indentation
    type(nose_contact_t) :: contact

    if (allocated(self%nose)) then
      call self%nose%press(w + self%offset, position, contact)
      self%weights = contact%weights
      self%slopes = contact%slopes
      self%gain = contact%gain
      self%area = contact%area
      indentation = contact%indentation
    else
      indentation = position - (dot_product(self%weights, w) + self%offset)
    end if
  end subroutine find_indentation

  !> Chooses the offset with which the impactor in its first position has a given indentation of the deflected face. The
  !> indentation changes nearly as the position, so that the difference decreases until only round-off is left.
  pure subroutine touch(self, w, indentation)
    class(struck_patch_t), intent(inout) :: self
    !> Deflections of the points, (reached)
    real(wp), intent(in) :: w(:)
    !> Depth of an earlier dent; 0: first contact
    real(wp), intent(in) :: indentation
    real(wp) :: found, difference

    difference = huge(difference)
    do
      call self%find_indentation(w, 0.0_wp, found)
      if (.not. abs(found - indentation) < difference) exit
      difference = abs(found - indentation)
      self%offset = self%offset + (found - indentation)
    end do
  end subroutine touch

  !> Saves or loads.
  subroutine visit(self, archive)
    class(struck_patch_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('explicit/patch_weights', self%weights)
    call archive%item('explicit/patch_slopes', self%slopes)
    call archive%item('explicit/patch_gain', self%gain)
    call archive%item('explicit/patch_area', self%area)
    call archive%item('explicit/patch_offset', self%offset)
  end subroutine visit
end module struck_patches
