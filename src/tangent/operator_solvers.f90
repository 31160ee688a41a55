!> Which package factors the operator.
module operator_solvers
  use cholmod_solvers, only: cholmod_solver_t
  use errors, only: error_t
  use linear_solver_parameters, only: factorization_automatic, factorization_mumps
  use linear_solvers, only: linear_solver_t
  use models, only: model_t
  use petsc_library, only: new_petsc_solver
  implicit none
  private
  public :: choose_solver

contains

  !> Chooses a solver: without a wish of the deck's CHOLMOD on one rank, where the operator stays positive definite, and
  !> MUMPS elsewhere.
  subroutine choose_solver(model, stays_positive, factorization, solver, error)
    type(model_t), intent(in) :: model
    !> True: no operator of the run has a negative pivot
    logical, intent(in) :: stays_positive
    !> One of the factorization_* choices
    integer, intent(in) :: factorization
    !> The solver, not set up yet
    class(linear_solver_t), allocatable, intent(out) :: solver
    !> Set if MUMPS cannot be loaded
    type(error_t), allocatable, intent(inout) :: error
    logical :: suits

    suits = model%communicator%size == 1 .and. stays_positive
    if (factorization == factorization_mumps .or. factorization == factorization_automatic .and. .not. suits) then
      call model%profile%enter('MPI and PETSc')
      call new_petsc_solver(model%communicator, solver, error)
      call model%profile%leave()
    else
      allocate (solver, source=cholmod_solver_t(falls_back=factorization == factorization_automatic))
    end if
  end subroutine choose_solver
end module operator_solvers
