!> Data of implicit steps, and the interface of their kinds: steps in time and load steps.
module implicit_steps
  use errors, only: error_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use newmark_integrators, only: plate_integrator_t
  use states, only: state_t
  use step_controllers, only: step_controller_t
  use step_errors, only: step_error_t
  use steppers, only: stepper_t
  implicit none
  private
  public :: implicit_steps_t, step_kind_t

  !> A kind of implicit steps: in time or by load. It has no data; all variables are in the stepper.
  type, abstract :: step_kind_t
  contains
    !> Prepares the first step.
    procedure(start_steps), deferred :: start
    !> Tries a step.
    procedure(try_one_step), deferred :: try
    !> Completes the state tried before it is accepted.
    procedure(complete_trial_state), deferred :: complete_trial
    !> Chooses the length of the next step.
    procedure(choose_length), deferred :: choose_next
    procedure(name_of_kind), deferred :: name
    procedure(remedy_of_kind), deferred :: energy_remedy
    procedure :: equilibrate
  end type step_kind_t

  !> Data of implicit steps. It has many components because each part of the step control has its own.
  type, abstract, extends(stepper_t) :: implicit_steps_t
    type(step_controller_t) :: controller
    !> Error estimate of steps
    type(step_error_t) :: step_error
    !> Last error relative to its tolerance, and the lag of damage in the last step relative to its limit
    real(wp) :: error = 0, damage_lag = 0
    !> True: the length of steps is controlled by the error of each step
    logical :: is_error_controlled = .false.
    type(plate_integrator_t) :: integrator
    !> Steps in time or by load
    class(step_kind_t), allocatable :: kind
    !> Factorizations and solves before the present step
    integer :: factorizations_at_start = 0, solves_at_start = 0
    !> The trial state
    type(state_t), allocatable :: trial
  contains
    procedure :: energy_rate
    procedure :: step_scale
  end type implicit_steps_t

  abstract interface
    !> Prepares the first step from the initial equilibrium. Collective.
    subroutine start_steps(self, stepper, model, error)
      import :: step_kind_t, implicit_steps_t, model_t, error_t
      class(step_kind_t), intent(in) :: self
      !> The stepper, its state in equilibrium
      class(implicit_steps_t), intent(inout) :: stepper
      type(model_t), intent(in) :: model
      !> Set if the factorization fails
      type(error_t), allocatable, intent(inout) :: error
    end subroutine start_steps

    !> Tries a step, at most to an event. Collective.
    subroutine try_one_step(self, stepper, model, event, step, converged, error)
      import :: step_kind_t, implicit_steps_t, model_t, error_t, wp
      class(step_kind_t), intent(in) :: self
      !> The stepper; its trial state is that at the end of the step
      class(implicit_steps_t), intent(inout) :: stepper
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: event
      !> Step tried
      real(wp), intent(out) :: step
      !> True if equilibrium was reached
      logical, intent(out) :: converged
      !> Set if the solver fails for good
      type(error_t), allocatable, intent(out) :: error
    end subroutine try_one_step

    !> Completes the state tried before it is accepted. Collective.
    subroutine complete_trial_state(self, stepper, model)
      import :: step_kind_t, implicit_steps_t, model_t
      class(step_kind_t), intent(in) :: self
      !> The stepper, with the failures of the trial step
      class(implicit_steps_t), intent(inout) :: stepper
      type(model_t), intent(in) :: model
    end subroutine complete_trial_state

    !> Chooses the length of the next step.
    subroutine choose_length(self, stepper, model, step, change, extended)
      import :: step_kind_t, implicit_steps_t, model_t, wp
      class(step_kind_t), intent(in) :: self
      !> The stepper, the step accepted
      class(implicit_steps_t), intent(inout) :: stepper
      type(model_t), intent(in) :: model
      !> Step taken
      real(wp), intent(in) :: step
      !> Change of the struck point's stress over the largest so far
      real(wp), intent(in) :: change
      !> True: delaminations have grown
      logical, intent(in) :: extended
    end subroutine choose_length

    !> The kind as the subject of a sentence, such as Load steps.
    pure function name_of_kind(self) result(words)
      import :: step_kind_t
      class(step_kind_t), intent(in) :: self
      character(len=:), allocatable :: words
    end function name_of_kind

    !> What to change where steps have created or dissipated too much energy; the end of a sentence.
    pure function remedy_of_kind(self, created) result(words)
      import :: step_kind_t
      class(step_kind_t), intent(in) :: self
      !> True: energy was created; false: dissipated
      logical, intent(in) :: created
      character(len=:), allocatable :: words
    end function remedy_of_kind
  end interface

contains

  !> Steps are accepted in equilibrium.
  subroutine equilibrate(self, stepper, model, error)
    class(step_kind_t), intent(in) :: self
    !> The stepper, the step accepted
    class(implicit_steps_t), intent(inout) :: stepper
    type(model_t), intent(in) :: model
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(inout) :: error
  end subroutine equilibrate

  !> Energy to be dissipated per unit of pseudo-time in the remaining steps, so that the total is that of the deck.
  pure real(wp) function energy_rate(self, plate)
    class(implicit_steps_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate

    energy_rate = max(0.0_wp, plate%setup%loading%dissipation - self%now%ledger%delamination)/(1 - self%now%time)
  end function energy_rate

  !> Pseudo-time of a step under control of dissipation over that of a step under load control; 1 for the latter.
  pure real(wp) function step_scale(self, plate)
    class(implicit_steps_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate

    step_scale = 1
    if (self%now%path%by_dissipation) step_scale = plate%setup%loading%dissipation/self%energy_rate(plate)
  end function step_scale
end module implicit_steps
