!> Motion of the layers of nodes in a step: velocities from the forces on each layer, tractions between them, jumps.
module stack_motions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use element_batches, only: lanes
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use line_steps, only: line_steps_t
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: along_z, nodal_inertia_t
  use rig_steps, only: rig_steps_t
  use stack_batches, only: layer_lanes_t, load_layers, new_stack_batches, stack_batch_t, stack_batches_t, store_layers
  use stack_solutions, only: solve_damaged, solve_intact, solve_openings, solve_tractions
  use stack_updates, only: start_damage, update_damaged, update_intact
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: newest, past_jumps
  implicit none
  private
  public :: nodal_steps_t, move_stacks

  !> The nodes in a step.
  type :: nodal_steps_t
    !> Lumped inertia of the points, inverted for the step
    type(nodal_inertia_t) :: inertia
    !> Forces on the layers without tractions, (5, points); at the end of a step loads minus internal forces
    real(wp), allocatable :: force(:, :)
    !> Nodes with their layers
    type(interface_stacks_t) :: stacks
    !> Batches of stacks; unallocated: to be formed for the step
    type(stack_batches_t), allocatable :: batches
    type(line_steps_t) :: lines
    !> Frames and springs
    type(rig_steps_t) :: rigs
    !> The step taken last and the one before it
    type(step_lengths_t) :: steps
  end type nodal_steps_t

