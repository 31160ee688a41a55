!> Linear equations of one solver, preconditioned by the factor of another one.
module solver_systems
  use errors, only: error_t, fail, exit_convergence
  use kinds, only: wp
  use krylov_solvers, only: linear_system_t
  use linear_solvers, only: linear_solver_t
  implicit none
  private
  public :: solver_system_t

  !> The equations.
  type, extends(linear_system_t) :: solver_system_t
    !> The solver that holds the matrix, and the one whose factor is the preconditioner
    type(linear_solver_t), pointer :: matrix => null(), near => null()
    !> Products so far, and the one that fails; 0: none
    integer :: products = 0, failing = 0
  contains
    procedure :: multiply
    procedure :: precondition
  end type solver_system_t

contains

  !> Product of the matrix.
  subroutine multiply(self, vector, product, error)
    !> The equations
    class(solver_system_t), intent(inout) :: self
    !> The vector
    real(wp), intent(in) :: vector(:)
    !> The product
    real(wp), intent(out) :: product(:)
    !> Set where it fails
    type(error_t), allocatable, intent(inout) :: error

    product = 0
    self%products = self%products + 1
    if (self%products == self%failing) then
      call fail(error, exit_convergence, 'No product.')
    else
      call self%matrix%matrix%multiply(vector, product, error)
    end if
  end subroutine multiply

  !> Product of the inverse of the preconditioner.
  subroutine precondition(self, vector, product, error)
    !> The equations
    class(solver_system_t), intent(inout) :: self
    !> The vector
    real(wp), intent(in) :: vector(:)
    !> The product
    real(wp), intent(out) :: product(:)
    !> Set where it fails
    type(error_t), allocatable, intent(inout) :: error

    call self%near%solve(vector, product, error)
  end subroutine precondition
end module solver_systems
