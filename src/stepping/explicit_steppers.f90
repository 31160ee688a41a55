!> Steps by central differences.
module explicit_steppers
  use archives, only: archive_t
  use central_differences, only: central_difference_t
  use central_difference_energies, only: record_energies
  use errors, only: error_t
  use explicit_steps, only: advance_explicit, complete_step
  use initial_equilibrium, only: has_initial_motion
  use initial_state_parameters, only: motion_rest
  use kinds, only: wp
  use layer_switches, only: find_required_layers, has_adaptive_layers, insert_layers, move_with_plate
  use layer_transfers, only: layer_transfer_t
  use linear_solver_parameters, only: linear_solver_parameters_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use separated_elements, only: separate_unequal, visit_separated
  use setups, only: setup_t
  use short_numbers, only: short_text
  use single_rank_equilibria, only: equilibrate_initial_stresses
  use states, only: new_state
  use step_intervals, only: interval_of_checks, interval_of_stages
  use steppers, only: stepper_t
  use stepping_parameters, only: stepping_t
  use text, only: counted, line_t, rounded_text, to_text
  implicit none
  private
  public :: explicit_stepper_t

  !> Steps of central differences between two checks whether damage requires more layers. A crack grows by at most two
  !> cells in eight steps (`explicit_steps`): by the cells that an extension adds (`layer_extents`).
  integer, parameter :: steps_between_zone_checks = 16

  !> A stepper by central differences.
  type, extends(stepper_t) :: explicit_stepper_t
    !> The method and its data that are not part of the state
    type(central_difference_t) :: method
  contains
    procedure :: start
    procedure :: advance
    procedure :: advance_with_layers
    procedure :: take_layers
    procedure :: begin_inherited
    procedure :: complete_state
    procedure :: visit
    procedure :: last_step
    procedure :: longest_step
    procedure :: steps_between_checks
    procedure :: steps_between_stages
    procedure :: done
    procedure :: left
    procedure :: expected_steps
    procedure :: model_sentences
    procedure :: method_name
    procedure :: energy_remedy
    procedure :: ledger_remedy
    procedure :: cost
  end type explicit_stepper_t

