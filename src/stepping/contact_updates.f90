!> Updates the distribution of the force of a nose in implicit steps, theory (F12), as the plate bends around it.
!>
!> The pressure is proportional to the local depth and uniform on the patch: pressures point by point would excite
!> motions shorter than the steps resolve. It is found from the last accepted state and kept constant in the next step,
!> so that force and mean deflection under the impactor are work-conjugate. An offset keeps that deflection, and the
!> indentation, continuous when the distribution changes: no energy is created.
module contact_updates
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: total_of
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: update_contact_area

  !> Relaxation factor of the weights per step: the plate responds to the change, and without relaxation the update
  !> overshoots where the plate is more compliant than the contact (doc/studies/solution_controls.md).
  real(wp), parameter :: relaxation = 0.2_wp
  !> Sum of the magnitudes of the changes of the weights, whose sum is one, below which they are not updated: the change
  !> of the force is then below its tolerance of 1e-6.
  real(wp), parameter :: negligible = 1.0e-6_wp

contains

  !> Updates the distribution of the force from the state reached. Collective.
  subroutine update_contact_area(model, now, operator, error)
    type(model_t), intent(in) :: model
    !> The state reached; receives the weights and the offset of its patch
    type(state_t), intent(inout) :: now
    !> The factored operator; receives its unit-load solution
    type(tangent_operator_t), intent(inout) :: operator
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: change(:)

    if (.not. allocated(model%nose)) return
    associate (w => now%motion%displacement(3, :), contact => now%impact%patch)
      change = relaxation*(weights_of(model, w, now%impact%indentation%alpha) - contact%weights)
      if (.not. total_of(model%plate%communicator, abs(change)) > negligible) return
      call contact%spread(contact%weights + change, contact%offset - total_of(model%plate%communicator, change*w))
      contact%area = model%nose%area_of(model%plate%communicator, contact%weights)
    end associate
    if (operator%ready) call operator%find_response(model%plate, now%impact%patch, error)
  end subroutine update_contact_area

  !> Weights of the force distribution, with the sum 1 over the modelled part. Collective.
  function weights_of(model, w, indentation) result(weights)
    type(model_t), intent(in) :: model
    !> Deflection of the struck face, (local points)
    real(wp), intent(in) :: w(:)
    !> Indentation; not positive: the patch alone is loaded
    real(wp), intent(in) :: indentation
    !> (local points); ghosts zero
    real(wp), allocatable :: weights(:)
    real(wp), allocatable :: pressures(:)

    weights = model%patch%weights
    if (.not. indentation > 0) return
    pressures = model%nose%nose%foundation(model%nose%points%gathered(model%plate%communicator, w), indentation)
    ! If the indentation is below the round-off of the deflections, all pressures may be zero.
    if (.not. sum(pressures) > 0) return
    weights = model%nose%points%to_local(pressures/sum(pressures), size(w))
    associate (patch => model%patch%weights)
      weights = merge(total_of(model%plate%communicator, merge(weights, 0.0_wp, patch > 0))*patch, weights, patch > 0)
    end associate
  end function weights_of
end module contact_updates
