!> Start of a run by central differences from the final state of another run: internal forces are computed from that
!> state, supports and lines start from the present displacement, the ledger from the present energies.
module inherited_starts
  use central_difference_energies, only: record_energies
  use errors, only: error_t
  use initial_state_parameters, only: motion_rest
  use layer_switches, only: move_with_plate
  use layer_transfers, only: layer_transfer_t
  use models, only: model_t
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: begin_inherited

contains

  !> Starts from a loaded state. Collective.
  subroutine begin_inherited(model, transfer, motion, stepper, error)
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    class(layer_transfer_t), intent(in) :: transfer
    !> motion_rest or motion_kept
    integer, intent(in) :: motion
    !> The stepper with the loaded state
    type(time_stepper_t), intent(inout) :: stepper
    !> Set if the motion is unstable
    type(error_t), allocatable, intent(out) :: error

    associate (now => stepper%now, explicit => stepper%explicit)
      call move_with_plate(model, transfer, now%motion%displacement)
      call move_with_plate(model, transfer, now%motion%velocity)
      if (motion == motion_rest) now%motion%velocity = 0
      call now%plies%restack(model, transfer%is_split(model%distribution%elements))
      call explicit%lines%start_from(model, explicit%inertia, model%motion_of(now%motion%displacement))
      call explicit%resume(model, now)
      call explicit%renew_forces(model, now)
      now%deflection = model%deflection(now%motion%displacement)
      now%patch_mean = now%contact_deflection(model)
      call record_energies(explicit, model, now)
      now%ledger%initial = now%ledger%initial + now%ledger%error()
      call stepper%complete_state(model, error)
    end associate
  end subroutine begin_inherited
end module inherited_starts