contains

  !> Initial state: the plate at rest, or in equilibrium with its residual stresses, and the impactor at first contact.
  !> Collective.
  subroutine start(self, model, stepping, linear_solver, resumed, error)
    class(explicit_stepper_t), intent(out) :: self
    type(model_t), intent(in) :: model
    type(stepping_t), intent(in) :: stepping
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    logical, intent(in) :: resumed
    !> Set if there is no initial equilibrium
    type(error_t), allocatable, intent(out) :: error

    self%stepping = stepping
    self%smallest_step = stepping%time%step_min
    self%dissipates_in_contact = .true.
    allocate (self%now, source=new_state(model))
    self%unknowns = count(.not. model%plate%constraints%fixed)
    if (.not. resumed .and. has_initial_motion(model)) &
      call equilibrate_initial_stresses(self%operator, model, linear_solver, self%now, error)
    if (.not. allocated(error)) call self%method%start(model, stepping%central, self%now)
  end subroutine start

  !> Takes one step, at most to an event. Collective.
  subroutine advance(self, model, event, error)
    class(explicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    !> Never set: an unstable motion is found when the state is completed
    type(error_t), allocatable, intent(out) :: error

    call advance_explicit(self%method, model, event, self%now)
  end subroutine advance

  !> Takes a step, and checks at intervals whether damage requires more layers. Damage grows by less than a cell per
  !> step, so that it does not pass the layered cells ahead of it between checks. Collective.
  subroutine advance_with_layers(self, model, linear_solver, event, switched, error)
    class(explicit_stepper_t), intent(inout) :: self
    type(model_t), intent(inout) :: model
    type(linear_solver_parameters_t), intent(in) :: linear_solver
    real(wp), intent(in) :: event
    logical, intent(out) :: switched
    !> Set if the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: extents(2, size(model%plate%mesh%zones))

    switched = .false.
    call self%advance(model, event, error)
    if (allocated(error) .or. .not. has_adaptive_layers(model)) return
    if (modulo(self%now%step, steps_between_zone_checks) > 0) return
    call model%plate%profile%enter('layers')
    call find_required_layers(model%plate, self%now, extents, switched)
    if (switched) call insert_layers(model, self, linear_solver, extents, error)
    call model%plate%profile%leave()
  end subroutine advance_with_layers

  !> Gives new layers the motion of the single plate, and computes their forces. Collective.
  subroutine take_layers(self, model, transfer, error)
    class(explicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(layer_transfer_t), intent(in) :: transfer
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: before

    associate (now => self%now)
      before = now%ledger%kinetic + now%ledger%strain
      call move_with_plate(model%plate, transfer, now%motion%displacement)
      call move_with_plate(model%plate, transfer, now%motion%velocity)
      call now%plies%restack(model%plate, transfer%is_split(model%plate%distribution%elements))
      call self%method%resume(model, now)
      call self%method%renew_forces(model, now)
      call self%complete_state(model, error)
      now%ledger%layers = now%ledger%layers + before - now%ledger%kinetic - now%ledger%strain
    end associate
  end subroutine take_layers

  !> Starts from the final state of another run: internal forces are computed from that state, supports and lines start
  !> from the present displacement, an impactor from first contact, the ledger from the present energies. Collective.
  subroutine begin_inherited(self, model, transfer, motion, error)
    !> The stepper with the loaded state
    class(explicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Map of points and elements from the former mesh
    class(layer_transfer_t), intent(in) :: transfer
    !> motion_rest or motion_kept
    integer, intent(in) :: motion
    !> Set if the motion is unstable
    type(error_t), allocatable, intent(out) :: error

    associate (now => self%now, method => self%method)
      call move_with_plate(model%plate, transfer, now%motion%displacement)
      call move_with_plate(model%plate, transfer, now%motion%velocity)
      if (motion == motion_rest) now%motion%velocity = 0
      call now%plies%restack(model%plate, transfer%is_split(model%plate%distribution%elements))
      if (allocated(now%plies%bands)) call separate_unequal(now%plies%bands)
      call method%lines%start_from(model, method%inertia, model%plate%motion_of(now%motion%displacement))
      call method%resume(model, now)
      call method%renew_forces(model, now)
      now%impact%deflection = model%plate%deflection(now%motion%displacement)
      now%impact%patch_mean = now%contact_deflection(model%plate)
      if (model%plate%setup%impactor%is_present) call method%impact%place(model, now)
      call record_energies(method, model, now)
      now%ledger%initial = now%ledger%initial + now%ledger%error()
      call self%complete_state(model, error)
    end associate
  end subroutine begin_inherited

  !> Computes energies, reactions and stress of a step. Collective.
  subroutine complete_state(self, model, error)
    class(explicit_stepper_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error

    call complete_step(self%method, model, self%now, error)
  end subroutine complete_state

  !> Saves or loads the evolving state.
  subroutine visit(self, archive, model, error)
    class(explicit_stepper_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> Never set: no operator is factorized
    type(error_t), allocatable, intent(out) :: error

    call self%now%visit(archive, model)
    call self%method%visit(archive, model)
    if (model%plate%setup%initial%is_inherited .and. allocated(self%now%plies%bands)) &
      call visit_separated(self%now%plies%bands, archive, model%plate)
    call archive%item('operator/factorizations', self%operator%factorizations)
    call archive%item('operator/solves', self%operator%solves)
    if (archive%loading) call self%method%resume(model, self%now)
  end subroutine visit

  !> Length of the last step.
  pure real(wp) function last_step(self)
    class(explicit_stepper_t), intent(in) :: self

    last_step = self%method%steps%now
  end function last_step

  !> Longest step of the undeformed plate.
  pure real(wp) function longest_step(self)
    class(explicit_stepper_t), intent(in) :: self

    longest_step = self%method%parameters%stable_step(self%method%frequency)
  end function longest_step

  !> Steps between two checks of a run.
  pure integer function steps_between_checks(self, elements)
    class(explicit_stepper_t), intent(in) :: self
    !> Number of elements of all layers
    integer, intent(in) :: elements

    steps_between_checks = interval_of_checks(elements)
  end function steps_between_checks

  !> Steps between two updates of the damaged state of interfaces.
  pure integer function steps_between_stages(self)
    class(explicit_stepper_t), intent(in) :: self

    steps_between_stages = interval_of_stages
  end function steps_between_stages

  !> The completed steps.
  pure real(wp) function done(self)
    class(explicit_stepper_t), intent(in) :: self

    done = self%now%step
  end function done

  !> The remaining steps, if their length does not change.
  pure real(wp) function left(self, end)
    class(explicit_stepper_t), intent(in) :: self
    real(wp), intent(in) :: end

    left = max(0.0_wp, end - self%now%time)
    left = left/max(self%method%steps%now, tiny(left))
  end function left

  !> Number of steps of the whole run.
  pure integer function expected_steps(self, end)
    class(explicit_stepper_t), intent(in) :: self
    real(wp), intent(in) :: end

    expected_steps = nint(self%done() + self%left(end))
  end function expected_steps

  !> The size of the model, and the element that determines the stable step. Collective.
  function model_sentences(self, model) result(lines)
    class(explicit_stepper_t), intent(in) :: self
    type(model_t), intent(in) :: model
    type(line_t), allocatable :: lines(:)
    character(len=:), allocatable :: shares
    integer :: most, least

    most = size(model%plate%distribution%elements)
    least = most
    call model%plate%communicator%maximum(most)
    call model%plate%communicator%minimum(least)
    shares = ''
    if (model%plate%communicator%size > 1) shares = ' of '//to_text(least)//' to '//counted(to_text(most), 'element')
    lines = [line_t('Model: '//counted(to_text(model%plate%mesh%elements()), 'element')//', '// &
                    counted(to_text(self%unknowns), 'unknown')//', '// &
                    counted(to_text(model%plate%communicator%size), 'rank')//shares//'.'), &
             line_t('Stable step '//rounded_text(2/self%method%frequency)//' by element '// &
                    to_text(self%method%element)//' '//place_of(model%plate, self%method%element)// &
                    ', shorter during contact; steps are at most '// &
                    rounded_text(self%method%parameters%step_factor)//' of it.')]
  end function model_sentences

  !> Where an element is.
  pure function place_of(plate, element) result(place)
    type(composite_plate_t), intent(in) :: plate
    !> Element of the mesh
    integer, intent(in) :: element
    !> Plies and middle
    character(len=:), allocatable :: place
    integer :: plies(2), at(2)

    plies = plate%mesh%plies_of(element)
    at = plate%mesh%place_of(plate%mesh%element_cell(element))
    place = 'of plies '//to_text(plies(1))//' to '//to_text(plies(2))//' at x = '// &
            short_text(sum(plate%mesh%along(1)%ends(at(1)))/2)//', y = '// &
            short_text(sum(plate%mesh%along(2)%ends(at(2)))/2)
  end function place_of

  !> The method as the subject of a sentence.
  pure function method_name(self) result(words)
    class(explicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'Central differences'
  end function method_name

  !> What to change where the method has created or dissipated too much energy. Layers inserted by a growing zone relax,
  !> and the energy released is damped.
  pure function energy_remedy(self, setup, created) result(words)
    class(explicit_stepper_t), intent(in) :: self
    type(setup_t), intent(in) :: setup
    logical, intent(in) :: created
    character(len=:), allocatable :: words

    words = 'use a smaller step_factor.'
    if (.not. created .and. any(setup%delaminations%is_adaptive)) &
      words = 'use a smaller step_factor or, as zones that grow release energy, a larger zone of &delamination.'
  end function energy_remedy

  !> What to change where the ledger does not close.
  pure function ledger_remedy(self) result(words)
    class(explicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: words

    words = 'use a smaller step_factor.'
  end function ledger_remedy

  !> Cost of a run in one line.
  function cost(self) result(line)
    class(explicit_stepper_t), intent(in) :: self
    character(len=:), allocatable :: line

    line = counted(to_text(self%now%step), 'step')//' by central differences'
  end function cost
end module explicit_steppers
