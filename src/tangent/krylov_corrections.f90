!> Newton's correction: the tangent's equations solved by a Krylov method of PETSc, with the factored operator as
!> preconditioner. A factorization older than the present contacts, ties, damage or deflection costs iterations, not
!> accuracy.
!>
!> Flexible GMRES takes fewer solves than conjugate gradients (input/li2002.nml: 7864 against 10182). Conjugate
!> gradients are used where cohesive points soften: they stop before a direction of negative curvature, and their last
!> iterate is a direction of descent (Newton's method with conjugate gradients, J. Nocedal, S. J. Wright, Numerical
!> Optimization, 2006, algorithm 7.1).
module krylov_corrections
  use cohesive_interfaces, only: cohesive_interfaces_t
  use errors, only: error_t
  use kinds, only: wp
  use krylov_solvers, only: krylov_solver_t
  use linear_maps, only: linear_map_t
  use models, only: model_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_krylov_correction, solve_load_tangent

  !> Relative tolerance of solutions of a load step. Near a limit point a small correction is the difference of two
  !> large solutions: with 1e-3 its error is 1.5 times the correction, and no step converges however short
  !> (input/verify/dcb_ubm.nml).
  real(wp), parameter :: left_over = 1.0e-6_wp

  !> Solution by the factored operator, with the rank-one term of the impactor's force (Sherman and Morrison).
  type, extends(linear_map_t) :: factored_tangent_t
    !> The factored operator
    type(tangent_operator_t), pointer :: operator => null()
    !> The tangent, with the slope of the impactor's force
    type(tangent_product_t), pointer :: tangent => null()
  contains
    !> Displacement under forces.
    procedure :: multiply
  end type factored_tangent_t

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(operator, model, tangent, diagonal, residual, tolerance, correction, error, &
                                    has_negative_curvature, converged)
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), target, intent(inout) :: tangent
    !> Its diagonal, (5, points); unallocated: the tangent is the factored operator
    real(wp), allocatable, intent(in) :: diagonal(:, :)
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    !> True: negative curvature of the tangent was met, and the correction is the iterate before it
    logical, intent(out), optional :: has_negative_curvature
    !> False: the tolerance was not reached
    logical, intent(out), optional :: converged
    type(factored_tangent_t) :: factored
    real(wp) :: rows(operator%numbering%rows), solution(operator%numbering%rows)
    logical :: reached, indefinite

    call operator%numbering%gather(residual, rows)
    factored%operator => operator
    factored%tangent => tangent
    reached = .true.
    indefinite = .false.
    if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
      call factored%multiply(rows, solution, error)
    else
      call solve_tangent(operator, model, tangent, factored, diagonal, rows, tolerance, solution, reached, indefinite, &
                         error)
    end if
    if (present(has_negative_curvature)) has_negative_curvature = indefinite
    if (present(converged)) converged = reached
    if (allocated(error)) return
    call operator%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine find_krylov_correction

  !> Solves with the tangent, by conjugate gradients where it may be indefinite.
  subroutine solve_tangent(operator, model, tangent, factored, diagonal, rows, tolerance, solution, reached, &
                           indefinite, error)
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), intent(inout) :: tangent
    !> The preconditioner
    type(factored_tangent_t), intent(inout) :: factored
    !> Diagonal of the tangent, (5, points). Its inverse weights the forces, so that forces and moments, plate and stiff
    !> contacts are comparable
    real(wp), intent(in) :: diagonal(:, :)
    !> Right-hand side
    real(wp), intent(in) :: rows(:)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Solution
    real(wp), intent(out) :: solution(:)
    !> False: neither the tolerance was reached nor negative curvature met
    logical, intent(out) :: reached
    !> True: negative curvature was met
    logical, intent(out) :: indefinite
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(krylov_solver_t), pointer :: krylov
    real(wp) :: row_factors(size(rows))

    if (tangent%softens) then
      krylov => operator%conjugate_gradients
      row_factors = 1
    else
      krylov => operator%minimal_residuals
      row_factors = 1/sqrt(abs(operator%rows_of(diagonal)))
    end if
    reached = .false.
    indefinite = .false.
    if (.not. krylov%defined) &
      call krylov%define(model%communicator, size(rows), trim(merge('cg    ', 'fgmres', tangent%softens)), error)
    if (.not. allocated(error)) &
      call krylov%solve(tangent, factored, row_factors, rows, tolerance, solution, reached, indefinite, error)
    reached = reached .or. indefinite
    ! Negative curvature in the first direction: the solution with the factored operator is a direction of descent.
    if (indefinite .and. krylov%iterations <= 1) call factored%multiply(rows, solution, error)
  end subroutine solve_tangent

  !> Solution under forces, ghosts included, with the tangent of a load step, whose symmetric part has just been
  !> factored. A cohesive law whose toughness depends on the mixture of modes has an unsymmetric tangent where damage
  !> grows. Collective.
  subroutine solve_load_tangent(operator, model, cohesive, forces, solution, error)
    !> The operator, just factored
    type(tangent_operator_t), target, intent(inout) :: operator
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> The interfaces with their tangents
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Forces at the owned points, (5, points)
    real(wp), intent(in) :: forces(:, :)
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(tangent_product_t) :: tangent
    real(wp), allocatable :: diagonal(:, :)

    tangent%model => model
    tangent%operator => operator
    tangent%displacement => operator%displacement
    if (allocated(cohesive%tangents)) call tangent%set_skew_part(cohesive%tangents)
    diagonal = operator%diagonal
    diagonal(:3, :) = diagonal(:3, :) + abs(operator%added)
    call find_krylov_correction(operator, model, tangent, diagonal, forces, left_over, solution, error)
  end subroutine solve_load_tangent

  !> Displacement under forces.
  subroutine multiply(self, vector, product, error)
    !> The factored operator and the slope of the force
    class(factored_tangent_t), intent(inout) :: self
    !> Forces on this rank's rows
    real(wp), intent(in) :: vector(:)
    !> Displacement under them
    real(wp), intent(out) :: product(:)
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error

    associate (operator => self%operator, slope => self%tangent%force_slope)
      call operator%solve_rows(vector, product, error)
      operator%solves = operator%solves + 1
      if (allocated(error) .or. .not. slope > 0) return
      product = product - slope*self%tangent%mean(product)/(1 + slope*operator%compliance)*operator%response_rows
    end associate
  end subroutine multiply
end module krylov_corrections
