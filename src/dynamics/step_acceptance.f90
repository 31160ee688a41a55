!> Accepts a step tried, or rejects it; the length of the next one.
module step_acceptance
  use kinds, only: wp
  use crack_flaws, only: note_flaws
  use energy_balance, only: book_failures
  use errors, only: error_t, fail, exit_convergence
  use front_growth, only: find_release_ratio
  use growth_in_steps, only: grows_by_steps
  use models, only: model_t
  use states, only: state_t
  use step_controllers, only: rejection_error
  use step_limits, only: has_gear
  use steppers, only: stepper_t
  use stepping_parameters, only: is_error_controlled
  use struck_stresses, only: struck_stress
  use text, only: rounded_text
  implicit none
  private
  public :: accept_step, reject_step, assess_error

contains

  !> Makes the state tried the state reached.
  subroutine accept_step(self, model, step)
    !> The time stepper
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step taken
    real(wp), intent(in) :: step
    type(state_t), allocatable :: before
    real(wp) :: change
    logical :: extended

    if (self%stepping%dissipation > 0 .and. step > 0) call self%trial%note_path(self%now, self%stepping%dissipation)
    self%trial%stress = struck_stress(model, self%trial%motion%displacement)
    self%trial%largest_stress = max(self%now%largest_stress, self%trial%stress)
    change = 0
    if (self%trial%largest_stress > 0) change = abs(self%trial%stress - self%now%stress)/self%trial%largest_stress
    call note_damage(self, model)
    extended = self%trial%ledger%delamination > self%now%ledger%delamination
    if (is_error_controlled(self%stepping%adapt) .and. .not. model%setup%has_static) then
      call self%step_error%note(model, self%now, self%trial)
      if (extended .or. self%trial%plies%softened) call self%step_error%reset()
    end if
    call move_alloc(self%now, before)
    call move_alloc(self%trial, self%now)
    call move_alloc(before, self%trial)
    call choose_next_step(self, model, step, change, extended)
  end subroutine accept_step

  !> Plies that fail and interfaces that have changed in the step tried.
  subroutine note_damage(self, model)
    !> The time stepper
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model

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
  end subroutine note_damage

  !> Length of the next step.
  subroutine choose_next_step(self, model, step, change, extended)
    !> The time stepper, the step accepted
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step taken
    real(wp), intent(in) :: step
    !> Change of the struck point's stress over the largest so far
    real(wp), intent(in) :: change
    !> True: delaminations have grown
    logical, intent(in) :: extended
    integer :: lag_iterations

    if (model%setup%has_static) then
      self%controller%target = 1.0_wp/self%stepping%static_steps
      return
    end if
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
  end subroutine choose_next_step

  !> Estimates the error of the step tried; one too large is to be tried again shorter.
  subroutine assess_error(self, model, step, shortest, accurate)
    !> The time stepper
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step tried
    real(wp), intent(in) :: step
    !> Shortest step that the error may ask for
    real(wp), intent(out) :: shortest
    !> False: the step is too long
    logical, intent(out) :: accurate

    call self%step_error%estimate(model, self%integrator, self%stepping%expected, self%now, self%trial, self%error)
    self%error = self%error/self%stepping%adapt%tolerance
    shortest = self%controller%shortest(self%stepping, self%now%has_failures())
    accurate = self%error <= rejection_error .or. step <= shortest*(1 + 1.0e-9_wp)
    if (accurate) return
    self%rejected = self%rejected + 1
    call self%controller%shorten(step, self%error, shortest)
  end subroutine assess_error

  !> Prepares a shorter step after one that has not converged.
  subroutine reject_step(self, model, step, error)
    !> The time stepper
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step tried
    real(wp), intent(in) :: step
    !> Set if it was the smallest one
    type(error_t), allocatable, intent(inout) :: error

    self%rejected = self%rejected + 1
    call self%controller%reject(step/self%step_scale())
    self%operator%ready = .false.
    if (self%stepping%dissipation > 0) self%now%path%by_dissipation = self%now%path%dissipated > 0
    if (step <= self%smallest_step(model)*self%step_scale()*(1 + 1.0e-9_wp)) &
      call fail(error, exit_convergence, 'No equilibrium from '// &
                trim(merge('load factor', 'time       ', model%setup%has_static))//' '//rounded_text(self%now%time)// &
                ' on with the smallest step, '//rounded_text(step)//'.')
  end subroutine reject_step
end module step_acceptance
