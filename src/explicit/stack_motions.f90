!> Motion of the layers of a node in a step: velocities from the forces on each layer, tractions between them, jumps.
module stack_motions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use damaged_stacks, only: load_stack, solve_damaged
  use interface_stacks, only: interface_stacks_t
  use jump_motions, only: advance_intact, advance_points
  use kinds, only: wp
  use layer_motions, only: accelerate_layers, find_rates, traction_resultant, accelerate_by_tractions, to_layers
  use line_steps, only: line_steps_t
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use stack_solutions, only: stack_t
  use step_lengths, only: step_lengths_t
  use rig_steps, only: rig_steps_t
  use tridiagonal_systems, only: solve_factored, solve_tractions
  use weighted_jumps, only: newest, past_jumps
  implicit none
  private
  public :: move_stacks, new_workspaces

contains

  !> Work arrays for the stacks of a model, one for each number of interfaces.
  pure function new_workspaces(stacks) result(work)
    !> The stacks
    type(interface_stacks_t), intent(in) :: stacks
    !> (largest number of interfaces)
    type(stack_t), allocatable :: work(:)
    integer :: n

    allocate (work(maxval([1, stacks%layers]) - 1))
    do n = 1, size(work)
      work(n)%n = n
      allocate (work(n)%stiffness(2, n), work(n)%diagonal(3, n), work(n)%off_diagonal(3, n), work(n)%trial(3, n), &
                work(n)%start(3, n), work(n)%points(n), work(n)%closing(n), work(n)%friction(n), work(n)%secant(2, n), &
                work(n)%given(3, n), work(n)%forces(3, n), work(n)%normal_stiffness(n))
    end do
  end function new_workspaces

  !> Updates all stacks.
  subroutine move_stacks(stacks, work, rigs, lines, model, inertia, steps, force, cohesive, u, v)
    !> The stacks; receive forces, changes of the jumps and losses
    type(interface_stacks_t), intent(inout) :: stacks
    !> Work arrays, one for each number of interfaces
    type(stack_t), intent(inout) :: work(:)
    !> Frames
    type(rig_steps_t), intent(inout) :: rigs
    !> Lines
    type(line_steps_t), intent(inout) :: lines
    type(model_t), intent(in) :: model
    !> Lumped inertia, inverted for the step
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the layers, without tractions, (5, points)
    real(wp), intent(in) :: force(:, :)
    !> The interfaces; receive the growth of damage
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    integer :: i

    do i = 1, size(stacks%first)
      call move_stack(stacks, i, work(stacks%layers(i) - 1), rigs, lines, model, inertia, steps, force, cohesive, u, v)
    end do
  end subroutine move_stacks

  !> Updates one stack.
  subroutine move_stack(stacks, i, work, rigs, lines, model, inertia, steps, force, cohesive, u, v)
    !> The stacks
    type(interface_stacks_t), intent(inout) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    !> Work array
    type(stack_t), intent(inout) :: work
    !> Frames
    type(rig_steps_t), intent(inout) :: rigs
    !> Lines
    type(line_steps_t), intent(inout) :: lines
    type(model_t), intent(in) :: model
    !> Lumped inertia
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the layers, (5, points)
    real(wp), intent(in) :: force(:, :)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    real(wp) :: layer(5, stacks%layers(i)), trial(3, work%n), forces(3, work%n), past(3, work%n)
    integer :: n, p, q, k
    logical :: prescribed

    n = work%n
    p = stacks%first(i)
    q = p + n
    call to_layers(n, stacks%height(p:q), v(:, p:q), layer)
    call accelerate_layers(n + 1, inertia%inverse(:, p:q), steps%mean(), force(:, p:q), layer)
    prescribed = size(lines%dofs) > 0
    if (prescribed) prescribed = any([(lines%is_prescribed(k), k=p, q)])
    if (prescribed) then
      do k = 0, n
        if (lines%is_prescribed(p + k)) call lines%prescribe(p + k, layer(:, k + 1))
      end do
    end if
    call find_rates(n, stacks%height(p:q), layer, trial)
    trial = u(1:3, p + 1:q) + steps%now*trial
    if (stacks%damaged(i)) then
      call load_stack(stacks, work, model, cohesive, p, u, trial)
      call solve_damaged(stacks, work, model, steps, cohesive, p)
      forces = work%forces
    else
      past = past_jumps(u(1:3, p + 1:q), stacks%history%change(:, p + 1:q), stacks%history%earlier(:, p + 1:q))
      call solve_factored(n, stacks%factors(:, :, p + 1:q), trial + past/newest, forces)
      if (rigs%on_frame(p)) then
        work%normal_stiffness = newest*stacks%stiffness(2, p + 1:q)
        work%given(3, :) = stacks%stiffness(2, p + 1:q)*past(3, :)
      end if
    end if
    if (rigs%on_frame(p)) call stop_stack_at_frame(stacks, i, work, rigs, inertia, steps, u(3, p:q), trial(3, :), &
                                                   layer, forces(3, :))
    call accelerate_by_tractions(n, stacks%height(p:q), inertia%inverse(:, p:q), steps%mean(), forces, layer)
    if (rigs%on_frame(p)) layer(3, n + 1) = rigs%approach(p)/steps%now
    if (prescribed) &
      call record_reactions(stacks, i, lines, inertia, steps, force(:, p:q), forces, v(:, p:q), layer)
    call find_rates(n, stacks%height(p:q), layer, trial)
    v(:, p) = layer(:, 1)
    v(1:3, p + 1:q) = trial
    v(4:5, p + 1:q) = layer(4:5, 2:)
    if (stacks%damaged(i)) then
      call advance_points(stacks, i, model, steps, work%friction, forces, cohesive, u, v)
    else
      call advance_intact(stacks, i, model, steps, forces, cohesive, u, v)
    end if
    u(4:5, p + 1:q) = u(4:5, p + 1:q) + steps%now*v(4:5, p + 1:q)
    u(:, p) = u(:, p) + steps%now*v(:, p)
  end subroutine move_stack

  !> Stops the lowest layer at a frame that it would penetrate.
  pure subroutine stop_stack_at_frame(stacks, i, work, rigs, inertia, steps, u, trial, layer, forces)
    !> The stacks
    type(interface_stacks_t), intent(in) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    !> The stack, with its stiffness against openings and the given part of the forces
    type(stack_t), intent(in) :: work
    !> Frames
    type(rig_steps_t), intent(inout) :: rigs
    !> Lumped inertia
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
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
    associate (n => size(trial), p => stacks%first(i), inverse => inertia%inverse(7, stacks%first(i) + size(trial)))
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
      call rigs%stop_at_frame(p, steps, inverse, w, rate)
    end associate
  end subroutine stop_stack_at_frame

  !> Records the reactions of lines on the layers of a stack.
  pure subroutine record_reactions(stacks, i, lines, inertia, steps, force, forces, before, after)
    !> The stacks
    type(interface_stacks_t), intent(in) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    !> The lines
    type(line_steps_t), intent(inout) :: lines
    !> Lumped inertia
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the layers, (5, n + 1), and on the jumps, (3, n)
    real(wp), intent(in) :: force(:, :), forces(:, :)
    !> Rates of the unknowns before the step, and velocities of the layers after it, (5, n + 1)
    real(wp), intent(in) :: before(:, :), after(:, :)
    real(wp) :: layer(5, size(force, 2))
    integer :: l, p

    associate (height => stacks%height(stacks%first(i):stacks%first(i) + stacks%layers(i) - 1))
      call to_layers(size(forces, 2), height, before, layer)
      do l = 1, size(force, 2)
        p = stacks%first(i) + l - 1
        if (lines%is_prescribed(p)) call lines%react(p, steps, inertia%mass(:, p), layer(:, l), after(:, l), &
                                                 force(:, l) + traction_resultant(size(forces, 2), height, forces, l))
      end do
    end associate
  end subroutine record_reactions
end module stack_motions
