!> Load steps: by load control, or by control of the energy that each dissipates.
module load_steps
  use section_bounds, only: uniform_stiffness
  use dissipation_steps, only: dissipation_step_t, new_dissipation_step
  use errors, only: error_t, fail, exit_convergence
  use front_growth, only: find_release_ratio
  use kinds, only: wp
  use models, only: model_t
  use static_steps, only: static_step_t, new_static_step
  use step_acceptance, only: accept_step
  use step_problems, only: solve_step
  use implicit_steps, only: implicit_steps_t, step_kind_t
  use text, only: rounded_text
  implicit none
  private
  public :: load_steps_t

  !> Load steps.
  type, extends(step_kind_t) :: load_steps_t
  contains
    procedure :: start
    procedure :: try
    procedure :: complete_trial
    procedure :: choose_next
    procedure :: name
    procedure :: energy_remedy
    procedure :: equilibrate
  end type load_steps_t

contains

  !> The first step has the length given in the deck.
  subroutine start(self, stepper, model, error)
    class(load_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    type(error_t), allocatable, intent(inout) :: error

    stepper%controller%target = 1.0_wp/model%plate%setup%loading%steps
    stepper%smallest_step = stepper%controller%target/stepper%stepping%controls%load_step_parts
  end subroutine start

  !> Tries one load step.
  subroutine try(self, stepper, model, event, step, converged, error)
    class(load_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    real(wp), intent(out) :: step
    logical, intent(out) :: converged
    type(error_t), allocatable, intent(out) :: error
    type(static_step_t) :: by_load
    type(dissipation_step_t) :: by_dissipation

    associate (now => stepper%now)
      step = stepper%step_scale(model%plate)
      step = step*stepper%controller%propose((event - now%time)/step, huge(step))
      if (now%path%by_dissipation) then
        by_dissipation = new_dissipation_step(model%plate, now%time + step, stepper%energy_rate(model%plate)*step, &
                                              1.0_wp/model%plate%setup%loading%steps)
        call solve_step(by_dissipation, model, stepper%stepping%equilibrium, stepper%operator, now, stepper%trial, &
                        converged, error)
        ! With a larger change of the load another branch of equilibrium might be found that is not connected with the
        ! path.
        if (converged) converged = abs(stepper%trial%load_factor - now%load_factor) <= by_dissipation%max_load_change
      else
        by_load = new_static_step(model%plate, now%time + step, now%load_factor + step)
        call solve_step(by_load, model, stepper%stepping%equilibrium, stepper%operator, now, stepper%trial, converged, &
                        error)
      end if
    end associate
  end subroutine try

  !> Finds the ratio of energy release rate to toughness at fronts; under load steps they do not grow.
  subroutine complete_trial(self, stepper, model)
    class(load_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model

    associate (trial => stepper%trial)
      call find_release_ratio(model%plate, uniform_stiffness(trial%plies), trial%motion, trial%interfaces)
    end associate
  end subroutine complete_trial

  !> Each step is first tried with the length given in the deck.
  subroutine choose_next(self, stepper, model, step, change, extended)
    class(load_steps_t), intent(in) :: self
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: step
    real(wp), intent(in) :: change
    logical, intent(in) :: extended

    stepper%controller%target = 1.0_wp/model%plate%setup%loading%steps
  end subroutine choose_next

  !> Restores equilibrium at constant load after failures of plies, until no more plies fail.
  subroutine equilibrate(self, stepper, model, error)
    class(load_steps_t), intent(in) :: self
    !> The stepper, the step accepted
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    !> Set if the damaged plate cannot carry the load
    type(error_t), allocatable, intent(inout) :: error
    type(static_step_t) :: problem
    logical :: converged

    do while (stepper%now%plies%softened)
      problem = new_static_step(model%plate, stepper%now%time, stepper%now%load_factor)
      call solve_step(problem, model, stepper%stepping%equilibrium, stepper%operator, stepper%now, stepper%trial, &
                      converged, error)
      if (.not. (allocated(error) .or. converged)) &
        call fail(error, exit_convergence, 'No equilibrium at '//rounded_text(stepper%now%time)// &
                  ' of the load: the plate with its failed plies cannot carry it.')
      if (allocated(error)) return
      stepper%trial%step = stepper%now%step
      call accept_step(stepper, model, 0.0_wp)
    end do
  end subroutine equilibrate

  !> Subject of a sentence.
  pure function name(self) result(words)
    class(load_steps_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'Load steps'
  end function name

  !> What to change where steps have created or dissipated too much energy.
  pure function energy_remedy(self, created) result(words)
    class(load_steps_t), intent(in) :: self
    !> True: energy was created; false: dissipated
    logical, intent(in) :: created
    character(len=:), allocatable :: words

    words = 'use more steps, unless failures or snap-through release it as kinetic energy.'
  end function energy_remedy
end module load_steps
