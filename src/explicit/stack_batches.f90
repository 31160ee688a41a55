!> Stacks of layers, several at a time: constants of stacks with the same number of layers and of the same kind, lane
!> first, and the states of their surfaces.
module stack_batches
  use element_batches, only: lanes
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_points, only: cohesive_point_t
  use interface_stacks, only: interface_stacks_t, jump_history_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: along_x, along_y, along_z, nodal_inertia_t
  use surface_friction, only: sliding_t
  use tridiagonal_systems, only: factorize
  use weighted_jumps, only: newest
  implicit none
  private
  public :: stack_batch_t, stack_batches_t, new_stack_batches, load_states, store_states

  !> Constants of the surfaces of an interface of damaged stacks, a value for each lane, of laws without flaws.
  type, public :: surface_lanes_t
    !> Area
    real(wp) :: area(lanes)
    !> Stiffness of shear, opening and closing, pressure per jump
    real(wp) :: shear(lanes), opening(lanes), closing(lanes)
    !> The smaller toughness of the pure modes, and the ratio of the jumps at failure and at the onset
    real(wp) :: toughness(lanes), failure_ratio(lanes)
    !> Coefficient of friction
    real(wp) :: friction(lanes)
    !> True: they do not penetrate each other
    logical :: contact(lanes)
  end type surface_lanes_t

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
    !> Surfaces, of damaged stacks only, (n)
    type(surface_lanes_t), allocatable :: surfaces(:)
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
    !> Product of the step and the mean of it and the step before
    real(wp), private :: step_square = 0
  contains
    procedure :: move_damaged
  end type stack_batches_t

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
    !> Data of earlier steps of friction, as in jump_history_t
    real(wp) :: rubbing(lanes, 3)
    !> Work on the cohesive law in the last step
    real(wp) :: work(lanes)
    !> Jumps, and their change in the last step and in the one before
    real(wp) :: start(lanes, 3), last(lanes, 3), earlier(lanes, 3)
  end type surface_states_t

