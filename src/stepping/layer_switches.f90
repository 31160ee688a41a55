!> Insertion of layers: the model is built again with larger layered zones, and the state is transferred to it.
!>
!> The new layers receive the motion of the single plate, with its rotations and without jumps, so that displacement,
!> velocity and acceleration of every ply, strains and energies are unchanged. The remaining difference of energy is
!> recorded: round-off or, with the energy-consistent shear correction, the difference of the sections.
module layer_switches
  use contact_updates, only: update_contact_area
  use errors, only: error_t
  use kinds, only: wp
  use required_zones, only: required_extents
  use layer_transfers, only: layer_transfer_t
  use layered_meshes, only: layered_mesh_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use model_building, only: create_model
  use models, only: model_t
  use profiles, only: profile_t
  use setups, only: setup_t
  use states, only: state_t
  use step_memories, only: save_state, step_memory_t
  use stepping_parameters, only: stepping_t
  use time_stepping, only: time_stepper_t
  use timers, only: timer_set_t
  implicit none
  private
  public :: advance_with_layers, move_with_plate

  !> Steps of central differences between two checks whether damage requires more layers.
  integer, parameter :: steps_between_zone_checks = 16

contains

  !> Takes a step and inserts the layers that the damage requires. A step in which damage has reached the border of an
  !> extensible zone is repeated with more layers. Collective.
  subroutine advance_with_layers(model, stepper, linear_solver, event, switched, error)
    !> The model; receives larger zones
    type(model_t), intent(inout) :: model
    type(time_stepper_t), intent(inout) :: stepper
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Time, or load factor, that must not be exceeded
    real(wp), intent(in) :: event
    !> True if layers were inserted
    logical, intent(out) :: switched
    !> Set if the smallest step fails or the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    type(step_memory_t) :: memory
    real(wp) :: extents(2, size(model%mesh%zones))
    logical :: repeats, more

    switched = .false.
    if (allocated(stepper%explicit)) then
      call advance_explicit(model, stepper, linear_solver, event, switched, error)
      return
    end if
    repeats = has_adaptive_layers(model)
    if (.not. repeats) call stepper%advance(model, event, error)
    do while (repeats)
      memory = save_state(stepper)
      call stepper%advance(model, event, error)
      if (allocated(error)) return
      call model%profile%enter('layers')
      associate (now => stepper%now)
        extents = required_extents(model, now%plies%stiffness, now%interfaces, now%motion%displacement)
        more = any(extents > present_extents(model%setup))
        repeats = more .and. any(now%interfaces%border_reached .and. model%setup%delaminations%is_adaptive)
      end associate
      if (repeats) call memory%restore_state(stepper)
      if (more) call switch(model, stepper, linear_solver, extents, error)
      switched = switched .or. more
      call model%profile%leave()
      if (allocated(error)) return
    end do
    if (.not. allocated(error)) call update_contact_area(model, stepper%now, stepper%operator, error)
  end subroutine advance_with_layers

  !> Takes a step by central differences, and checks at intervals whether damage requires more layers. Damage grows by
  !> less than a cell per step, so that it does not pass the layered cells ahead of it between checks. Collective.
  subroutine advance_explicit(model, stepper, linear_solver, event, switched, error)
    !> The model; receives larger zones
    type(model_t), intent(inout) :: model
    type(time_stepper_t), intent(inout) :: stepper
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Time that must not be exceeded
    real(wp), intent(in) :: event
    !> True if layers were inserted
    logical, intent(out) :: switched
    !> Set if the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: extents(2, size(model%mesh%zones))

    switched = .false.
    call stepper%advance(model, event, error)
    if (allocated(error) .or. .not. has_adaptive_layers(model)) return
    if (modulo(stepper%now%step, steps_between_zone_checks) > 0) return
    call model%profile%enter('layers')
    associate (now => stepper%now)
      extents = required_extents(model, now%plies%stiffness, now%interfaces, now%motion%displacement)
    end associate
    switched = any(extents > present_extents(model%setup))
    if (switched) call switch(model, stepper, linear_solver, extents, error)
    call model%profile%leave()
  end subroutine advance_explicit

  !> True if there are adaptive layers.
  pure logical function has_adaptive_layers(model)
    type(model_t), intent(in) :: model

    has_adaptive_layers = model%map%layered
    if (has_adaptive_layers) has_adaptive_layers = any(model%setup%delaminations%is_adaptive)
  end function has_adaptive_layers

  !> Extents of the zones.
  pure function present_extents(setup) result(extents)
    type(setup_t), intent(in) :: setup
    !> Full extents along x and y, (2, zones)
    real(wp) :: extents(2, size(setup%delaminations))
    integer :: zone

    do zone = 1, size(extents, 2)
      extents(:, zone) = setup%delaminations(zone)%zone
    end do
  end function present_extents

  !> Builds the model with larger zones and transfers the state to it.
  subroutine switch(model, stepper, linear_solver, extents, error)
    type(model_t), intent(inout) :: model
    type(time_stepper_t), intent(inout) :: stepper
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Full extents of the zones along x and y, (2, zones)
    real(wp), intent(in) :: extents(:, :)
    !> Set if the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    type(layer_transfer_t) :: transfer
    type(timer_set_t) :: timers
    type(profile_t) :: profile
    type(layered_mesh_t) :: mesh
    type(setup_t) :: setup
    type(stepping_t) :: stepping
    integer :: zone

    transfer%communicator = model%communicator
    call stepper%complete_state(model, error)
    if (allocated(error)) return
    stepper%operator%ready = .false.
    call stepper%visit(transfer, model, error)
    if (allocated(error)) return
    timers = stepper%operator%timers
    call stepper%operator%release()
    setup = model%setup
    do zone = 1, size(extents, 2)
      setup%delaminations(zone)%zone = extents(:, zone)
    end do
    mesh = model%mesh
    profile = model%profile
    call create_model(setup, transfer%communicator, model, error)
    model%profile = profile
    if (allocated(error)) return
    stepping = stepper%stepping
    call stepper%start(model, stepping, linear_solver, .true., error)
    if (allocated(error)) return
    call transfer%turn_to(mesh, model%mesh)
    call stepper%visit(transfer, model, error)
    if (allocated(error)) return
    stepper%operator%timers = timers
    if (allocated(stepper%explicit)) then
      call transfer_explicit_state(model, transfer, stepper, error)
      return
    end if
    call transfer_state(model, transfer, stepper%now)
    if (allocated(stepper%now%path%change)) call move_with_plate(model, transfer, stepper%now%path%change)
  end subroutine switch

  !> Gives the new layers the motion of the single plate, and computes forces and energies.
  subroutine transfer_state(model, transfer, now)
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    type(state_t), intent(inout) :: now
    type(state_t), allocatable :: before
    real(wp) :: energies(2)

    associate (motion => now%motion)
      call move_with_plate(model, transfer, motion%displacement)
      call move_with_plate(model, transfer, motion%velocity)
      call move_with_plate(model, transfer, motion%acceleration)
      call now%plies%restack(model, transfer%is_split(model%distribution%elements))
      allocate (before, source=now)
      now%plies%keeps_stiffness = allocated(now%plies%bands)
      call now%find_internal(model, before, energies(1))
      now%plies%keeps_stiffness = .false.
      now%interfaces%cohesive%points = before%interfaces%cohesive%points
      call model%inertia(motion%acceleration, motion%inertia)
      call model%inertia(motion%velocity, motion%momentum)
      energies(2) = model%product(motion%velocity, motion%momentum)/2
      call model%communicator%sum(energies)
      energies = energies*model%mesh%multiplicity
      if (.not. model%setup%has_inertia()) energies(2) = now%ledger%kinetic
      now%ledger%layers = now%ledger%layers + now%ledger%strain + now%ledger%kinetic - sum(energies)
      now%ledger%strain = energies(1)
      now%ledger%kinetic = energies(2)
      if (model%setup%has_inertia()) call balance_new_layers(model, transfer, now)
    end associate
  end subroutine transfer_state

  !> Gives the new layers the motion of the single plate, and computes their forces. Collective.
  subroutine transfer_explicit_state(model, transfer, stepper, error)
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    !> The stepper with the loaded state
    type(time_stepper_t), intent(inout) :: stepper
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: before

    associate (now => stepper%now, explicit => stepper%explicit)
      before = now%ledger%kinetic + now%ledger%strain
      call move_with_plate(model, transfer, now%motion%displacement)
      call move_with_plate(model, transfer, now%motion%velocity)
      call now%plies%restack(model, transfer%is_split(model%distribution%elements))
      call explicit%resume(model, now)
      call explicit%renew_forces(model, now)
      call stepper%complete_state(model, error)
      now%ledger%layers = now%ledger%layers + before - now%ledger%kinetic - now%ledger%strain
    end associate
  end subroutine transfer_explicit_state

  !> Gives the new layers the rotations of the layer above, and zero jumps.
  subroutine move_with_plate(model, transfer, field)
    type(model_t), intent(in) :: model
    !> Map of points from the former mesh
    class(layer_transfer_t), intent(in) :: transfer
    !> Displacement or a rate of it, (5, points)
    real(wp), intent(inout) :: field(:, :)
    integer :: i

    do i = 1, model%distribution%owned
      if (transfer%point_origin(model%distribution%points(i)) > 0) cycle
      field(1:3, i) = 0
      field(4:5, i) = field(4:5, model%map%above(i))
    end do
    call model%halo%update(field)
  end subroutine move_with_plate

  !> Adds the interlaminar forces of the undelaminated plate to the internal forces of the new layers, so that the state
  !> stays in equilibrium. The forces vanish at the end of the next step. Without them, an integrator that weights the
  !> old internal forces would overshoot the equilibrium jumps by the factor 1 + alpha_f/(1 - alpha_f).
  pure subroutine balance_new_layers(model, transfer, now)
    type(model_t), intent(in) :: model
    !> Map of points from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    type(state_t), intent(inout) :: now
    real(wp) :: interlaminar(5)
    integer :: i

    associate (internal => now%motion%internal)
      do i = model%distribution%owned, 1, -1
        if (transfer%point_origin(model%distribution%points(i)) > 0) cycle
        interlaminar = -(internal(:, i) + now%motion%inertia(:, i))
        internal(:, i) = internal(:, i) + interlaminar
        associate (above => internal(:, model%map%above(i)))
          above(4:5) = above(4:5) - interlaminar(4:5)
        end associate
      end do
    end associate
  end subroutine balance_new_layers
end module layer_switches
