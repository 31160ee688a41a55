!> Stacks of layers, several at a time: constants of stacks with the same number of layers and of the same kind, lane
!> first, and their layers in a step. Layers are counted from 0; each but the first has the interface above it.
module stack_batches
  use element_batches, only: lanes
  use cohesive_interfaces, only: cohesive_interfaces_t, prevents_penetration
  use cohesive_points, only: cohesive_point_t
  use interface_stacks, only: interface_stacks_t, jump_history_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: along_x, along_y, along_z, nodal_inertia_t
  use surface_friction, only: sliding_t
  use weighted_jumps, only: newest
  implicit none
  private
  public :: layer_constants_t, layer_lanes_t, surface_lanes_t, stack_batch_t, stack_batches_t, new_stack_batches, &
            couple, load_layers, store_layers

  !> Constants of a layer and its interface in a step of the present length, a value for each lane.
  type :: layer_constants_t
    !> Inverse inertia of the layer
    real(wp) :: inverse(lanes, 7) = 0
    !> Height of the interface; undamaged stiffness of shear and opening, force per jump
    real(wp) :: height(lanes) = 0, stiffness(lanes, 2) = 0
    !> Square of the step times the compliance of the layers, and its coupling with the interface below, (lanes, 3)
    real(wp) :: diagonal(lanes, 3) = 0, off_diagonal(lanes, 3) = 0
    !> Inverse pivot of the tridiagonal system of undamaged stacks, and multiplier to the interface below, (lanes, 3)
    real(wp) :: pivot(lanes, 3) = 0, multiplier(lanes, 3) = 0
    !> Of damaged stacks, area, and stiffness of shear, opening and closing without flaws, pressure per jump
    real(wp) :: area(lanes) = 0, shear(lanes) = 0, opening(lanes) = 0, closing(lanes) = 0
    !> The smaller toughness of the pure modes, and the ratio of the jumps at failure and at the onset without flaws
    real(wp) :: toughness(lanes) = 0, failure_ratio(lanes) = 0
    !> Coefficient of friction
    real(wp) :: friction(lanes) = 0
    !> True: surfaces do not penetrate each other
    logical :: contact(lanes) = .true.
  end type layer_constants_t

  !> Stacks, and their constants in a step of the present length.
  type :: stack_batch_t
    !> Number of interfaces, and number of stacks
    integer :: n = 0, members = 0
    !> True: some interfaces are damaged. True: frames or lines constrain layers
    logical :: damaged = .false., constrained = .false.
    !> Stack and first point of each lane; others than those of the members are computed and not stored
    integer :: stack(lanes) = 0, first(lanes) = 0
    !> The layers, (0:n)
    type(layer_constants_t), allocatable :: layers(:)
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
  end type stack_batches_t

  !> Earlier steps of an interface, as in jump_history_t, a value for each lane.
  type :: past_lanes_t
    !> Of all stacks
    real(wp) :: forces(lanes, 3), change(lanes, 3), earlier(lanes, 3), lost(lanes, 2)
    !> Of damaged ones
    real(wp) :: rubbing(lanes, 3), work(lanes), sticking(lanes, 4)
  end type past_lanes_t

  !> Damaged surfaces of an interface in a step, a value for each lane.
  type :: surface_lanes_t
    !> Damage, and energy dissipated per area
    real(wp) :: damage(lanes), dissipated(lanes)
    !> Slip, and frictional heat per area
    real(wp) :: slip(lanes, 2), heat(lanes)
    !> Factor of the stiffness of opening, that stiffness, and ratio of the jumps at failure and at the onset
    real(wp) :: loosened(lanes), opening(lanes), failure_ratio(lanes)
    !> Friction limit of this step, and friction, forces
    real(wp) :: limit(lanes), friction(lanes, 2)
    !> Part of earlier elastic jumps of sticking surfaces in the weighted mean; elastic jumps at the end of the step
    real(wp) :: past_elastic(lanes, 2), elastic(lanes, 2)
    !> True: slips in this step
    logical :: slips(lanes)
  end type surface_lanes_t

  !> A layer and its interface in a step, a value for each lane.
  type :: layer_lanes_t
    !> Unknowns, their rates, velocities of the layer, those at the start of the step, and forces on the layer
    real(wp), dimension(lanes, 5) :: u, rates, velocity, start, force
    !> Jumps at the end of the step without tractions, and their change with them
    real(wp), dimension(lanes, 3) :: trial, change
    !> Forces on the jumps; those of cohesive law and friction that do not depend on the jumps at the end of the step
    real(wp), dimension(lanes, 3) :: forces, given
    !> Force per jump at the end of the step by the cohesive law: shear, opening
    real(wp) :: secant(lanes, 2)
    type(past_lanes_t) :: past
    type(surface_lanes_t) :: surfaces
  end type layer_lanes_t

