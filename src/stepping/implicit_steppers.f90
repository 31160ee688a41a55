!> Implicit steps: each is tried, and accepted or repeated with a shorter length.
module implicit_steppers
  use archives, only: archive_t
  use contact_updates, only: update_contact_area
  use errors, only: error_t
  use implicit_steps, only: implicit_steps_t
  use initial_equilibrium, only: find_initial_equilibrium
  use kinds, only: wp
  use layer_switches, only: find_required_layers, has_adaptive_layers, insert_layers, move_with_plate
  use implicit_layers, only: transfer_state
  use layer_transfers, only: layer_transfer_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use load_steps, only: load_steps_t
  use models, only: model_t
  use motion_steps, only: motion_steps_t
  use setups, only: setup_t
  use states, only: new_state, state_t
  use step_acceptance, only: accept_step, assess_error, reject_step
  use step_controllers, only: step_controller_t
  use step_errors, only: step_error_t
  use stepping_parameters, only: stepping_t
  use text, only: counted, line_t, to_text
  implicit none
  private
  public :: implicit_stepper_t

  !> A stepper of implicit steps in time or by load. It has many components because it has those of any stepper and of
  !> trial, operator and step control.
  type, extends(implicit_steps_t) :: implicit_stepper_t
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
  end type implicit_stepper_t

