!> Tries a step in time or a load step.
module step_trials
  use kinds, only: wp
  use dissipation_steps, only: dissipation_step_t, new_dissipation_step
  use dynamic_steps, only: dynamic_step_t, new_dynamic_step
  use errors, only: error_t
  use growth_in_steps, only: grow_in_step
  use models, only: model_t
  use plate_options, only: kinematics_von_karman
  use static_steps, only: static_step_t, new_static_step
  use step_limits, only: impactor_limit, growth_limit
  use step_problems, only: solve_step
  use steppers, only: stepper_t
  implicit none
  private
  public :: try_step, try_load

  !> Largest ratio of the energies that consecutive steps dissipate: the predictor is scaled by it.
  real(wp), parameter :: max_growth = 4

contains

  !> Tries one time step.
  subroutine try_step(self, model, event, step, converged, error)
    !> The time stepper
    class(stepper_t), intent(inout) :: self
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
    class(stepper_t), intent(inout) :: self
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
end module step_trials
