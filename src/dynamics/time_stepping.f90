!> Time or load stepping: steps are tried, and accepted or repeated with a shorter length.
module time_stepping
  use kinds, only: wp
  use errors, only: error_t, fail, exit_convergence
  use archives, only: archive_t
  use text, only: rounded_text
  use initial_equilibrium, only: find_initial_equilibrium, find_acceleration, has_initial_motion
  use step_errors, only: step_error_t
  use central_differences, only: central_difference_t
  use explicit_steps, only: advance_explicit, complete_step, equilibrate_initial_stresses
  use stepping_parameters, only: stepping_t, is_error_controlled, is_explicit
  use linear_solver_parameters, only: linear_solver_parameters_t
  use newmark_integrators, only: plate_integrator_t, plate_integrator
  use models, only: model_t
  use states, only: state_t, new_state
  use tangent_operators, only: tangent_operator_t
  use operator_restarts, only: visit_operator
  use step_controllers, only: step_controller_t, rejection_error, shortening_error
  use step_limits, only: impactor_limit, growth_limit, has_gear
  use step_problems, only: solve_step
  use dynamic_steps, only: dynamic_step_t, new_dynamic_step
  use static_steps, only: static_step_t, new_static_step
  use dissipation_steps, only: dissipation_step_t, new_dissipation_step
  use energy_balance, only: book_failures
  use struck_stresses, only: struck_stress
  use crack_flaws, only: note_flaws
  use front_growth, only: find_release_ratio
  use growth_in_steps, only: grow_in_step, grows_by_steps
  use plate_options, only: kinematics_von_karman
  implicit none
  private
  public :: time_stepper_t

  !> Largest ratio of the energies that consecutive steps dissipate: the predictor is scaled by it.
  real(wp), parameter :: max_growth = 4
  !> All that evolves during a run.
  type :: time_stepper_t
    !> The state reached
    type(state_t), allocatable :: now
    !> The factored operator
    type(tangent_operator_t) :: operator
    !> The step controller
    type(step_controller_t) :: controller
    !> Error estimate of steps
    type(step_error_t) :: step_error
    !> Last error relative to its tolerance, and the lag of damage in the last step relative to its limit
    real(wp), private :: error = 0, damage_lag = 0
    !> True: the error of the last step exceeds the tolerance at the shortest step
    logical :: errs = .false.
    !> Integrator of the plate
    type(plate_integrator_t) :: integrator
    !> How steps are taken
    type(stepping_t) :: stepping
    !> Factorizations and solves when the present step was begun
    integer, private :: factorizations_at_start = 0, solves_at_start = 0
    !> Rejected steps
    integer :: rejected = 0
    !> Number of unconstrained unknowns
    integer :: unknowns = 0
    !> The trial state
    type(state_t), allocatable, private :: trial
    !> Central differences; unallocated: steps are implicit
    type(central_difference_t), allocatable :: explicit
  contains
    !> The plate at rest.
    procedure :: start
    !> One accepted step.
    procedure :: advance
    !> Smallest step worth trying.
    procedure :: smallest_step
    !> Completes what a step by central differences leaves until output or a check is due.
    procedure :: complete_state
    !> Energy to be dissipated per time.
    procedure, private :: energy_rate
    !> Time of a step by dissipation over that of one by load.
    procedure, private :: step_scale
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
    logical :: converged, follows

    if (allocated(self%explicit)) then
      call advance_explicit(self%explicit, model, event, self%now)
      self%controller%last = self%explicit%steps%now
      return
    end if
    follows = is_error_controlled(self%stepping%adapt) .and. .not. model%setup%has_static
    if (follows .and. self%now%step == 0) call self%controller%begin(self%stepping, event)
    do
      if (model%setup%has_static) then
        call try_load(self, model, event, step, converged, error)
      else
        call try_step(self, model, event, step, converged, error)
      end if
      if (allocated(error)) return
      if (converged .and. follows) then
        call self%step_error%estimate(model, self%integrator, self%stepping%expected, self%now, self%trial, self%error)
        self%error = self%error/self%stepping%adapt%tolerance
        shortest = self%controller%shortest(self%stepping, self%now%has_failures())
        if (self%error > rejection_error .and. step > shortest*(1 + 1.0e-9_wp)) then
          self%rejected = self%rejected + 1
          call self%controller%shorten(step, self%error, shortest)
          cycle
        end if
      end if
      if (converged) exit
      self%rejected = self%rejected + 1
      call self%controller%reject(step/self%step_scale())
      self%operator%ready = .false.
      if (self%stepping%dissipation > 0) self%now%path%by_dissipation = self%now%path%dissipated > 0
      if (step <= self%smallest_step(model)*self%step_scale()*(1 + 1.0e-9_wp)) then
        call fail(error, exit_convergence, 'No equilibrium from '// &
                  trim(merge('load factor', 'time       ', model%setup%has_static))//' '// &
                  rounded_text(self%now%time)// &
                  ' on with the smallest step, '//rounded_text(step)//'.')
        return
      end if
    end do
    if (follows) self%errs = self%error > shortening_error .and. step <= shortest*(1 + 1.0e-9_wp)
    if (abs(self%trial%time - event) <= 1.0e-9_wp*step) self%trial%time = event
    call accept(self, model, step)
    if (model%setup%has_static .and. self%now%plies%softened) call equilibrate(self, model, error)
  end subroutine advance

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
      call accept(self, model, 0.0_wp)
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

  !> Smallest step worth trying.
  pure real(wp) function smallest_step(self, model) result(step)
    !> The stepper
    class(time_stepper_t), intent(in) :: self
    type(model_t), intent(in) :: model

    step = merge(1.0_wp/(1024*self%stepping%static_steps), self%stepping%time%step_min, model%setup%has_static)
  end function smallest_step

  !> Tries one time step.
  subroutine try_step(self, model, event, step, converged, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time not to be passed
    real(wp), intent(in) :: event
    !> Step tried
    real(wp), intent(out) :: step
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    type(dynamic_step_t) :: problem
    real(wp) :: mass_factor
    logical :: due

    step = self%controller%propose(event - self%now%time, impactor_limit(model, self%now, self%controller%target), &
                                   growth_limit(model, self%stepping%adapt, self%controller))
    mass_factor = self%integrator%mass_factor(step)
    due = .not. self%operator%ready
    if (.not. due) &
      due = self%controller%renewal_due(self%stepping%adapt, model%setup%kinematics == kinematics_von_karman, &
        mass_factor/self%operator%mass_factor, self%now%deflection - self%operator%deflection, model%thickness)
    if (due) then
      call self%operator%renew(model, self%now%plies%stiffness, self%now%interfaces, self%now%motion%displacement, &
                               self%integrator%stiffness_factor(), mass_factor, error)
      if (allocated(error)) return
      call self%controller%renewed()
    end if
    self%factorizations_at_start = self%operator%factorizations
    self%solves_at_start = self%operator%solves
    problem = new_dynamic_step(self%integrator, step, self%stepping%adapt%iterations)
    call solve_step(problem, model, self%stepping%equilibrium, self%operator, self%now, self%trial, converged, error)
    if (converged .and. model%map%layered) &
      call grow_in_step(problem, model, self%stepping%equilibrium, self%operator, self%now, self%trial, converged, &
                        error)
    self%damage_lag = self%trial%plies%damage_lag
    if (converged .and. self%damage_lag > 1) converged = .not. step > self%smallest_step(model)*(1 + 1.0e-9_wp)
  end subroutine try_step

  !> Tries one load step.
  subroutine try_load(self, model, event, step, converged, error)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Load factor not to be passed
    real(wp), intent(in) :: event
    !> Step tried
    real(wp), intent(out) :: step
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    type(static_step_t) :: by_load
    type(dissipation_step_t) :: by_dissipation
    real(wp) :: target

    step = self%controller%propose((event - self%now%time)/self%step_scale(), huge(step))*self%step_scale()
    associate (now => self%now)
      if (now%path%by_dissipation) then
        target = self%energy_rate()*step
        if (target > max_growth*now%path%dissipated) step = step*max_growth*now%path%dissipated/target
        by_dissipation = new_dissipation_step(model, now%time + step, self%energy_rate()*step, &
                                              1.0_wp/self%stepping%static_steps)
        call solve_step(by_dissipation, model, self%stepping%equilibrium, self%operator, now, self%trial, converged, &
                        error)
        ! Farther away there are other branches of equilibrium, which no path leads to.
        if (converged) converged = abs(self%trial%load_factor - now%load_factor) <= by_dissipation%max_load_change
      else
        by_load = new_static_step(model, now%time + step, now%load_factor + step)
        call solve_step(by_load, model, self%stepping%equilibrium, self%operator, now, self%trial, converged, error)
      end if
    end associate
  end subroutine try_load

  !> Energy that is to be dissipated per time from now on, so that at the end it is what the deck asks for.
  pure real(wp) function energy_rate(self)
    !> The stepper
    class(time_stepper_t), intent(in) :: self

    energy_rate = max(0.0_wp, self%stepping%dissipation - self%now%ledger%delamination)/(1 - self%now%time)
  end function energy_rate

  !> Time of a step that dissipates its part of the energy asked for, over that of a step taken by load; 1 for these.
  pure real(wp) function step_scale(self)
    !> The stepper
    class(time_stepper_t), intent(in) :: self

    step_scale = 1
    if (self%now%path%by_dissipation) step_scale = self%stepping%dissipation/self%energy_rate()
  end function step_scale

  !> Makes the state tried the state reached.
  subroutine accept(self, model, step)
    !> The time stepper
    class(time_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step taken
    real(wp), intent(in) :: step
    type(state_t), allocatable :: before
    real(wp) :: change
    logical :: extended
    integer :: lag_iterations

    if (self%stepping%dissipation > 0 .and. step > 0) call self%trial%note_path(self%now, self%stepping%dissipation)
    self%trial%stress = struck_stress(model, self%trial%motion%displacement)
    self%trial%largest_stress = max(self%now%largest_stress, self%trial%stress)
    change = 0
    if (self%trial%largest_stress > 0) change = abs(self%trial%stress - self%now%stress)/self%trial%largest_stress
    call model%profile%enter('ply criteria')
    call self%trial%plies%grow(model, self%trial%motion%displacement)
    call model%profile%leave()
    if (self%trial%plies%softened) call book_failures(model, self%now, self%trial)
    call note_flaws(model, self%trial%plies, self%trial%motion%displacement, self%trial%interfaces)
    associate (interfaces => self%trial%interfaces)
      if (model%setup%has_static) &
        call find_release_ratio(model, self%trial%plies%stiffness, self%trial%motion, interfaces)
      interfaces%border_reached = interfaces%border_reached .or. interfaces%cohesive%border_reached(model)
      interfaces%faces%glued = interfaces%faces%glued .or. model%setup%has_impactor .and. .not. model%setup%has_static &
        .and. self%trial%impactor%velocity <= 0 .and. self%trial%force < self%now%force
    end associate
    extended = self%trial%ledger%delamination > self%now%ledger%delamination
    if (is_error_controlled(self%stepping%adapt) .and. .not. model%setup%has_static) then
      call self%step_error%note(model, self%now, self%trial)
      if (extended .or. self%trial%plies%softened) call self%step_error%reset()
    end if
    call move_alloc(self%now, before)
    call move_alloc(self%trial, self%now)
    call move_alloc(before, self%trial)
    if (model%setup%has_static) then
      self%controller%target = 1.0_wp/self%stepping%static_steps
    else
      lag_iterations = self%operator%solves - self%solves_at_start
      call self%controller%accept(self%stepping, step, self%now%iterations, lag_iterations, change)
      if (model%setup%has_crack_bands()) call self%controller%limit_by_ply_damage(self%stepping, self%damage_lag)
      if (is_error_controlled(self%stepping%adapt)) &
        call self%controller%adapt_to_error(self%stepping, step, self%error, self%stepping%time%end - self%now%time, &
          .not. model%setup%has_impactor .or. self%step_error%impact_is_over(self%stepping%expected, self%now), &
                                          has_gear(model), self%now%has_failures())
      ! What a step took until it renewed the operator itself does not speak against the new one.
      if (self%operator%factorizations /= self%factorizations_at_start) call self%controller%renewed()
      if (grows_by_steps(model)) &
        call self%controller%limit_by_fronts(self%stepping, self%now%interfaces%growth_ratio, extended)
    end if
  end subroutine accept

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
    call visit_operator(self%operator, archive, model, error)
  end subroutine visit
end module time_stepping