contains

  !> Initial state: the plate at rest and the impactor at first contact.
  subroutine start(self, model, stepping, linear_solver, resumed, error)
    class(implicit_stepper_t), intent(out) :: self
    type(model_t), intent(in) :: model
    type(stepping_t), intent(in) :: stepping
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    logical, intent(in) :: resumed
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    self%smallest_step = stepping%time%step_min
    allocate (self%now, source=new_state(model))
    allocate (self%trial, source=self%now)
    if (model%plate%setup%is_static()) then
      allocate (load_steps_t :: self%kind)
    else
      allocate (motion_steps_t :: self%kind)
    end if
    if (model%plate%setup%loading%dissipation > 0) allocate (self%now%path%change, source=self%now%motion%displacement)
    call self%operator%create(model, linear_solver%factorization, error)
    self%unknowns = self%operator%numbering%total
    if (.not. allocated(error)) call find_initial_equilibrium(model, self%operator, self%now, error)
    if (.not. allocated(error)) call self%kind%start(self, model, error)
  end subroutine start

  !> Takes one step, at most to the next event; the step is tried again with half its length until
  !> equilibrium is reached or the smallest step of the deck has failed.
  subroutine advance(self, model, event, error)
    class(implicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: step, shortest

    if (self%is_error_controlled .and. self%now%step == 0) call self%controller%begin(self%stepping, event)
    call find_step(self, model, event, step, shortest, error)
    if (allocated(error)) return
    if (self%is_error_controlled) &
      self%error_exceeded = self%error > self%stepping%controls%shortening_error .and. &
                               step <= shortest*(1 + 1.0e-9_wp)
    if (abs(self%trial%time - event) <= 1.0e-9_wp*step) self%trial%time = event
    call accept_step(self, model, step)
    call self%kind%equilibrate(self, model, error)
  end subroutine advance

  !> Tries steps, each shorter than the one before, until one has converged with an error within the tolerance.
  subroutine find_step(self, model, event, step, shortest, error)
    class(implicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    !> Step found
    real(wp), intent(out) :: step
    !> Shortest step allowed under error control
    real(wp), intent(out) :: shortest
    !> Set if the smallest step failed
    type(error_t), allocatable, intent(inout) :: error
    logical :: converged, accurate

    shortest = 0
    do
      call self%kind%try(self, model, event, step, converged, error)
      if (allocated(error)) return
      if (converged) then
        accurate = .true.
        if (self%is_error_controlled) call assess_error(self, model%plate, step, shortest, accurate)
        if (accurate) return
      else
        call reject_step(self, model%plate, step, error)
        if (allocated(error)) return
      end if
    end do
  end subroutine find_step

  !> Takes a step and inserts the layers that the damage requires. A step in which damage has reached the border of an
  !> extensible zone is repeated with more layers. Collective.
  subroutine advance_with_layers(self, model, linear_solver, event, switched, error)
    class(implicit_stepper_t), intent(inout) :: self
    type(model_t), intent(inout) :: model
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    real(wp), intent(in) :: event
    logical, intent(out) :: switched
    type(error_t), allocatable, intent(out) :: error
    type(state_t), allocatable :: now
    type(step_controller_t) :: controller
    type(step_error_t) :: step_error
    real(wp) :: extents(2, size(model%plate%mesh%zones))
    logical :: repeats, more

    switched = .false.
    repeats = has_adaptive_layers(model)
    if (.not. repeats) call self%advance(model, event, error)
    do while (repeats)
      now = self%now
      controller = self%controller
      step_error = self%step_error
      call self%advance(model, event, error)
      if (allocated(error)) return
      call model%plate%profile%enter('layers')
      call find_required_layers(model%plate, self%now, extents, more)
      repeats = more .and. any(self%now%interfaces%border_reached .and. model%plate%setup%delaminations%is_adaptive)
      if (repeats) then
        self%now = now
        self%controller = controller
        self%step_error = step_error
        self%rejected = self%rejected + 1
        self%operator%ready = .false.
      end if
      if (more) call insert_layers(model, self, linear_solver, extents, error)
      switched = switched .or. more
      call model%plate%profile%leave()
      if (allocated(error)) return
    end do
    if (.not. allocated(error)) call update_contact_area(model, self%now, self%operator, error)
  end subroutine advance_with_layers

  !> Gives new layers the motion of the single plate, and computes forces and energies. Collective.
  subroutine take_layers(self, model, transfer, error)
    class(implicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(layer_transfer_t), intent(in) :: transfer
    !> Never set: forces are computed without a solution
    type(error_t), allocatable, intent(out) :: error

    call transfer_state(model, transfer, self%now)
    if (allocated(self%now%path%change)) call move_with_plate(model%plate, transfer, self%now%path%change)
  end subroutine take_layers

  !> Saves or loads the evolving state.
  subroutine visit(self, archive, model, error)
    class(implicit_stepper_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    call self%controller%visit(archive)
    if (allocated(self%step_error%share)) call self%step_error%visit(archive, model%plate)
    call archive%item('stepper/rejected', self%rejected)
    call self%operator%visit(archive, model, self%now%impact%patch, error)
  end subroutine visit

  !> Length of the last step.
  pure real(wp) function last_step(self)
    class(implicit_stepper_t), intent(in) :: self

    last_step = self%controller%last
  end function last_step

  !> The size of the model and the factorization package.
  function model_sentences(self, model) result(lines)
    class(implicit_stepper_t), intent(in) :: self
    type(model_t), intent(in) :: model
    type(line_t), allocatable :: lines(:)

    lines = [line_t('Model: '//counted(to_text(model%plate%mesh%elements()), 'element')//', '// &
                    counted(to_text(self%unknowns), 'unknown')//', '// &
                    counted(to_text(model%plate%communicator%size), 'rank')//', factored by '// &
                    self%operator%solver%package_used()//'.')]
  end function model_sentences

  !> The method as the subject of a sentence.
  pure function method_name(self) result(words)
    class(implicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = self%kind%name()
  end function method_name

  !> What to change where the method has created or dissipated too much energy.
  pure function energy_remedy(self, setup, created) result(words)
    class(implicit_stepper_t), intent(in) :: self
    type(setup_t), intent(in) :: setup
    logical, intent(in) :: created
    character(len=:), allocatable :: words

    words = self%kind%energy_remedy(created)
  end function energy_remedy

  !> What to change where the ledger does not close.
  pure function ledger_remedy(self) result(words)
    class(implicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'use a smaller tolerance of &solver.'
  end function ledger_remedy

  !> Cost of a run in one line.
  function cost(self) result(line)
    class(implicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: line

    associate (now => self%now, operator => self%operator)
      line = counted(to_text(now%step), 'step')//' ('//to_text(self%rejected)//' rejected), '// &
             counted(to_text(now%all_iterations%equilibrium), 'iteration')//' of equilibrium, '// &
             to_text(now%all_iterations%force)//' of the force, '// &
             counted(to_text(operator%factorizations), 'factorization')//', '// &
             counted(to_text(operator%solves), 'solve')//' by '//operator%solver%package_used()
    end associate
  end function cost
end module implicit_steppers