contains

  !> Batches of all stacks. Stacks of the same number of layers and of the same kind share batches.
  pure function new_stack_batches(stacks, inertia, plate, constrained) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
    !> True for stacks with layers that frames or lines constrain
    logical, intent(in) :: constrained(:)
    type(stack_batches_t) :: self
    integer :: i, layers

    layers = maxval([1, stacks%layers])
    ! All stacks may become damaged. For each number of layers and kind, one batch has free lanes.
    allocate (self%list(2*(size(constrained)/lanes) + 6*layers), self%open(layers, 0:3))
    self%open = 0
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
        call set_lane(self%list(b), lane, self%list(b)%stack(self%list(b)%members), stacks, inertia, plate)
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
    integer :: lane, last

    associate (open => self%open(stacks%layers(i), merge(1, 0, constrained) + merge(2, 0, stacks%damaged(i))))
      last = lanes
      if (open > 0) last = self%list(open)%members + 1
      if (open == 0 .or. last > lanes) then
        self%filled = self%filled + 1
        open = self%filled
        self%list(open) = stack_batch_t(n=stacks%layers(i) - 1, damaged=stacks%damaged(i), constrained=constrained)
        allocate (self%list(open)%layers(0:stacks%layers(i) - 1))
        last = lanes
      end if
      associate (batch => self%list(open))
        batch%members = batch%members + 1
        do lane = batch%members, last
          call set_lane(batch, lane, i, stacks, inertia, plate)
        end do
      end associate
    end associate
  end subroutine join

  !> Sets the constants of a lane.
  pure subroutine set_lane(self, lane, i, stacks, inertia, plate)
    type(stack_batch_t), intent(inout) :: self
    !> The lane, and index of the stack
    integer, intent(in) :: lane, i
    type(interface_stacks_t), intent(in) :: stacks
    type(nodal_inertia_t), intent(in) :: inertia
    type(composite_plate_t), intent(in) :: plate
    integer :: j

    self%stack(lane) = i
    self%first(lane) = stacks%first(i)
    do j = 0, self%n
      associate (layer => self%layers(j), p => stacks%first(i) + j)
        layer%inverse(lane, :) = inertia%inverse(:, p)
        layer%height(lane) = plate%map%height(p)
        layer%stiffness(lane, :) = stacks%stiffness(:, p)
        if (.not. self%damaged .or. j == 0) cycle
        associate (law => plate%interfaces%cohesive_laws(plate%zone(p)))
          layer%area(lane) = stacks%area(p)
          layer%shear(lane) = law%stiffness_shear
          layer%opening(lane) = law%stiffness_opening
          layer%closing(lane) = law%stiffness_closing
          layer%toughness(lane) = min(law%toughness_opening, law%toughness_shear)
          layer%failure_ratio(lane) = law%failure_ratio
        end associate
        layer%friction(lane) = plate%setup%delaminations(plate%zone(p))%friction
        layer%contact(lane) = prevents_penetration(plate, plate%zone(p))
      end associate
    end do
    call couple(self%layers, lane, inertia%step_square)
  end subroutine set_lane

  !> Compliances of the layers between the interfaces of a lane, and factors of the symmetric system (1/k + H C) of an
  !> undamaged stack.
  pure subroutine couple(layers, lane, step_square)
    !> Layers of the batch
    type(layer_constants_t), intent(inout) :: layers(0:)
    integer, intent(in) :: lane
    real(wp), intent(in) :: step_square
    real(wp) :: carried(3)
    integer :: j

    carried = 0
    do j = 1, ubound(layers, 1)
      associate (layer => layers(j), z => layers(j)%height(lane))
        layer%diagonal(lane, :) = step_square*(coupling(layers(j - 1)%inverse(lane, :), z, z) &
                                               + coupling(layer%inverse(lane, :), z, z))
        layer%pivot(lane, :) = 1/(1/(newest*layer%stiffness(lane, [1, 1, 2])) + layer%diagonal(lane, :) - carried)
        if (j == ubound(layers, 1)) exit
        layer%off_diagonal(lane, :) = -step_square*coupling(layer%inverse(lane, :), z, layers(j + 1)%height(lane))
        layer%multiplier(lane, :) = layer%pivot(lane, :)*layer%off_diagonal(lane, :)
        carried = layer%multiplier(lane, :)*layer%off_diagonal(lane, :)
      end associate
    end do
  end subroutine couple

  !> Displacements of a layer at one height by unit forces at another, divided by the square of the time, theory (T8).
  pure function coupling(inverse, z1, z2)
    !> Inverse inertia of the layer
    real(wp), intent(in) :: inverse(7)
    !> The heights
    real(wp), intent(in) :: z1, z2
    !> Along x, y and z
    real(wp) :: coupling(3)

    coupling(:2) = inverse([along_x, along_y]) + inverse([along_x, along_y] + 1)*(z1 + z2) &
                   + inverse([along_x, along_y] + 2)*z1*z2
    coupling(3) = inverse(along_z)
  end function coupling

  !> Loads the layers of a batch at the start of a step. Arrays of explicit shape let the loop over the values of a
  !> point be unrolled, and the points of a stack are read one after the other, as they lie in memory, here and in
  !> `store_layers`.
  pure subroutine load_layers(batch, points, u, v, force, history, cohesive, layers)
    type(stack_batch_t), intent(in) :: batch
    !> Number of points
    integer, intent(in) :: points
    !> Unknowns, their rates and forces on the layers
    real(wp), dimension(5, points), intent(in) :: u, v, force
    type(jump_history_t), intent(in) :: history(points)
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(layer_lanes_t), intent(out) :: layers(0:batch%n)
    integer :: lane, j, p

    layers(0)%forces = 0
    do lane = 1, lanes
      do j = 0, batch%n
        associate (layer => layers(j), past => layers(j)%past, surfaces => layers(j)%surfaces)
          p = batch%first(lane) + j
          layer%u(lane, :) = u(:, p)
          layer%rates(lane, :) = v(:, p)
          layer%force(lane, :) = force(:, p)
          if (j == 0) cycle
          past%forces(lane, :) = history(p)%forces
          past%change(lane, :) = history(p)%change
          past%earlier(lane, :) = history(p)%earlier
          past%lost(lane, :) = history(p)%lost
          if (.not. batch%damaged) cycle
          past%rubbing(lane, :) = history(p)%rubbing
          past%work(lane) = history(p)%work
          past%sticking(lane, :) = history(p)%sticking
          surfaces%damage(lane) = cohesive%points(p)%damage
          surfaces%dissipated(lane) = cohesive%points(p)%dissipated
          surfaces%slip(lane, :) = cohesive%points(p)%sliding%slip
          surfaces%heat(lane) = cohesive%points(p)%sliding%heat
          surfaces%loosened(lane) = cohesive%opening(p)
          surfaces%failure_ratio(lane) = batch%layers(j)%failure_ratio(lane)/cohesive%strength(p)**2
          surfaces%opening(lane) = surfaces%loosened(lane)*batch%layers(j)%opening(lane)
        end associate
      end do
    end do
  end subroutine load_layers

  !> Stores the layers of a batch at the end of a step.
  pure subroutine store_layers(batch, points, layers, u, v, history, cohesive)
    type(stack_batch_t), intent(in) :: batch
    !> Number of points
    integer, intent(in) :: points
    type(layer_lanes_t), intent(in) :: layers(0:batch%n)
    !> Unknowns and their rates
    real(wp), dimension(5, points), intent(inout) :: u, v
    type(jump_history_t), intent(inout) :: history(points)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    integer :: lane, j, p

    do lane = 1, batch%members
      do j = 0, batch%n
        associate (layer => layers(j), past => layers(j)%past, surfaces => layers(j)%surfaces)
          p = batch%first(lane) + j
          u(:, p) = layer%u(lane, :)
          v(:, p) = layer%rates(lane, :)
          if (j == 0) cycle
          history(p)%forces = layer%forces(lane, :)
          history(p)%change = layer%change(lane, :)
          history(p)%earlier = past%change(lane, :)
          history(p)%lost = past%lost(lane, :)
          if (.not. batch%damaged) cycle
          history(p)%rubbing = past%rubbing(lane, :)
          history(p)%work = past%work(lane)
          history(p)%sticking = past%sticking(lane, :)
          cohesive%points(p) = cohesive_point_t(surfaces%damage(lane), surfaces%dissipated(lane), &
            sliding_t(surfaces%slip(lane, :), surfaces%limit(lane)/batch%layers(j)%area(lane), surfaces%heat(lane)))
        end associate
      end do
    end do
  end subroutine store_layers
end module stack_batches
