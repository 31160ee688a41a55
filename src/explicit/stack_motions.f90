!> Motion of the layers of nodes in a step: velocities from the forces on each layer, tractions between them, jumps.
module stack_motions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use element_batches, only: lanes
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use layer_motions, only: accelerate_layers, find_rates, find_resultants, find_velocities
  use line_steps, only: line_steps_t
  use composite_plates, only: composite_plate_t
  use nodal_inertia, only: nodal_inertia_t
  use rig_steps, only: rig_steps_t
  use stack_batches, only: stack_batches_t, load_states, new_stack_batches, stack_batch_t, store_states, &
                           surface_states_t
  use stack_solutions, only: friction_t, solve_damaged, solve_intact
  use stack_updates, only: start_damage, update_damaged, update_intact
  use step_lengths, only: step_lengths_t
  use tridiagonal_systems, only: solve_tractions
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
    !> Nodes with several layers
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
    !> Unknowns and their rates, (5, points)
    real(wp), contiguous, intent(inout) :: u(:, :), v(:, :)
    type(stack_batches_t), allocatable :: batches
    integer :: b

    call move_alloc(nodes%batches, batches)
    if (allocated(batches)) then
      call batches%move_damaged(nodes%stacks, nodes%inertia, plate)
    else
      batches = new_stack_batches(nodes%stacks, nodes%inertia, plate, are_constrained(nodes), &
                                  nodes%steps%now*nodes%steps%mean())
    end if
    call nodes%stacks%history%begin_step()
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
        constrained(i) = nodes%rigs%on_frame(first)
        if (size(nodes%lines%dofs) == 0) cycle
        constrained(i) = constrained(i) .or. any([(nodes%lines%is_prescribed(p), p=first, last)])
      end associate
    end do
  end function are_constrained

  !> Updates the stacks of a batch.
  subroutine move_batch(batch, nodes, plate, cohesive, u, v)
    type(stack_batch_t), intent(in) :: batch
    !> The nodes
    type(nodal_steps_t), intent(inout) :: nodes
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), contiguous, intent(inout) :: u(:, :), v(:, :)
    real(wp), dimension(lanes, 5, batch%n + 1) :: displacement, rates, loads, velocity
    real(wp), dimension(lanes, 3, batch%n) :: jumps, trial, tractions, before, change, last
    real(wp) :: lost(lanes, 2, batch%n), normal(lanes, batch%n), given(lanes, 3, batch%n)
    type(surface_states_t) :: states(batch%n)
    type(friction_t) :: friction(batch%n)

    associate (n => batch%n, history => nodes%stacks%history, points => size(u, 2), steps => nodes%steps)
      call take(5, points, u, batch%first, n + 1, displacement)
      call take(3, points, history%earlier, batch%first + 1, n, last)
      call take(3, points, history%change, batch%first + 1, n, change)
      call take(3, points, history%forces, batch%first + 1, n, before)
      call take(2, points, history%lost, batch%first + 1, n, lost)
      jumps = displacement(:, :3, 2:)
      call find_free_motion(batch, nodes, v, velocity, rates)
      trial = jumps + steps%now*rates(:, :3, 2:)
      if (batch%damaged) then
        call load_states(batch, cohesive, history, jumps, last, change, states)
        call solve_damaged(batch, states, steps, plate, cohesive, trial, tractions, friction, normal, given)
      else
        call solve_intact(n, batch%factors, jumps, last, change, trial, tractions)
        if (batch%constrained) call weigh_openings(n, batch%stiffness, jumps, last, change, normal, given)
      end if
      if (batch%constrained) &
        call stop_at_frames(batch, nodes%rigs, steps, displacement, velocity, normal, given, trial, tractions)
      call find_resultants(n, batch%height, tractions, loads)
      call accelerate_layers(n + 1, batch%inverse, steps%mean(), loads, velocity)
      if (batch%constrained) call record_reactions(batch, nodes, v, loads, velocity)
      call find_rates(n, batch%height, velocity, rates)
      change = steps%now*rates(:, :3, 2:)
      displacement = displacement + steps%now*rates
      if (batch%damaged) then
        call update_damaged(batch, states, steps, plate, cohesive, change, tractions, before, friction, lost)
        call store_states(batch, states, cohesive, history)
      else
        call update_intact(batch, steps, jumps, change, last, tractions, before, lost)
      end if
      call put(5, points, displacement, batch%first, n + 1, batch%members, u)
      call put(5, points, rates, batch%first, n + 1, batch%members, v)
      call put(3, points, change, batch%first + 1, n, batch%members, history%change)
      call put(3, points, tractions, batch%first + 1, n, batch%members, history%forces)
      call put(2, points, lost, batch%first + 1, n, batch%members, history%lost)
    end associate
    if (.not. batch%damaged) call start_damage(batch, nodes%stacks, plate, displacement, cohesive, u)
  end subroutine move_batch

  !> Velocities of layers, and rates of the unknowns, at the end of a step without tractions.
  pure subroutine find_free_motion(batch, nodes, v, velocity, rates)
    type(stack_batch_t), intent(in) :: batch
    !> The nodes
    type(nodal_steps_t), intent(in) :: nodes
    !> Rates of the unknowns at the start, (5, points)
    real(wp), contiguous, intent(in) :: v(:, :)
    !> Velocities of the layers, and rates of the unknowns
    real(wp), dimension(lanes, 5, batch%n + 1), intent(out) :: velocity, rates
    real(wp) :: loads(lanes, 5, batch%n + 1)
    integer :: lane, l, p

    call take(5, size(v, 2), v, batch%first, batch%n + 1, rates)
    call take(5, size(v, 2), nodes%force, batch%first, batch%n + 1, loads)
    call find_velocities(batch%n, batch%height, rates, velocity)
    call accelerate_layers(batch%n + 1, batch%inverse, nodes%steps%mean(), loads, velocity)
    if (batch%constrained .and. size(nodes%lines%dofs) > 0) then
      do lane = 1, batch%members
        do l = 1, batch%n + 1
          p = batch%first(lane) + l - 1
          if (nodes%lines%is_prescribed(p)) call nodes%lines%prescribe(p, velocity(lane, :, l))
        end do
      end do
    end if
    call find_rates(batch%n, batch%height, velocity, rates)
  end subroutine find_free_motion

  !> Force per opening and given part of the normal forces of undamaged stacks, for frames.
  pure subroutine weigh_openings(n, stiffness, jumps, last, earlier, normal, given)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Stiffness of shear and opening
    real(wp), intent(in) :: stiffness(lanes, 2, n)
    !> Jumps at the start, and their changes in the last step and in the one before
    real(wp), dimension(lanes, 3, n), intent(in) :: jumps, last, earlier
    !> Force per opening, and given parts of the forces; those along the jumps are not used
    real(wp), intent(out) :: normal(lanes, n), given(lanes, 3, n)
    integer :: j

    normal = newest*stiffness(:, 2, :)
    given = 0
    do j = 1, n
      given(:, 3, j) = stiffness(:, 2, j)*past_jumps(jumps(:, 3, j), last(:, 3, j), earlier(:, 3, j))
    end do
  end subroutine weigh_openings

  !> Stops lowest layers at frames that they would penetrate.
  pure subroutine stop_at_frames(batch, rigs, steps, displacement, velocity, normal, given, trial, forces)
    type(stack_batch_t), intent(in) :: batch
    type(rig_steps_t), intent(inout) :: rigs
    type(step_lengths_t), intent(in) :: steps
    !> Unknowns at the start of the step, and velocities of the layers without tractions
    real(wp), dimension(lanes, 5, batch%n + 1), intent(in) :: displacement, velocity
    !> Force per opening, and given parts of the forces
    real(wp), intent(in) :: normal(lanes, batch%n), given(lanes, 3, batch%n)
    !> Jumps without tractions, and forces on the jumps
    real(wp), dimension(lanes, 3, batch%n), intent(inout) :: trial, forces
    real(wp), dimension(lanes, 3, batch%n) :: diagonal, stopped
    real(wp) :: w(lanes), rate
    logical :: stops(lanes)
    integer :: lane

    associate (n => batch%n, time => steps%mean())
      stops = .false.
      diagonal = batch%diagonal
      do lane = 1, batch%members
        w(lane) = sum(displacement(lane, 3, :))
        rate = velocity(lane, 3, n + 1) - time*batch%inverse(lane, 7, n + 1)*forces(lane, 3, n)
        stops(lane) = rigs%on_frame(batch%first(lane)) .and. w(lane) + steps%now*rate > 0
        if (.not. stops(lane)) cycle
        trial(lane, 3, n) = displacement(lane, 3, n + 1) - w(lane) - steps%now*velocity(lane, 3, n)
        diagonal(lane, 3, n) = diagonal(lane, 3, n) - steps%now*time*batch%inverse(lane, 7, n + 1)
      end do
      if (any(stops)) call solve_tractions(n, 3, normal, given, diagonal, batch%off_diagonal, trial, stopped)
      do lane = 1, batch%members
        if (.not. rigs%on_frame(batch%first(lane))) cycle
        if (stops(lane)) forces(lane, 3, :) = stopped(lane, 3, :)
        rate = velocity(lane, 3, n + 1) - time*batch%inverse(lane, 7, n + 1)*forces(lane, 3, n)
        if (stops(lane) .and. .not. w(lane) + steps%now*rate > 0) rate = -w(lane)/steps%now + tiny(rate)
        call rigs%stop_at_frame(batch%first(lane), steps, batch%inverse(lane, 7, n + 1), w(lane), rate)
      end do
    end associate
  end subroutine stop_at_frames

  !> Velocities of layers stopped by frames, and reactions of lines.
  pure subroutine record_reactions(batch, nodes, v, resultants, velocity)
    type(stack_batch_t), intent(in) :: batch
    !> The nodes; their lines receive the reactions
    type(nodal_steps_t), intent(inout) :: nodes
    !> Rates of the unknowns at the start, (5, points)
    real(wp), contiguous, intent(in) :: v(:, :)
    !> Forces of the tractions on the layers
    real(wp), intent(in) :: resultants(lanes, 5, batch%n + 1)
    !> Velocities of the layers at the end
    real(wp), intent(inout) :: velocity(lanes, 5, batch%n + 1)
    real(wp), dimension(lanes, 5, batch%n + 1) :: rates, before
    integer :: lane, l, p

    do lane = 1, batch%members
      p = batch%first(lane)
      if (nodes%rigs%on_frame(p)) velocity(lane, 3, batch%n + 1) = nodes%rigs%approach(p)/nodes%steps%now
    end do
    if (size(nodes%lines%dofs) == 0) return
    call take(5, size(v, 2), v, batch%first, batch%n + 1, rates)
    call find_velocities(batch%n, batch%height, rates, before)
    do lane = 1, batch%members
      do l = 1, batch%n + 1
        p = batch%first(lane) + l - 1
        if (nodes%lines%is_prescribed(p)) &
          call nodes%lines%react(p, nodes%steps, nodes%inertia%mass(:, p), before(lane, :, l), velocity(lane, :, l), &
                                 nodes%force(:, p) + resultants(lane, :, l))
      end do
    end do
  end subroutine record_reactions

  !> Values of consecutive points from the first of each lane on. In this module, and with arrays of explicit shape,
  !> the loop over the values of a point is unrolled, here and in `put`.
  pure subroutine take(values, points, field, first, rows, taken)
    !> Number of values of a point, and of points
    integer, intent(in) :: values, points
    !> Values of all points
    real(wp), intent(in) :: field(values, points)
    !> The first point of each lane, and number of consecutive points
    integer, intent(in) :: first(lanes), rows
    !> Those of the lanes
    real(wp), intent(out) :: taken(lanes, values, rows)
    integer :: lane, l

    do l = 1, rows
      do lane = 1, lanes
        taken(lane, :, l) = field(:, first(lane) + l - 1)
      end do
    end do
  end subroutine take

  !> Reverse of `take` for the lanes with a stack of their own.
  pure subroutine put(values, points, taken, first, rows, members, field)
    !> Number of values of a point, and of points
    integer, intent(in) :: values, points
    !> The first point of each lane, number of consecutive points, and number of lanes
    integer, intent(in) :: first(lanes), rows, members
    !> Values of the lanes
    real(wp), intent(in) :: taken(lanes, values, rows)
    !> Those of all points
    real(wp), intent(inout) :: field(values, points)
    integer :: lane, l

    do l = 1, rows
      do lane = 1, members
        field(:, first(lane) + l - 1) = taken(lane, :, l)
      end do
    end do
  end subroutine put
end module stack_motions
