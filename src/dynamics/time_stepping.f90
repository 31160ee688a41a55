!> The march through time or load: steps are tried, accepted or tried again shorter.
module time_stepping
  use kinds, only: wp
  use errors, only: error_t, fail, exit_convergence
  use archives, only: archive_t
  use text, only: to_text
  use impactors, only: largest_safe_step
  use stepping_parameters, only: stepping_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use newmark_integrators, only: plate_integrator_t, plate_integrator
  use models, only: model_t
  use states, only: state_t, new_state
  use tangent_operators, only: tangent_operator_t
  use step_controllers, only: step_controller_t
  use dynamic_steps, only: attempt_step
  use static_steps, only: attempt_load
  use struck_stresses, only: struck_stress
  use front_growth, only: grow_fronts
  use tie_release, only: tie_release_t
  use plate_options, only: kinematics_von_karman
  use ply_failures, only: ply_failure_t, new_ply_failure
  use delamination_parameters, only: growth_equilibrium
  implicit none
  private
  public :: time_stepper_t

  !> All that evolves during a run.
  type :: time_stepper_t
    !> The state reached
    type(state_t), allocatable :: now
    !> The factored operator
    type(tangent_operator_t) :: operator
    !> The step controller
    type(step_controller_t) :: controller
    !> Integrator of the plate
    type(plate_integrator_t) :: integrator
    !> How steps are taken
    type(stepping_t) :: stepping
    !> Failed plies
    type(ply_failure_t) :: failures
    !> Factorizations when the failures were last noted
    integer, private :: factorizations_noted = 0
    !> Factorizations when the present step was begun
    integer, private :: factorizations_begun = 0
    !> Steps that were tried in vain
    integer :: rejected = 0
    !> Room for the state that is being tried
    type(state_t), allocatable, private :: trial
  contains
    !> The plate at rest.
    procedure :: start
    !> One accepted step.
    procedure :: advance
    !> Saves or loads all that evolves.
    procedure :: visit
  end type time_stepper_t

