!> Updates the contact of a nose in implicit steps, theory (F12), as the plate bends around it.
!>
!> On the patch the force is uniform, as that of a single point excites motions shorter than the steps resolve.
!> Distribution and gain of the force are found from the last accepted state and kept constant in the next step, so that
!> force and deflection under the impactor are work-conjugate. An offset keeps the indentation continuous when they
!> change: no energy is created.
module contact_updates
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use nose_contacts, only: nose_contact_t
  use rank_totals, only: total_of
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: update_contact_area

  !> Relaxation factor of the contact per step: the plate responds to the change, and without relaxation the update
  !> overshoots where the plate is more compliant than the contact (doc/studies/solution_controls.md).
  real(wp), parameter :: relaxation = 0.2_wp
  !> Sum of the magnitudes of the changes of the weights, whose sum is one, below which they are not updated: the change
  !> of the force is then below its tolerance of 1e-6.
  real(wp), parameter :: negligible = 1.0e-6_wp

contains

  !> Updates the contact from the state reached. Collective.
  subroutine update_contact_area(model, now, operator, error)
    type(model_t), intent(in) :: model
    !> The state reached; receives weights, gain and offset of its patch
    type(state_t), intent(inout) :: now
    !> The factored operator; receives its unit-load solution
    type(tangent_operator_t), intent(inout) :: operator
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(nose_contact_t) :: touching
    real(wp), allocatable :: change(:)

    if (.not. allocated(model%nose)) return
    associate (w => now%motion%displacement(3, :), contact => now%contact)
      touching = model%nose%find_contact(model%communicator, w - contact%touched_at, now%impactor%displacement)
      if (.not. touching%indentation > 0) return
      change = relaxation*(spread_on_patch(model, model%nose%to_local(touching%weights, size(w))) - contact%weights)
      contact%gain = contact%gain + relaxation*(touching%gain - contact%gain)
      call contact%spread(contact%weights + change, now%impactor%displacement - now%indentation%alpha/contact%gain - &
                          total_of(model%communicator, (contact%weights + change)*w))
      now%patch_mean = now%contact_deflection(model)
      if (.not. total_of(model%communicator, abs(change)) > negligible) return
    end associate
    if (operator%ready) call operator%find_response(model, now%contact, error)
  end subroutine update_contact_area

  !> Weights that are uniform on the patch, with their sum. Collective.
  function spread_on_patch(model, weights) result(spread)
    type(model_t), intent(in) :: model
    !> Weights of the points, (local points)
    real(wp), intent(in) :: weights(:)
    !> (local points)
    real(wp), allocatable :: spread(:)

    associate (patch => model%patch%weights)
      spread = merge(total_of(model%communicator, merge(weights, 0.0_wp, patch > 0))*patch, weights, patch > 0)
    end associate
  end function spread_on_patch
end module contact_updates
