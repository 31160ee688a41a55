!> New layers in implicit steps: they receive the motion of the single plate, and forces that keep it in equilibrium.
module implicit_layers
  use kinds, only: wp
  use layer_switches, only: move_with_plate
  use layer_transfers, only: layer_transfer_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: transfer_state

contains

  !> Gives the new layers the motion of the single plate, and computes forces and energies.
  subroutine transfer_state(model, transfer, now)
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    type(state_t), intent(inout) :: now
    type(state_t), allocatable :: before
    real(wp) :: energies(2)

    associate (motion => now%motion)
      call move_with_plate(model%plate, transfer, motion%displacement)
      call move_with_plate(model%plate, transfer, motion%velocity)
      call move_with_plate(model%plate, transfer, motion%acceleration)
      call now%plies%restack(model%plate, transfer%is_split(model%plate%distribution%elements))
      allocate (before, source=now)
      now%plies%keeps_stiffness = allocated(now%plies%bands)
      call now%find_internal(model, before, energies(1))
      now%plies%keeps_stiffness = .false.
      now%interfaces%cohesive%points = before%interfaces%cohesive%points
      call model%inertia(motion%acceleration, motion%inertia)
      call model%inertia(motion%velocity, motion%momentum)
      energies(2) = model%plate%product(motion%velocity, motion%momentum)/2
      call model%plate%communicator%sum(energies)
      energies = energies*model%plate%mesh%multiplicity
      if (.not. model%plate%setup%has_inertia()) energies(2) = now%ledger%kinetic
      now%ledger%layers = now%ledger%layers + now%ledger%strain + now%ledger%kinetic - sum(energies)
      now%ledger%strain = energies(1)
      now%ledger%kinetic = energies(2)
      if (model%plate%setup%has_inertia()) call balance_new_layers(model%plate, transfer, now)
    end associate
  end subroutine transfer_state

  !> Adds the interlaminar forces of the undelaminated plate to the internal forces of the new layers, so that the state
  !> stays in equilibrium. The forces vanish at the end of the next step. Without them, an integrator that weights the
  !> old internal forces would overshoot the equilibrium jumps by the factor 1 + alpha_f/(1 - alpha_f).
  pure subroutine balance_new_layers(plate, transfer, now)
    type(composite_plate_t), intent(in) :: plate
    !> Map of points from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    type(state_t), intent(inout) :: now
    real(wp) :: interlaminar(5)
    integer :: i

    associate (internal => now%motion%internal)
      do i = plate%distribution%owned, 1, -1
        if (transfer%point_origin(plate%distribution%points(i)) > 0) cycle
        interlaminar = -(internal(:, i) + now%motion%inertia(:, i))
        internal(:, i) = internal(:, i) + interlaminar
        associate (above => internal(:, plate%map%above(i)))
          above(4:5) = above(4:5) - interlaminar(4:5)
        end associate
      end do
    end associate
  end subroutine balance_new_layers
end module implicit_layers
