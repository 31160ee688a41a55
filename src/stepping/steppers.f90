!> A stepper through time or load: the state of a run and how it advances. Each kind carries its own data and says
!> for itself what a run asks of its steps, so that nothing else asks which kind it is.
module steppers
  use archives, only: archive_t
  use errors, only: error_t, exit_deck, fail
  use kinds, only: wp
  use layer_transfers, only: layer_transfer_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use models, only: model_t
  use setups, only: setup_t
  use states, only: state_t
  use stepping_parameters, only: stepping_t
  use tangent_operators, only: tangent_operator_t
  use text, only: line_t
  implicit none
  private
  public :: stepper_t

  !> The state of a run, and parameters of its steps.
  type, abstract :: stepper_t
    !> The state reached
    type(state_t), allocatable :: now
    !> Parameters of steps
    type(stepping_t) :: stepping
    !> Operator of the equilibria that are solved: of each step, or only of the one before the first step
    type(tangent_operator_t) :: operator
    !> Number of unconstrained unknowns
    integer :: unknowns = 0
    !> Shortest step
    real(wp) :: smallest_step = 0
    !> Number of steps that were tried again with a shorter length
    integer :: rejected = 0
    !> True: the error of the last step exceeds its tolerance at the shortest length
    logical :: error_exceeded = .false.
    !> True: nodes that meet come to rest against each other, so that contact dissipates energy
    logical :: dissipates_in_contact = .false.
  contains
    procedure(start_stepper), deferred :: start
    procedure(advance_stepper), deferred :: advance
    procedure(advance_stepper_with_layers), deferred :: advance_with_layers
    procedure(take_layers_of_plate), deferred :: take_layers
    procedure(visit_stepper), deferred :: visit
    procedure(length_of_steps), deferred :: last_step
    procedure(sentences_on_model), deferred :: model_sentences
    procedure(words_of_method), deferred :: method_name
    procedure(words_on_energy), deferred :: energy_remedy
    procedure(words_of_method), deferred :: ledger_remedy
    procedure(sentence_on_cost), deferred :: cost
    procedure :: begin_inherited
    procedure :: complete_state
    procedure :: longest_step
    procedure :: steps_between_checks
    procedure :: steps_between_stages
    procedure :: done
    procedure :: left
    procedure :: expected_steps
  end type stepper_t

  abstract interface
    !> Finds the initial state: the plate at rest and the impactor at first contact. Collective.
    subroutine start_stepper(self, model, stepping, linear_solver, resumed, error)
      import :: stepper_t, model_t, stepping_t, linear_solver_parameters_t, error_t
      class(stepper_t), intent(out) :: self
      type(model_t), intent(in) :: model
      type(stepping_t), intent(in) :: stepping
      type(linear_solver_parameters_t), intent(in) :: linear_solver
      !> True: a state will be loaded, so that no initial state is computed
      logical, intent(in) :: resumed
      !> Set if the solver cannot be set up
      type(error_t), allocatable, intent(out) :: error
    end subroutine start_stepper

    !> Takes one step, at most to an event. Collective.
    subroutine advance_stepper(self, model, event, error)
      import :: stepper_t, model_t, error_t, wp
      class(stepper_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      real(wp), intent(in) :: event
      !> Set if the smallest step failed
      type(error_t), allocatable, intent(out) :: error
    end subroutine advance_stepper

    !> Takes one step and inserts the layers that the damage requires. Collective.
    subroutine advance_stepper_with_layers(self, model, linear_solver, event, switched, error)
      import :: stepper_t, model_t, linear_solver_parameters_t, error_t, wp
      class(stepper_t), intent(inout) :: self
      !> The model; receives larger zones
      type(model_t), intent(inout) :: model
      type(linear_solver_parameters_t), intent(in) :: linear_solver
      real(wp), intent(in) :: event
      !> True if layers were inserted
      logical, intent(out) :: switched
      !> Set if the smallest step fails or the model cannot be built
      type(error_t), allocatable, intent(out) :: error
    end subroutine advance_stepper_with_layers

    !> Gives layers inserted in the model the motion of the single plate. Collective.
    subroutine take_layers_of_plate(self, model, transfer, error)
      import :: stepper_t, model_t, layer_transfer_t, error_t
      !> The stepper with the loaded state
      class(stepper_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      !> Map of points and elements from the former mesh
      type(layer_transfer_t), intent(in) :: transfer
      !> Set if the motion has become unstable
      type(error_t), allocatable, intent(out) :: error
    end subroutine take_layers_of_plate

    !> Saves or loads the evolving state.
    subroutine visit_stepper(self, archive, model, error)
      import :: stepper_t, archive_t, model_t, error_t
      class(stepper_t), intent(inout) :: self
      class(archive_t), intent(inout) :: archive
      type(model_t), intent(in) :: model
      !> Set if the operator cannot be factorized again
      type(error_t), allocatable, intent(out) :: error
    end subroutine visit_stepper

    !> Length of the last step.
    pure real(wp) function length_of_steps(self)
      import :: stepper_t, wp
      class(stepper_t), intent(in) :: self
    end function length_of_steps

    !> The size of the model and its steps, one sentence each. Collective.
    function sentences_on_model(self, model) result(lines)
      import :: stepper_t, model_t, line_t
      class(stepper_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(line_t), allocatable :: lines(:)
    end function sentences_on_model

    !> The method as the subject of a sentence, such as Central differences; or what to change where the ledger does not
    !> close, as its end.
    pure function words_of_method(self) result(words)
      import :: stepper_t
      class(stepper_t), intent(in) :: self
      character(len=:), allocatable :: words
    end function words_of_method

    !> What to change where the method has created or dissipated too much energy; the end of a sentence.
    pure function words_on_energy(self, setup, created) result(words)
      import :: stepper_t, setup_t
      class(stepper_t), intent(in) :: self
      type(setup_t), intent(in) :: setup
      !> True: energy was created; false: dissipated
      logical, intent(in) :: created
      character(len=:), allocatable :: words
    end function words_on_energy

    !> Cost of a run in one line.
    function sentence_on_cost(self) result(line)
      import :: stepper_t
      class(stepper_t), intent(in) :: self
      character(len=:), allocatable :: line
    end function sentence_on_cost
  end interface

contains

  !> Starts from the loaded state of another run, which only some methods can. Collective.
  subroutine begin_inherited(self, model, transfer, motion, error)
    !> The stepper with the loaded state
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    class(layer_transfer_t), intent(in) :: transfer
    !> motion_rest or motion_kept
    integer, intent(in) :: motion
    !> Set if the motion is unstable
    type(error_t), allocatable, intent(out) :: error

    call fail(error, exit_deck, self%method_name()//' cannot start from the final state of another run.')
  end subroutine begin_inherited

  !> Computes what a step leaves out because it is needed only when output or a check is due. Collective.
  subroutine complete_state(self, model, error)
    class(stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error
  end subroutine complete_state

  !> Longest step that may be taken; huge: that of the deck.
  pure real(wp) function longest_step(self)
    class(stepper_t), intent(in) :: self

    longest_step = huge(1.0_wp)
  end function longest_step

  !> Steps between two checks of a run. It is the same on any number of ranks and after a restart, as warnings are given
  !> at checks.
  pure integer function steps_between_checks(self, elements)
    class(stepper_t), intent(in) :: self
    !> Number of elements of all layers
    integer, intent(in) :: elements

    steps_between_checks = 1
  end function steps_between_checks

  !> Steps between two updates of the damaged state of interfaces.
  pure integer function steps_between_stages(self)
    class(stepper_t), intent(in) :: self

    steps_between_stages = 1
  end function steps_between_stages

  !> The completed part of a run, in time or steps, whichever the remainder is foreseen in.
  pure real(wp) function done(self)
    class(stepper_t), intent(in) :: self

    done = self%now%time
  end function done

  !> The remainder of a run, in the same unit.
  pure real(wp) function left(self, end)
    class(stepper_t), intent(in) :: self
    real(wp), intent(in) :: end

    left = max(0.0_wp, end - self%now%time)
  end function left

  !> Number of steps of the whole run; 0: unknown.
  pure integer function expected_steps(self, end)
    class(stepper_t), intent(in) :: self
    real(wp), intent(in) :: end

    expected_steps = 0
  end function expected_steps
end module steppers
