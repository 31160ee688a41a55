!> State of a run. A step is computed in a second state of this type, which replaces the first if it is accepted: a
!> rejected step has no effect.
module states
  use field_mappings, only: motion_field
  use kinds, only: wp
  use archives, only: archive_t
  use contact_loading, only: loading_indentation
  use impactors, only: new_impactor, impactor_energy
  use impact_states, only: impact_state_t
  use energy_ledgers, only: ledger_t
  use load_paths, only: load_path_t
  use motions, only: motion_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use ply_failures, only: ply_failure_t, new_ply_failure
  use interface_states, only: interface_state_t, new_interface_state
  implicit none
  private
  public :: state_t, new_state

  !> Name of the time in checkpoints.
  character(len=*), parameter, public :: time_item = 'time'

  !> Iterations of equilibrium, of the contact force and of the contact pressures.
  type :: iteration_counts_t
    !> Iterations of each
    integer :: equilibrium = 0, force = 0, contact = 0
  end type iteration_counts_t

  !> The state of plate, impactor and contact at one time.
  type :: state_t
    !> Time, or load factor of a static analysis
    real(wp) :: time = 0
    !> Accepted steps
    integer :: step = 0
    !> Ramps of lines over their full values; in a static analysis all loads
    real(wp) :: load_factor = 0
    !> Last step on the path of a static analysis
    type(load_path_t) :: path
    !> Motion of the plate
    type(motion_t) :: motion
    !> The impactor, its contact and the response at the struck point
    type(impact_state_t) :: impact
    !> Failures of the plies and the reduced stiffness
    type(ply_failure_t) :: plies
    type(interface_state_t) :: interfaces
    !> Reactions of prescribed lines of the full plate in explicit steps, (lines)
    real(wp), allocatable :: line_reactions(:)
    !> The energy ledger
    type(ledger_t) :: ledger
    !> Iterations of the last step, and their sums over all steps
    type(iteration_counts_t) :: iterations, all_iterations
    !> True: plies and interfaces keep their damage, as a state mapped to this mesh comes to equilibrium
    logical :: holds_damage = .false.
    !> Largest forces so far, the reference of the residual when forces are small: translations, rotations
    real(wp) :: largest_forces(2) = 0
  contains
    procedure :: start_from
    procedure :: find_internal
    procedure :: contact_deflection
    procedure :: has_failures
    procedure :: hold_damage
    procedure :: count_step
    procedure :: record_path
    procedure :: visit
  end type state_t

