!> Motion of the layers of nodes in a step: velocities from the forces on each layer, tractions between them, jumps.
module stack_motions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use element_batches, only: lanes
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use line_steps, only: line_steps_t
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: nodal_inertia_t
  use rig_steps, only: rig_steps_t
  use stack_batches, only: layer_lanes_t, load_layers, new_stack_batches, stack_batch_t, stack_batches_t, store_layers
  use stack_solutions, only: solve_damaged, solve_intact, solve_tractions, weigh_openings
  use stack_updates, only: start_damage, update_damaged, update_intact
  use step_lengths, only: step_lengths_t
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
      if (batches%list(b)%members > 0) call move_batch(batches%list(b), nodes, plate, cohesive, u, v)
    end do
    call move_alloc(batches, nodes%batches)
  end subroutine move_stacks

  !> True for stacks with layers that frames or lines constrain.
  pure function are_constrained(nodes) result(constrained)
    !> The nodes
    type(nodal_steps_t), intent(in) :: nodes
    !> One for each stack
    logical :: constrained(size(nodes%stacks%first))
    integer :: i, p

    do i = 1, size(constrained)
      associate (first => nodes%stacks%first(i), last => nodes%stacks%first(i) + nodes%stacks%layers(i) - 1)
        constrained(i) = nodes%rigs%on_frame(first) .or. any([(nodes%lines%is_prescribed(p), p=first, last)])
      end associate
    end do
  end function are_constrained

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
      call accelerate(batch, steps%mean(), layers)
      if (batch%constrained) call prescribe(batch, nodes%lines, layers)
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
      call accelerate(batch, steps%mean(), layers)
      if (batch%constrained) call record_reactions(batch, nodes, layers)
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
    integer :: j, k

    layers(0)%velocity = layers(0)%rates
    layers(0)%start = layers(0)%velocity
    do j = 1, batch%n
      associate (velocity => layers(j)%velocity, rates => layers(j)%rates, above => layers(j - 1)%velocity)
        velocity = rates
        do k = 1, 2
          velocity(:, k) = rates(:, k) + above(:, k) + batch%layers(j)%height*(above(:, k + 3) - rates(:, k + 3))
        end do
        velocity(:, 3) = rates(:, 3) + above(:, 3)
        layers(j)%start = velocity
      end associate
    end do
  end subroutine find_velocities

  !> Rates of the unknowns from the velocities of the layers.
  pure subroutine find_rates(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j, k

    layers(0)%rates = layers(0)%velocity
    do j = 1, batch%n
      associate (rates => layers(j)%rates, velocity => layers(j)%velocity, above => layers(j - 1)%velocity)
        rates = velocity
        do k = 1, 2
          rates(:, k) = velocity(:, k) - above(:, k) + batch%layers(j)%height*(velocity(:, k + 3) - above(:, k + 3))
        end do
        rates(:, 3) = velocity(:, 3) - above(:, 3)
      end associate
    end do
  end subroutine find_rates

  !> Adds the change of the velocities of the layers by forces during a time.
  pure subroutine accelerate(batch, time, layers)
    type(stack_batch_t), intent(in) :: batch
    real(wp), intent(in) :: time
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j, k

    do j = 0, batch%n
      associate (m => batch%layers(j)%inverse, f => layers(j)%force, v => layers(j)%velocity)
        do k = 1, 2
          v(:, k) = v(:, k) + time*(m(:, 3*k - 2)*f(:, k) + m(:, 3*k - 1)*f(:, k + 3))
          v(:, k + 3) = v(:, k + 3) + time*(m(:, 3*k - 1)*f(:, k) + m(:, 3*k)*f(:, k + 3))
        end do
        v(:, 3) = v(:, 3) + time*m(:, 7)*f(:, 3)
      end associate
    end do
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

  !> Stops lowest layers at frames that they would penetrate.
  pure subroutine stop_at_frames(batch, rigs, steps, layers)
    type(stack_batch_t), intent(in) :: batch
    type(rig_steps_t), intent(inout) :: rigs
    type(step_lengths_t), intent(in) :: steps
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp), dimension(lanes) :: w, mobility, held
    real(wp) :: normal(lanes, batch%n), given(lanes, batch%n), forces(lanes, batch%n), rate
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
          if (.not. batch%damaged) call weigh_openings(batch%layers(j), layers(j))
          normal(:, j) = layers(j)%normal
          given(:, j) = layers(j)%given(:, 3)
          forces(:, j) = layers(j)%forces(:, 3)
        end do
        where (stops) lowest%trial(:, 3) = lowest%u(:, 3) - w - steps%now*layers(batch%n - 1)%velocity(:, 3)
        held = merge(steps%now*steps%mean()*batch%layers(batch%n)%inverse(:, 7), 0.0_wp, stops)
        call solve_tractions(batch, 3, normal, given, held, layers)
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
