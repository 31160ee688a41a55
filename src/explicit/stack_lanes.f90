!> What changes in stacks of layers in a step besides the motion of the points, over lanes of stacks: jumps, losses and
!> surfaces. These stay with the batches, and are stored at the points where others need them there.
module stack_lanes
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_points, only: cohesive_point_t
  use element_batches, only: lanes
  use interface_stacks, only: friction_history_t, interface_stacks_t, jump_history_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use surface_friction, only: sliding_t
  implicit none
  private
  public :: jump_lanes_t, surface_lanes_t, surface_states_t, load_states, set_surfaces, store_friction, store_points

  !> Constants of the surfaces, (lanes, n) each, of laws without flaws.
  type :: surface_lanes_t
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
  type :: surface_states_t
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
  type :: jump_lanes_t
    !> Change of the jumps in the last step and in the one before, and forces on them in the last step, (lanes, 3, n)
    real(wp), allocatable :: last(:, :, :), earlier(:, :, :), forces(:, :, :)
    !> Energy dissipated by contact, and algorithmic dissipation, (lanes, 2, n)
    real(wp), allocatable :: lost(:, :, :)
  contains
    procedure :: load => load_jumps
    procedure :: store => store_jumps
  end type jump_lanes_t

contains

  !> Sets the surfaces of a lane.
  pure subroutine set_surfaces(self, lane, n, first, stacks, plate)
    type(surface_lanes_t), intent(inout) :: self
    !> The lane, number of interfaces, and first point of the stack
    integer, intent(in) :: lane, n, first
    type(interface_stacks_t), intent(in) :: stacks
    type(composite_plate_t), intent(in) :: plate
    integer :: j

    do j = 1, n
      associate (zone => plate%zone(first + j))
        associate (law => plate%interfaces%cohesive_laws(zone))
          self%area(lane, j) = stacks%area(first + j)
          self%shear(lane, j) = law%stiffness_shear
          self%opening(lane, j) = law%stiffness_opening
          self%closing(lane, j) = law%stiffness_closing
          self%toughness(lane, j) = min(law%toughness_opening, law%toughness_shear)
          self%failure_ratio(lane, j) = law%failure_ratio
        end associate
        self%friction(lane, j) = plate%setup%delaminations(zone)%friction
        self%contact(lane, j) = prevents_penetration(plate, zone)
      end associate
    end do
  end subroutine set_surfaces

  !> Loads the states of the surfaces of lanes, without the reductions of their laws.
  pure subroutine load_states(states, first, from, to, cohesive, history)
    !> One for each interface
    type(surface_states_t), intent(inout) :: states(:)
    !> First point of each lane, and first and last lane
    integer, intent(in) :: first(lanes), from, to
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(jump_history_t), intent(in) :: history
    integer :: lane, j, p

    do j = 1, size(states)
      do lane = from, to
        p = first(lane) + j
        associate (state => states(j), point => cohesive%points(p), friction => history%friction(p))
          state%damage(lane) = point%damage
          state%dissipated(lane) = point%dissipated
          state%slip(lane, :) = point%sliding%slip
          state%heat(lane) = point%sliding%heat
          state%steps(lane) = friction%steps
          state%rubbing(lane, :) = [friction%stored, friction%deficit]
          state%sticking(lane, :) = history%sticking(:, p)
          state%work(lane) = history%work(p)
        end associate
      end do
    end do
  end subroutine load_states

  !> Stores damage and slip of surfaces at their points.
  pure subroutine store_points(states, first, members, cohesive)
    !> One for each interface
    type(surface_states_t), intent(in) :: states(:)
    !> First point of each lane, and number of lanes
    integer, intent(in) :: first(lanes), members
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    integer :: lane, j

    do j = 1, size(states)
      associate (state => states(j))
        do lane = 1, members
          cohesive%points(first(lane) + j) = &
            cohesive_point_t(state%damage(lane), state%dissipated(lane), &
                             sliding_t(state%slip(lane, :), state%limit(lane), state%heat(lane)))
        end do
      end associate
    end do
  end subroutine store_points

  !> Stores the history of friction and work.
  pure subroutine store_friction(states, first, members, history)
    !> One for each interface
    type(surface_states_t), intent(in) :: states(:)
    !> First point of each lane, and number of lanes
    integer, intent(in) :: first(lanes), members
    type(jump_history_t), intent(inout) :: history
    integer :: lane, j, p

    do j = 1, size(states)
      associate (state => states(j))
        do lane = 1, members
          p = first(lane) + j
          history%friction(p) = friction_history_t(nint(state%steps(lane)), state%rubbing(lane, 1), &
                                                    state%rubbing(lane, 2))
          history%sticking(:, p) = state%sticking(lane, :)
          history%work(p) = state%work(lane)
        end do
      end associate
    end do
  end subroutine store_friction

  !> Loads the jumps of lanes from the points.
  pure subroutine load_jumps(self, first, from, to, history)
    class(jump_lanes_t), intent(inout) :: self
    !> First point of each lane, and first and last lane
    integer, intent(in) :: first(lanes), from, to
    type(jump_history_t), intent(in) :: history
    integer :: lane, j, p

    do j = 1, size(self%last, 3)
      do lane = from, to
        p = first(lane) + j
        self%last(lane, :, j) = history%change(:, p)
        self%earlier(lane, :, j) = history%earlier(:, p)
        self%forces(lane, :, j) = history%forces(:, p)
        self%lost(lane, :, j) = history%lost(:, p)
      end do
    end do
  end subroutine load_jumps

  !> Stores the jumps of lanes at the points. The forces are there.
  pure subroutine store_jumps(self, first, from, to, history)
    class(jump_lanes_t), intent(in) :: self
    !> First point of each lane, and first and last lane
    integer, intent(in) :: first(lanes), from, to
    type(jump_history_t), intent(inout) :: history
    integer :: lane, j, p

    do j = 1, size(self%last, 3)
      do lane = from, to
        p = first(lane) + j
        history%change(:, p) = self%last(lane, :, j)
        history%earlier(:, p) = self%earlier(lane, :, j)
        history%lost(:, p) = self%lost(lane, :, j)
      end do
    end do
  end subroutine store_jumps
end module stack_lanes