contains

  !> Batches of all stacks. Stacks of the same number of layers and of the same kind share batches.
  pure function new_stack_batches(stacks, inertia, plate, constrained, step_square) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
    !> True for stacks with layers that frames or lines constrain
    logical, intent(in) :: constrained(:)
    !> Product of the step and the mean of it and the step before
    real(wp), intent(in) :: step_square
    type(stack_batches_t) :: self
    integer :: i, layers

    layers = maxval([1, stacks%layers])
    ! All stacks may become damaged. For each number of layers and kind, one batch has free lanes.
    allocate (self%list(2*(size(constrained)/lanes) + 6*layers), self%open(layers, 0:3))
    self%open = 0
    self%step_square = step_square
    do i = 1, size(constrained)
      call join(self, i, constrained(i), stacks, inertia, plate)
    end do
    self%damaged = count(stacks%damaged)
  end function new_stack_batches

  !> Moves stacks that have become damaged to batches of damaged stacks.
  pure subroutine move_damaged(self, stacks, inertia, plate)
    class(stack_batches_t), intent(inout) :: self
    type(interface_stacks_t), intent(in) :: stacks
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
    integer :: b, lane, i

    if (count(stacks%damaged) == self%damaged) return
    self%damaged = count(stacks%damaged)
    do b = 1, self%filled
      if (self%list(b)%damaged) cycle
      do lane = self%list(b)%members, 1, -1
        i = self%list(b)%stack(lane)
        if (.not. stacks%damaged(i)) cycle
        ! The last stack takes its lane.
        call set_lanes(self%list(b), lane, lane, self%list(b)%stack(self%list(b)%members), stacks, inertia, plate, &
                       self%step_square)
        self%list(b)%members = self%list(b)%members - 1
        call join(self, i, self%list(b)%constrained, stacks, inertia, plate)
      end do
    end do
  end subroutine move_damaged

  !> Adds a stack to a batch with free lanes, or to a new one, which it fills.
  pure subroutine join(self, i, constrained, stacks, inertia, plate)
    type(stack_batches_t), intent(inout) :: self
    !> Index of the stack
    integer, intent(in) :: i
    !> True: frames or lines constrain layers
    logical, intent(in) :: constrained
    type(interface_stacks_t), intent(in) :: stacks
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
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
        call set_lanes(batch, batch%members, last, i, stacks, inertia, plate, self%step_square)
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
              self%diagonal(lanes, 3, n), self%off_diagonal(lanes, 3, n), self%factors(lanes, 2, 3, n))
    if (damaged) allocate (self%surfaces(n))
  end subroutine allocate_batch

  !> Sets the constants of lanes.
  pure subroutine set_lanes(self, from, to, i, stacks, inertia, plate, step_square)
    type(stack_batch_t), intent(inout) :: self
    !> First and last lane, and index of the stack
    integer, intent(in) :: from, to, i
    type(interface_stacks_t), intent(in) :: stacks
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
    !> Product of the step and the mean of it and the step before
    real(wp), intent(in) :: step_square
    integer :: lane, p

    p = stacks%first(i)
    do lane = from, to
      self%stack(lane) = i
      self%first(lane) = p
      self%height(lane, :) = stacks%height(p + 1:p + self%n)
      self%inverse(lane, :, :) = inertia%inverse(:, p:p + self%n)
      self%stiffness(lane, :, :) = stacks%stiffness(:, p + 1:p + self%n)
      call couple(self, lane, step_square)
      if (self%damaged) call set_surfaces(self%surfaces, lane, p, stacks, plate)
    end do
  end subroutine set_lanes

  !> Compliances of the layers between the interfaces of a lane, and factors of an undamaged stack.
  pure subroutine couple(self, lane, step_square)
    type(stack_batch_t), intent(inout) :: self
    !> The lane
    integer, intent(in) :: lane
    !> Product of the step and the mean of it and the step before
    real(wp), intent(in) :: step_square
    real(wp) :: upper(7), lower(7), next
    integer :: j, k

    do j = 1, self%n
      upper = self%inverse(lane, :, j)
      lower = self%inverse(lane, :, j + 1)
      associate (z => self%height(lane, j))
        self%diagonal(lane, :, j) = step_square*[coupling(upper(along_x:), z, z) + coupling(lower(along_x:), z, z), &
                                                 coupling(upper(along_y:), z, z) + coupling(lower(along_y:), z, z), &
                                                 upper(along_z) + lower(along_z)]
        self%off_diagonal(lane, :, j) = 0
        if (j == self%n) exit
        next = self%height(lane, j + 1)
        self%off_diagonal(lane, :, j) = -step_square*[coupling(lower(along_x:), z, next), &
                                                      coupling(lower(along_y:), z, next), lower(along_z)]
      end associate
    end do
    do k = 1, 3
      call factorize(newest*self%stiffness(lane, merge(2, 1, k == 3), :), self%diagonal(lane, k, :), &
                     self%off_diagonal(lane, k, :), self%factors(lane, :, k, :))
    end do
  end subroutine couple

  !> Displacement of a layer at one height by a unit force at another, divided by the square of the time, theory (T8).
  pure real(wp) function coupling(inverse, z1, z2)
    !> Inverse inertia of displacement, of both, of rotation
    real(wp), intent(in) :: inverse(3)
    !> The heights
    real(wp), intent(in) :: z1, z2

    coupling = inverse(1) + inverse(2)*(z1 + z2) + inverse(3)*z1*z2
  end function coupling

  !> Sets the surfaces of a lane.
  pure subroutine set_surfaces(surfaces, lane, first, stacks, plate)
    !> One for each interface
    type(surface_lanes_t), intent(inout) :: surfaces(:)
    !> The lane, and first point of the stack
    integer, intent(in) :: lane, first
    type(interface_stacks_t), intent(in) :: stacks
    type(composite_plate_t), intent(in) :: plate
    integer :: j

    do j = 1, size(surfaces)
      associate (surface => surfaces(j), zone => plate%zone(first + j))
        associate (law => plate%interfaces%cohesive_laws(zone))
          surface%area(lane) = stacks%area(first + j)
          surface%shear(lane) = law%stiffness_shear
          surface%opening(lane) = law%stiffness_opening
          surface%closing(lane) = law%stiffness_closing
          surface%toughness(lane) = min(law%toughness_opening, law%toughness_shear)
          surface%failure_ratio(lane) = law%failure_ratio
        end associate
        surface%friction(lane) = plate%setup%delaminations(zone)%friction
        surface%contact(lane) = prevents_penetration(plate, zone)
      end associate
    end do
  end subroutine set_surfaces

  !> Loads the surfaces of a damaged batch.
  pure subroutine load_states(batch, cohesive, history, jumps, last, earlier, states)
    type(stack_batch_t), intent(in) :: batch
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(jump_history_t), intent(in) :: history
    !> Jumps, and their change in the last step and in the one before
    real(wp), dimension(lanes, 3, batch%n), intent(in) :: jumps, last, earlier
    type(surface_states_t), intent(out) :: states(batch%n)
    integer :: lane, j, p

    do j = 1, batch%n
      associate (state => states(j))
        do lane = 1, lanes
          p = batch%first(lane) + j
          associate (point => cohesive%points(p))
            state%damage(lane) = point%damage
            state%dissipated(lane) = point%dissipated
            state%slip(lane, :) = point%sliding%slip
            state%heat(lane) = point%sliding%heat
          end associate
          state%part(lane) = cohesive%opening(p)
          state%failure_ratio(lane) = batch%surfaces(j)%failure_ratio(lane)/cohesive%strength(p)**2
          state%sticking(lane, :) = history%sticking(:, p)
          state%rubbing(lane, :) = history%rubbing(:, p)
          state%work(lane) = history%work(p)
        end do
        state%opening = state%part*batch%surfaces(j)%opening
        state%start = jumps(:, :, j)
        state%last = last(:, :, j)
        state%earlier = earlier(:, :, j)
      end associate
    end do
  end subroutine load_states

  !> Stores the surfaces of a damaged batch.
  pure subroutine store_states(batch, states, cohesive, history)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    type(jump_history_t), intent(inout) :: history
    integer :: lane, j, p

    do j = 1, batch%n
      associate (state => states(j))
        do lane = 1, batch%members
          p = batch%first(lane) + j
          cohesive%points(p) = cohesive_point_t(state%damage(lane), state%dissipated(lane), &
                                                sliding_t(state%slip(lane, :), state%limit(lane), state%heat(lane)))
          history%sticking(:, p) = state%sticking(lane, :)
          history%rubbing(:, p) = state%rubbing(lane, :)
          history%work(p) = state%work(lane)
        end do
      end associate
    end do
  end subroutine store_states
end module stack_batches
