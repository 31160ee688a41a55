!> Time or load stepping: steps are tried, and accepted or repeated with a shorter length.
module time_stepping
  use kinds, only: wp
  use archives, only: archive_t
  use errors, only: error_t, fail, exit_convergence
  use explicit_steps, only: advance_explicit, complete_step, equilibrate_initial_stresses
  use initial_equilibrium, only: find_initial_equilibrium, find_acceleration, has_initial_motion
  use linear_solver_parameters, only: linear_solver_parameters_t
  use models, only: model_t
  use newmark_integrators, only: plate_integrator
  use states, only: new_state
  use static_steps, only: static_step_t, new_static_step
  use step_acceptance, only: accept_step, reject_step, assess_error
  use step_controllers, only: shortening_error
  use step_problems, only: solve_step
  use step_trials, only: try_step, try_load
  use steppers, only: stepper_t
  use stepping_parameters, only: stepping_t, is_error_controlled, is_explicit
  use text, only: rounded_text
  implicit none
  private
  public :: time_stepper_t

  !> A stepper through time or load.
  type, extends(stepper_t) :: time_stepper_t
  contains
    !> The plate at rest.
    procedure :: start
    !> One accepted step.
    procedure :: advance
    !> Completes what a step by central differences leaves until output or a check is due.
    procedure :: complete_state
    !> Saves or loads all that evolves.
    procedure :: visit
  end type time_stepper_t

contains

  !> Initial state: the plate at rest and the impactor at first contact.
  subroutine start(self, model, stepping, linear_solver, resumed, error)
    !> The time stepper
    class(time_stepper_t), intent(out) :: self
    type(model_t), intent(in) :: model
    !> How steps are taken
    type(stepping_t), intent(in) :: stepping
    !> The linear solver
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> True: a state will be loaded, so that none has to be found
    logical, intent(in) :: resumed
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    allocate (self%now, source=new_state(model))
    if (is_explicit(stepping)) then
      allocate (self%explicit)
      self%unknowns = count(.not. model%held)
      if (.not. resumed .and. has_initial_motion(model)) &
        call equilibrate_initial_stresses(self%operator, model, linear_solver, self%now, error)
      if (.not. allocated(error)) call self%explicit%start(model, stepping%central, self%now)
      return
    end if
    allocate (self%trial, source=self%now)
    self%controller%target = 1.0_wp/self%stepping%static_steps
    if (self%stepping%dissipation > 0) allocate (self%now%path%change, source=self%now%motion%displacement)
    call self%operator%create(model, linear_solver%factorization, error)
    self%unknowns = self%operator%numbering%total
    if (.not. allocated(error)) call find_initial_equilibrium(model, self%operator, self%now, error)
    if (allocated(error) .or. model%setup%has_static) return
    self%integrator = plate_integrator(self%stepping%time)
    self%controller%target = self%stepping%time%step
    if (is_error_controlled(stepping%adapt)) call self%step_error%start(model, stepping%time%step)
    if (allocated(model%pressure) .or. size(model%lines) > 0) &
      call find_acceleration(model, self%operator, self%integrator%mass_factor(stepping%time%step), self%now, error)
  end subroutine start

  !> Takes one step, at most to the next event; the step is tried again with half its length until
  !> equilibrium is reached or the smallest step of the deck has failed.
  subroutine advance(self, model, event, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time, or load factor, not to be passed
    real(wp), intent(in) :: event
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: step, shortest
    logical :: follows

    if (allocated(self%explicit)) then
      call advance_explicit(self%explicit, model, event, self%now)
      self%controller%last = self%explicit%steps%now
      return
    end if
    follows = is_error_controlled(self%stepping%adapt) .and. .not. model%setup%has_static
    if (follows .and. self%now%step == 0) call self%controller%begin(self%stepping, event)
    call find_step(self, model, event, follows, step, shortest, error)
    if (allocated(error)) return
    if (follows) self%errs = self%error > shortening_error .and. step <= shortest*(1 + 1.0e-9_wp)
    if (abs(self%trial%time - event) <= 1.0e-9_wp*step) self%trial%time = event
    call accept_step(self, model, step)
    if (model%setup%has_static .and. self%now%plies%softened) call equilibrate(self, model, error)
  end subroutine advance

  !> Tries steps, each shorter than the one before, until one has converged with an error within the tolerance.
  subroutine find_step(self, model, event, follows, step, shortest, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time, or load factor, not to be passed
    real(wp), intent(in) :: event
    !> True: the length follows the error
    logical, intent(in) :: follows
    !> Step found
    real(wp), intent(out) :: step
    !> Shortest step that the error may ask for, where the length follows it
    real(wp), intent(out) :: shortest
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(inout) :: error
    logical :: converged, accurate

    shortest = 0
    do
      if (model%setup%has_static) then
        call try_load(self, model, event, step, converged, error)
      else
        call try_step(self, model, event, step, converged, error)
      end if
      if (allocated(error)) return
      if (converged) then
        accurate = .true.
        if (follows) call assess_error(self, model, step, shortest, accurate)
        if (accurate) return
      else
        call reject_step(self, model, step, error)
        if (allocated(error)) return
      end if
    end do
  end subroutine find_step

  !> Brings a plate whose plies have failed under a load back into equilibrium with it, until no more of them fail.
  subroutine equilibrate(self, model, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if what is left of the plate does not bear the load
    type(error_t), allocatable, intent(out) :: error
    type(static_step_t) :: problem
    logical :: converged

    do while (self%now%plies%softened)
      problem = new_static_step(model, self%now%time, self%now%load_factor)
      call solve_step(problem, model, self%stepping%equilibrium, self%operator, self%now, self%trial, converged, error)
      if (.not. (allocated(error) .or. converged)) &
        call fail(error, exit_convergence, 'No equilibrium at '//rounded_text(self%now%time)// &
                  ' of the load: what is left of the plate after failures of plies does not bear it.')
      if (allocated(error)) return
      self%trial%step = self%now%step
      call accept_step(self, model, 0.0_wp)
    end do
  end subroutine equilibrate

  !> Completes what a step by central differences leaves until output or a check is due. Collective.
  subroutine complete_state(self, model, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    !> Receives how the impactor's force is spread
    type(model_t), intent(inout) :: model
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error

    if (allocated(self%explicit)) call complete_step(self%explicit, model, self%now, error)
  end subroutine complete_state

  !> Saves or loads all that evolves.
  subroutine visit(self, archive, model, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Set if the operator cannot be made again
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    if (allocated(self%explicit)) then
      call self%explicit%visit(archive, model)
      if (archive%loading) call self%explicit%resume(model, self%now)
      return
    end if
    call self%controller%visit(archive)
    if (allocated(self%step_error%share)) call self%step_error%visit(archive, model)
    call archive%item('stepper/rejected', self%rejected)
    call self%operator%visit(archive, model, error)
  end subroutine visit
end module time_stepping
