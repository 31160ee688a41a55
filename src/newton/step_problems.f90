!> Equilibrium of a step: one nonlinear iteration for all kinds of steps, in time and by load.
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
  use newton_iterations, only: newton_iteration_t, new_newton_iteration
  use solution_controls, only: newton_controls_t
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: step_problem_t, solve_step

  !> One kind of step.
  type, abstract :: step_problem_t
    !> True: after a failure of the solver in the first iteration a shorter step may succeed
    logical :: may_be_shortened = .true.
    !> True: element tangents are used, as the factored operator reduces the residual too little
    logical :: uses_element_tangents = .false.
    !> True: a line search follows each correction
    logical :: uses_line_search = .false.
    !> Constants of Newton's method
    type(newton_controls_t) :: controls
  contains
    procedure(begin_step), deferred :: begin
    procedure(find_residual), deferred :: find_residual
    procedure(residual_norm), deferred :: residual_norm
    procedure(may_stop), deferred :: may_stop
    procedure(find_correction), deferred :: find_correction
    procedure :: find_force
    procedure(complete), deferred :: complete
    procedure(finish), deferred :: finish
  end type step_problem_t

  abstract interface
    !> Predictor of the state at the end of the step.
    subroutine begin_step(self, at)
      import :: step_problem_t, newton_iteration_t
      class(step_problem_t), intent(inout) :: self
      !> The iteration; receives the state at the end
      type(newton_iteration_t), intent(inout) :: at
    end subroutine begin_step

    !> Residual of equilibrium without ties and contact.
    subroutine find_residual(self, at)
      import :: step_problem_t, newton_iteration_t
      class(step_problem_t), intent(in) :: self
      !> The iteration; receives residual and energy, and its state the forces
      type(newton_iteration_t), intent(inout) :: at
    end subroutine find_residual

    !> Residual relative to the reference force; infinite if a number is not finite.
    real(wp) function residual_norm(self, at)
      import :: step_problem_t, newton_iteration_t, wp
      class(step_problem_t), intent(in) :: self
      !> The iteration; its state stores its largest forces
      type(newton_iteration_t), intent(inout) :: at
    end function residual_norm

    !> True if the iteration may end with a residual within the tolerance.
    pure logical function may_stop(self, at)
      import :: step_problem_t, newton_iteration_t
      class(step_problem_t), intent(in) :: self
      type(newton_iteration_t), intent(in) :: at
    end function may_stop

    !> Finds a correction by the tangent, renewing the operator where that is due.
    subroutine find_correction(self, at, tolerance, error)
      import :: step_problem_t, newton_iteration_t, error_t, wp
      class(step_problem_t), intent(inout) :: self
      !> The iteration; receives the correction and whether it is one of negative curvature
      type(newton_iteration_t), intent(inout) :: at
      !> Required reduction of the residual
      real(wp), intent(in) :: tolerance
      !> Set if a solve fails or numbers are not finite
      type(error_t), allocatable, intent(inout) :: error
    end subroutine find_correction

    !> Completes the motion after a correction.
    subroutine complete(self, at)
      import :: step_problem_t, newton_iteration_t
      class(step_problem_t), intent(in) :: self
      !> The iteration; its state receives the motion
      type(newton_iteration_t), intent(inout) :: at
    end subroutine complete

    !> Completes the state of a step that has converged, and its ledger.
    subroutine finish(self, at)
      import :: step_problem_t, newton_iteration_t
      class(step_problem_t), intent(in) :: self
      !> The iteration; completes its state
      type(newton_iteration_t), intent(inout) :: at
    end subroutine finish
  end interface

