!> Updates the contact of a nose in implicit steps, theory (F9), as the plate bends around it.
!>
!> Distribution and gain of the force are found from the last accepted state and kept constant in the next step, so that
!> force and deflection under the impactor are work-conjugate. Between steps they approach the contact point by point;
!> the work of the force on the change of the indentation is recorded as algorithmic.
module contact_updates
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use nose_contacts, only: nose_contact_t
  use rank_totals, only: total_of
  use states, only: state_t
  use tan_sun_indentation, only: commit_indentation, indentation_force
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
    !> The state reached; receives weights, gain and offset of its patch, and the indentation
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
      change = relaxation*(model%nose%to_local(touching%weights, size(w)) - contact%weights)
      contact%gain = contact%gain + relaxation*(touching%gain - contact%gain)
      call move_indentation(model, relaxation*(touching%indentation - now%indentation%alpha), now)
      call contact%spread(contact%weights + change, now%impactor%displacement - now%indentation%alpha/contact%gain - &
                          total_of(model%communicator, (contact%weights + change)*w))
      now%patch_mean = now%contact_deflection(model)
      now%force = contact%gain*indentation_force(model%setup%indentation, now%indentation, now%indentation%alpha)
      now%impactor%force = now%force
      if (.not. total_of(model%communicator, abs(change)) > negligible) return
    end associate
    if (operator%ready) call operator%find_response(model, now%contact, error)
  end subroutine update_contact_area

  !> Changes the indentation at a given motion, and records the work of the force as algorithmic.
  subroutine move_indentation(model, change, now)
    type(model_t), intent(in) :: model
    !> Change of the indentation
    real(wp), intent(in) :: change
    !> The state
    type(state_t), intent(inout) :: now
    real(wp) :: before

    before = now%indentation%work
    call commit_indentation(model%setup%indentation, now%indentation, now%indentation%alpha + change)
    now%ledger%indentation = now%indentation%work
    now%ledger%algorithmic = now%ledger%algorithmic - (now%indentation%work - before)
  end subroutine move_indentation
end module contact_updates