contains

  !> Updates all stacks.
  subroutine move_stacks(nodes, plate, cohesive, u, v)
    !> The nodes; their stacks receive forces, changes of the jumps and losses
    type(nodal_steps_t), intent(inout) :: nodes
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces; receive the growth of damage
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), contiguous, intent(inout) :: u(:, :)
    real(wp), contiguous, intent(inout) :: v(:, :)
    type(stack_batches_t), allocatable :: batches
    integer :: b

    call move_alloc(nodes%batches, batches)
    if (allocated(batches)) then
      call batches%move_damaged(nodes%stacks, nodes%inertia, plate)
    else
      batches = new_stack_batches(nodes%stacks, nodes%inertia, plate, are_constrained(nodes))
    end if
    do b = 1, batches%filled
      associate (batch => batches%list(b))
        if (batch%n == 0 .and. .not. batch%constrained) then
          call move_single(batch, size(u, 2), nodes%inertia%inverse, nodes%steps, nodes%force, u, v)
        else if (batch%members > 0) then
          call move_batch(batch, nodes, plate, cohesive, u, v)
        end if
      end associate
    end do
    call move_alloc(batches, nodes%batches)
  end subroutine move_stacks

  !> True for stacks with layers that frames or lines constrain.
  pure function are_constrained(nodes) result(constrained)
    !> The nodes
    type(nodal_steps_t), intent(in) :: nodes
    !> One for each stack
    logical :: constrained(size(nodes%stacks%first))
    integer :: i

    do i = 1, size(constrained)
      associate (first => nodes%stacks%first(i), last => nodes%stacks%first(i) + nodes%stacks%layers(i) - 1)
        constrained(i) = nodes%rigs%on_frame(first) .or. nodes%rigs%circles%holds(first) .or. &
                         any(nodes%lines%line(:, first:last) >= 0)
      end associate
    end do
  end function are_constrained

  !> Updates unconstrained nodes with one layer, point by point: to load lanes would take longer.
  pure subroutine move_single(batch, points, inverse, steps, force, u, v)
    type(stack_batch_t), intent(in) :: batch
    !> Number of points
    integer, intent(in) :: points
    !> Inverse inertia
    real(wp), intent(in) :: inverse(7, points)
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the layers
    real(wp), intent(in) :: force(5, points)
    !> Unknowns and their rates
    real(wp), intent(inout) :: u(5, points), v(5, points)
    real(wp) :: m(7), f(5), time
    integer :: lane, p

    time = steps%mean()
    do lane = 1, batch%members
      p = batch%first(lane)
      m = inverse(:, p)
      f = force(:, p)
      v(:, p) = v(:, p) + [time*(m(1)*f(1) + m(2)*f(4)), time*(m(4)*f(2) + m(5)*f(5)), time*m(7)*f(3), &
                           time*(m(2)*f(1) + m(3)*f(4)), time*(m(5)*f(2) + m(6)*f(5))]
      u(:, p) = u(:, p) + steps%now*v(:, p)
    end do
  end subroutine move_single

  !> Updates the stacks of a batch.
  subroutine move_batch(batch, nodes, plate, cohesive, u, v)
    type(stack_batch_t), intent(in) :: batch
    !> The nodes; their stacks receive forces, changes of the jumps and losses
    type(nodal_steps_t), intent(inout) :: nodes
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), contiguous, intent(inout) :: u(:, :)
    real(wp), contiguous, intent(inout) :: v(:, :)
    type(layer_lanes_t) :: layers(0:batch%n)
    integer :: j

    associate (history => nodes%stacks%history, points => size(u, 2), steps => nodes%steps)
      call load_layers(batch, points, u, v, nodes%force, history, cohesive, layers)
      call find_velocities(batch, layers)
      do j = 0, batch%n
        call accelerate(batch%layers(j)%inverse, steps%mean(), layers(j)%force, layers(j)%velocity)
      end do
      if (batch%constrained) then
        call prescribe(batch, nodes%lines, layers)
        call hold_together(batch, nodes%rigs%circles%holds, layers)
      end if
      call find_rates(batch, layers)
      do j = 1, batch%n
        layers(j)%trial = layers(j)%u(:, :3) + steps%now*layers(j)%rates(:, :3)
      end do
      if (batch%damaged) then
        call solve_damaged(batch, steps, plate, cohesive, layers)
      else
        call solve_intact(batch, layers)
      end if
      if (batch%constrained) call stop_at_frames(batch, nodes%rigs, steps, layers)
      call find_resultants(batch, layers)
      do j = 0, batch%n
        call accelerate(batch%layers(j)%inverse, steps%mean(), layers(j)%force, layers(j)%velocity)
      end do
      if (batch%constrained) then
        call hold_together(batch, nodes%rigs%circles%holds, layers)
        call record_reactions(batch, nodes, layers)
      end if
      call find_rates(batch, layers)
      do j = 1, batch%n
        layers(j)%change = steps%now*layers(j)%rates(:, :3)
      end do
      if (batch%damaged) then
        call update_damaged(batch, steps, plate, cohesive, layers)
      else
        call update_intact(batch, steps, layers)
      end if
      do j = 0, batch%n
        layers(j)%u = layers(j)%u + steps%now*layers(j)%rates
      end do
      call store_layers(batch, points, layers, u, v, history, cohesive)
    end associate
    if (.not. batch%damaged) call start_damage(batch, layers, nodes%stacks, plate, cohesive, u)
  end subroutine move_batch

  !> Velocities of the layers from the rates of the unknowns.
  pure subroutine find_velocities(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j

    layers(0)%velocity = layers(0)%rates
    do j = 1, batch%n
      call relate(1.0_wp, batch%layers(j)%height, layers(j - 1)%velocity, layers(j)%rates, layers(j)%velocity)
    end do
    if (.not. batch%constrained) return
    do j = 0, batch%n
      layers(j)%start = layers(j)%velocity
    end do
  end subroutine find_velocities

  !> Rates of the unknowns from the velocities of the layers.
  pure subroutine find_rates(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j

    layers(0)%rates = layers(0)%velocity
    do j = 1, batch%n
      call relate(-1.0_wp, batch%layers(j)%height, layers(j - 1)%velocity, layers(j)%velocity, layers(j)%rates)
    end do
  end subroutine find_rates

  !> Adds the motion at an interface of the layer above to that of a layer, or subtracts it. As arguments the arrays are
  !> known not to overlap, so that the operations are vectorized, here and in `accelerate`.
  pure subroutine relate(sign, z, above, from, to)
    !> 1 or -1, height of the interface, and velocity of the layer above
    real(wp), intent(in) :: sign, z(lanes), above(lanes, 5)
    !> Rates of the unknowns, or velocity of the layer
    real(wp), intent(in) :: from(lanes, 5)
    !> Velocity of the layer, or rates of the unknowns
    real(wp), intent(out) :: to(lanes, 5)

    to(:, 1) = from(:, 1) + sign*above(:, 1) + z*(sign*(above(:, 4) - from(:, 4)))
    to(:, 2) = from(:, 2) + sign*above(:, 2) + z*(sign*(above(:, 5) - from(:, 5)))
    to(:, 3) = from(:, 3) + sign*above(:, 3)
    to(:, 4:5) = from(:, 4:5)
  end subroutine relate

  !> Adds the change of the velocity of a layer by forces during a time.
  pure subroutine accelerate(m, time, f, v)
    !> Inverse inertia
    real(wp), intent(in) :: m(lanes, 7)
    real(wp), intent(in) :: time
    !> Forces
    real(wp), intent(in) :: f(lanes, 5)
    !> Velocity
    real(wp), intent(inout) :: v(lanes, 5)

    v(:, 1) = v(:, 1) + time*(m(:, 1)*f(:, 1) + m(:, 2)*f(:, 4))
    v(:, 4) = v(:, 4) + time*(m(:, 2)*f(:, 1) + m(:, 3)*f(:, 4))
    v(:, 2) = v(:, 2) + time*(m(:, 4)*f(:, 2) + m(:, 5)*f(:, 5))
    v(:, 5) = v(:, 5) + time*(m(:, 5)*f(:, 2) + m(:, 6)*f(:, 5))
    v(:, 3) = v(:, 3) + time*m(:, 7)*f(:, 3)
  end subroutine accelerate

  !> Forces of the tractions on the layers.
  pure subroutine find_resultants(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j, k

    do j = 0, batch%n
      associate (force => layers(j)%force, above => layers(j)%forces)
        force(:, :3) = -above
        do k = 1, 2
          force(:, k + 3) = -batch%layers(j)%height*above(:, k)
        end do
        if (j == batch%n) exit
        associate (below => layers(j + 1)%forces)
          force(:, :3) = force(:, :3) + below
          do k = 1, 2
            force(:, k + 3) = force(:, k + 3) + batch%layers(j + 1)%height*below(:, k)
          end do
        end associate
      end associate
    end do
  end subroutine find_resultants

  !> Sets the velocities of layers that lines prescribe.
  pure subroutine prescribe(batch, lines, layers)
    type(stack_batch_t), intent(in) :: batch
    type(line_steps_t), intent(in) :: lines
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: lane, j

    if (size(lines%points) == 0) return
    do j = 0, batch%n
      do lane = 1, batch%members
        call lines%prescribe(batch%first(lane) + j, layers(j)%velocity(lane, :))
      end do
    end do
  end subroutine prescribe

  !> Gives all layers of nodes on a circular window the mean velocity along w, weighted with their inertia. The frame
  !> acts on w of the node; if layers moved apart, it would do work on their openings.
  pure subroutine hold_together(batch, holds, layers)
    type(stack_batch_t), intent(in) :: batch
    !> True at first points of such nodes, (points)
    logical, intent(in) :: holds(:)
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp), dimension(lanes) :: momentum, inertia
    logical, dimension(lanes) :: held, fixed
    integer :: j

    held = holds(batch%first)
    if (batch%n == 0 .or. .not. any(held)) return
    momentum = 0
    inertia = 0
    fixed = .false.
    do j = 0, batch%n
      associate (inverse => batch%layers(j)%inverse(:, along_z))
        fixed = fixed .or. .not. inverse > 0
        where (inverse > 0)
          momentum = momentum + layers(j)%velocity(:, 3)/inverse
          inertia = inertia + 1/inverse
        end where
      end associate
    end do
    where (fixed)
      momentum = 0
      inertia = 1
    end where
    do j = 0, batch%n
      where (held) layers(j)%velocity(:, 3) = momentum/inertia
    end do
  end subroutine hold_together

  !> Stops lowest layers at frames that they would penetrate.
  pure subroutine stop_at_frames(batch, rigs, steps, layers)
    type(stack_batch_t), intent(in) :: batch
    type(rig_steps_t), intent(inout) :: rigs
    type(step_lengths_t), intent(in) :: steps
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp), dimension(lanes) :: w, mobility, held
    real(wp) :: forces(lanes, batch%n), rate
    logical :: stops(lanes)
    integer :: lane, j

    associate (lowest => layers(batch%n))
      w = 0
      do j = 0, batch%n
        w = w + layers(j)%u(:, 3)
      end do
      mobility = steps%mean()*batch%layers(batch%n)%inverse(:, 7)
      stops = rigs%on_frame(batch%first) &
              .and. w + steps%now*(lowest%velocity(:, 3) - mobility*lowest%forces(:, 3)) > 0
      if (any(stops) .and. batch%n > 0) then
        do j = 1, batch%n
          forces(:, j) = layers(j)%forces(:, 3)
        end do
        where (stops) lowest%trial(:, 3) = lowest%u(:, 3) - w - steps%now*layers(batch%n - 1)%velocity(:, 3)
        held = merge(steps%now*steps%mean()*batch%layers(batch%n)%inverse(:, 7), 0.0_wp, stops)
        if (batch%damaged) then
          call solve_openings(batch, held, layers)
        else
          call solve_intact_openings(batch, held, layers)
        end if
        do j = 1, batch%n
          where (.not. stops) layers(j)%forces(:, 3) = forces(:, j)
        end do
      end if
      do lane = 1, batch%members
        if (.not. rigs%on_frame(batch%first(lane))) cycle
        rate = lowest%velocity(lane, 3) - mobility(lane)*lowest%forces(lane, 3)
        if (stops(lane) .and. .not. w(lane) + steps%now*rate > 0) rate = -w(lane)/steps%now + tiny(rate)
        call rigs%stop_at_frame(batch%first(lane), steps, batch%layers(batch%n)%inverse(lane, 7), w(lane), rate)
        if (batch%n == 0) lowest%velocity(lane, 3) = rate
      end do
    end associate
  end subroutine stop_at_frames

  !> Forces normal to the surfaces of undamaged stacks.
  pure subroutine solve_intact_openings(batch, lowest, layers)
    type(stack_batch_t), intent(in) :: batch
    !> Compliance that the lowest layer does not have: its own where it is held
    real(wp), intent(in) :: lowest(lanes)
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp) :: normal(lanes, batch%n), given(lanes, batch%n)
    integer :: j

    do j = 1, batch%n
      associate (layer => layers(j), stiffness => batch%layers(j)%stiffness(:, 2))
        normal(:, j) = newest*stiffness
        given(:, j) = stiffness*past_jumps(layer%u(:, 3), layer%past%change(:, 3), layer%past%earlier(:, 3))
      end associate
    end do
    call solve_tractions(batch, 3, normal, given, lowest, layers)
  end subroutine solve_intact_openings

  !> Velocities of layers stopped by frames, and reactions of lines.
  pure subroutine record_reactions(batch, nodes, layers)
    type(stack_batch_t), intent(in) :: batch
    !> The nodes; their lines receive the reactions
    type(nodal_steps_t), intent(inout) :: nodes
    !> Layers with their velocities at the end, and with the forces of the tractions
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: lane, j, p

    do lane = 1, batch%members
      p = batch%first(lane)
      if (batch%n > 0 .and. nodes%rigs%on_frame(p)) &
        layers(batch%n)%velocity(lane, 3) = nodes%rigs%approach(p)/nodes%steps%now
    end do
    if (size(nodes%lines%points) == 0) return
    do j = 0, batch%n
      do lane = 1, batch%members
        p = batch%first(lane) + j
        call nodes%lines%react(p, nodes%steps, nodes%inertia%mass(:, p), layers(j)%start(lane, :), &
                               layers(j)%velocity(lane, :), nodes%force(:, p) + layers(j)%force(lane, :))
      end do
    end do
  end subroutine record_reactions
end module stack_motions
