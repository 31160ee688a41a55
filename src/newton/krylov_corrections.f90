!> Newton's correction, theory (N2): the tangent's equations solved by a Krylov method of PETSc, with the factored
!> operator as preconditioner. A factorization older than the present contacts, ties, damage or deflection costs
!> iterations, not accuracy.
!>
!> Flexible GMRES takes fewer solves than conjugate gradients (input/li2002.nml: 7864 against 10182). Conjugate
!> gradients are used where cohesive points soften: they stop before a direction of negative curvature, and their last
!> iterate is a direction of descent (Newton's method with conjugate gradients, J. Nocedal, S. J. Wright, Numerical
!> Optimization, 2006, algorithm 7.1).
module krylov_corrections
  use errors, only: error_t
  use kinds, only: wp
  use krylov_solvers, only: krylov_solver_t
  use models, only: model_t
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_krylov_correction, solve_load_tangent

  !> Relative tolerance of solutions of a load step. Near a limit point a small correction is the difference of two
  !> large solutions: with 1e-3 its error is 1.5 times the correction, and no step converges however short
  !> (input/verify/dcb_ubm.nml).
  real(wp), parameter :: relative_tolerance = 1.0e-6_wp

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(tangent, residual, tolerance, correction, error, has_negative_curvature, converged)
    type(tangent_product_t), intent(inout) :: tangent
    real(wp), intent(in) :: residual(:, :)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    !> True: a direction of negative curvature of the tangent was found; the correction is the last iterate before it
    logical, intent(out) :: has_negative_curvature
    !> False: neither the tolerance was reached nor negative curvature found
    logical, intent(out) :: converged
    real(wp), allocatable :: rows(:), solution(:)

    associate (numbering => tangent%operator%numbering)
      allocate (rows(numbering%rows), solution(numbering%rows))
      call numbering%gather(residual, rows)
      has_negative_curvature = .false.
      converged = .true.
      if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
        call tangent%precondition(rows, solution, error)
      else
        call solve_tangent(tangent, rows, tolerance, solution, converged, has_negative_curvature, error)
      end if
      if (allocated(error)) return
      call numbering%scatter(solution, correction)
      call tangent%model%plate%halo%update(correction)
    end associate
  end subroutine find_krylov_correction

  !> Solves with the tangent, by conjugate gradients where it may be indefinite.
  subroutine solve_tangent(tangent, rows, tolerance, solution, converged, indefinite, error)
    type(tangent_product_t), intent(inout) :: tangent
    !> Right-hand side
    real(wp), intent(in) :: rows(:)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Solution
    real(wp), intent(out) :: solution(:)
    !> False: neither the tolerance was reached nor negative curvature found
    logical, intent(out) :: converged
    !> True: negative curvature was found
    logical, intent(out) :: indefinite
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(krylov_solver_t), pointer :: krylov
    real(wp) :: row_factors(size(rows))

    if (tangent%softens) then
      krylov => tangent%operator%conjugate_gradients
      row_factors = 1
    else
      krylov => tangent%operator%minimal_residuals
      ! The inverse diagonal weights the forces, so that forces and moments, plate and stiff contacts are comparable.
      row_factors = 1/sqrt(abs(tangent%operator%rows_of(tangent%diagonal)))
    end if
    converged = .false.
    indefinite = .false.
    if (.not. krylov%defined) call krylov%define(tangent%model%plate%communicator, size(rows), &
                                                 trim(merge('cg    ', 'fgmres', tangent%softens)), error)
    if (allocated(error)) return
    call krylov%solve(tangent, row_factors, rows, tolerance, solution, error)
    indefinite = krylov%indefinite
    converged = krylov%converged .or. indefinite
    ! With negative curvature in the first iteration, the solution of the factored operator is a direction of descent.
    if (indefinite .and. krylov%iterations <= 1) call tangent%precondition(rows, solution, error)
  end subroutine solve_tangent

  !> Solution under forces, ghosts included, with the tangent of a load step, whose symmetric part has just been
  !> factored. A cohesive law whose toughness depends on the mixture of modes has an unsymmetric tangent where damage
  !> grows. Plies with E1c have elements whose tangent is not the factored one: the factor has E1c for all strains of a
  !> compressed ply, and alone converges for E1c above E1/2 only. Collective.
  subroutine solve_load_tangent(operator, model, state, forces, solution, error)
    !> The operator, just factored
    type(tangent_operator_t), target, intent(inout) :: operator
    type(model_t), target, intent(in) :: model
    !> The state at which the tangent is taken
    type(state_t), target, intent(in) :: state
    !> Forces at the owned points, (5, points)
    real(wp), intent(in) :: forces(:, :)
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(tangent_product_t) :: tangent
    logical :: has_negative_curvature, converged

    tangent%model => model
    tangent%operator => operator
    tangent%displacement => operator%displacement
    if (allocated(state%plies%mean_change)) then
      call set_elements(tangent, operator, state)
    else if (allocated(state%interfaces%cohesive%tangents)) then
      call tangent%set_skew_part(state%interfaces%cohesive%tangents)
    end if
    tangent%diagonal = operator%diagonal
    tangent%diagonal(:3, :) = tangent%diagonal(:3, :) + abs(operator%added)
    call find_krylov_correction(tangent, forces, relative_tolerance, solution, error, has_negative_curvature, converged)
  end subroutine solve_load_tangent

  !> Sets a tangent of plies with E1c: that of the elements, and all of the stiffness of jumps.
  subroutine set_elements(tangent, operator, state)
    type(tangent_product_t), intent(inout) :: tangent
    !> The operator, just factored
    type(tangent_operator_t), intent(in) :: operator
    !> The state at which the tangent is taken
    type(state_t), target, intent(in) :: state
    logical, allocatable :: cohesive(:)

    tangent%elements = .true.
    tangent%stiffness => state%plies%stiffness
    tangent%free => state%plies%free
    tangent%mean_change => state%plies%mean_change
    tangent%stiffness_factor = operator%stiffness_factor
    tangent%mass_factor = operator%mass_factor
    if (allocated(state%interfaces%cohesive%tangents)) then
      call tangent%set_jump_stiffness(operator%added, operator%added, state%interfaces%cohesive%cohesive, &
                                      state%interfaces%cohesive%tangents)
    else
      call tangent%set_jump_stiffness(operator%added, operator%added, cohesive, reshape([real(wp) ::], [3, 3, 0]))
    end if
    ! A path may lead through unstable states, which conjugate gradients would leave.
    tangent%softens = .false.
  end subroutine set_elements
end module krylov_corrections
