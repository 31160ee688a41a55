!> Iterative solution of linear equations by PETSc's KSP: flexible GMRES (Y. Saad, SIAM J. Sci. Comput. 14 (1993)
!> 461-469) or conjugate gradients, with matrix-free matrix and preconditioner (MATSHELL, PCSHELL). Options of PETSc for
!> them begin with `newton_`.
module krylov_solvers
  use, intrinsic :: iso_c_binding, only: c_int, c_intptr_t, c_loc, c_f_pointer, c_ptr
  use petscksp, only: tMat, tVec, tKSP, tPC, MATOP_MULT, KSP_GMRES_CGS_REFINE_IFNEEDED, &
                      KSP_NORM_NATURAL, KSP_DIVERGED_INDEFINITE_MAT, PETSC_DEFAULT_REAL, PETSC_FALSE, KSPSetOperators
  use communicators, only: communicator_t
  use errors, only: error_t
  use kinds, only: wp
  use petsc_matrices, only: put, take
  use petsc_session, only: report_petsc
  implicit none
  private
  public :: krylov_solver_t, linear_system_t

  !> Largest dimension of the Krylov space: this number of solves takes about as long as a factorization.
  integer, parameter :: max_dimension = 30
  !> PETSC_ERR_CONV_FAILED, by which a product that fails ends the iteration
  integer, parameter :: product_failed = 82

  !> Equations known by the products of their matrix and of a preconditioner.
  type, abstract :: linear_system_t
  contains
    !> Product of the matrix, and of the preconditioner.
    procedure(find_product), deferred :: multiply, precondition
  end type linear_system_t

  abstract interface
    !> Product with a vector. Collective.
    subroutine find_product(self, vector, product, error)
      import :: linear_system_t, error_t, wp
      class(linear_system_t), intent(inout) :: self
      !> The vector, (rows of this rank)
      real(wp), intent(in) :: vector(:)
      !> The product, (rows of this rank)
      real(wp), intent(out) :: product(:)
      !> Set if it cannot be found
      type(error_t), allocatable, intent(inout) :: error
    end subroutine find_product
  end interface

  !> The solver.
  type :: krylov_solver_t
    !> True between `define` and `release`
    logical :: defined = .false.
    !> Iterations of the last solve
    integer :: iterations = 0
    !> True: the last solve reached its tolerance, or ended before a direction of negative curvature
    logical :: converged = .false., indefinite = .false.
    !> PETSc's solver
    type(tKSP), private :: solver
    !> Its preconditioner
    type(tPC), private :: preconditioner
    !> Its matrix
    type(tMat), private :: matrix
    !> Right-hand side and solution
    type(tVec), private :: right, left
  contains
    procedure :: define
    procedure :: solve
    procedure :: release
  end type krylov_solver_t

  !> Data of the products during a solve.
  type :: products_t
    !> The equations
    class(linear_system_t), pointer :: system => null()
    !> Factor of each row of the equations, (rows)
    real(wp), allocatable :: row_factors(:)
    !> Set if a product fails
    type(error_t), allocatable :: error
  end type products_t

  interface
    !> Sets the context of a matrix-free matrix: the C entries accept any address.
    integer(c_int) function set_matrix_context(matrix, context) bind(c, name='MatShellSetContext')
      import :: c_int, c_intptr_t, c_ptr
      integer(c_intptr_t), value :: matrix
      !> The address
      type(c_ptr), value :: context
    end function set_matrix_context

    !> Its context.
    integer(c_int) function get_matrix_context(matrix, context) bind(c, name='MatShellGetContext')
      import :: c_int, c_intptr_t, c_ptr
      integer(c_intptr_t), value :: matrix
      !> The address
      type(c_ptr), intent(out) :: context
    end function get_matrix_context
  end interface

