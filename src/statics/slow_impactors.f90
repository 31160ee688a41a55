!> Quasi-static indentation: load steps by the travel of the impactor. Its force on the patch is that of the indentation
!> law.
module slow_impactors
  use kinds, only: wp
  use errors, only: error_t
  use impact_force, only: contact_step_t, solve_impact_force
  use tan_sun_indentation, only: commit_indentation, indentation_force, indentation_of, indentation_stiffness
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use krylov_corrections, only: solve_load_tangent
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: add_impactor_force, find_force_change, force_mismatch, travel_for, move_slow_impactor

contains

  !> Adds the impactor's force to loads.
  pure subroutine add_impactor_force(plate, state, force, loads)
    type(composite_plate_t), intent(in) :: plate
    !> The state, with its patch
    type(state_t), intent(in) :: state
    !> The force of the impactor on the full plate
    real(wp), intent(in) :: force
    !> Forces on the unknowns at the owned points, (5, points)
    real(wp), intent(inout) :: loads(:, :)

    if (plate%setup%impactor%is_present) loads(3, :) = loads(3, :) + force/plate%mesh%multiplicity &
                                                       *state%impact%patch%weights
  end subroutine add_impactor_force

  !> Finds the impactor's force for the travel and the deflection of the plate, and adds the unit-load solution times
  !> its change to a correction.
  subroutine find_force_change(model, operator, part, new, correction, error)
    type(model_t), target, intent(in) :: model
    type(tangent_operator_t), target, intent(inout) :: operator
    !> Factor of the correction that will be applied
    real(wp), intent(in) :: part
    !> State at this load, before the correction; receives the force
    type(state_t), intent(inout) :: new
    !> Correction for the force on entry, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails or numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    type(contact_step_t) :: step
    real(wp), allocatable :: response(:, :), push(:, :)
    real(wp) :: compliance, mean, force, alpha, force_end
    integer :: iterations

    allocate (push, response, mold=correction)
    push = 0
    response = 0
    call add_impactor_force(model%plate, new, 1.0_wp, push)
    call solve_load_tangent(operator, model, new, push, response, error)
    if (allocated(error)) return
    compliance = new%impact%patch%mean(model%plate%communicator, response)
    mean = new%contact_deflection(model%plate) + new%impact%patch%mean(model%plate%communicator, correction)
    if (compliance < 0 .and. allocated(model%plate%elements%initial_slopes)) then
      force = force_beyond_limit(model%plate, new, mean, compliance)
      if (force >= 0) then
        correction = correction + (force - new%impact%force)*response
        new%impact%force = new%impact%force + part*(force - new%impact%force)
        return
      end if
    end if
    ! With a negative compliance the force would be tensile: the step has to be repeated with a shorter length.
    step = contact_step_t(model%plate%setup%impactor%indentation, new%impact%indentation, &
                          start=new%impact%indentation%alpha, &
                          free=new%load_factor*model%plate%setup%impactor%travel - mean + new%impact%force*compliance, &
                          compliance=compliance, is_mean=.false.)
    call solve_impact_force(step, force, alpha, force_end, iterations, error)
    if (allocated(error)) return
    new%iterations%force = new%iterations%force + iterations
    correction = correction + (force - new%impact%force)*response
    new%impact%force = new%impact%force + part*(force - new%impact%force)
  end subroutine find_force_change

  !> Force beyond the limit load of a curved plate, which needs less force the further it deflects: the root of
  !> the linearized difference between travel, deflection and indentation. The equilibrium is stable under a given
  !> travel if the contact is stiffer than the plate; otherwise -1.
  real(wp) function force_beyond_limit(plate, new, mean, compliance) result(force)
    type(composite_plate_t), intent(in) :: plate
    !> State before the correction
    type(state_t), intent(in) :: new
    !> Deflection of the patch after it, with the present force
    real(wp), intent(in) :: mean
    !> Deflection of the patch per force, < 0
    real(wp), intent(in) :: compliance
    real(wp) :: alpha, flexibility

    force = -1
    if (.not. new%impact%force > 0) return
    associate (law => plate%setup%impactor%indentation)
      alpha = indentation_of(law, new%impact%indentation, new%impact%force)
      flexibility = compliance + 1/indentation_stiffness(law, new%impact%indentation, alpha)
    end associate
    if (flexibility < 0) &
      force = max(0.0_wp, new%impact%force + (new%load_factor*plate%setup%impactor%travel - mean - alpha)/flexibility)
  end function force_beyond_limit

  !> Difference between the force and that of the indentation law, relative to the larger of them.
  real(wp) function force_mismatch(plate, new) result(mismatch)
    type(composite_plate_t), intent(in) :: plate
    !> State at this load
    type(state_t), intent(in) :: new
    real(wp) :: force

    force = indentation_force(plate%setup%impactor%indentation, new%impact%indentation, &
                              new%load_factor*plate%setup%impactor%travel - new%contact_deflection(plate))
    mismatch = abs(force - new%impact%force)/max(force, new%impact%force, tiny(force))
  end function force_mismatch

  !> Travel of the impactor for the force and the deflection of a state.
  real(wp) function travel_for(plate, new) result(travel)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: new

    travel = indentation_of(plate%setup%impactor%indentation, new%impact%indentation, new%impact%force) + &
             new%contact_deflection(plate)
  end function travel_for

  !> Completes an accepted load step: position of the impactor, indentation, and work of the force that drives it.
  subroutine move_slow_impactor(plate, old, new)
    type(composite_plate_t), intent(in) :: plate
    !> State at the load before
    type(state_t), intent(in) :: old
    !> State at this load, with its deflections
    type(state_t), intent(inout) :: new

    new%impact%impactor%displacement = new%load_factor*plate%setup%impactor%travel
    call commit_indentation(plate%setup%impactor%indentation, new%impact%indentation, &
                            new%impact%impactor%displacement - new%impact%patch_mean)
    new%ledger%indentation = new%impact%indentation%work
    new%ledger%external_work = new%ledger%external_work + new%impact%indentation%work - old%impact%indentation%work + &
                               (old%impact%force + new%impact%force)/2*(new%impact%patch_mean - old%impact%patch_mean)
  end subroutine move_slow_impactor
end module slow_impactors
