!> A third kind of stepper: velocity Verlet with lumped mass, for linear or nonlinear plates under pressure without
!> impactor, lines, interfaces and damage.
module verlet_steppers
  use archives, only: archive_t
  use errors, only: error_t, exit_deck, fail
  use kinds, only: wp
  use layer_transfers, only: layer_transfer_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use models, only: model_t
  use rank_totals, only: total_of
  use setups, only: setup_t
  use states, only: new_state
  use steppers, only: stepper_t
  use stepping_parameters, only: stepping_t
  use text, only: counted, line_t, to_text
  implicit none
  private
  public :: verlet_stepper_t

  !> A stepper by velocity Verlet.
  type, extends(stepper_t) :: verlet_stepper_t
    !> Length of the last step
    real(wp) :: step = 0
  contains
    procedure :: start
    procedure :: advance
    procedure :: advance_with_layers
    procedure :: take_layers
    procedure :: visit
    procedure :: last_step
    procedure :: model_sentences
    procedure :: method_name
    procedure :: energy_remedy
    procedure :: ledger_remedy
    procedure :: cost
  end type verlet_stepper_t

contains

  !> The plate at rest, accelerated by the load.
  subroutine start(self, model, stepping, linear_solver, resumed, error)
    class(verlet_stepper_t), intent(out) :: self
    type(model_t), intent(in) :: model
    !> Parameters of steps
    type(stepping_t), intent(in) :: stepping
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> True: a state will be loaded
    logical, intent(in) :: resumed
    !> Set if the model has what the method does not
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    self%smallest_step = stepping%time%step_min
    self%unknowns = count(.not. model%plate%constraints%fixed)
    if (.not. allocated(model%lumped) .or. model%plate%map%layered .or. size(model%loads%lines) > 0 .or. &
        model%plate%setup%impactor%is_present .or. model%plate%setup%has_variable_sections()) then
      call fail(error, exit_deck, 'Verlet steps require &mesh mass=''lumped'' and a plate under pressure alone.')
      return
    end if
    allocate (self%now, source=new_state(model))
    call find_accelerations(self, model)
  end subroutine start

  !> Takes one step, at most to an event. Collective.
  subroutine advance(self, model, event, error)
    class(verlet_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time that must not be exceeded
    real(wp), intent(in) :: event
    !> Never set
    type(error_t), allocatable, intent(out) :: error

    associate (now => self%now, motion => self%now%motion)
      self%step = min(self%stepping%time%step, event - now%time)
      motion%velocity = motion%velocity + self%step/2*motion%acceleration
      motion%displacement = motion%displacement + self%step*motion%velocity
      now%time = now%time + self%step
      now%step = now%step + 1
      call find_accelerations(self, model)
      motion%velocity = motion%velocity + self%step/2*motion%acceleration
      call record_energies(self, model)
      now%impact%deflection = model%plate%deflection(motion%displacement)
    end associate
  end subroutine advance

  !> Accelerations by the forces of the present displacement. The mass of a symmetric laminate is diagonal.
  subroutine find_accelerations(self, model)
    class(verlet_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    integer :: i

    associate (now => self%now, motion => self%now%motion)
      call model%internal(now%plies%stiffness, motion%displacement, motion%internal, now%ledger%strain)
      motion%acceleration = -motion%internal
      if (allocated(model%loads%pressure)) motion%acceleration = motion%acceleration &
        + model%plate%setup%pressure_factor(now%time, now%load_factor)*model%loads%pressure
      do i = 1, model%plate%distribution%owned
        associate (mass => model%lumped(:, i), value => motion%acceleration(:, i))
          value = value/[mass(1), mass(1), mass(1), mass(3), mass(3)]
          where (model%plate%constraints%fixed(:, model%plate%distribution%points(i))) value = 0
        end associate
      end do
      call model%plate%halo%update(motion%acceleration)
    end associate
  end subroutine find_accelerations

  !> Energies at the end of a step, for a pressure that is constant from the start. Collective.
  subroutine record_energies(self, model)
    class(verlet_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model

    associate (motion => self%now%motion, ledger => self%now%ledger, owned => model%plate%distribution%owned)
      call model%inertia(motion%velocity, motion%momentum)
      call model%plate%communicator%sum(ledger%strain)
      ledger%strain = ledger%strain*model%plate%mesh%multiplicity
      ledger%kinetic = model%plate%mesh%multiplicity/2*total_of(model%plate%communicator, &
                                                          sum(motion%velocity(:, :owned)*motion%momentum(:, :owned), 1))
      ledger%external_work = model%plate%mesh%multiplicity*total_of( &
        model%plate%communicator, sum(motion%displacement(:, :owned)*model%loads%pressure(:, :owned), 1))
      call ledger%note_largest()
    end associate
  end subroutine record_energies

  !> A step; the model has no layers.
  subroutine advance_with_layers(self, model, linear_solver, event, switched, error)
    class(verlet_stepper_t), intent(inout) :: self
    !> The model
    type(model_t), intent(inout) :: model
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    !> Time that must not be exceeded
    real(wp), intent(in) :: event
    !> Always false
    logical, intent(out) :: switched
    !> Never set
    type(error_t), allocatable, intent(out) :: error

    switched = .false.
    call self%advance(model, event, error)
  end subroutine advance_with_layers

  !> Without layers nothing is taken.
  subroutine take_layers(self, model, transfer, error)
    class(verlet_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    type(layer_transfer_t), intent(in) :: transfer
    !> Never set
    type(error_t), allocatable, intent(out) :: error
  end subroutine take_layers

  !> Saves or loads the evolving state: velocity and acceleration are part of it.
  subroutine visit(self, archive, model, error)
    class(verlet_stepper_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Never set
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    call archive%item('verlet/step', self%step)
  end subroutine visit

  !> Length of the last step.
  pure real(wp) function last_step(self)
    class(verlet_stepper_t), intent(in) :: self

    last_step = self%step
  end function last_step

  !> The size of the model.
  function model_sentences(self, model) result(lines)
    class(verlet_stepper_t), intent(in) :: self
    type(model_t), intent(in) :: model
    type(line_t), allocatable :: lines(:)

    lines = [line_t('Model: '//counted(to_text(model%plate%mesh%elements()), 'element')//'.')]
  end function model_sentences

  !> The method as the subject of a sentence.
  pure function method_name(self) result(words)
    class(verlet_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'Verlet steps'
  end function method_name

  !> What to change where energy was created or dissipated.
  pure function energy_remedy(self, setup, created) result(words)
    class(verlet_stepper_t), intent(in) :: self
    type(setup_t), intent(in) :: setup
    !> True: energy was created
    logical, intent(in) :: created
    character(len=:), allocatable :: words

    words = self%ledger_remedy()
  end function energy_remedy

  !> What to change where the ledger does not close.
  pure function ledger_remedy(self) result(words)
    class(verlet_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'use a shorter step.'
  end function ledger_remedy

  !> Cost of a run in one line.
  function cost(self) result(line)
    class(verlet_stepper_t), intent(in) :: self
    character(len=:), allocatable :: line

    line = counted(to_text(self%now%step), 'Verlet step')
  end function cost
end module verlet_steppers
