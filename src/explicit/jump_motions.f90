!> Jumps between layers in a step: update, damage, and work of the tractions.
!>
!> The kinetic energy of the layers at whole steps changes by -(F dJ + (F - F_old) dJ_old/2) with the forces F on the
!> jumps J, theory (E6). Work of the contact pressure beyond the energy it stores is recorded as dissipated by contact;
!> work of the other forces beyond the energy they store and dissipate is algorithmic dissipation.
module jump_motions
  use cohesive_surfaces, only: cohesive_surfaces_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use surface_friction, only: friction_energy, sliding_t
  use interface_stacks, only: interface_stacks_t
  use jump_histories, only: friction_history_t
  use kinds, only: wp
  use models, only: model_t
  use nodal_steps, only: nodal_steps_t
  use stack_solutions, only: friction_t
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: memory
  implicit none
  private
  public :: advance_intact, advance_points, start_damage

contains

  !> Updates the jumps of an undamaged stack, and finds the onset of damage.
  subroutine advance_intact(nodes, i, model, forces, cohesive, u, v)
    !> The nodes
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(:, :)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    real(wp) :: change(3), jump(3)
    integer :: j, p

    associate (stacks => nodes%stacks, history => nodes%stacks%history, steps => nodes%steps)
      do j = 1, size(forces, 2)
        p = stacks%first(i) + j
        change = steps%now*v(1:3, p)
        jump = u(1:3, p) + change
        ! Work beyond the stored energy k (jump**2 - u**2)/2.
        history%lost(2, p) = history%lost(2, p) + work_of(stacks, p, steps, forces(:, j), change) &
                             - sum(stacks%stiffness([1, 1, 2], p)*change*(u(1:3, p) + jump))/2
        u(1:3, p) = jump
        call history%record(p, forces(:, j), change)
      end do
      call start_damage(stacks, i, model, cohesive, u)
    end associate
  end subroutine advance_intact

  !> Finds the onset of damage of a stack at the jumps at the end of a step.
  subroutine start_damage(stacks, i, model, cohesive, u)
    !> The stacks; the stack is damaged if an interface is
    type(interface_stacks_t), intent(inout) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns, (5, points)
    real(wp), intent(in) :: u(:, :)
    type(cohesive_surfaces_t) :: surfaces
    real(wp) :: k(3), traction(3)
    logical :: begins
    integer :: p

    begins = .false.
    associate (history => stacks%history, from => stacks%first(i) + 1, to => stacks%first(i) + stacks%layers(i) - 1)
      do p = from, to
        k = stacks%stiffness([1, 1, 2], p)
        associate (jump => u(1:3, p), point => cohesive%points(p))
          if (k(1)*(jump(1)**2 + jump(2)**2) + k(3)*max(jump(3), 0.0_wp)**2 < stacks%min_onset(p)) cycle
          surfaces = cohesive%surfaces_of(model, p)
          point%sliding%slip = jump(1:2)
          call surfaces%traction(jump, cohesive_point_t(sliding=point%sliding), traction, point)
          history%lost(2, p) = history%lost(2, p) + sum(k*jump**2)/2 &
                               - stacks%area(p)*(surfaces%stored(jump, point) + point%dissipated)
          if (point%damage > 0) begins = .true.
        end associate
      end do
      if (begins) call stacks%mark_damaged(i, cohesive, u)
    end associate
  end subroutine start_damage

  !> Updates jumps, damage and friction of a damaged stack, and records the work of the tractions.
  subroutine advance_points(nodes, i, forces, cohesive, u, v)
    !> The nodes, with laws and friction in the work array of the stack
    type(nodal_steps_t), intent(inout) :: nodes
    !> Index of the stack
    integer, intent(in) :: i
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(:, :)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    type(cohesive_point_t) :: old
    real(wp) :: change(3), last(3), before(3), traction(3), work, in_contact, growth
    integer :: j, p

    associate (stacks => nodes%stacks, history => nodes%stacks%history, steps => nodes%steps)
      do j = 1, size(forces, 2)
        p = stacks%first(i) + j
        change = steps%now*v(1:3, p)
        last = history%last_change(p, steps%kept)
        before = u(1:3, p)
        u(1:3, p) = before + change
        work = work_of(stacks, p, steps, forces(:, j), change)
        in_contact = 0
        if (nodes%workspaces(size(forces, 2))%closing(j)) &
          in_contact = lost_in_contact(stacks, p, steps, before(3), change(3))
        old = cohesive%points(p)
        associate (new => cohesive%points(p), area => stacks%area(p), &
                   friction => nodes%workspaces(size(forces, 2))%friction(j), &
                   surfaces => nodes%workspaces(size(forces, 2))%surfaces(j))
          old%sliding%limit = friction%limit/area
          call surfaces%traction(u(1:3, p), old, traction, new)
          if (surfaces%friction > 0) then
            call slip_surfaces(friction, u(1:2, p), old%sliding, new%sliding, history%sticking(:, p), change(1:2))
            call add_heat(surfaces%law%stiffness_shear, before(1:2), u(1:2, p), &
                          sum(friction%force*(change(1:2) + last(1:2)))/(2*area), old%sliding, new%sliding, &
                          history%friction(p))
          end if
          growth = new%dissipated - old%dissipated
          in_contact = in_contact + area*surfaces%closing_loss(before(3), u(3, p), new%damage - old%damage)
          history%lost(:, p) = history%lost(:, p) + [in_contact, work - in_contact - area* &
            (surfaces%stored(u(1:3, p), new) - surfaces%stored(before, old) + growth + &
             new%sliding%heat - old%sliding%heat)]
          history%work(p) = area*surfaces%work(before, u(1:3, p), old, new%damage)
        end associate
        call history%record(p, forces(:, j), change)
      end do
    end associate
  end subroutine advance_points

  !> Decrease of the kinetic energy at whole steps by the forces on a jump.
  pure real(wp) function work_of(stacks, p, steps, force, change)
    !> The stacks, with force and change of the step before
    type(interface_stacks_t), intent(in) :: stacks
    !> The point
    integer, intent(in) :: p
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Force, and change of the jump in this step
    real(wp), intent(in) :: force(3), change(3)
    real(wp) :: last(3)

    last = stacks%history%last_change(p, steps%kept)
    work_of = sum(force*(change + steps%shift(last, change)) + (force - stacks%history%forces(:, p))*last/2)
  end function work_of

  !> The same for the pressure of closed surfaces, a spring at the end of each step, beyond the energy that it stores.
  pure real(wp) function lost_in_contact(stacks, p, steps, before, change) result(lost)
    !> The stacks, with the change of the step before
    type(interface_stacks_t), intent(in) :: stacks
    !> The point
    integer, intent(in) :: p
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Opening at the start of the step, and its change
    real(wp), intent(in) :: before, change
    real(wp) :: from, to, last(3)

    last = stacks%history%last_change(p, steps%kept)
    from = min(before, 0.0_wp)
    to = min(before + change, 0.0_wp)
    lost = stacks%stiffness(2, p)*(to*(change + steps%shift(last(3), change)) + (to - from)*last(3)/2 &
                                   - (to**2 - from**2)/2)
  end function lost_in_contact

  !> Slip of surfaces, and the change of their elastic jumps.
  pure subroutine slip_surfaces(friction, jumps, old, new, sticking, change)
    !> Friction in the step
    type(friction_t), intent(in) :: friction
    !> Tangential jumps at the end
    real(wp), intent(in) :: jumps(2)
    !> The surfaces at the start
    type(sliding_t), intent(in) :: old
    !> The surfaces at the end; receive the slip
    type(sliding_t), intent(inout) :: new
    !> Change of the elastic jumps in the last two steps; receives that of this one
    real(wp), intent(inout) :: sticking(4)
    !> Change of the jumps
    real(wp), intent(in) :: change(2)

    new%slip = old%slip
    if (.not. friction%limit > 0) then
      new%slip = jumps
    else if (friction%slips) then
      new%slip = jumps - friction%elastic
    end if
    sticking = [change, sticking(1:2)]
    ! Forces of slipping surfaces do not depend on the forces before the slip.
    if (friction%slips .or. .not. friction%limit > 0) sticking = 0
  end subroutine slip_surfaces

  !> Heat of slipping surfaces, theory (T11): the work of friction less half of the change of the energy of sticking in
  !> this step and half of that in the step before, while forces depend on a slip. Negative values are subtracted from
  !> later heat.
  pure subroutine add_heat(stiffness, from, to, work, old, new, history)
    !> Stiffness of sticking surfaces, pressure per jump
    real(wp), intent(in) :: stiffness
    !> Tangential jumps at the start and at the end
    real(wp), intent(in) :: from(2), to(2)
    !> Work of friction per area
    real(wp), intent(in) :: work
    !> The surfaces at the start
    type(sliding_t), intent(in) :: old
    !> The surfaces at the end; receive the heat
    type(sliding_t), intent(inout) :: new
    !> Earlier steps; receives this one
    type(friction_history_t), intent(inout) :: history
    real(wp) :: heat, stored

    if (norm2(new%slip - old%slip) > 0) history%steps = memory
    new%heat = old%heat
    stored = friction_energy(stiffness, to, new) - friction_energy(stiffness, from, old)
    if (history%steps > 0) then
      heat = work - (stored + history%stored)/2 - history%deficit
      new%heat = old%heat + max(0.0_wp, heat)
      history%steps = history%steps - 1
      history%deficit = max(0.0_wp, -heat)
    end if
    history%stored = stored
  end subroutine add_heat
end module jump_motions
