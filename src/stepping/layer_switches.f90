!> Insertion of layers: the model is built again with larger layered zones, and the state is transferred to it.
!>
!> The new layers receive the motion of the single plate, with its rotations and without jumps, so that displacement,
!> velocity and acceleration of every ply, strains and energies are unchanged. The remaining difference of energy is
!> recorded: round-off or, with the energy-consistent shear correction, the difference of the sections.
module layer_switches
  use errors, only: error_t
  use kinds, only: wp
  use required_zones, only: required_extents
  use layer_transfers, only: layer_transfer_t
  use layered_meshes, only: layered_mesh_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use model_building, only: create_model
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use profiles, only: profile_t
  use setups, only: setup_t
  use states, only: state_t
  use steppers, only: stepper_t
  use stepping_parameters, only: stepping_t
  use timers, only: timer_set_t
  implicit none
  private
  public :: find_required_layers, has_adaptive_layers, insert_layers, move_with_plate

contains

  !> Extents of the layered zones that the damage requires. Collective.
  subroutine find_required_layers(plate, now, extents, more)
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Full extents of the zones along x and y, (2, zones)
    real(wp), intent(out) :: extents(:, :)
    !> True: they are larger than the present ones
    logical, intent(out) :: more
    integer :: zone

    extents = required_extents(plate, now%plies%stiffness, now%interfaces, now%motion%displacement)
    more = any([(any(extents(:, zone) > plate%setup%delaminations(zone)%zone), zone=1, size(extents, 2))])
  end subroutine find_required_layers

  !> True if there are adaptive layers.
  pure logical function has_adaptive_layers(model)
    type(model_t), intent(in) :: model

    has_adaptive_layers = model%plate%map%layered
    if (has_adaptive_layers) has_adaptive_layers = any(model%plate%setup%delaminations%is_adaptive)
  end function has_adaptive_layers

  !> Builds the model with larger zones and transfers the state to it.
  subroutine insert_layers(model, stepper, linear_solver, extents, error)
    type(model_t), intent(inout) :: model
    class(stepper_t), intent(inout) :: stepper
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

    transfer%communicator = model%plate%communicator
    call stepper%complete_state(model, error)
    if (allocated(error)) return
    stepper%operator%ready = .false.
    call stepper%visit(transfer, model, error)
    if (allocated(error)) return
    timers = stepper%operator%timers
    call stepper%operator%release()
    setup = model%plate%setup
    do zone = 1, size(extents, 2)
      setup%delaminations(zone)%zone = extents(:, zone)
    end do
    mesh = model%plate%mesh
    profile = model%plate%profile
    call create_model(setup, transfer%communicator, model, error)
    model%plate%profile = profile
    if (allocated(error)) return
    stepping = stepper%stepping
    call stepper%start(model, stepping, linear_solver, .true., error)
    if (allocated(error)) return
    call transfer%turn_to(mesh, model%plate%mesh)
    call stepper%visit(transfer, model, error)
    if (allocated(error)) return
    stepper%operator%timers = timers
    call stepper%take_layers(model, transfer, error)
  end subroutine insert_layers

  !> Gives the new layers the rotations of the layer above, and zero jumps.
  subroutine move_with_plate(plate, transfer, field)
    type(composite_plate_t), intent(in) :: plate
    !> Map of points from the former mesh
    class(layer_transfer_t), intent(in) :: transfer
    !> Displacement or a rate of it, (5, points)
    real(wp), intent(inout) :: field(:, :)
    integer :: i

    do i = 1, plate%distribution%owned
      if (transfer%point_origin(plate%distribution%points(i)) > 0) cycle
      field(1:3, i) = 0
      field(4:5, i) = field(4:5, plate%map%above(i))
    end do
    call plate%halo%update(field)
  end subroutine move_with_plate
end module layer_switches
