!> Jumps between layers in a step, over lanes of stacks: work of the tractions, damage, slip and heat, onset of damage.
!>
!> The kinetic energy of the layers at whole steps changes by -(F dJ + (F - F_old) dJ_old/2) with the forces F on the
!> jumps J, theory (E6). Work of the contact pressure beyond the energy it stores is recorded as dissipated by contact;
!> work of the other forces beyond the energy they store and dissipate is algorithmic dissipation.
module stack_updates
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use cohesive_surfaces, only: cohesive_surfaces_t
  use element_batches, only: lanes
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use stack_batches, only: stack_batch_t, surface_lanes_t, surface_states_t
  use stack_solutions, only: energy_of, friction_t, may_grow
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: memory
  implicit none
  private
  public :: start_damage, update_damaged, update_intact

contains

  !> Adds the work of the tractions of undamaged stacks beyond the stored energy k (jump**2 - u**2)/2.
  pure subroutine update_intact(batch, steps, start, change, last, forces, before, lost)
    type(stack_batch_t), intent(in) :: batch
    type(step_lengths_t), intent(in) :: steps
    !> Jumps at the start of the step, their change in this step and in the last
    real(wp), dimension(lanes, 3, batch%n), intent(in) :: start, change, last
    !> Forces on the jumps in this step and in the last
    real(wp), dimension(lanes, 3, batch%n), intent(in) :: forces, before
    !> By contact, and algorithmic
    real(wp), intent(inout) :: lost(lanes, 2, batch%n)
    real(wp) :: work(lanes), stored(lanes, 3)
    integer :: j, k

    do j = 1, batch%n
      work = work_of(steps, forces(:, :, j), before(:, :, j), change(:, :, j), last(:, :, j))
      do k = 1, 3
        stored(:, k) = batch%stiffness(:, merge(2, 1, k == 3), j)*change(:, k, j) &
                       *(start(:, k, j) + (start(:, k, j) + change(:, k, j)))
      end do
      lost(:, 2, j) = lost(:, 2, j) + work - (stored(:, 1) + stored(:, 2) + stored(:, 3))/2
    end do
  end subroutine update_intact

  !> Decrease of the kinetic energy at whole steps by the forces on jumps.
  pure function work_of(steps, forces, before, change, last) result(work)
    type(step_lengths_t), intent(in) :: steps
    !> Forces in this step and in the last
    real(wp), intent(in) :: forces(lanes, 3), before(lanes, 3)
    !> Change of the jumps in this step and, without damping, in the last
    real(wp), intent(in) :: change(lanes, 3), last(lanes, 3)
    !> One for each lane
    real(wp) :: work(lanes)
    real(wp) :: works(lanes, 3)
    integer :: k

    do k = 1, 3
      works(:, k) = steps%work_in_lanes(forces(:, k), before(:, k), change(:, k), steps%kept*last(:, k))
    end do
    work = works(:, 1) + works(:, 2) + works(:, 3)
  end function work_of

  !> Finds the onset of damage in undamaged stacks at the jumps at the end of a step.
  subroutine start_damage(batch, stacks, plate, displacement, cohesive, u)
    type(stack_batch_t), intent(in) :: batch
    !> The stacks; are damaged if an interface is
    type(interface_stacks_t), intent(inout) :: stacks
    type(composite_plate_t), intent(in) :: plate
    !> Unknowns at the end of the step
    real(wp), intent(in) :: displacement(lanes, 5, batch%n + 1)
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> The same of all points, (5, points)
    real(wp), intent(in) :: u(:, :)
    logical :: starts(lanes)
    integer :: j, lane

    starts = .false.
    do j = 1, batch%n
      associate (jump => displacement(:, :3, j + 1))
        starts = starts .or. .not. batch%stiffness(:, 1, j)*(jump(:, 1)**2 + jump(:, 2)**2) &
                 + batch%stiffness(:, 2, j)*max(jump(:, 3), 0.0_wp)**2 < stacks%min_onset(batch%first + j)
      end associate
    end do
    if (.not. any(starts)) return
    do lane = 1, batch%members
      if (starts(lane)) call start_in_stack(stacks, batch%stack(lane), plate, cohesive, u)
    end do
  end subroutine start_damage

  !> Finds the onset of damage of a stack.
  subroutine start_in_stack(stacks, i, plate, cohesive, u)
    type(interface_stacks_t), intent(inout) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(inout) :: cohesive
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
          surfaces = cohesive%surfaces_of(plate, p)
          point%sliding%slip = jump(1:2)
          call surfaces%traction(jump, cohesive_point_t(sliding=point%sliding), traction, point)
          history%lost(2, p) = history%lost(2, p) + sum(k*jump**2)/2 &
                               - stacks%area(p)*(surfaces%stored(jump, point) + point%dissipated)
          if (point%damage > 0) begins = .true.
        end associate
      end do
      if (begins) call stacks%mark_damaged(i, cohesive, u)
    end associate
  end subroutine start_in_stack

  !> Updates damage and friction of damaged stacks, and adds the work of the tractions beyond what surfaces store and
  !> dissipate.
  pure subroutine update_damaged(batch, states, steps, plate, cohesive, change, forces, before, friction, lost)
    type(stack_batch_t), intent(in) :: batch
    !> Their surfaces; are updated
    type(surface_states_t), intent(inout) :: states(batch%n)
    type(step_lengths_t), intent(in) :: steps
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Change of the jumps, and forces on them in this step and in the last
    real(wp), dimension(lanes, 3, batch%n), intent(in) :: change, forces, before
    type(friction_t), intent(in) :: friction(batch%n)
    !> By contact, and algorithmic
    real(wp), intent(inout) :: lost(lanes, 2, batch%n)
    type(surface_states_t) :: old
    real(wp), dimension(lanes) :: work, in_contact, released
    real(wp) :: to(lanes, 3)
    integer :: j

    do j = 1, batch%n
      old = states(j)
      associate (new => states(j), surface => batch%surfaces(j), area => batch%surfaces(j)%area)
        to = old%start + change(:, :, j)
        work = work_of(steps, forces(:, :, j), before(:, :, j), change(:, :, j), old%last)
        call grow_damage(batch, j, plate, cohesive, to, new)
        call slip_surfaces(surface, friction(j), to, change(:, :, j), steps%kept*old%last, new)
        in_contact = lost_in_contact(batch, j, steps, old%start(:, 3), change(:, 3, j), old%last(:, 3)) &
                     + area*closing_loss(surface, old%start(:, 3), to(:, 3), new%damage - old%damage)
        released = stored(surface, new, to) - stored(surface, old, old%start) + (new%dissipated - old%dissipated) &
                   + new%heat - old%heat
        lost(:, 1, j) = lost(:, 1, j) + in_contact
        lost(:, 2, j) = lost(:, 2, j) + (work - in_contact - area*released)
        new%work = area*new%work
      end associate
    end do
  end subroutine update_damaged

  !> Damage, energy dissipated and work per area on the law with the jumps at the end.
  pure subroutine grow_damage(batch, j, plate, cohesive, to, state)
    type(stack_batch_t), intent(in) :: batch
    !> The interface
    integer, intent(in) :: j
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Jumps at the end
    real(wp), intent(in) :: to(lanes, 3)
    !> The surfaces at the start; receive damage, energies and work
    type(surface_states_t), intent(inout) :: state
    type(cohesive_surfaces_t) :: surfaces
    type(cohesive_point_t) :: new
    real(wp) :: traction(3)
    logical :: grows(lanes)
    integer :: lane

    state%work = (1 - state%damage)*energy_of(batch%surfaces(j), state, to) &
                 - (1 - state%damage)*energy_of(batch%surfaces(j), state, state%start)
    where (.not. batch%surfaces(j)%contact) state%work = state%work + batch%surfaces(j)%closing/2* &
      ((1 - state%damage)*min(to(:, 3), 0.0_wp)**2 - (1 - state%damage)*min(state%start(:, 3), 0.0_wp)**2)
    if (cohesive%is_held) return
    grows = may_grow(batch%surfaces(j), state, to)
    if (.not. any(grows)) return
    do lane = 1, lanes
      if (.not. grows(lane)) cycle
      associate (old => cohesive%points(batch%first(lane) + j))
        surfaces = cohesive%surfaces_of(plate, batch%first(lane) + j)
        call surfaces%traction(to(lane, :), old, traction, new)
        state%damage(lane) = new%damage
        state%dissipated(lane) = new%dissipated
        state%work(lane) = surfaces%work(state%start(lane, :), to(lane, :), old, new%damage)
      end associate
    end do
  end subroutine grow_damage

  !> Energy per area stored by the jumps.
  pure function stored(surface, state, jumps) result(energy)
    type(surface_lanes_t), intent(in) :: surface
    type(surface_states_t), intent(in) :: state
    !> Two shears and opening
    real(wp), intent(in) :: jumps(lanes, 3)
    !> One for each lane
    real(wp) :: energy(lanes)

    energy = (1 - state%damage)*energy_of(surface, state, jumps) &
             + merge(1.0_wp, 1 - state%damage, surface%contact) &
             *surface%closing*min(jumps(:, 3), 0.0_wp)**2/2 &
             + merge(sticking_energy(surface%shear, jumps, state%slip), 0.0_wp, surface%friction > 0)
  end function stored

  !> Elastic energy per area of sticking surfaces.
  pure function sticking_energy(stiffness, jumps, slip) result(energy)
    !> Stiffness, pressure per jump
    real(wp), intent(in) :: stiffness(lanes)
    !> Jumps, and slip
    real(wp), intent(in) :: jumps(lanes, 3), slip(lanes, 2)
    !> One for each lane
    real(wp) :: energy(lanes)

    energy = stiffness*((jumps(:, 1) - slip(:, 1))**2 + (jumps(:, 2) - slip(:, 2))**2)/2
  end function sticking_energy

  !> Energy per area that closed surfaces without contact lose by growing damage, by the trapezoidal rule.
  pure function closing_loss(surface, from, to, growth) result(loss)
    type(surface_lanes_t), intent(in) :: surface
    !> Opening at the start and at the end, and growth of damage
    real(wp), intent(in) :: from(lanes), to(lanes), growth(lanes)
    !> One for each lane
    real(wp) :: loss(lanes)

    loss = merge(0.0_wp, surface%closing*growth*min(from, 0.0_wp)*min(to, 0.0_wp)/2, &
                 surface%contact)
  end function closing_loss

  !> Work of the pressure of closed surfaces, a spring at the end of each step, beyond the energy that it stores.
  pure function lost_in_contact(batch, j, steps, before, change, last) result(lost)
    type(stack_batch_t), intent(in) :: batch
    !> The interface
    integer, intent(in) :: j
    type(step_lengths_t), intent(in) :: steps
    !> Opening at the start of the step, its change and, without damping, that in the last step
    real(wp), intent(in) :: before(lanes), change(lanes), last(lanes)
    !> One for each lane
    real(wp) :: lost(lanes)
    real(wp), dimension(lanes) :: from, to

    from = min(before, 0.0_wp)
    to = min(before + change, 0.0_wp)
    lost = merge(batch%stiffness(:, 2, j)*(steps%work_in_lanes(to, from, change, steps%kept*last) &
                                           - (to**2 - from**2)/2), 0.0_wp, batch%surfaces(j)%contact)
  end function lost_in_contact

  !> Slip of surfaces, change of their elastic jumps, and heat, theory (T11): the work of friction less half of the
  !> change of the energy of sticking in this step and half of that in the step before, while forces depend on a slip.
  !> Negative values are subtracted from later heat.
  pure subroutine slip_surfaces(surface, friction, to, change, last, state)
    type(surface_lanes_t), intent(in) :: surface
    type(friction_t), intent(in) :: friction
    !> Jumps at the end, their change, and that in the last step
    real(wp), dimension(lanes, 3), intent(in) :: to, change, last
    !> The surfaces at the start; receive slip and heat
    type(surface_states_t), intent(inout) :: state
    real(wp), dimension(lanes) :: before, after, work, heat
    logical, dimension(lanes) :: rubs, free, moves
    integer :: k

    rubs = surface%friction > 0
    state%limit = friction%limit/surface%area
    if (.not. any(rubs)) then
      state%slip = 0
      state%heat = 0
      return
    end if
    before = sticking_energy(surface%shear, state%start, state%slip)
    free = .not. friction%limit > 0
    moves = .false.
    do k = 1, 2
      heat = merge(to(:, k), merge(to(:, k) - friction%elastic(:, k), state%slip(:, k), friction%slips), free)
      moves = moves .or. abs(heat - state%slip(:, k)) > 0
      state%slip(:, k) = merge(heat, 0.0_wp, rubs)
      state%sticking(:, k + 2) = merge(0.0_wp, state%sticking(:, k), friction%slips .or. free)
      ! Forces of slipping surfaces do not depend on the forces before the slip.
      state%sticking(:, k) = merge(0.0_wp, change(:, k), friction%slips .or. free)
    end do
    after = sticking_energy(surface%shear, to, state%slip) - before
    work = (friction%force(:, 1)*(change(:, 1) + last(:, 1)) + friction%force(:, 2)*(change(:, 2) + last(:, 2))) &
           /(2*surface%area)
    associate (steps => state%rubbing(:, 1), sticking => state%rubbing(:, 2), deficit => state%rubbing(:, 3))
      where (moves) steps = real(memory, wp)
      where (rubs .and. steps > 0)
        heat = work - (after + sticking)/2 - deficit
        state%heat = state%heat + max(0.0_wp, heat)
        steps = steps - 1
        deficit = max(0.0_wp, -heat)
      end where
      where (rubs) sticking = after
    end associate
    where (.not. rubs) state%heat = 0
  end subroutine slip_surfaces
end module stack_updates
