!> Equilibrium before the first step of central differences, found by rank 0 for all ranks. With assembly and
!> factorization on several ranks round-off would depend on the partition, and explicit histories are equal on any
!> number of ranks.
module single_rank_equilibria
  use communicators, only: communicator_t
  use errors, only: error_t
  use initial_equilibrium, only: find_initial_equilibrium
  use layer_transfers, only: layer_transfer_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use model_building, only: create_model
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use states, only: new_state, state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: equilibrate_initial_stresses

contains

  !> Finds the equilibrium of a plate with residual stresses and with displacements prescribed before the run, so that
  !> the run starts without vibration. Collective.
  subroutine equilibrate_initial_stresses(operator, model, linear_solver, now, error)
    !> The factored operator; released afterwards
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    type(state_t), intent(inout) :: now
    !> Set on all ranks if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error
    type(layer_transfer_t) :: transfer

    associate (ranks => model%plate%communicator)
      if (ranks%size == 1) then
        call equilibrate(operator, model, linear_solver, now, error)
        return
      end if
      if (ranks%is_root()) call equilibrate_whole(operator, model%plate, linear_solver, transfer, error)
      call ranks%agree(error)
      if (allocated(error)) return
      call transfer%broadcast(ranks)
      call transfer%turn_to(model%plate%mesh, model%plate%mesh)
      call now%visit(transfer, model)
      call ranks%broadcast(operator%factorizations)
      call ranks%broadcast(operator%solves)
    end associate
  end subroutine equilibrate_initial_stresses

  !> Finds the equilibrium of the plate on one rank, and stores it.
  subroutine equilibrate_whole(operator, plate, linear_solver, transfer, error)
    !> The factored operator; released afterwards
    type(tangent_operator_t), intent(inout) :: operator
    type(composite_plate_t), intent(in) :: plate
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Receives the state
    type(layer_transfer_t), intent(inout) :: transfer
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error
    type(communicator_t) :: alone
    type(model_t), allocatable :: whole
    type(state_t), allocatable :: now

    allocate (whole)
    call create_model(plate%setup, alone, whole, error)
    if (allocated(error)) return
    allocate (now, source=new_state(whole))
    call equilibrate(operator, whole, linear_solver, now, error)
    if (.not. allocated(error)) call now%visit(transfer, whole)
  end subroutine equilibrate_whole

  !> Finds the equilibrium of a model. Collective.
  subroutine equilibrate(operator, model, linear_solver, now, error)
    !> The factored operator; released afterwards
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    type(state_t), intent(inout) :: now
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error

    call operator%create(model, linear_solver%factorization, error)
    if (.not. allocated(error)) call find_initial_equilibrium(model, operator, now, error)
    call operator%release()
  end subroutine equilibrate
end module single_rank_equilibria
