!> Stacks of layers, several at a time: constants of stacks with the same number of layers and of the same kind, lane
!> first, and the states of their surfaces.
module stack_batches
  use element_batches, only: lanes
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_points, only: cohesive_point_t
  use interface_stacks, only: interface_stacks_t
  use jump_histories, only: friction_history_t, jump_history_t
  use kinds, only: wp
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use surface_friction, only: sliding_t
  implicit none
  private
  public :: stack_batch_t, create_stack_batches, load_states, store_states

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

  !> Stacks, and their constants in a step of the present length.
  type :: stack_batch_t
    !> Number of interfaces, and number of stacks
    integer :: n = 0, members = 0
    !> True: some interfaces are damaged. True: frames or lines constrain layers
    logical :: damaged = .false., constrained = .false.
    !> Stack and first point of each lane; the last stack fills the remaining lanes
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
  end type stack_batch_t

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

contains

  !> Batches of all stacks. Stacks of the same number of layers and of the same kind share batches.
  pure function create_stack_batches(stacks, inertia, model, constrained) result(batches)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(model_t), intent(in) :: model
    !> True for stacks with layers that frames or lines constrain
    logical, intent(in) :: constrained(:)
    !> The batches
    type(stack_batch_t), allocatable :: batches(:)
    integer, allocatable :: equal(:)
    integer :: layers, kind, i, total

    allocate (batches(size(constrained)))
    total = 0
    do layers = 2, maxval([1, stacks%layers])
      do kind = 0, 3
        equal = pack([(i, i=1, size(constrained))], stacks%layers == layers .and. &
                     (stacks%damaged .eqv. kind > 1) .and. (constrained .eqv. modulo(kind, 2) == 1))
        do i = 1, size(equal), lanes
          total = total + 1
          associate (members => equal(i:min(i + lanes - 1, size(equal))), batch => batches(total))
            batch = new_batch(stacks, inertia, members)
            batch%constrained = constrained(members(1))
            if (batch%damaged) batch%surfaces = new_surfaces(stacks, model, batch)
          end associate
        end do
      end do
    end do
    batches = batches(:total)
  end function create_stack_batches

  !> A batch of stacks.
  pure function new_batch(stacks, inertia, members) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    !> Indices of at least one and at most `lanes` stacks
    integer, intent(in) :: members(:)
    type(stack_batch_t) :: self
    integer :: lane, p

    self%members = size(members)
    self%n = stacks%layers(members(1)) - 1
    self%damaged = stacks%damaged(members(1))
    allocate (self%height(lanes, self%n), self%inverse(lanes, 7, self%n + 1), self%stiffness(lanes, 2, self%n), &
              self%diagonal(lanes, 3, self%n), self%off_diagonal(lanes, 3, self%n), self%factors(lanes, 2, 3, self%n))
    do lane = 1, lanes
      self%stack(lane) = members(min(lane, size(members)))
      p = stacks%first(self%stack(lane))
      self%first(lane) = p
      self%height(lane, :) = stacks%height(p + 1:p + self%n)
      self%inverse(lane, :, :) = inertia%inverse(:, p:p + self%n)
      self%stiffness(lane, :, :) = stacks%stiffness(:, p + 1:p + self%n)
      self%diagonal(lane, :, :) = stacks%diagonal(:, p + 1:p + self%n)
      self%off_diagonal(lane, :, :) = stacks%off_diagonal(:, p + 1:p + self%n)
      self%factors(lane, :, :, :) = stacks%factors(:, :, p + 1:p + self%n)
    end do
  end function new_batch

  !> The surfaces of a batch.
  pure function new_surfaces(stacks, model, batch) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    type(model_t), intent(in) :: model
    type(stack_batch_t), intent(in) :: batch
    type(surface_lanes_t) :: self
    integer :: lane, j

    associate (n => batch%n)
      allocate (self%area(lanes, n), self%shear(lanes, n), self%opening(lanes, n), self%closing(lanes, n), &
                self%toughness(lanes, n), self%failure_ratio(lanes, n), self%friction(lanes, n), self%contact(lanes, n))
    end associate
    do j = 1, batch%n
      do lane = 1, lanes
        associate (p => batch%first(lane) + j, zone => model%zone(batch%first(lane) + j))
          associate (law => model%cohesive_laws(zone))
            self%area(lane, j) = stacks%area(p)
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
    end do
  end function new_surfaces

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
          associate (point => cohesive%points(p), friction => history%friction(p))
            state%damage(lane) = point%damage
            state%dissipated(lane) = point%dissipated
            state%slip(lane, :) = point%sliding%slip
            state%heat(lane) = point%sliding%heat
            state%steps(lane) = friction%steps
            state%rubbing(lane, :) = [friction%stored, friction%deficit]
          end associate
          state%part(lane) = cohesive%opening(p)
          state%failure_ratio(lane) = batch%surfaces%failure_ratio(lane, j)/cohesive%strength(p)**2
          state%sticking(lane, :) = history%sticking(:, p)
          state%work(lane) = history%work(p)
        end do
        state%opening = state%part*batch%surfaces%opening(:, j)
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
          history%friction(p) = friction_history_t(nint(state%steps(lane)), state%rubbing(lane, 1), &
                                                    state%rubbing(lane, 2))
          history%sticking(:, p) = state%sticking(lane, :)
          history%work(p) = state%work(lane)
        end do
      end associate
    end do
  end subroutine store_states
end module stack_batches
