!> Central differences: explicit motion of layers, with interface tractions implicit at each node, no global system.
!>
!> Velocities are those at the middle of steps, from the forces F at the start of a step,
!>   v(n+1/2) = v(n-1/2) + h M^-1 (F(n) - B^T lambda(n)),   u(n+1) = u(n) + h v(n+1/2),
!> followed by the forces at its end (K. J. Bathe, Finite Element Procedures, 1996, section 9.2.1). The tractions lambda
!> on the jumps B u are those of weighted jumps, which include the jumps at the end of the step (`weighted_jumps`).
module central_differences
  use archives, only: archive_t
  use batch_strains, only: depends_on_slopes
  use central_difference_parameters, only: central_difference_parameters_t
  use field_mappings, only: motion_field
  use impactor_steps, only: impactor_steps_t
  use front_onsets, only: front_onsets_t, create_front_onsets
  use inertia_scaling, only: inertia_scaling_t, create_inertia_scaling
  use interface_stacks, only: create_interface_stacks
  use kinds, only: wp
  use line_steps, only: create_line_steps
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use nodal_inertia, only: create_nodal_inertia
  use element_batches, only: lanes
  use rank_totals, only: total_of
  use rig_steps, only: add_clamp_forces, create_rig_steps
  use section_bounds, only: largest_stiffness
  use stable_steps, only: find_sprung_elements, find_stiffened_frequency, highest_element_frequency, sprung_elements_t
  use stack_motions, only: move_stacks, nodal_steps_t
  use states, only: state_t
  use step_lengths, only: allow_for, commensurate_step, lengthening_ratio, step_lengths_t
  use struck_patches, only: create_struck_patch
  implicit none
  private
  public :: central_difference_t

  !> Steps between two updates of the highest frequency by slopes and membrane tension.
  integer, parameter :: steps_between_frequencies = 16
  !> Fraction of a step by which a sum of n steps, with a round-off of up to n**2/1e16 steps, may miss an event.
  real(wp), parameter :: event_tolerance = 1.0e-3_wp

  !> Data of the method that are not part of the state, many because each of nodes, lines and impactor has a rule.
  type, extends(nodal_steps_t) :: central_difference_t
    type(central_difference_parameters_t) :: parameters
    !> The impactor and its patch
    type(impactor_steps_t) :: impact
    !> Search for onsets of damage by energy
    type(front_onsets_t), private :: onsets
    !> Step for which inertia and stacks are prepared
    type(step_lengths_t), private :: prepared
    !> Highest frequency of the undeformed elements, and with slopes and tension that allowed for by the step
    real(wp) :: frequency = 0, stiffened = 0
    !> Frequency that slopes and tension add below the impactor, allowed for, and elements there with contact springs
    real(wp), private :: sloped = 0
    type(sprung_elements_t), private :: sprung
    !> Square of the highest frequency of each undeformed element, (lanes, batches)
    real(wp), allocatable, private :: of_elements(:, :)
    !> Element with the highest frequency
    integer :: element = 0
    !> Strain energy of this rank's elements, (lanes, batches)
    real(wp), allocatable :: strain(:, :)
    !> Work of loads before the run began
    real(wp) :: initial_work = 0
    !> Motion of the layers
    real(wp), allocatable :: motion(:, :)
    !> Work array: forces including those at borders between ranks
    real(wp), allocatable, private :: field(:, :)
  contains
    procedure :: start
    procedure :: longest_step
    procedure :: advance
    procedure :: find_forces
    procedure :: add_loads
    procedure :: renew_forces
    procedure :: record_failures
    procedure :: resume
    procedure :: visit
  end type central_difference_t

