!> Steps in time: trial, error and length.
module motion_steps
  use dynamic_steps, only: dynamic_step_t
  use errors, only: error_t
  use growth_in_steps, only: grow_in_step, grows_by_steps
  use initial_equilibrium, only: find_acceleration
  use kinds, only: wp
  use models, only: model_t
  use newmark_integrators, only: plate_integrator
  use plate_options, only: kinematics_von_karman
  use step_limits, only: impactor_limit, growth_limit, has_gear
  use step_problems, only: solve_step
  use implicit_steps, only: implicit_steps_t, step_kind_t
  use stepping_parameters, only: is_error_controlled
  implicit none
  private
  public :: motion_steps_t

  !> Steps in time.
  type, extends(step_kind_t) :: motion_steps_t
  contains
    procedure :: start
    procedure :: try
    procedure :: complete_trial
    procedure :: choose_next
    procedure :: name
    procedure :: energy_remedy
  end type motion_steps_t

contains

  !> Integrator, first step, and the acceleration under the initial loads.
  subroutine start(self, stepper, model, error)
    class(motion_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    !> Set if the mass matrix is singular
    type(error_t), allocatable, intent(inout) :: error

    associate (time => stepper%stepping%time)
      stepper%integrator = plate_integrator(time)
      stepper%controller%target = time%step
      stepper%is_error_controlled = is_error_controlled(stepper%stepping%adapt)
      if (stepper%is_error_controlled) call stepper%step_error%start(model, time%step)
      if (allocated(model%loads%pressure) .or. size(model%loads%lines) > 0) &
        call find_acceleration(model, stepper%operator, stepper%integrator%mass_factor(time%step), stepper%now, error)
    end associate
  end subroutine start

  !> Tries one time step.
  subroutine try(self, stepper, model, event, step, converged, error)
    class(motion_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    real(wp), intent(out) :: step
    logical, intent(out) :: converged
    type(error_t), allocatable, intent(out) :: error
    type(dynamic_step_t) :: problem
    logical :: factor_is_due

    converged = .false.
    associate (now => stepper%now, controller => stepper%controller, stepping => stepper%stepping)
      step = controller%propose(event - now%time, impactor_limit(model%plate, now, controller%target), &
                                growth_limit(model%plate, stepping, controller))
      call prepare_operator(stepper, model, stepper%integrator%mass_factor(step), factor_is_due, error)
      if (allocated(error)) return
      problem = dynamic_step_t(integrator=stepper%integrator, step=step, renewal=stepping%adapt%iterations, &
                               factor_is_due=factor_is_due)
      call solve_step(problem, model, stepping%equilibrium, stepper%operator, now, stepper%trial, converged, error)
      if (converged .and. model%plate%map%layered) &
        call grow_in_step(problem, model, stepping%equilibrium, stepper%operator, now, stepper%trial, converged, error)
      stepper%damage_lag = stepper%trial%plies%damage_lag
      if (converged .and. stepper%damage_lag > 1) &
        converged = .not. step > stepper%smallest_step*(1 + 1.0e-9_wp)
    end associate
  end subroutine try

  !> Factorizes the operator if there is no factor. A factorization that is due again is left to the step, whose first
  !> correction requires the tangent at the predictor.
  subroutine prepare_operator(stepper, model, mass_factor, factor_is_due, error)
    !> The state accepted, the trial state and the step control
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    !> Factor of the mass in the step
    real(wp), intent(in) :: mass_factor
    !> True: the step has to factorize it again
    logical, intent(out) :: factor_is_due
    !> Set if the factorization fails
    type(error_t), allocatable, intent(inout) :: error

    associate (now => stepper%now, operator => stepper%operator)
      stepper%factorizations_at_start = operator%factorizations
      stepper%solves_at_start = operator%solves
      factor_is_due = operator%ready
      if (factor_is_due) then
        factor_is_due = stepper%controller%renewal_due(stepper%stepping, model%plate%setup%mesh%kinematics == &
          kinematics_von_karman, mass_factor/operator%mass_factor, now%impact%deflection - operator%deflection, &
          model%plate%layup%thickness)
      else
        call operator%renew(model, now, stepper%integrator%stiffness_factor(), mass_factor, error)
      end if
    end associate
  end subroutine prepare_operator

  !> Records that surfaces are glued once the impactor moves back (unloading = 'glued').
  subroutine complete_trial(self, stepper, model)
    class(motion_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model

    associate (trial => stepper%trial)
      trial%interfaces%contact%glued = trial%interfaces%contact%glued .or. model%plate%setup%impactor%is_present &
        .and. trial%impact%impactor%velocity <= 0 .and. trial%impact%force < stepper%now%impact%force
    end associate
  end subroutine complete_trial

  !> Length of the next step by iterations, error, damage and growth.
  subroutine choose_next(self, stepper, model, step, change, extended)
    class(motion_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: step
    real(wp), intent(in) :: change
    logical, intent(in) :: extended
    integer :: lag_iterations

    associate (now => stepper%now, controller => stepper%controller, stepping => stepper%stepping)
      ! Excess solves are counted from the step that renewed the operator.
      if (stepper%operator%factorizations /= stepper%factorizations_at_start) call controller%renewed()
      lag_iterations = stepper%operator%solves - stepper%solves_at_start
      call controller%accept(stepping, step, now%iterations%equilibrium, lag_iterations, change)
      if (model%plate%setup%has_crack_bands()) call controller%limit_by_ply_damage(stepping, stepper%damage_lag)
      if (stepper%is_error_controlled) &
        call controller%adapt_to_error(stepping, step, stepper%error, stepping%time%end - now%time, &
          .not. model%plate%setup%impactor%is_present .or. stepper%step_error%impact_is_over(stepping%expected, now), &
                                       has_gear(model%plate), now%has_failures())
      if (grows_by_steps(model)) call controller%limit_by_fronts(stepping, now%interfaces%growth_ratio, extended)
    end associate
  end subroutine choose_next

  !> Subject of a sentence.
  pure function name(self) result(words)
    class(motion_steps_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'The time integrators'
  end function name

  !> What to change where steps have created or dissipated too much energy.
  pure function energy_remedy(self, created) result(words)
    class(motion_steps_t), intent(in) :: self
    !> True: energy was created; false: dissipated
    logical, intent(in) :: created
    character(len=:), allocatable :: words

    words = 'use smaller steps, or less damping (rho_inf).'
    if (created) words = 'use smaller steps, &impactor integrator=''conserving'', or more damping (rho_inf) with '// &
                         'delamination.'
  end function energy_remedy
end module motion_steps