contains

  !> Creates the solver. Collective.
  subroutine define(self, communicator, rows, method, error)
    class(krylov_solver_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    !> Rows that this rank owns
    integer, intent(in) :: rows
    !> PETSc's name of the method, `fgmres` or `cg`
    character(len=*), intent(in) :: method
    type(error_t), allocatable, intent(inout) :: error
    integer :: total, ierr(15)

    total = rows
    call communicator%sum(total)
    ierr = 0
    call MatCreateShell(communicator%handle(), rows, rows, total, total, 0, self%matrix, ierr(1))
    call MatShellSetOperation(self%matrix, MATOP_MULT, multiply_rows, ierr(2))
    call MatCreateVecs(self%matrix, self%left, self%right, ierr(3))
    call KSPCreate(communicator%handle(), self%solver, ierr(4))
    call KSPSetOptionsPrefix(self%solver, 'newton_', ierr(5))
    call KSPSetOperators(self%solver, self%matrix, self%matrix, ierr(6))
    call KSPSetType(self%solver, method, ierr(7))
    call KSPGetPC(self%solver, self%preconditioner, ierr(8))
    call PCSetType(self%preconditioner, 'shell', ierr(9))
    call PCShellSetApply(self%preconditioner, precondition_rows, ierr(10))
    call KSPGMRESSetRestart(self%solver, max_dimension, ierr(11))
    call KSPGMRESSetCGSRefinementType(self%solver, KSP_GMRES_CGS_REFINE_IFNEEDED, ierr(12))
    call KSPSetInitialGuessNonzero(self%solver, PETSC_FALSE, ierr(13))
    if (method == 'cg') call KSPSetNormType(self%solver, KSP_NORM_NATURAL, ierr(15))
    call KSPSetFromOptions(self%solver, ierr(14))
    call report_petsc(ierr, error)
    self%defined = .true.
  end subroutine define

  !> Solves to a tolerance, or until the Krylov space has its largest dimension. If a product fails, the solver must be
  !> defined again. Collective.
  subroutine solve(self, system, row_factors, right_hand_side, tolerance, solution, error)
    class(krylov_solver_t), intent(inout) :: self
    !> The equations
    class(linear_system_t), target, intent(inout) :: system
    !> Factors of the equations by which their residuals are comparable, (rows)
    real(wp), intent(in) :: row_factors(:)
    !> Right-hand side, (rows)
    real(wp), intent(in) :: right_hand_side(:)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Solution, (rows)
    real(wp), intent(out) :: solution(:)
    !> Set if a product fails
    type(error_t), allocatable, intent(inout) :: error
    type(products_t), target :: products
    integer :: reason, ierr(7)

    products%system => system
    products%row_factors = row_factors
    ierr(1) = int(set_matrix_context(int(self%matrix%v, c_intptr_t), c_loc(products)))
    call KSPSetTolerances(self%solver, tolerance, tiny(tolerance), PETSC_DEFAULT_REAL, max_dimension, ierr(2))
    call put(self%right, row_factors*right_hand_side, ierr(3))
    call KSPSolve(self%solver, self%right, self%left, ierr(4))
    call take(self%left, solution, ierr(5))
    call KSPGetIterationNumber(self%solver, self%iterations, ierr(6))
    call KSPGetConvergedReason(self%solver, reason, ierr(7))
    self%converged = reason > 0
    self%indefinite = reason == KSP_DIVERGED_INDEFINITE_MAT
    if (allocated(products%error)) then
      call move_alloc(products%error, error)
      ! PETSc keeps the right-hand side locked after a solve that a product has ended.
      call self%release()
    else
      call report_petsc(ierr, error)
    end if
  end subroutine solve

  !> The products in the context of a matrix.
  subroutine find_products(matrix, products, ierr)
    type(tMat), intent(in) :: matrix
    type(products_t), pointer, intent(out) :: products
    integer, intent(out) :: ierr
    type(c_ptr) :: context

    ierr = int(get_matrix_context(int(matrix%v, c_intptr_t), context))
    if (ierr == 0) call c_f_pointer(context, products)
  end subroutine find_products

  !> Product of the matrix, with scaled rows.
  subroutine multiply_rows(matrix, vector, product, ierr)
    type(tMat) :: matrix
    !> The vector, and its product
    type(tVec) :: vector, product
    integer, intent(out) :: ierr
    type(products_t), pointer :: products
    real(wp), allocatable :: values(:), results(:)

    call find_products(matrix, products, ierr)
    if (ierr /= 0) return
    allocate (values, results, mold=products%row_factors)
    call take(vector, values, ierr)
    call products%system%multiply(values, results, products%error)
    if (ierr == 0) call put(product, products%row_factors*results, ierr)
    if (allocated(products%error)) ierr = product_failed
  end subroutine multiply_rows

  !> Product of the preconditioner with scaled rows.
  subroutine precondition_rows(preconditioner, vector, product, ierr)
    !> The preconditioner
    type(tPC) :: preconditioner
    !> The vector, and its product
    type(tVec) :: vector, product
    integer, intent(out) :: ierr
    type(products_t), pointer :: products
    type(tMat) :: matrix, of_preconditioner
    real(wp), allocatable :: values(:), results(:)

    call PCGetOperators(preconditioner, matrix, of_preconditioner, ierr)
    if (ierr == 0) call find_products(matrix, products, ierr)
    if (ierr /= 0) return
    allocate (values, results, mold=products%row_factors)
    call take(vector, values, ierr)
    call products%system%precondition(values/products%row_factors, results, products%error)
    if (ierr == 0) call put(product, results, ierr)
    if (allocated(products%error)) ierr = product_failed
  end subroutine precondition_rows

  !> Deallocates the solver. Collective.
  subroutine release(self)
    class(krylov_solver_t), intent(inout) :: self
    integer :: ierr

    if (.not. self%defined) return
    self%defined = .false.
    call KSPDestroy(self%solver, ierr)
    call MatDestroy(self%matrix, ierr)
    call VecDestroy(self%left, ierr)
    call VecDestroy(self%right, ierr)
  end subroutine release
end module krylov_solvers
