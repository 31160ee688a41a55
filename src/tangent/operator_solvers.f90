!> The linear solver of an operator, and solutions as fields.
module operator_solvers
  use errors, only: error_t
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use models, only: model_t
  use numberings, only: numbering_t
  use operator_assembly, only: is_positive_definite
  use timers, only: timer_set_t
  implicit none
  private
  public :: create_solver, solve_field

contains

  !> Creates a solver for the sparsity pattern of an operator.
  subroutine create_solver(model, numbering, factorization, solver, error)
    type(model_t), intent(in) :: model
    !> Equations
    type(numbering_t), intent(in) :: numbering
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> The solver
    class(linear_solver_t), allocatable, intent(out) :: solver
    !> Set if it cannot be set up
    type(error_t), allocatable, intent(inout) :: error

    allocate (solver)
    solver%factorization = factorization
    call solver%define(model%communicator, numbering%first_row, numbering%total, numbering%row_start, &
                       numbering%columns, is_positive_definite(model), error)
  end subroutine create_solver

  !> Solution by the factored operator, ghosts included.
  subroutine solve_field(model, numbering, solver, timers, name, force, solution, error)
    type(model_t), intent(in) :: model
    !> Equations
    type(numbering_t), intent(in) :: numbering
    !> The factored matrix
    class(linear_solver_t), intent(inout) :: solver
    !> Time spent in the parts of a step
    type(timer_set_t), intent(inout) :: timers
    !> Name of this part
    character(len=*), intent(in) :: name
    !> Force at the owned points, (5, points)
    real(wp), intent(in) :: force(:, :)
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    !> Set if the solution is not finite
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: right_hand_side(:), values(:)

    allocate (right_hand_side(numbering%rows), values(numbering%rows))
    call numbering%gather(force, right_hand_side)
    call timers%start(name)
    call solver%solve(right_hand_side, values, error)
    call timers%stop(name)
    if (allocated(error)) return
    call numbering%scatter(values, solution)
    call model%halo%update(solution)
  end subroutine solve_field
end module operator_solvers
