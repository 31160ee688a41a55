!> Parameters of linear algebra in the deck.
module linear_solver_parameters
  implicit none
  private
  public :: linear_solver_parameters_t

  !> Factorizations.
  integer, parameter, public :: factorization_mumps = 1, factorization_cholmod = 2, &
                                factorization_automatic = 3

  !> Factorization and options of the linear solver.
  type :: linear_solver_parameters_t
    !> factorization_mumps, factorization_cholmod, or the fastest for the number of ranks and the operator
    integer :: factorization = factorization_automatic
    !> Passed to PETSc unchanged
    character(len=:), allocatable :: petsc_options
  end type linear_solver_parameters_t
end module linear_solver_parameters