contains

  !> Finds the impactor's force for a displacement; here there is none.
  subroutine find_force(self, at)
    class(step_problem_t), intent(inout) :: self
    !> The iteration, the displacement of its state known
    type(newton_iteration_t), intent(inout) :: at
  end subroutine find_force

  !> Tries a step. If it has not converged, `new` is undefined on return.
  subroutine solve_step(problem, model, equilibrium, operator, old, new, converged, error)
    class(step_problem_t), intent(inout) :: problem
    type(model_t), target, intent(in) :: model
    type(equilibrium_t), intent(in) :: equilibrium
    !> The factored operator; factorized again if convergence requires it
    type(tangent_operator_t), target, intent(inout) :: operator
    type(state_t), target, intent(in) :: old
    type(state_t), target, intent(inout) :: new
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    type(newton_iteration_t) :: at
    type(line_search_t) :: search
    logical :: ends, corrected

    converged = .false.
    call new%start_from(model%plate, old)
    at = new_newton_iteration(model, equilibrium, operator, old, new)
    problem%controls = equilibrium%controls
    search%controls = equilibrium%controls
    call problem%begin(at)
    do
      call find_forces(problem, at)
      at%norm = problem%residual_norm(at)
      if (search%on .and. at%norm > equilibrium%tolerance) then
        call try_fraction(problem, at, search, ends)
        if (.not. ends) cycle
      end if
      search%on = .false.
      call update_contact(problem, at, converged)
      if (converged) exit
      if (at%multipliers_changed .and. new%iterations%contact < equilibrium%max_iterations) cycle
      if (.not. at%norm <= huge(at%norm) .or. new%iterations%equilibrium >= equilibrium%max_iterations) exit
      problem%uses_element_tangents = problem%uses_element_tangents .or. at%previous_norm > 0 &
        .and. at%norm > equilibrium%controls%element_reduction*at%previous_norm
      call correct(problem, at, search, corrected, error)
      if (.not. corrected) exit
      at%previous_norm = at%norm
      new%motion%displacement = new%motion%displacement + at%correction
      call problem%complete(at)
      new%iterations%equilibrium = new%iterations%equilibrium + 1
    end do
    if (converged) call problem%finish(at)
  end subroutine solve_step

  !> Updates the multipliers of the augmented Lagrangian at equilibrium, by the pressures found; the step has converged
  !> once they have.
  subroutine update_contact(problem, at, converged)
    class(step_problem_t), intent(in) :: problem
    type(newton_iteration_t), intent(inout) :: at
    !> True: the step has converged
    logical, intent(out) :: converged

    converged = at%norm <= at%equilibrium%tolerance
    if (converged) converged = problem%may_stop(at)
    at%multipliers_changed = .false.
    if (.not. converged) return
    call at%model%plate%profile%enter('contact and ties')
    associate (equilibrium => at%equilibrium, new => at%new)
      call new%interfaces%update_contact(at%model, new%motion%displacement, &
                                         equilibrium%controls%contact_share*equilibrium%tolerance, &
                                         new%iterations%contact, converged)
    end associate
    call at%model%plate%profile%leave()
    at%multipliers_changed = .not. converged
    if (at%multipliers_changed) at%previous_norm = 0
  end subroutine update_contact

  !> Accepts a fraction of the correction, or tries the next one.
  subroutine try_fraction(problem, at, search, ends)
    class(step_problem_t), intent(inout) :: problem
    type(newton_iteration_t), intent(inout) :: at
    type(line_search_t), intent(inout) :: search
    !> True: the fraction is accepted
    logical, intent(out) :: ends

    call search%assess(at%model%plate, at%smooth, ends)
    if (ends) return
    at%new%motion%displacement = search%start + search%fraction*search%direction
    call problem%complete(at)
    call problem%find_force(at)
  end subroutine try_fraction

  !> Residual with and without ties and contacts.
  subroutine find_forces(problem, at)
    class(step_problem_t), intent(inout) :: problem
    type(newton_iteration_t), intent(inout) :: at

    call at%operator%timers%start('element forces')
    call problem%find_residual(at)
    if (problem%uses_line_search) at%smooth = at%residual
    call at%model%plate%profile%enter('contact and ties')
    call at%new%interfaces%add_to_residual(at%model, at%new%motion%displacement, at%residual)
    call at%model%plate%profile%leave()
    call at%operator%timers%stop('element forces')
  end subroutine find_forces

  !> Finds a correction, and starts the line search along it.
  subroutine correct(problem, at, search, corrected, error)
    class(step_problem_t), intent(inout) :: problem
    type(newton_iteration_t), intent(inout) :: at
    type(line_search_t), intent(inout) :: search
    !> True: a correction was found
    logical, intent(out) :: corrected
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: stiffness(:, :)

    call problem%find_correction(at, forcing_term(at%equilibrium%controls, at%equilibrium%tolerance, at%norm, &
                                                  at%previous_norm), error)
    corrected = .not. allocated(error)
    if (corrected .and. problem%uses_line_search) then
      allocate (stiffness(3, size(at%correction, 2)))
      call at%new%interfaces%contact%added_stiffness(at%model%plate, at%operator%diagonal, stiffness)
      call at%new%interfaces%rig%add_stiffness(at%model, 0.0_wp, stiffness)
      call search%begin(at%model%plate, at%new%motion%displacement, at%correction, at%residual, at%smooth, stiffness, &
                        at%negative_curvature)
    else if (.not. corrected) then
      ! Divergence, or an operator that is not definite, as where all contacts open: a shorter step may succeed.
      if ((problem%may_be_shortened .or. at%model%plate%setup%impactor%is_present &
           .or. at%new%iterations%equilibrium > 0) .and. error%code == exit_convergence) deallocate (error)
    end if
  end subroutine correct
end module step_problems
