!> Accepts or rejects a trial step, and sets the length of the next one.
module step_acceptance
  use kinds, only: wp
  use crack_flaws, only: update_flaws
  use energy_balance, only: record_failures
  use errors, only: error_t, fail, exit_convergence
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use states, only: state_t
  use implicit_steps, only: implicit_steps_t
  use struck_stresses, only: struck_stress
  use text, only: rounded_text
  implicit none
  private
  public :: accept_step, reject_step, assess_error

contains

  !> Makes the trial state the accepted state.
  subroutine accept_step(self, model, step)
    class(implicit_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Step taken
    real(wp), intent(in) :: step
    type(state_t), allocatable :: before
    real(wp) :: change
    logical :: extended

    if (model%plate%setup%loading%dissipation > 0 .and. step > 0) &
      call self%trial%record_path(self%now, model%plate%setup%loading%dissipation)
    change = 0
    associate (now => self%now%impact, trial => self%trial%impact)
      trial%stress = struck_stress(model%plate, model%plate%motion_of(self%trial%motion%displacement))
      trial%largest_stress = max(now%largest_stress, trial%stress)
      if (trial%largest_stress > 0) change = abs(trial%stress - now%stress)/trial%largest_stress
    end associate
    call update_damage(self, model)
    extended = self%trial%ledger%delamination > self%now%ledger%delamination
    if (self%is_error_controlled) then
      call self%step_error%record(model, self%now, self%trial)
      if (extended .or. self%trial%plies%softened) call self%step_error%reset()
    end if
    call move_alloc(self%now, before)
    call move_alloc(self%trial, self%now)
    call move_alloc(before, self%trial)
    call self%kind%choose_next(self, model, step, change, extended)
  end subroutine accept_step

  !> Updates failures of plies and flaws of interfaces in the trial state.
  subroutine update_damage(self, model)
    class(implicit_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    logical :: reached(size(self%trial%interfaces%border_reached))

    call model%plate%profile%enter('ply criteria')
    call self%trial%plies%grow(model%plate, self%trial%motion%displacement)
    call model%plate%profile%leave()
    if (self%trial%plies%softened) call record_failures(model, self%now, self%trial)
    call update_flaws(model%plate, self%trial%plies, self%trial%motion%displacement, self%trial%interfaces)
    call self%kind%complete_trial(self, model)
    associate (interfaces => self%trial%interfaces)
      ! A call of its own, which all ranks take part in.
      reached = interfaces%cohesive%border_reached(model%plate)
      interfaces%border_reached = interfaces%border_reached .or. reached
    end associate
  end subroutine update_damage

  !> Estimates the error of the trial step and whether it has to be repeated with a shorter length.
  subroutine assess_error(self, plate, step, shortest, accurate)
    class(implicit_steps_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Step tried
    real(wp), intent(in) :: step
    !> Shortest step allowed under error control
    real(wp), intent(out) :: shortest
    !> False: the step is too long
    logical, intent(out) :: accurate

    call self%step_error%estimate(plate, self%integrator, self%stepping%expected, self%now, self%trial, self%error)
    self%error = self%error/self%stepping%adapt%tolerance
    shortest = self%controller%shortest(self%stepping, self%now%has_failures())
    accurate = self%error <= self%stepping%controls%rejection_error .or. step <= shortest*(1 + 1.0e-9_wp)
    if (accurate) return
    self%rejected = self%rejected + 1
    call self%controller%shorten(self%stepping%controls, step, self%error, shortest)
  end subroutine assess_error

  !> Prepares a shorter step after a step that has not converged.
  subroutine reject_step(self, plate, step, error)
    class(implicit_steps_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Step tried
    real(wp), intent(in) :: step
    !> Set if it had the smallest length
    type(error_t), allocatable, intent(inout) :: error

    self%rejected = self%rejected + 1
    call self%controller%reject(step/self%step_scale(plate))
    if (step <= self%smallest_step*self%step_scale(plate)*(1 + 1.0e-9_wp)) &
      call fail(error, exit_convergence, 'No equilibrium from '//plate%setup%progress_name()//' '// &
                rounded_text(self%now%time)//' on with the smallest step, '// &
                trim(rounded_text(step)//'. '//self%operator%solver%fault))
    self%operator%ready = .false.
    if (plate%setup%loading%dissipation > 0) self%now%path%by_dissipation = self%now%path%dissipated > 0
  end subroutine reject_step
end module step_acceptance
