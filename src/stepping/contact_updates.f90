!> The impactor's force spreads as the plate bends about its nose.
!>
!> How it is spread is found from the last accepted state and holds through the next step, so force and deflection
!> under the impactor do the same work. As the spreading changes, the deflection and with it the indentation go on from
!> what they were: no energy appears.
module contact_updates
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: total_of
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: update_contact_area, set_contact_area

  !> Part of the way to what the last state asks for that a step goes: the plate responds to the change, and a whole
  !> way would overshoot where it gives way more than the nose is indented. doc/theory/impact.md has figures.
  real(wp), parameter :: relaxation = 0.2_wp
  !> Sum of the changes of weights, of one, that are not worth a solve: they change the force by less than its tolerance
  !> of 1e-6.
  real(wp), parameter :: negligible = 1.0e-6_wp

contains

  !> Spreads the force as a new state asks for. Collective.
  subroutine update_contact_area(model, now, operator, error)
    !> The model; receives how the force is spread
    type(model_t), intent(inout) :: model
    !> The state reached; remembers it
    type(state_t), intent(inout) :: now
    !> The factored operator; receives its response to the force
    type(tangent_operator_t), intent(inout) :: operator
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: change(:)

    if (.not. allocated(model%contact%nose)) return
    associate (w => now%motion%displacement(3, :), contact => model%contact)
      change = relaxation*(contact%nose%weights(model%communicator, w, now%indentation%alpha) - contact%weights)
      if (.not. total_of(model%communicator, abs(change)) > negligible) return
      now%patch = contact%weights + change
      now%patch_offset = now%patch_offset - total_of(model%communicator, change*w)
    end associate
    call set_contact_area(model, now, operator, error)
  end subroutine update_contact_area

  !> Spreads the force as a state has it. Collective.
  subroutine set_contact_area(model, now, operator, error)
    !> The model; receives how the force is spread
    type(model_t), intent(inout) :: model
    !> The state
    type(state_t), intent(in) :: now
    !> The factored operator; receives its response to the force
    type(tangent_operator_t), intent(inout) :: operator
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error

    if (.not. allocated(now%patch)) return
    call model%spread_force(now%patch, now%patch_offset)
    if (.not. operator%ready) return
    call operator%find_response(model, error)
  end subroutine set_contact_area
end module contact_updates