contains

  !> Puts the plate at rest and the impactor at first touch.
  subroutine start(self, model, stepping, linear_solver, error)
    !> The march
    class(time_stepper_t), intent(out) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> How steps are taken
    type(stepping_t), intent(in) :: stepping
    !> The linear solver
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Set if the solver cannot be set up
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    allocate (self%now, source=new_state(model))
    allocate (self%trial, source=self%now)
    self%controller%wanted = 1.0_wp/self%stepping%static_steps
    self%failures = new_ply_failure(model)
    call self%operator%create(model, linear_solver%factorization, error)
    if (allocated(error) .or. model%scene%has_static) return
    self%integrator = plate_integrator(self%stepping%time)
    self%controller%wanted = self%stepping%time%step
    if (allocated(model%pressure)) call start_acceleration(self, model, error)
  end subroutine start

  !> Acceleration of the plate under a pressure that is there from the start.
  subroutine start_acceleration(self, model, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Set if the mass matrix is singular
    type(error_t), allocatable, intent(out) :: error

    associate (motion => self%now%motion)
      call self%operator%renew(model, self%now%interfaces%faces, motion%displacement, 0.0_wp, 1.0_wp, error)
      if (allocated(error)) return
      call self%operator%correct(model, model%scene%pressure%amplitude(0.0_wp)*model%pressure, &
                                 motion%acceleration, error)
      call model%inertia(motion%acceleration, motion%inertia)
    end associate
    self%operator%ready = .false.
  end subroutine start_acceleration

  !> Takes one step, at most to the next event; the step is tried again with half its length until
  !> equilibrium is reached or the smallest step of the deck has failed.
  subroutine advance(self, model, event, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model; elements whose plies fail lose stiffness
    type(model_t), intent(inout) :: model
    !> Time, or load factor, not to be passed
    real(wp), intent(in) :: event
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: step
    logical :: converged

    do
      if (model%scene%has_static) then
        call try_load(self, model, event, step, converged, error)
      else
        call try_step(self, model, event, step, converged, error)
      end if
      if (allocated(error)) return
      if (converged) exit
      self%rejected = self%rejected + 1
      call self%controller%reject(step)
      self%operator%ready = .false.
      if (step <= smallest_step(self, model)*(1 + 1.0e-9_wp)) then
        call fail(error, exit_convergence, 'No equilibrium from time '//to_text(self%now%time)// &
                  ' on with the smallest step, '//to_text(step)//'.')
        return
      end if
    end do
    if (abs(self%trial%time - event) <= 1.0e-9_wp*step) self%trial%time = event
    call accept(self, model, step)
    if (model%scene%has_static .and. self%failures%softened) call settle(self, model, error)
  end subroutine advance

  !> Brings a plate whose plies have failed under a load back into equilibrium with it, until no more of them fail.
  subroutine settle(self, model, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(inout) :: model
    !> Set if what is left of the plate does not bear the load
    type(error_t), allocatable, intent(out) :: error
    logical :: converged

    do while (self%failures%softened)
      call attempt_load(model, self%stepping%equilibrium, self%operator, self%now, self%now%time, self%trial, converged, error)
      if (.not. (allocated(error) .or. converged)) &
        call fail(error, exit_convergence, 'No equilibrium at '//to_text(self%now%time)// &
                  ' of the load: what is left of the plate after failures of plies does not bear it.')
      if (allocated(error)) return
      self%trial%step = self%now%step
      call accept(self, model, 0.0_wp)
    end do
  end subroutine settle

  !> Smallest step worth trying.
  pure real(wp) function smallest_step(self, model) result(step)
    !> The stepper
    type(time_stepper_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model

    step = self%stepping%time%step_min
    if (model%scene%has_static) step = 1.0_wp/(1024*self%stepping%static_steps)
  end function smallest_step

  !> Tries one time step.
  subroutine try_step(self, model, event, step, converged, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Time not to be passed
    real(wp), intent(in) :: event
    !> Step tried
    real(wp), intent(out) :: step
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: mass_factor
    logical :: due

    step = self%controller%propose(event - self%now%time, impactor_limit(self, model))
    mass_factor = self%integrator%mass_factor(step)
    due = .not. self%operator%ready
    if (.not. due) due = self%controller%renewal_due(self%stepping%adapt, &
      model%scene%kinematics == kinematics_von_karman, mass_factor/self%operator%mass_factor, &
                                                     self%now%deflection - self%operator%deflection, model%thickness)
    if (due) then
      call self%operator%renew(model, self%now%interfaces%faces, self%now%motion%displacement, &
                               self%integrator%stiffness_factor(), mass_factor, error)
      if (allocated(error)) return
      call self%controller%renewed()
    end if
    self%factorizations_begun = self%operator%factorizations
    call attempt_step(model, self%stepping, self%integrator, self%operator, self%now, step, self%trial, converged, error)
    if (converged .and. model%map%layered) call let_grow(self, model, step, converged, error)
  end subroutine try_step

  !> Lets delaminations grow in a step that has converged: with equilibrium growth the step is computed again
  !> from its start until no front is above its critical value, else what grew acts from the next step on.
  subroutine let_grow(self, model, step, converged, error)
    !> The march
    type(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Step tried
    real(wp), intent(in) :: step
    !> False on return if equilibrium was lost
    logical, intent(inout) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(inout) :: error
    type(state_t) :: start
    type(tie_release_t) :: ties
    real(wp), allocatable :: guess(:, :), opened(:)
    logical, allocatable :: free(:)
    real(wp) :: fracture
    logical :: grown

    ties = self%now%interfaces%ties
    do
      free = self%trial%interfaces%faces%free
      fracture = self%trial%ledger%delamination
      call grow_fronts(model, self%trial%motion, self%trial%interfaces, self%trial%ledger%delamination, grown)
      ! The integrators cannot tell the energy that fracture takes from their own losses.
      self%trial%ledger%algorithmic = self%trial%ledger%algorithmic - (self%trial%ledger%delamination - fracture)
      if (.not. grown .or. grows_by_steps(model)) return
      associate (trial => self%trial)
        call ties%let_go(model, free, trial%interfaces%faces%free, &
                         trial%motion%internal(1:3, :) + trial%motion%inertia(1:3, :))
        ties%asked = trial%interfaces%ties%asked
        guess = trial%motion%displacement
      end associate
      start = self%now
      start%interfaces%faces = self%trial%interfaces%faces
      start%interfaces%ties = ties
      start%ledger%delamination = start%ledger%delamination &
                                  + (self%trial%ledger%delamination - self%now%ledger%delamination)
      start%ledger%algorithmic = start%ledger%algorithmic &
                                 - (self%trial%ledger%delamination - self%now%ledger%delamination)
      call attempt_step(model, self%stepping, self%integrator, self%operator, start, step, self%trial, converged, error, &
                        guess)
      if (.not. converged .or. allocated(error)) return
      associate (trial => self%trial)
        opened = trial%interfaces%ties%first_opening(model, free, trial%interfaces%faces%free, trial%motion%displacement)
        trial%interfaces%ties%set_free = trial%interfaces%ties%set_free + opened
        ties%set_free = ties%set_free + opened
      end associate
    end do
  end subroutine let_grow

  !> True if delaminations grow with the steps, none of them at a frozen time.
  pure logical function grows_by_steps(model)
    !> The model
    type(model_t), intent(in) :: model

    grows_by_steps = model%map%layered
    if (grows_by_steps) grows_by_steps = all(model%scene%delaminations%growth /= growth_equilibrium)
  end function grows_by_steps

  !> Longest step that the impactor's integrator bears now, as a binary fraction of the step wanted so that
  !> the factored operator need not follow every small change.
  pure real(wp) function impactor_limit(self, model) result(limit)
    !> The march
    type(time_stepper_t), intent(in) :: self
    !> The model
    type(model_t), intent(in) :: model

    limit = huge(limit)
    if (.not. model%scene%has_impactor) return
    limit = largest_safe_step(model%scene%impactor, model%scene%indentation, self%now%indentation, &
                              self%now%indentation%alpha, self%now%impactor%velocity)
    if (limit < self%controller%wanted) limit = self%controller%wanted*2.0_wp**floor(log(limit/self%controller%wanted) &
                                                                                     /log(2.0_wp))
  end function impactor_limit

  !> Tries one load step.
  subroutine try_load(self, model, event, step, converged, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(in) :: model
    !> Load factor not to be passed
    real(wp), intent(in) :: event
    !> Step tried
    real(wp), intent(out) :: step
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error

    step = self%controller%propose(event - self%now%time, huge(step))
    call attempt_load(model, self%stepping%equilibrium, self%operator, self%now, self%now%time + step, self%trial, converged, error)
  end subroutine try_load

  !> Makes the state tried the state reached.
  subroutine accept(self, model, step)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(inout) :: model
    !> Step taken
    real(wp), intent(in) :: step
    type(state_t), allocatable :: before
    real(wp) :: change, strain
    logical :: extended

    self%trial%stress = struck_stress(model, self%trial%motion%displacement)
    self%trial%largest_stress = max(self%now%largest_stress, self%trial%stress)
    change = 0
    if (self%trial%largest_stress > 0) change = abs(self%trial%stress - self%now%stress)/self%trial%largest_stress
    if (self%operator%factorizations /= self%factorizations_noted) call self%failures%note_factored()
    self%factorizations_noted = self%operator%factorizations
    strain = self%trial%ledger%strain
    call self%failures%grow(model, [self%now%time, self%trial%time], self%now%motion%displacement, self%trial%motion, &
                            self%trial%ledger%strain)
    if (self%failures%softened) &
      self%trial%ledger%ply_damage = self%trial%ledger%ply_damage + strain - self%trial%ledger%strain
    self%trial%interfaces%faces%glued = self%trial%interfaces%faces%glued .or. model%scene%has_impactor .and. &
                                  self%trial%impactor%velocity <= 0 .and. self%trial%force < self%now%force
    extended = self%trial%ledger%delamination > self%now%ledger%delamination
    call move_alloc(self%now, before)
    call move_alloc(self%trial, self%now)
    call move_alloc(before, self%trial)
    if (model%scene%has_static) then
      self%controller%wanted = 1.0_wp/self%stepping%static_steps
    else
      call self%controller%accept(self%stepping, step, self%now%iterations, &
                                  self%now%iterations - self%operator%switches, change)
      ! What a step took until it renewed the operator itself does not speak against the new one.
      if (self%operator%factorizations /= self%factorizations_begun) call self%controller%renewed()
      if (grows_by_steps(model)) call self%controller%heed_fronts(self%stepping, self%now%interfaces%growth_ratio, extended)
    end if
  end subroutine accept

  !> Saves or loads all that evolves.
  subroutine visit(self, archive, model, error)
    !> The march
    class(time_stepper_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive
    !> The model
    type(model_t), intent(inout) :: model
    !> Set if the operator cannot be made again
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    call self%controller%visit(archive)
    call archive%item('stepper/rejected', self%rejected)
    call self%failures%visit(archive, model)
    ! The lagged factor is made again with the stiffness of its time.
    if (archive%loading) call self%failures%swap()
    if (archive%loading) call self%failures%apply(model)
    call self%operator%visit(archive, model, error)
    self%factorizations_noted = self%operator%factorizations
    if (.not. archive%loading) return
    call self%failures%swap()
    call self%failures%apply(model)
  end subroutine visit
end module time_stepping
