!> The impactor, its contact with the plate and the plate's response at the struck point at one time.
module impact_states
  use archives, only: archive_t
  use contact_patches, only: contact_patch_t
  use field_mappings, only: area_field
  use impactors, only: impactor_t
  use kinds, only: wp
  use models, only: model_t
  use tan_sun_indentation, only: indentation_t
  implicit none
  private
  public :: impact_state_t

  !> State of the impact.
  type :: impact_state_t
    type(impactor_t) :: impactor
    !> History variables of the indentation
    type(indentation_t) :: indentation
    !> Impact force at this time
    real(wp) :: force = 0
    !> Patch under the impactor
    type(contact_patch_t) :: patch
    !> Mean deflection of the patch, and deflection of the struck point
    real(wp) :: patch_mean = 0, deflection = 0
    !> Bending stress at the struck point, and its largest value so far
    real(wp) :: stress = 0, largest_stress = 0
  contains
    procedure :: pressed_area
    procedure :: depth_below_impactor
    procedure :: visit
  end type impact_state_t

contains

  !> Contact area on the full plate, the same on every rank.
  pure real(wp) function pressed_area(self, model) result(area)
    class(impact_state_t), intent(in) :: self
    type(model_t), intent(in) :: model

    area = model%plate%setup%mesh%patch**2
    if (allocated(model%nose)) area = self%patch%area
  end function pressed_area

  !> Depth of the struck point below the impactor, both from their position at first contact.
  pure real(wp) function depth_below_impactor(self, model) result(depth)
    class(impact_state_t), intent(in) :: self
    type(model_t), intent(in) :: model

    depth = self%deflection - self%impactor%displacement
    if (allocated(model%nose)) then
      depth = depth - self%patch%touched_at
    else
      depth = depth + self%patch%offset
    end if
  end function depth_below_impactor

  !> Saves or loads the state of the impact.
  subroutine visit(self, archive, model)
    class(impact_state_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model

    call self%impactor%visit(archive)
    call self%indentation%visit(archive)
    call archive%item('force', self%force)
    call archive%item('patch_mean', self%patch_mean)
    call visit_patch(self%patch, archive, model)
    call archive%item('deflection', self%deflection)
    call archive%item('stress', self%stress)
    call archive%item('largest_stress', self%largest_stress)
  end subroutine visit

  !> Saves or loads the distribution of the impactor's force.
  subroutine visit_patch(patch, archive, model)
    type(contact_patch_t), intent(inout) :: patch
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    real(wp), allocatable :: weights(:, :)

    call archive%item('contact/offset', patch%offset)
    if (.not. allocated(model%nose)) return
    call archive%item('contact/touched_at', patch%touched_at)
    call archive%item('contact/area', patch%area)
    weights = reshape(patch%weights, [1, size(patch%weights)])
    call model%plate%visit_points(archive, 'contact/weights', weights, area_field)
    call patch%spread(weights(1, :), (patch%offset))
  end subroutine visit_patch
end module impact_states
