!> Stacks of layers, several at a time: constants of stacks with the same number of layers and of the same kind, lane
!> first, and their jumps, losses and surfaces.
module stack_batches
  use element_batches, only: lanes
  use cohesive_interfaces, only: cohesive_interfaces_t
  use interface_stacks, only: interface_stacks_t, jump_history_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: nodal_inertia_t
  use stack_lanes, only: jump_lanes_t, load_states, set_surfaces, store_friction, surface_lanes_t, surface_states_t
  implicit none
  private
  public :: stack_batch_t, stack_batches_t, new_stack_batches

  !> Stacks, and their constants in a step of the present length. They are many because lanes are computed from copies.
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
    !> Twice the energy below which damage neither starts nor grows, of undamaged stacks only, (lanes, n)
    real(wp), allocatable :: min_onset(:, :)
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
  pure function new_stack_batches(stacks, inertia, plate, cohesive, constrained) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
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
      call join(self, i, constrained(i), stacks, inertia, plate, cohesive)
    end do
    self%damaged = count(stacks%damaged)
  end function new_stack_batches

  !> Moves stacks that have become damaged to batches of damaged stacks.
  pure subroutine move_damaged(self, stacks, inertia, plate, cohesive)
    class(stack_batches_t), intent(inout) :: self
    !> The stacks; receive the history of the jumps of these batches
    type(interface_stacks_t), intent(inout) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
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
        call set_lanes(self%list(b), lane, lane, self%list(b)%stack(self%list(b)%members), stacks, inertia, plate, &
                       cohesive)
        self%list(b)%members = self%list(b)%members - 1
        call join(self, i, self%list(b)%constrained, stacks, inertia, plate, cohesive)
      end do
    end do
  end subroutine move_damaged

  !> Adds a stack to a batch with free lanes, or to a new one, which it fills.
  pure subroutine join(self, i, constrained, stacks, inertia, plate, cohesive)
    type(stack_batches_t), intent(inout) :: self
    !> Index of the stack
    integer, intent(in) :: i
    !> True: frames or lines constrain layers
    logical, intent(in) :: constrained
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
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
        call set_lanes(batch, batch%members, last, i, stacks, inertia, plate, cohesive)
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
    if (.not. damaged) allocate (self%min_onset(lanes, n))
    if (.not. damaged) return
    allocate (self%states(n))
    associate (its => self%surfaces)
      allocate (its%area(lanes, n), its%shear(lanes, n), its%opening(lanes, n), its%closing(lanes, n), &
                its%toughness(lanes, n), its%failure_ratio(lanes, n), its%friction(lanes, n), its%contact(lanes, n))
    end associate
  end subroutine allocate_batch

  !> Sets the constants of lanes.
  pure subroutine set_lanes(self, from, to, i, stacks, inertia, plate, cohesive)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane, and index of the stack
    integer, intent(in) :: from, to, i
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
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
      if (self%damaged) call set_surfaces(self%surfaces, lane, self%n, p, stacks, plate)
    end do
    call self%jumps%load(self%first, from, to, stacks%history)
    if (self%damaged) call load_states(self%states, self%first, from, to, cohesive, stacks%history)
    call set_laws(self, from, to, stacks, cohesive)
  end subroutine set_lanes

  !> Sets what flaws and fronts change in lanes: the reductions of laws, or the onset of damage.
  pure subroutine set_laws(self, from, to, stacks, cohesive)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane
    integer, intent(in) :: from, to
    type(interface_stacks_t), intent(in) :: stacks
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: lane, j, p

    do j = 1, self%n
      do lane = from, to
        p = self%first(lane) + j
        if (self%damaged) then
          self%states(j)%part(lane) = cohesive%opening(p)
          self%states(j)%opening(lane) = cohesive%opening(p)*self%surfaces%opening(lane, j)
          self%states(j)%failure_ratio(lane) = self%surfaces%failure_ratio(lane, j)/cohesive%strength(p)**2
        else
          self%min_onset(lane, j) = stacks%min_onset(p)
        end if
      end do
    end do
  end subroutine set_laws

  !> Updates the laws of all stacks, after flaws or fronts may have reduced them.
  pure subroutine update_laws(self, stacks, cohesive)
    class(stack_batches_t), intent(inout) :: self
    type(interface_stacks_t), intent(in) :: stacks
    type(cohesive_interfaces_t), intent(in) :: cohesive
    integer :: b

    do b = 1, self%filled
      call set_laws(self%list(b), 1, lanes, stacks, cohesive)
    end do
  end subroutine update_laws

  !> Stores the history of all stacks at their points, except for the damage, which is there.
  pure subroutine store(self, history)
    class(stack_batches_t), intent(in) :: self
    type(jump_history_t), intent(inout) :: history
    integer :: b

    do b = 1, self%filled
      associate (batch => self%list(b))
        call batch%jumps%store(batch%first, 1, batch%members, history)
        if (batch%damaged) call store_friction(batch%states, batch%first, batch%members, history)
      end associate
    end do
  end subroutine store

  !> Loads the jumps of all stacks, after others have changed them at the points.
  pure subroutine load(self, history)
    class(stack_batches_t), intent(inout) :: self
    type(jump_history_t), intent(in) :: history
    integer :: b

    do b = 1, self%filled
      call self%list(b)%jumps%load(self%list(b)%first, 1, lanes, history)
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
end module stack_batches
