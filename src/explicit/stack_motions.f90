!> Motion of the layers of a node in a step: velocities from the forces on each layer, tractions between them, jumps.
module stack_motions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use damaged_stacks, only: load_stack, solve_damaged
  use element_batches, only: lanes
  use intact_stacks, only: create_intact_batches, move_intact
  use interface_stacks, only: interface_stacks_t
  use jump_motions, only: advance_intact, advance_points, start_damage
  use kinds, only: wp
  use layer_motions, only: accelerate_layers, find_rates, traction_resultant, accelerate_by_tractions, to_layers
  use line_steps, only: line_steps_t
  use models, only: model_t
  use nodal_steps, only: nodal_steps_t
  use stack_solutions, only: stack_t
  use tridiagonal_systems, only: solve_factored, solve_tractions
  use weighted_jumps, only: newest, past_jumps
  implicit none
  private
  public :: move_stacks, new_workspaces

contains

  !> Work arrays for the stacks of a model, one for each number of interfaces.
  pure function new_workspaces(stacks) result(work)
    type(interface_stacks_t), intent(in) :: stacks
    !> (largest number of interfaces)
    type(stack_t), allocatable :: work(:)
    integer :: n

    allocate (work(maxval([1, stacks%layers]) - 1))
    do n = 1, size(work)
      work(n)%n = n
      allocate (work(n)%stiffness(2, n), work(n)%diagonal(3, n), work(n)%off_diagonal(3, n), work(n)%trial(3, n), &
                work(n)%start(3, n), work(n)%points(n), work(n)%surfaces(n), work(n)%closing(n), work(n)%friction(n), &
                work(n)%secant(2, n), work(n)%given(3, n), work(n)%forces(3, n), work(n)%normal_stiffness(n))
    end do
  end function new_workspaces

  !> Updates all stacks.
  subroutine move_stacks(nodes, model, cohesive, u, v)
    !> The nodes; their stacks receive forces, changes of the jumps and losses
    type(nodal_steps_t), intent(inout) :: nodes
    type(model_t), intent(in) :: model
    !> The interfaces; receive the growth of damage
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), contiguous, intent(inout) :: u(:, :), v(:, :)
    logical :: reaches_onset(lanes)
    integer :: i, b, lane

    if (allocated(nodes%intact) .and. count(nodes%stacks%damaged) > nodes%damaged) deallocate (nodes%intact)
    if (.not. allocated(nodes%intact)) call separate_stacks(nodes)
    do b = 1, size(nodes%intact)
      call move_intact(nodes%intact(b), nodes%steps, nodes%force, nodes%stacks, u, v, reaches_onset)
      if (.not. any(reaches_onset)) cycle
      do lane = 1, lanes
        if (.not. reaches_onset(lane)) cycle
        if (lane > 1) then
          if (nodes%intact(b)%stack(lane) == nodes%intact(b)%stack(lane - 1)) exit
        end if
        call start_damage(nodes%stacks, nodes%intact(b)%stack(lane), model, cohesive, u)
      end do
    end do
    do i = 1, size(nodes%others)
      call move_stack(nodes, nodes%others(i), model, cohesive, u, v)
    end do
  end subroutine move_stacks

  !> Separates undamaged stacks on no frame and no line from the others.
  pure subroutine separate_stacks(nodes)
    !> The nodes
    type(nodal_steps_t), intent(inout) :: nodes
    logical :: is_other(size(nodes%stacks%first))
    integer :: i, p

    do i = 1, size(is_other)
      associate (first => nodes%stacks%first(i), last => nodes%stacks%first(i) + nodes%stacks%layers(i) - 1)
        is_other(i) = nodes%stacks%damaged(i) .or. nodes%rigs%on_frame(first)
        if (size(nodes%lines%dofs) == 0) cycle
        is_other(i) = is_other(i) .or. any([(nodes%lines%is_prescribed(p), p=first, last)])
      end associate
    end do
    nodes%damaged = count(nodes%stacks%damaged)
    nodes%others = pack([(i, i=1, size(is_other))], is_other)
    nodes%intact = create_intact_batches(nodes%stacks, nodes%inertia, pack([(i, i=1, size(is_other))], .not. is_other))
  end subroutine separate_stacks

  !> Updates one stack.
  subroutine move_stack(nodes, i, model, cohesive, u, v)
    !> The nodes
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    real(wp) :: layer(5, nodes%stacks%layers(i))
    real(wp), dimension(3, nodes%stacks%layers(i) - 1) :: rates, trial, forces
    integer :: n, p, q

    n = nodes%stacks%layers(i) - 1
    p = nodes%stacks%first(i)
    q = p + n
    associate (stacks => nodes%stacks, steps => nodes%steps)
      call to_layers(n, stacks%height(p:q), v(:, p:q), layer)
      call accelerate_layers(n + 1, nodes%inertia%inverse(:, p:q), steps%mean(), nodes%force(:, p:q), layer)
      call prescribe_layers(nodes%lines, p, layer)
      call find_rates(n, stacks%height(p:q), layer, rates)
      trial = u(1:3, p + 1:q) + steps%now*rates
      call find_forces(nodes, i, model, cohesive, u, trial, forces)
      if (nodes%rigs%on_frame(p)) call stop_stack_at_frame(nodes, i, u(3, p:q), trial(3, :), layer, forces(3, :))
      call accelerate_by_tractions(n, stacks%height(p:q), nodes%inertia%inverse(:, p:q), steps%mean(), forces, layer)
      if (nodes%rigs%on_frame(p)) layer(3, n + 1) = nodes%rigs%approach(p)/steps%now
      call record_reactions(nodes, i, forces, v(:, p:q), layer)
      call find_rates(n, stacks%height(p:q), layer, rates)
      v(:, p) = layer(:, 1)
      v(1:3, p + 1:q) = rates
      v(4:5, p + 1:q) = layer(4:5, 2:)
      if (stacks%damaged(i)) then
        call advance_points(nodes, i, forces, cohesive, u, v)
      else
        call advance_intact(nodes, i, model, forces, cohesive, u, v)
      end if
      u(4:5, p + 1:q) = u(4:5, p + 1:q) + steps%now*v(4:5, p + 1:q)
      u(:, p) = u(:, p) + steps%now*v(:, p)
    end associate
  end subroutine move_stack

  !> Prescribes the velocities of layers on lines.
  pure subroutine prescribe_layers(lines, first, layer)
    type(line_steps_t), intent(in) :: lines
    !> First point of the stack
    integer, intent(in) :: first
    !> Velocities of the layers, (5, n + 1)
    real(wp), intent(inout) :: layer(:, :)
    integer :: l

    if (size(lines%dofs) == 0) return
    do l = 1, size(layer, 2)
      if (lines%is_prescribed(first + l - 1)) call lines%prescribe(first + l - 1, layer(:, l))
    end do
  end subroutine prescribe_layers

  !> Forces on the jumps of a stack, as if there were no frame.
  pure subroutine find_forces(nodes, i, model, cohesive, u, trial, forces)
    !> The nodes; the work array of the stack receives its stiffness
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Unknowns, (5, points)
    real(wp), intent(in) :: u(:, :)
    !> Jumps without tractions, (3, n)
    real(wp), contiguous, intent(in) :: trial(:, :)
    !> Forces on the jumps, (3, n)
    real(wp), contiguous, intent(out) :: forces(:, :)
    real(wp) :: past(3, size(trial, 2))

    associate (stacks => nodes%stacks, work => nodes%workspaces(size(trial, 2)), p => nodes%stacks%first(i), &
               from => nodes%stacks%first(i) + 1, to => nodes%stacks%first(i) + size(trial, 2))
      if (stacks%damaged(i)) then
        call load_stack(stacks, work, model, cohesive, p, u, trial)
        call solve_damaged(stacks, work, nodes%steps, p)
        forces = work%forces
      else
        past = past_jumps(u(1:3, from:to), stacks%history%change(:, from:to), stacks%history%earlier(:, from:to))
        call solve_factored(size(trial, 2), stacks%factors(:, :, from:to), trial + past/newest, forces)
        if (nodes%rigs%on_frame(p)) then
          work%normal_stiffness = newest*stacks%stiffness(2, from:to)
          work%given(3, :) = stacks%stiffness(2, from:to)*past(3, :)
        end if
      end if
    end associate
  end subroutine find_forces

  !> Stops the lowest layer at a frame that it would penetrate.
  pure subroutine stop_stack_at_frame(nodes, i, u, trial, layer, forces)
    !> The nodes, with the stack's stiffness against openings and the given part of the forces
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    !> Deflection of the first layer and openings at the start of the step, (n + 1)
    real(wp), intent(in) :: u(:)
    !> Openings without tractions, (n)
    real(wp), intent(inout) :: trial(:)
    !> Velocities of the layers without tractions, (5, n + 1)
    real(wp), intent(in) :: layer(:, :)
    !> Forces on the openings, (n)
    real(wp), intent(inout) :: forces(:)
    real(wp) :: rate, w, diagonal(size(trial))

    w = sum(u)
    associate (n => size(trial), p => nodes%stacks%first(i), steps => nodes%steps, stacks => nodes%stacks, &
               work => nodes%workspaces(size(trial)), &
               inverse => nodes%inertia%inverse(7, nodes%stacks%first(i) + size(trial)))
      rate = layer(3, n + 1) - steps%mean()*inverse*forces(n)
      if (w + steps%now*rate > 0) then
        rate = layer(3, n + 1)
        trial(n) = u(n + 1) - w - steps%now*layer(3, n)
        diagonal = stacks%diagonal(3, p + 1:p + n)
        diagonal(n) = diagonal(n) - steps%now*steps%mean()*inverse
        call solve_tractions(n, work%normal_stiffness, work%given(3, :), diagonal, &
                             stacks%off_diagonal(3, p + 1:p + n), trial, forces)
        rate = rate - steps%mean()*inverse*forces(n)
        if (.not. w + steps%now*rate > 0) rate = -w/steps%now + tiny(rate)
      end if
      call nodes%rigs%stop_at_frame(p, steps, inverse, w, rate)
    end associate
  end subroutine stop_stack_at_frame

  !> Records the reactions of lines on the layers of a stack.
  pure subroutine record_reactions(nodes, i, forces, before, after)
    !> The nodes; their lines receive the reactions
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(:, :)
    !> Rates of the unknowns before the step, and velocities of the layers after it, (5, n + 1)
    real(wp), intent(in) :: before(:, :), after(:, :)
    real(wp) :: layer(5, size(after, 2))
    integer :: l, p

    if (size(nodes%lines%dofs) == 0) return
    associate (n => size(forces, 2), first => nodes%stacks%first(i), &
               height => nodes%stacks%height(nodes%stacks%first(i):nodes%stacks%first(i) + size(forces, 2)))
      if (.not. any([(nodes%lines%is_prescribed(p), p=first, first + n)])) return
      call to_layers(n, height, before, layer)
      do l = 1, n + 1
        p = first + l - 1
        if (nodes%lines%is_prescribed(p)) &
          call nodes%lines%react(p, nodes%steps, nodes%inertia%mass(:, p), layer(:, l), after(:, l), &
                                 nodes%force(:, p) + traction_resultant(n, height, forces, l))
      end do
    end associate
  end subroutine record_reactions
end module stack_motions