contains

  !> The plate at rest, the impactor at first contact.
  function new_state(model) result(self)
    type(model_t), intent(in) :: model
    type(state_t) :: self
    real(wp) :: energy
    integer :: points

    points = size(model%plate%distribution%points)
    allocate (self%motion%displacement(5, points), self%motion%velocity(5, points), &
              self%motion%acceleration(5, points), self%motion%internal(5, points), &
              self%motion%inertia(5, points), self%motion%momentum(5, points), source=0.0_wp)
    self%plies = new_ply_failure(model%plate)
    self%interfaces = new_interface_state(model)
    ! Clamps with a force are in equilibrium with the frame from the start.
    energy = 0
    call self%interfaces%rig%add_springs(model, self%motion%displacement, self%motion%internal, energy)
    self%impact%patch = model%patch
    if (.not. model%plate%setup%moves_impactor()) return
    self%impact%impactor = new_impactor(model%plate%setup%impactor)
    self%ledger%impactor = impactor_energy(model%plate%setup%impactor, self%impact%impactor)
    self%ledger%initial = self%ledger%impactor
    ! Work of gravity until the contact carries the weight of the impactor, on a plate that does not deflect. The energy
    ! of an impactor placed on a plate at rest begins with zero, and its first steps are compared with this energy.
    associate (weight => model%plate%setup%impactor%mass*model%plate%setup%impactor%gravity)
      if (weight > 0) &
        self%ledger%largest = weight*loading_indentation(model%plate%setup%impactor%indentation, weight)
    end associate
  end function new_state

  !> Copies the state from which a step starts; of the motion only the displacement, as velocity, acceleration and
  !> forces are computed by the step.
  pure subroutine start_from(self, plate, old)
    class(state_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The state copied
    type(state_t), intent(in) :: old

    self%time = old%time
    self%step = old%step
    self%load_factor = old%load_factor
    self%path = old%path
    self%motion%displacement = old%motion%displacement
    self%impact = old%impact
    ! Plies change only by damage.
    if (plate%setup%ply_damage%is_present) self%plies = old%plies
    self%interfaces = old%interfaces
    self%ledger = old%ledger
    self%iterations = iteration_counts_t()
    self%all_iterations = old%all_iterations
    self%holds_damage = old%holds_damage
    self%largest_forces = old%largest_forces
  end subroutine start_from

  !> Internal forces of layers and cohesive interfaces, and their stored energy on this rank.
  subroutine find_internal(self, model, old, energy)
    !> The state with its displacement; receives the forces
    class(state_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: old
    !> Strain energy
    real(wp), intent(out) :: energy

    call self%plies%note_step(self%time - old%time)
    call self%plies%find_forces(model, self%motion%displacement, self%motion%internal, energy)
    call model%plate%profile%enter('interface law')
    call self%interfaces%cohesive%add_forces(model%plate, old%interfaces%cohesive, self%motion%displacement, &
                                             self%motion%internal, energy)
    call model%plate%profile%leave()
    call model%plate%profile%enter('contact and ties')
    call self%interfaces%rig%add_springs(model, self%motion%displacement, self%motion%internal, energy)
    call model%plate%profile%leave()
  end subroutine find_internal

  !> Deflection of the plate under the impactor, the same on every rank.
  real(wp) function contact_deflection(self, plate)
    class(state_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate

    contact_deflection = self%impact%patch%deflection(plate%communicator, self%motion%displacement)
  end function contact_deflection

  !> True once plies have failed or delaminations have grown.
  pure logical function has_failures(self)
    class(state_t), intent(in) :: self

    has_failures = self%ledger%ply_damage > 0 .or. self%ledger%delamination > 0
  end function has_failures

  !> Holds the damage of plies and interfaces, or lets it grow.
  pure subroutine hold_damage(self, holds)
    class(state_t), intent(inout) :: self
    !> True: damage does not grow
    logical, intent(in) :: holds

    self%holds_damage = holds
    self%plies%keeps_stiffness = holds
    self%interfaces%cohesive%is_held = holds
  end subroutine hold_damage

  !> Counts a step and its iterations.
  pure subroutine count_step(self, old)
    !> State at the end of the step
    class(state_t), intent(inout) :: self
    !> State at its start
    type(state_t), intent(in) :: old

    self%step = old%step + 1
    associate (all => self%all_iterations, before => old%all_iterations, now => self%iterations)
      all%equilibrium = before%equilibrium + now%equilibrium
      all%force = before%force + now%force
      all%contact = before%contact + now%contact
    end associate
  end subroutine count_step

  !> Stores the changes of a load step, and chooses the control of the next one: load or dissipated energy, whichever
  !> advanced by the larger fraction of its total. The run ends if a step under load control has dissipated all of it.
  pure subroutine record_path(self, old, dissipation)
    !> State at the end of the step
    class(state_t), intent(inout) :: self
    !> State at its start
    type(state_t), intent(in) :: old
    !> Energy dissipated at which the analysis ends
    real(wp), intent(in) :: dissipation

    self%path%change = self%motion%displacement - old%motion%displacement
    self%path%factor_change = self%load_factor - old%load_factor
    self%path%force_change = self%impact%force - old%impact%force
    self%path%dissipated = self%ledger%delamination - old%ledger%delamination
    self%path%by_dissipation = self%path%dissipated > dissipation*self%path%factor_change
    if (self%ledger%delamination >= dissipation) self%time = 1
  end subroutine record_path

  !> Saves or loads the state.
  subroutine visit(self, archive, model)
    class(state_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model

    call archive%item(time_item, self%time)
    call archive%item('step', self%step)
    call archive%item('load_factor', self%load_factor)
    call self%path%visit(archive, model%plate)
    call visit_motion(self%motion, archive, model%plate)
    call self%impact%visit(archive, model)
    call self%plies%visit(archive, model%plate)
    call self%interfaces%visit(archive, model)
    call self%ledger%visit(archive)
    call archive%item('holds_damage', self%holds_damage)
    if (archive%loading) call self%hold_damage(self%holds_damage)
    call archive%item('iterations', self%iterations%equilibrium)
    call archive%item('force_iterations', self%iterations%force)
    call archive%item('contact_iterations', self%iterations%contact)
    call archive%item('all_contact_iterations', self%all_iterations%contact)
    call archive%item('all_iterations', self%all_iterations%equilibrium)
    call archive%item('all_force_iterations', self%all_iterations%force)
    call archive%item('largest_forces/translation', self%largest_forces(1))
    call archive%item('largest_forces/rotation', self%largest_forces(2))
  end subroutine visit

  !> Saves or loads the motion of the plate.
  subroutine visit_motion(motion, archive, plate)
    type(motion_t), intent(inout) :: motion
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate

    call plate%visit_points(archive, 'motion/displacement', motion%displacement, motion_field)
    call plate%visit_points(archive, 'motion/velocity', motion%velocity, motion_field)
    call plate%visit_points(archive, 'motion/acceleration', motion%acceleration, motion_field)
    call plate%visit_points(archive, 'motion/internal', motion%internal, motion_field)
    call plate%visit_points(archive, 'motion/inertia', motion%inertia, motion_field)
    call plate%visit_points(archive, 'motion/momentum', motion%momentum, motion_field)
    if (.not. archive%loading) return
    call plate%halo%update(motion%displacement)
    call plate%halo%update(motion%velocity)
    call plate%halo%update(motion%acceleration)
  end subroutine visit_motion
end module states