contains

  !> Initializes for a state. Collective.
  subroutine start(self, model, parameters, now)
    class(central_difference_t), intent(out) :: self
    type(model_t), intent(in) :: model
    type(central_difference_parameters_t), intent(in) :: parameters
    !> The state; receives the forces
    type(state_t), intent(inout) :: now
    type(inertia_scaling_t) :: scaling

    self%parameters = parameters
    scaling = create_inertia_scaling(model%plate%setup, parameters%mass_scaling)
    self%inertia = create_nodal_inertia(model, scaling)
    call self%inertia%invert(0.0_wp)
    call highest_element_frequency(model%plate, largest_stiffness(now%plies), scaling, self%frequency, self%element, &
                                   self%of_elements)
    self%stiffened = self%frequency
    self%stacks = create_interface_stacks(model, now%interfaces%cohesive, self%inertia)
    self%rigs = create_rig_steps(model)
    self%lines = create_line_steps(model, self%inertia)
    self%onsets = create_front_onsets(model%plate)
    self%impact%velocity = now%impact%impactor%velocity
    self%impact%patch = create_struck_patch(model)
    self%impact%patch%offset = merge(-now%impact%patch%touched_at, now%impact%patch%offset, allocated(model%nose))
    self%impact%patch%inverse = self%impact%patch%points%gathered(model%plate%communicator, &
                                                                  self%inertia%inverse_of_images())
    call find_sprung_elements(model%plate, largest_stiffness(now%plies), scaling, self%impact%patch%points%local, &
                              self%sprung)
    allocate (self%force(5, size(model%plate%distribution%points)), self%field(5, model%plate%borders%columns), &
              self%strain(lanes, model%plate%elements%batches), source=0.0_wp)
    self%motion = self%force
    self%initial_work = now%ledger%external_work
    call self%find_forces(model, now)
    call self%add_loads(model, now, [0.0_wp, 0.0_wp])
  end subroutine start

  !> Stable step of elements and contact times step_factor, theory (T6). Elements below the impactor have the springs
  !> of the contact on w.
  real(wp) function longest_step(self, plate, now) result(step)
    class(central_difference_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    real(wp) :: frequency, sloped, square

    if (depends_on_slopes(plate%elements, plate%setup%mesh%kinematics) .and. &
        modulo(now%step, steps_between_frequencies) == 0) then
      call find_stiffened_frequency(plate, largest_stiffness(now%plies), self%of_elements, self%motion, frequency, &
                                    self%sprung, sloped)
      call allow_for(frequency, self%stiffened)
      call allow_for(sloped, self%sloped)
    end if
    square = self%stiffened**2
    if (plate%setup%impactor%is_present) &
      square = max(square, self%sloped**2 &
                           + self%sprung%bound(self%impact%allowed_square(plate, now%impact%indentation)))
    step = self%parameters%stable_step(sqrt(square))
  end function longest_step

  !> Takes one step. Its length changes only where the stable step requires it, as alternating lengths excite the
  !> highest modes (R. D. Skeel, BIT 33 (1993) 172-175); steps therefore do not end exactly at events, but an event is
  !> handled by the first step that reaches it. Collective.
  subroutine advance(self, model, event, kept, now)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Time not to be exceeded, and factor by which damping has multiplied the velocities before the step
    real(wp), intent(in) :: event, kept
    type(state_t), intent(inout) :: now
    real(wp), allocatable :: rates(:, :)
    real(wp) :: step, longest, factors(2)

    step = self%steps%now
    longest = self%longest_step(model%plate, now)
    if (.not. (step <= longest .and. step > lengthening_ratio*longest)) &
      step = commensurate_step(model%plate%setup%loading%ramp_time, longest)
    self%steps = step_lengths_t(now=step, last=self%steps%now, kept=kept)
    call prepare(self, model%plate)
    factors = [now%load_factor, model%plate%setup%load_factor_at(now%time + step)]
    associate (plate => model%plate, u => now%motion%displacement, v => now%motion%velocity)
      call self%lines%find_rates(model, self%steps, factors(2), plate%setup%offset_left(now%time + step), self%motion)
      call plate%profile%enter('nodes')
      if (allocated(self%inertia%springs)) then
        call self%inertia%add_spring_forces(step, u, v, self%force)
        rates = v(:, self%inertia%sprung)
      end if
      call change_length(self, plate, v, -1)
      call move_stacks(self%nodal_steps_t, plate, now%interfaces%cohesive, u, v)
      if (allocated(self%inertia%springs)) call self%rigs%record_springs(self%inertia, self%steps, rates, v)
      call self%rigs%circles%constrain(plate, self%steps, u(3, :), v(3, :))
      call self%inertia%move_dependents(u)
      call self%inertia%move_dependents(v)
      call self%stacks%copy_to_dependents(self%inertia, now%interfaces%cohesive)
      call change_length(self, plate, v, 1)
      call self%onsets%find(plate, now%step, self%stacks, now%interfaces%cohesive, u)
      call plate%profile%leave()
      call plate%halo%update(u)
    end associate
    now%time = now%time + step
    if (abs(now%time - event) <= event_tolerance*step) now%time = event
    now%step = now%step + 1
    now%load_factor = factors(2)
    call self%impact%move(model, self%steps, now)
    call self%find_forces(model, now)
    call add_loads(self, model, now, factors)
  end subroutine advance

  !> Records the change of energy by a change of the step length: the kinetic energy at the end of a step contains the
  !> force at that time over half of the step (`step_lengths`). Before the first step the length is zero; the change is
  !> then the energy of the initial state, -h^2 F M^-1 F/8 at rest, and is recorded as external work, not as
  !> dissipation. Collective.
  subroutine change_length(self, plate, v, sign)
    type(central_difference_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Rates of the unknowns before the step or after it, (5, points)
    real(wp), contiguous, intent(in) :: v(:, :)
    !> -1 before the step, 1 after it
    integer, intent(in) :: sign
    real(wp), allocatable :: change(:)

    if (.not. abs(self%steps%now - self%steps%last) > 0) return
    change = sign*(self%steps%now - self%steps%last)/4*sum(self%force*plate%motion_of(v), 1)
    if (self%steps%last > 0) then
      self%rigs%step_loss = self%rigs%step_loss + change
    else
      self%initial_work = self%initial_work - plate%mesh%multiplicity* &
                          total_of(plate%communicator, change(:plate%distribution%owned))
    end if
  end subroutine change_length

  !> Computes the inverse inertia for the step length, with which batches of stacks are formed anew.
  subroutine prepare(self, plate)
    type(central_difference_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate

    if (abs(self%prepared%now - self%steps%now) <= 0 .and. abs(self%prepared%last - self%steps%last) <= 0) return
    call self%inertia%invert(self%steps%now*self%steps%mean())
    call self%lines%project(self%inertia%inverse)
    call self%rigs%circles%prepare(plate, self%inertia%inverse(7, :))
    self%impact%patch%inverse = self%impact%patch%points%gathered(plate%communicator, self%inertia%inverse_of_images())
    if (allocated(self%batches)) deallocate (self%batches)
    self%prepared = self%steps
  end subroutine prepare

  !> Finds the forces on the layers. Collective.
  subroutine find_forces(self, model, now)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The state; its plies soften
    type(state_t), intent(inout) :: now

    call model%plate%profile%enter('element forces')
    call multiply(size(self%motion), 1.0_wp, now%motion%displacement, self%motion)
    if (model%plate%map%layered) call model%plate%map%to_motion(self%motion)
    self%field = 0
    call now%plies%note_step(self%steps%now)
    call now%plies%add_layer_forces(model%plate, self%motion, self%field, self%strain)
    call model%plate%borders%add(self%field)
    call multiply(size(self%force), -1.0_wp, self%field, self%force)
    call model%plate%profile%leave()
    associate (patch => self%impact%patch)
      self%force(3, :) = self%force(3, :) + patch%points%to_local( &
        now%impact%force/model%plate%mesh%multiplicity*patch%weights, size(self%force, 2))
    end associate
    call add_clamp_forces(model, self%force)
    call self%inertia%fold(self%force)
  end subroutine find_forces

  !> A field times a factor, in one loop over all of its values.
  pure subroutine multiply(values, factor, field, product)
    !> Number of values, the first of the field
    integer, intent(in) :: values
    !> The factor and the field
    real(wp), intent(in) :: factor, field(values)
    !> The field times the factor
    real(wp), intent(out) :: product(values)

    product = factor*field
  end subroutine multiply

  !> Adds the forces of pressure and lines to those on the layers, and records their work in the step.
  subroutine add_loads(self, model, now, load_factors)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> Ramps over their full values at the start and at the end of the step
    real(wp), intent(in) :: load_factors(2)
    real(wp), allocatable :: loads(:, :), change(:, :)
    real(wp) :: amplitudes(2)

    if (.not. (allocated(model%loads%pressure) .or. any(.not. model%loads%lines%load%prescribed))) return
    allocate (loads(5, size(self%force, 2)), source=0.0_wp)
    change = self%steps%now*model%plate%motion_of(now%motion%velocity)
    call self%lines%add_forces(model, load_factors, change, loads)
    if (allocated(model%loads%pressure)) then
      amplitudes = model%plate%setup%pressure%amplitude([now%time - self%steps%now, now%time])
      loads = loads + amplitudes(2)*model%loads%pressure
      self%lines%work = self%lines%work + sum(amplitudes)/2*model%loads%pressure(3, :)*change(3, :)
    end if
    call self%inertia%fold(loads)
    self%force = self%force + loads
  end subroutine add_loads

  !> Records the strain energy dissipated by failed plies, and computes the remaining forces. Collective.
  subroutine record_failures(self, model, now)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(inout) :: now
    real(wp) :: lost

    lost = total_of(model%plate%communicator, self%strain)
    call self%renew_forces(model, now)
    lost = lost - total_of(model%plate%communicator, self%strain)
    now%ledger%ply_damage = now%ledger%ply_damage + lost*model%plate%mesh%multiplicity
  end subroutine record_failures

  !> Computes the forces again after failures of plies or insertion of layers, without work of the loads. Collective.
  subroutine renew_forces(self, model, now)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(inout) :: now
    real(wp) :: work(size(self%force, 2))

    call self%find_forces(model, now)
    work = self%lines%work
    call self%add_loads(model, now, [now%load_factor, now%load_factor])
    self%lines%work = work
  end subroutine renew_forces

  !> Resumes from a loaded state, with the onset energies of its flaws. Collective.
  subroutine resume(self, model, now)
    class(central_difference_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now

    call self%stacks%find_onsets(model, now%interfaces%cohesive)
    call self%stacks%find_damaged(now%interfaces%cohesive)
    if (allocated(self%batches)) deallocate (self%batches)
    self%motion = model%plate%motion_of(now%motion%displacement)
    self%prepared = step_lengths_t()
    if (self%steps%now > 0) call prepare(self, model%plate)
  end subroutine resume

  !> Saves or loads.
  subroutine visit(self, archive, model)
    class(central_difference_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model

    call archive%item('explicit/step', self%steps%now)
    call archive%item('explicit/step_before', self%steps%last)
    call archive%item('explicit/initial_work', self%initial_work)
    call archive%item('explicit/frequency', self%stiffened)
    self%stiffened = max(self%stiffened, self%frequency)
    call archive%item('explicit/sloped', self%sloped)
    call model%plate%visit_points(archive, 'explicit/forces', self%force, motion_field)
    call self%rigs%visit(archive, model%plate)
    call self%impact%visit(archive)
    if (size(model%loads%lines) > 0 .or. allocated(model%loads%pressure) .or. model%plate%setup%initial%is_inherited) &
      call self%lines%visit(archive, model%plate)
    if (model%plate%map%layered) call self%stacks%visit(archive, model%plate)
  end subroutine visit
end module central_differences
