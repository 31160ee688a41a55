!> Stacks of layers, several at a time: constants of stacks with the same number of layers and of the same kind, lane
!> first, and what changes in a step besides the motion of the points: jumps, losses and surfaces. These stay with the
!> batches, and are stored at the points where others need them there.
module stack_batches
  use element_batches, only: lanes
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_points, only: cohesive_point_t
  use interface_stacks, only: friction_history_t, interface_stacks_t, jump_history_t
  use kinds, only: wp
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use surface_friction, only: sliding_t
  implicit none
  private
  public :: stack_batch_t, stack_batches_t, new_stack_batches, store_points

  !> Constants of the surfaces, (lanes, n) each, of laws without flaws.
  type, public :: surface_lanes_t
    !> Area
    real(wp), allocatable :: area(:, :)
    !> Stiffness of shear, opening and closing, pressure per jump
    real(wp), allocatable :: shear(:, :), opening(:, :), closing(:, :)
    !> The smaller toughness of the pure modes, and the ratio of the jumps at failure and at the onset
    real(wp), allocatable :: toughness(:, :), failure_ratio(:, :)
    !> Coefficient of friction
    real(wp), allocatable :: friction(:, :)
    !> True: surfaces do not penetrate each other
    logical, allocatable :: contact(:, :)
  end type surface_lanes_t

  !> Surfaces of an interface of damaged stacks, a value for each lane.
  type, public :: surface_states_t
    !> Damage, and energy dissipated per area
    real(wp) :: damage(lanes), dissipated(lanes)
    !> Slip, friction limit, and frictional heat per area
    real(wp) :: slip(lanes, 2), limit(lanes), heat(lanes)
    !> Factor of the stiffness of opening, that stiffness, and ratio of the jumps at failure and at the onset
    real(wp) :: part(lanes), opening(lanes), failure_ratio(lanes)
    !> Change of the elastic jumps of sticking surfaces in the last step, and in the one before
    real(wp) :: sticking(lanes, 4)
    !> Further steps whose forces depend on the last slip
    real(wp) :: steps(lanes)
    !> Change of the energy of sticking in the last step, and negative heat of earlier steps, per area
    real(wp) :: rubbing(lanes, 2)
    !> Work on the cohesive law in the last step
    real(wp) :: work(lanes)
    !> Jumps, and their change in the last step and in the one before
    real(wp) :: start(lanes, 3), last(lanes, 3), earlier(lanes, 3)
  end type surface_states_t

  !> Jumps of stacks in earlier steps.
  type, public :: jump_lanes_t
    !> Change of the jumps in the last step and in the one before, and forces on them in the last step, (lanes, 3, n)
    real(wp), allocatable :: last(:, :, :), earlier(:, :, :), forces(:, :, :)
    !> Energy dissipated by contact, and algorithmic dissipation, (lanes, 2, n)
    real(wp), allocatable :: lost(:, :, :)
  contains
    procedure :: load => load_jumps
    procedure :: store => store_jumps
  end type jump_lanes_t

  !> Stacks, and their constants in a step of the present length.
  type :: stack_batch_t
    !> Number of interfaces, and number of stacks
    integer :: n = 0, members = 0
    !> True: some interfaces are damaged. True: frames or lines constrain layers
    logical :: damaged = .false., constrained = .false.
    !> Stack and first point of each lane; others than those of the members are computed and not stored
    integer :: stack(lanes) = 0, first(lanes) = 0
    !> Height of the interface below each layer, (lanes, n)
    real(wp), allocatable :: height(:, :)
    !> Inverse inertia of the layers, (lanes, 7, n + 1)
    real(wp), allocatable :: inverse(:, :, :)
    !> Undamaged stiffness of shear and opening, force per jump, (lanes, 2, n)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Square of the step times the compliance of the layers, diagonal and off-diagonal entries, (lanes, 3, n)
    real(wp), allocatable :: diagonal(:, :, :), off_diagonal(:, :, :)
    !> Factors of the tridiagonal systems of undamaged stacks, (lanes, 2, 3, n)
    real(wp), allocatable :: factors(:, :, :, :)
    !> Surfaces, of damaged stacks only
    type(surface_lanes_t) :: surfaces
    !> Their states, (n)
    type(surface_states_t), allocatable :: states(:)
    !> Jumps in earlier steps
    type(jump_lanes_t), allocatable :: jumps
  end type stack_batch_t

  !> The batches of all stacks of this rank, in a step of the present length.
  type :: stack_batches_t
    !> The batches, with room for further ones
    type(stack_batch_t), allocatable :: list(:)
    !> Number of batches that have stacks, or had until these became damaged
    integer :: filled = 0
    !> Batch with free lanes for each number of layers and kind: 1 if constrained plus 2 if damaged; 0: none
    integer, allocatable, private :: open(:, :)
    !> Number of damaged stacks
    integer, private :: damaged = 0
  contains
    procedure :: move_damaged
    procedure :: update_laws
    procedure :: damp
    procedure :: store
    procedure :: load
  end type stack_batches_t

