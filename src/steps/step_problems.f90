!> Equilibrium of a step: one nonlinear iteration for every kind of step, be it a step in time or a load step.
!>
!> A kind of step defines predictor, residual, operator and energy balance. The iteration around them is the paper's
!> Fig. 7: residual, ties and contact, correction with a lagged operator; at equilibrium the contact pressures become
!> the next multipliers, until they converge.
module step_problems
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use forcing_terms, only: forcing_term
  use line_searches, only: line_search_t
  use models, only: model_t
  use solution_controls, only: newton_controls_t
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: step_problem_t, solve_step

  !> One kind of step.
  type, abstract :: step_problem_t
    !> True: after a failure of the solver a shorter step may succeed
    logical :: retries_shorter = .true.
    !> True: element tangents are used, as the factored operator reduces the residual too little
    logical :: uses_element_tangents = .false.
    !> True: a line search follows each correction
    logical :: searches_lines = .false.
    !> Constants of Newton's method
    type(newton_controls_t) :: controls
  contains
    !> Predictor of the state at the end of the step.
    procedure(begin_step), deferred :: begin
    !> Residual of equilibrium without ties and contact.
    procedure(find_residual), deferred :: find_residual
    !> Residual relative to the reference force.
    procedure(residual_norm), deferred :: residual_norm
    !> True if the iteration may end with a residual within the tolerance.
    procedure(may_stop), deferred :: may_stop
    !> Finds a correction by the tangent, renewing the operator where that is due.
    procedure(find_correction), deferred :: find_correction
    !> Finds the impactor's force for a displacement, where there is one.
    procedure :: find_force
    !> Completes the motion after a correction.
    procedure(complete), deferred :: complete
    !> Completes the state of a step that has converged, and its ledger.
    procedure(finish), deferred :: finish
  end type step_problem_t

  abstract interface
    !> Predictor of the state at the end of the step.
    subroutine begin_step(self, model, operator, old, new)
      import :: step_problem_t, model_t, tangent_operator_t, state_t
      !> The problem
      class(step_problem_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      !> The factored operator
      type(tangent_operator_t), intent(inout) :: operator
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine begin_step

    !> Residual of equilibrium without ties and contact.
    subroutine find_residual(self, model, old, new, residual, energy)
      import :: step_problem_t, model_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end; receives its forces
      type(state_t), intent(inout) :: new
      !> Residual at the owned points, (5, points)
      real(wp), intent(inout) :: residual(:, :)
      !> Strain energy of this rank's elements
      real(wp), intent(out) :: energy
    end subroutine find_residual

    !> Residual relative to the reference force; infinite if a number is not finite.
    real(wp) function residual_norm(self, model, equilibrium, operator, residual, new)
      import :: step_problem_t, model_t, equilibrium_t, tangent_operator_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> Required convergence
      type(equilibrium_t), intent(in) :: equilibrium
      !> The factored operator
      type(tangent_operator_t), intent(in) :: operator
      !> Residual at the owned points, (5, points)
      real(wp), intent(in) :: residual(:, :)
      !> State at the end; stores its largest forces
      type(state_t), intent(inout) :: new
    end function residual_norm

    !> True if the iteration may end with a residual within the tolerance.
    pure logical function may_stop(self, model, new, pressures_new)
      import :: step_problem_t, model_t, state_t
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the end
      type(state_t), intent(in) :: new
      !> True: multipliers were updated after the last correction
      logical, intent(in) :: pressures_new
    end function may_stop

    !> Finds a correction by the tangent, renewing the operator where that is due.
    subroutine find_correction(self, model, operator, old, new, residual, tolerance, correction, negative_curvature, &
                               error)
      import :: step_problem_t, model_t, tangent_operator_t, state_t, error_t, wp
      !> The problem
      class(step_problem_t), intent(inout) :: self
      !> Mesh, numbering and interfaces of the plate
      type(model_t), target, intent(in) :: model
      !> The factored operator
      type(tangent_operator_t), target, intent(inout) :: operator
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end, before the correction
      type(state_t), target, intent(inout) :: new
      !> The residual at the owned points, (5, points)
      real(wp), intent(in) :: residual(:, :)
      !> Required reduction of the residual
      real(wp), intent(in) :: tolerance
      !> Correction of the displacement, (5, points)
      real(wp), intent(inout) :: correction(:, :)
      !> True: it is a direction of negative curvature of the tangent
      logical, intent(out) :: negative_curvature
      !> Set if a solve fails or numbers are not finite
      type(error_t), allocatable, intent(inout) :: error
    end subroutine find_correction

    !> Completes the motion after a correction.
    subroutine complete(self, old, new)
      import :: step_problem_t, state_t
      !> The problem
      class(step_problem_t), intent(in) :: self
      !> State at the start
      type(state_t), intent(in) :: old
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine complete

    !> Completes the state of a step that has converged, and its ledger.
    subroutine finish(self, model, old, energy, new)
      import :: step_problem_t, model_t, state_t, wp
      !> The problem
      class(step_problem_t), intent(in) :: self
      type(model_t), intent(in) :: model
      !> State at the start
      type(state_t), intent(in) :: old
      !> Strain energy of this rank's elements
      real(wp), intent(in) :: energy
      !> State at the end
      type(state_t), intent(inout) :: new
    end subroutine finish
  end interface

contains

  !> There is no impactor.
  subroutine find_force(self, model, old, new)
    !> The problem
    class(step_problem_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, its displacement known
    type(state_t), intent(inout) :: new
  end subroutine find_force

  !> Tries a step. If it has not converged, `new` is undefined on return.
  subroutine solve_step(problem, model, equilibrium, operator, old, new, converged, error)
    !> The kind of step
    class(step_problem_t), intent(inout) :: problem
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> Required convergence
    type(equilibrium_t), intent(in) :: equilibrium
    !> The factored operator; factorized again if convergence requires it
    type(tangent_operator_t), target, intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), target, intent(inout) :: new
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: residual(:, :), smooth(:, :), correction(:, :)
    type(line_search_t) :: search
    real(wp) :: norm, before, energy
    logical :: pressures_new, ends

    converged = .false.
    call new%start_from(model, old)
    allocate (residual, correction, mold=old%motion%displacement)
    problem%controls = equilibrium%controls
    search%controls = equilibrium%controls
    pressures_new = .false.
    before = 0
    call problem%begin(model, operator, old, new)
    do
      call find_forces(problem, model, operator, old, new, residual, smooth, energy)
      norm = problem%residual_norm(model, equilibrium, operator, residual, new)
      if (search%on .and. norm > equilibrium%tolerance) then
        call try_fraction(problem, model, old, new, smooth, search, ends)
        if (.not. ends) cycle
      end if
      search%on = .false.
      call update_contact(problem, model, equilibrium, norm, new, before, pressures_new, converged)
      if (converged) exit
      if (pressures_new .and. new%contact_iterations < equilibrium%max_iterations) cycle
      if (.not. norm <= huge(norm) .or. new%iterations >= equilibrium%max_iterations) exit
      problem%uses_element_tangents = problem%uses_element_tangents .or. before > 0 &
        .and. norm > equilibrium%controls%element_reduction*before
      call correct(problem, model, operator, old, new, residual, smooth, &
                   forcing_term(equilibrium%controls, equilibrium%tolerance, norm, before), correction, &
                   search, error)
      if (allocated(error)) then
        call forgive(problem, model, error)
        return
      end if
      before = norm
      new%motion%displacement = new%motion%displacement + correction
      call problem%complete(old, new)
      new%iterations = new%iterations + 1
    end do
    if (converged) call problem%finish(model, old, energy, new)
  end subroutine solve_step

  !> Updates the multipliers of contact at equilibrium; the step has converged once they have.
  subroutine update_contact(problem, model, equilibrium, norm, new, before, pressures_new, converged)
    !> The kind of step
    class(step_problem_t), intent(in) :: problem
    type(model_t), intent(in) :: model
    !> Required convergence
    type(equilibrium_t), intent(in) :: equilibrium
    !> Norm of the residual
    real(wp), intent(in) :: norm
    !> State at the end
    type(state_t), intent(inout) :: new
    !> Norm of the residual before the last correction, zero with new multipliers
    real(wp), intent(inout) :: before
    !> True: multipliers were updated after the last correction
    logical, intent(inout) :: pressures_new
    !> True: the step has converged
    logical, intent(out) :: converged

    converged = norm <= equilibrium%tolerance
    if (converged) converged = problem%may_stop(model, new, pressures_new)
    pressures_new = .false.
    if (.not. converged) return
    call update_multipliers(equilibrium%controls%contact_share*equilibrium%tolerance, model, new, converged)
    pressures_new = .not. converged
    if (pressures_new) before = 0
  end subroutine update_contact

  !> Drops the error of a solver where a shorter step may succeed: divergence, or an operator that is not positive
  !> definite.
  pure subroutine forgive(problem, model, error)
    !> The kind of step
    class(step_problem_t), intent(in) :: problem
    type(model_t), intent(in) :: model
    !> The error
    type(error_t), allocatable, intent(inout) :: error

    if ((problem%retries_shorter .or. model%setup%has_impactor) .and. error%code == exit_convergence) deallocate (error)
  end subroutine forgive

  !> Accepts a fraction of the correction, or tries the next one.
  subroutine try_fraction(problem, model, old, new, smooth, search, ends)
    !> The kind of step
    class(step_problem_t), intent(inout) :: problem
    type(model_t), intent(in) :: model
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), intent(inout) :: new
    !> Residual without ties and contacts, (5, points)
    real(wp), intent(in) :: smooth(:, :)
    !> The search
    type(line_search_t), intent(inout) :: search
    !> True: the fraction is accepted
    logical, intent(out) :: ends

    call search%assess(model, smooth, ends)
    if (ends) return
    new%motion%displacement = search%start + search%fraction*search%direction
    call problem%complete(old, new)
    call problem%find_force(model, old, new)
  end subroutine try_fraction

  !> Residual with and without ties and contacts.
  subroutine find_forces(problem, model, operator, old, new, residual, smooth, energy)
    !> The kind of step
    class(step_problem_t), intent(inout) :: problem
    type(model_t), intent(in) :: model
    !> Its timers are used
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), intent(inout) :: new
    !> The residual at the owned points, (5, points)
    real(wp), intent(inout) :: residual(:, :)
    !> Residual without ties and contacts; allocated if lines are searched
    real(wp), allocatable, intent(inout) :: smooth(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy

    call operator%timers%start('element forces')
    call problem%find_residual(model, old, new, residual, energy)
    if (problem%searches_lines) smooth = residual
    call model%profile%enter('contact and ties')
    call new%interfaces%act(model, new%motion%displacement, residual)
    call model%profile%leave()
    call operator%timers%stop('element forces')
  end subroutine find_forces

  !> Updates the multipliers of the augmented Lagrangian by the pressures found.
  subroutine update_multipliers(tolerance, model, new, converged)
    !> Tolerance of complementarity
    real(wp), intent(in) :: tolerance
    type(model_t), intent(in) :: model
    !> State at the end
    type(state_t), intent(inout) :: new
    !> True if they have converged
    logical, intent(out) :: converged

    call model%profile%enter('contact and ties')
    call new%interfaces%update_contact(model, new%motion%displacement, tolerance, new%contact_iterations, &
                                       converged)
    call model%profile%leave()
  end subroutine update_multipliers

  !> Finds a correction, and starts the line search along it.
  subroutine correct(problem, model, operator, old, new, residual, smooth, tolerance, correction, search, error)
    !> The kind of step
    class(step_problem_t), intent(inout) :: problem
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end
    type(state_t), target, intent(inout) :: new
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Residual without ties and contacts; allocated if lines are searched
    real(wp), allocatable, intent(in) :: smooth(:, :)
    !> Required reduction of the residual
    real(wp), intent(in) :: tolerance
    !> Correction of the displacement, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> The search
    type(line_search_t), intent(inout) :: search
    !> Set if a solve fails or numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: stiffness(:, :)
    logical :: negative_curvature

    call problem%find_correction(model, operator, old, new, residual, tolerance, correction, negative_curvature, error)
    if (allocated(error) .or. .not. problem%searches_lines) return
    allocate (stiffness(3, size(correction, 2)))
    call new%interfaces%faces%added_stiffness(model, operator%diagonal, stiffness)
    call new%interfaces%rig%add_stiffness(model, 0.0_wp, stiffness)
    call search%begin(model, new%motion%displacement, correction, residual, smooth, stiffness, negative_curvature)
  end subroutine correct
end module step_problems
