!> Linear maps by a linear solver: the products of its matrix, and those of its factor.
module solver_maps
  use errors, only: error_t, fail, exit_convergence
  use kinds, only: wp
  use linear_maps, only: linear_map_t
  use linear_solvers, only: linear_solver_t
  implicit none
  private
  public :: matrix_map_t, factor_map_t

  !> Products of the matrix.
  type, extends(linear_map_t) :: matrix_map_t
    !> The solver
    type(linear_solver_t), pointer :: solver => null()
    !> Products so far, and the one that fails; 0: none
    integer :: products = 0, failing = 0
  contains
    !> The product.
    procedure :: multiply => multiply_matrix
  end type matrix_map_t

  !> Products of the inverse of the matrix.
  type, extends(linear_map_t) :: factor_map_t
    !> The solver
    type(linear_solver_t), pointer :: solver => null()
  contains
    !> The product.
    procedure :: multiply => multiply_factor
  end type factor_map_t

contains

  !> The product of the matrix.
  subroutine multiply_matrix(self, vector, product, error)
    !> The map
    class(matrix_map_t), intent(inout) :: self
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
      call self%solver%multiply(vector, product, error)
    end if
  end subroutine multiply_matrix

  !> The product of the inverse.
  subroutine multiply_factor(self, vector, product, error)
    !> The map
    class(factor_map_t), intent(inout) :: self
    !> The vector
    real(wp), intent(in) :: vector(:)
    !> The product
    real(wp), intent(out) :: product(:)
    !> Set where it fails
    type(error_t), allocatable, intent(inout) :: error

    call self%solver%solve(vector, product, error)
  end subroutine multiply_factor
end module solver_maps