contains

  !> Batches of all stacks. Stacks of the same number of layers and of the same kind share batches.
  pure function new_stack_batches(stacks, inertia, model, cohesive, constrained) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> True for stacks with layers that frames or lines constrain
    logical, intent(in) :: constrained(:)
    type(stack_batches_t) :: self
    integer :: i, layers

    layers = maxval([1, stacks%layers])
    ! All stacks may become damaged. For each number of layers and kind, one batch has free lanes.
    allocate (self%list(2*(size(constrained)/lanes) + 6*layers), self%open(layers, 0:3))
    self%open = 0
    do i = 1, size(constrained)
      call join(self, i, constrained(i), stacks, inertia, model, cohesive)
    end do
    self%damaged = count(stacks%damaged)
  end function new_stack_batches

  !> Moves stacks that have become damaged to batches of damaged stacks.
  pure subroutine move_damaged(self, stacks, inertia, model, cohesive)
    class(stack_batches_t), intent(inout) :: self
    !> The stacks; receive the history of the jumps of these batches
    type(interface_stacks_t), intent(inout) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: b, lane, i

    if (count(stacks%damaged) == self%damaged) return
    self%damaged = count(stacks%damaged)
    do b = 1, self%filled
      if (self%list(b)%damaged) cycle
      associate (batch => self%list(b))
        if (.not. any(stacks%damaged(batch%stack(:batch%members)))) cycle
        call batch%jumps%store(batch%first, 1, batch%members, stacks%history)
      end associate
      do lane = self%list(b)%members, 1, -1
        i = self%list(b)%stack(lane)
        if (.not. stacks%damaged(i)) cycle
        ! The last stack takes its lane.
        call set_lanes(self%list(b), lane, lane, self%list(b)%stack(self%list(b)%members), stacks, inertia, model, &
                       cohesive)
        self%list(b)%members = self%list(b)%members - 1
        call join(self, i, self%list(b)%constrained, stacks, inertia, model, cohesive)
      end do
    end do
  end subroutine move_damaged

  !> Adds a stack to a batch with free lanes, or to a new one, which it fills.
  pure subroutine join(self, i, constrained, stacks, inertia, model, cohesive)
    type(stack_batches_t), intent(inout) :: self
    !> Index of the stack
    integer, intent(in) :: i
    !> True: frames or lines constrain layers
    logical, intent(in) :: constrained
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: last

    associate (open => self%open(stacks%layers(i), merge(1, 0, constrained) + merge(2, 0, stacks%damaged(i))))
      last = lanes
      if (open > 0) last = self%list(open)%members + 1
      if (open == 0 .or. last > lanes) then
        self%filled = self%filled + 1
        open = self%filled
        call allocate_batch(self%list(open), stacks%layers(i) - 1, stacks%damaged(i), constrained)
        last = lanes
      end if
      associate (batch => self%list(open))
        batch%members = batch%members + 1
        call set_lanes(batch, batch%members, last, i, stacks, inertia, model, cohesive)
      end associate
    end associate
  end subroutine join

  !> Allocates the constants of a batch.
  pure subroutine allocate_batch(self, n, damaged, constrained)
    type(stack_batch_t), intent(inout) :: self
    !> Number of interfaces
    integer, intent(in) :: n
    !> Kind of the stacks
    logical, intent(in) :: damaged, constrained

    self%n = n
    self%damaged = damaged
    self%constrained = constrained
    allocate (self%height(lanes, n), self%inverse(lanes, 7, n + 1), self%stiffness(lanes, 2, n), &
              self%diagonal(lanes, 3, n), self%off_diagonal(lanes, 3, n), self%factors(lanes, 2, 3, n), self%jumps)
    allocate (self%jumps%last(lanes, 3, n), self%jumps%earlier(lanes, 3, n), self%jumps%forces(lanes, 3, n), &
              self%jumps%lost(lanes, 2, n))
    if (.not. damaged) return
    allocate (self%states(n))
    associate (its => self%surfaces)
      allocate (its%area(lanes, n), its%shear(lanes, n), its%opening(lanes, n), its%closing(lanes, n), &
                its%toughness(lanes, n), its%failure_ratio(lanes, n), its%friction(lanes, n), its%contact(lanes, n))
    end associate
  end subroutine allocate_batch

  !> Sets the constants of lanes.
  pure subroutine set_lanes(self, from, to, i, stacks, inertia, model, cohesive)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane, and index of the stack
    integer, intent(in) :: from, to, i
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: lane, p

    p = stacks%first(i)
    do lane = from, to
      self%stack(lane) = i
      self%first(lane) = p
      self%height(lane, :) = stacks%height(p + 1:p + self%n)
      self%inverse(lane, :, :) = inertia%inverse(:, p:p + self%n)
      self%stiffness(lane, :, :) = stacks%stiffness(:, p + 1:p + self%n)
      self%diagonal(lane, :, :) = stacks%diagonal(:, p + 1:p + self%n)
      self%off_diagonal(lane, :, :) = stacks%off_diagonal(:, p + 1:p + self%n)
      self%factors(lane, :, :, :) = stacks%factors(:, :, p + 1:p + self%n)
      if (self%damaged) call set_surfaces(self%surfaces, lane, self%n, p, stacks, model)
    end do
    call self%jumps%load(self%first, from, to, stacks%history)
    if (self%damaged) call load_states(self, from, to, cohesive, stacks%history)
  end subroutine set_lanes

  !> Sets the surfaces of a lane.
  pure subroutine set_surfaces(self, lane, n, first, stacks, model)
    type(surface_lanes_t), intent(inout) :: self
    !> The lane, number of interfaces, and first point of the stack
    integer, intent(in) :: lane, n, first
    type(interface_stacks_t), intent(in) :: stacks
    type(model_t), intent(in) :: model
    integer :: j

    do j = 1, n
      associate (zone => model%zone(first + j))
        associate (law => model%cohesive_laws(zone))
          self%area(lane, j) = stacks%area(first + j)
          self%shear(lane, j) = law%stiffness_shear
          self%opening(lane, j) = law%stiffness_opening
          self%closing(lane, j) = law%stiffness_closing
          self%toughness(lane, j) = min(law%toughness_opening, law%toughness_shear)
          self%failure_ratio(lane, j) = law%failure_ratio
        end associate
        self%friction(lane, j) = model%setup%delaminations(zone)%friction
        self%contact(lane, j) = prevents_penetration(model, zone)
      end associate
    end do
  end subroutine set_surfaces

  !> Loads the states of the surfaces of lanes.
  pure subroutine load_states(self, from, to, cohesive, history)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane
    integer, intent(in) :: from, to
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(jump_history_t), intent(in) :: history
    integer :: lane, j, p

    do j = 1, self%n
      associate (state => self%states(j))
        do lane = from, to
          p = self%first(lane) + j
          associate (point => cohesive%points(p), friction => history%friction(p))
            state%damage(lane) = point%damage
            state%dissipated(lane) = point%dissipated
            state%slip(lane, :) = point%sliding%slip
            state%heat(lane) = point%sliding%heat
            state%steps(lane) = friction%steps
            state%rubbing(lane, :) = [friction%stored, friction%deficit]
          end associate
          state%sticking(lane, :) = history%sticking(:, p)
          state%work(lane) = history%work(p)
        end do
      end associate
    end do
    call set_laws(self, from, to, cohesive)
  end subroutine load_states

  !> Sets the reductions of the laws of lanes.
  pure subroutine set_laws(self, from, to, cohesive)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane
    integer, intent(in) :: from, to
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: lane, j, p

    do j = 1, self%n
      associate (state => self%states(j))
        do lane = from, to
          p = self%first(lane) + j
          state%part(lane) = cohesive%opening(p)
          state%opening(lane) = state%part(lane)*self%surfaces%opening(lane, j)
          state%failure_ratio(lane) = self%surfaces%failure_ratio(lane, j)/cohesive%strength(p)**2
        end do
      end associate
    end do
  end subroutine set_laws

  !> Updates the laws of all damaged stacks, after flaws or fronts may have reduced them.
  pure subroutine update_laws(self, cohesive)
    class(stack_batches_t), intent(inout) :: self
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: b

    do b = 1, self%filled
      if (self%list(b)%damaged) call set_laws(self%list(b), 1, lanes, cohesive)
    end do
  end subroutine update_laws

  !> Stores damage and friction of the surfaces of a damaged batch at their points.
  pure subroutine store_points(batch, states, cohesive)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    integer :: lane, j

    do j = 1, batch%n
      associate (state => states(j))
        do lane = 1, batch%members
          cohesive%points(batch%first(lane) + j) = &
            cohesive_point_t(state%damage(lane), state%dissipated(lane), &
                             sliding_t(state%slip(lane, :), state%limit(lane), state%heat(lane)))
        end do
      end associate
    end do
  end subroutine store_points

  !> Stores the history of all stacks at their points, except for the damage, which is there.
  pure subroutine store(self, history)
    class(stack_batches_t), intent(in) :: self
    type(jump_history_t), intent(inout) :: history
    integer :: b, lane, j, p

    do b = 1, self%filled
      associate (batch => self%list(b))
        call batch%jumps%store(batch%first, 1, batch%members, history)
        if (.not. batch%damaged) cycle
        do j = 1, batch%n
          do lane = 1, batch%members
            p = batch%first(lane) + j
            associate (state => batch%states(j))
              history%friction(p) = friction_history_t(nint(state%steps(lane)), state%rubbing(lane, 1), &
                                                       state%rubbing(lane, 2))
              history%sticking(:, p) = state%sticking(lane, :)
              history%work(p) = state%work(lane)
            end associate
          end do
        end do
      end associate
    end do
  end subroutine store

  !> Loads the jumps of all stacks, after others have changed them at the points.
  pure subroutine load(self, history)
    class(stack_batches_t), intent(inout) :: self
    type(jump_history_t), intent(in) :: history
    integer :: b

    do b = 1, self%filled
      associate (batch => self%list(b))
        call batch%jumps%load(batch%first, 1, lanes, history)
      end associate
    end do
  end subroutine load

  !> Reduces the work done in the last step, as `damp` of the history.
  pure subroutine damp(self, ratio)
    class(stack_batches_t), intent(inout) :: self
    !> Factor of the work
    real(wp), intent(in) :: ratio
    integer :: b, j

    do b = 1, self%filled
      if (.not. self%list(b)%damaged) cycle
      do j = 1, self%list(b)%n
        associate (state => self%list(b)%states(j))
          state%work = ratio*state%work
          state%rubbing(:, 1) = ratio*state%rubbing(:, 1)
        end associate
      end do
    end do
  end subroutine damp

  !> Loads the jumps of lanes from the points.
  pure subroutine load_jumps(self, first, from, to, history)
    class(jump_lanes_t), intent(inout) :: self
    !> First point of each lane, and first and last lane
    integer, intent(in) :: first(lanes), from, to
    type(jump_history_t), intent(in) :: history
    integer :: lane, j

    do j = 1, size(self%last, 3)
      do lane = from, to
        associate (p => first(lane) + j)
          self%last(lane, :, j) = history%change(:, p)
          self%earlier(lane, :, j) = history%earlier(:, p)
          self%forces(lane, :, j) = history%forces(:, p)
          self%lost(lane, :, j) = history%lost(:, p)
        end associate
      end do
    end do
  end subroutine load_jumps

  !> Stores the jumps of lanes at the points.
  pure subroutine store_jumps(self, first, from, to, history)
    class(jump_lanes_t), intent(in) :: self
    !> First point of each lane, and first and last lane
    integer, intent(in) :: first(lanes), from, to
    type(jump_history_t), intent(inout) :: history
    integer :: lane, j

    do j = 1, size(self%last, 3)
      do lane = from, to
        associate (p => first(lane) + j)
          history%change(:, p) = self%last(lane, :, j)
          history%earlier(:, p) = self%earlier(lane, :, j)
          history%forces(:, p) = self%forces(lane, :, j)
          history%lost(:, p) = self%lost(lane, :, j)
        end associate
      end do
    end do
  end subroutine store_jumps
end module stack_batches
