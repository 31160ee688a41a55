!> Which package factors an operator, and solves with it for fields.
module operator_solvers
  use cholmod_solvers, only: cholmod_solver_t
  use errors, only: error_t
  use kinds, only: wp
  use linear_solver_parameters, only: factorization_automatic, factorization_mumps
  use linear_solvers, only: linear_solver_t
  use models, only: model_t
  use numberings, only: numbering_t
  use operator_assembly, only: stays_positive
  use petsc_library, only: new_petsc_solver
  use timers, only: timer_set_t
  implicit none
  private
  public :: set_solver_up, solve_field

  !> Rows on the borders between ranks that are taken together. The ranks share the work on their dense factor, but each
  !> has all of it, and what its own elements leave there: 72 MB each for so many.
  integer, parameter :: longest_border = 3000

contains

  !> Chooses a solver and gives it the pattern of the operator.
  subroutine set_solver_up(model, numbering, factorization, solver, error)
    type(model_t), intent(in) :: model
    !> Equations
    type(numbering_t), intent(in) :: numbering
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> The solver
    class(linear_solver_t), allocatable, intent(out) :: solver
    !> Set if it cannot be set up
    type(error_t), allocatable, intent(inout) :: error
    integer, allocatable :: seen(:)

    allocate (seen, source=numbering%seen())
    call choose_solver(model, size(seen), factorization, solver, error)
    if (.not. allocated(error)) &
      call solver%define(model%communicator, numbering%first_row, numbering%total, numbering%row_start, &
                         numbering%columns, stays_positive(model), error, seen)
  end subroutine set_solver_up

  !> Chooses a solver: without a wish of the deck's CHOLMOD where the operator stays positive definite and the border
  !> between ranks is short, and MUMPS elsewhere.
  subroutine choose_solver(model, seen, factorization, solver, error)
    type(model_t), intent(in) :: model
    !> Number of equations of other ranks that this rank adds to
    integer, intent(in) :: seen
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> The solver, not set up yet
    class(linear_solver_t), allocatable, intent(out) :: solver
    !> Set if MUMPS cannot be loaded
    type(error_t), allocatable, intent(inout) :: error
    integer :: border
    logical :: suits

    border = seen
    call model%communicator%sum(border)
    suits = border <= longest_border .and. stays_positive(model)
    if (factorization == factorization_mumps .or. factorization == factorization_automatic .and. .not. suits) then
      call model%profile%enter('MPI and PETSc')
      call new_petsc_solver(model%communicator, solver, error)
      call model%profile%leave()
    else
      allocate (solver, source=cholmod_solver_t(falls_back=factorization == factorization_automatic))
    end if
  end subroutine choose_solver

  !> Solution of an operator as it was factored, ghosts included.
  subroutine solve_field(model, numbering, solver, timers, name, force, solution, error)
    type(model_t), intent(in) :: model
    !> Equations
    type(numbering_t), intent(in) :: numbering
    !> Holds the factor
    class(linear_solver_t), intent(inout) :: solver
    !> Time spent in the parts of a step
    type(timer_set_t), intent(inout) :: timers
    !> The part that this is
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
