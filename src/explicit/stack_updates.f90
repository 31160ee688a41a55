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
  use stack_batches, only: layer_constants_t, layer_lanes_t, stack_batch_t, surface_lanes_t
  use stack_solutions, only: energy_of, may_grow
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: memory
  implicit none
  private
  public :: start_damage, update_damaged, update_intact

contains

  !> Adds the work of the tractions of undamaged stacks beyond the stored energy k (jump**2 - u**2)/2.
  pure subroutine update_intact(batch, steps, layers)
    type(stack_batch_t), intent(in) :: batch
    type(step_lengths_t), intent(in) :: steps
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp) :: stored(lanes, 3)
    integer :: j, k

    do j = 1, batch%n
      associate (layer => layers(j), lost => layers(j)%past%lost(:, 2))
        do k = 1, 3
          stored(:, k) = batch%layers(j)%stiffness(:, merge(2, 1, k == 3))*layer%change(:, k) &
                         *(layer%u(:, k) + (layer%u(:, k) + layer%change(:, k)))
        end do
        lost = lost + work_of(steps, layer) - (stored(:, 1) + stored(:, 2) + stored(:, 3))/2
      end associate
    end do
  end subroutine update_intact

  !> Decrease of the kinetic energy at whole steps by the forces on jumps.
  pure function work_of(steps, layer) result(work)
    type(step_lengths_t), intent(in) :: steps
    type(layer_lanes_t), intent(in) :: layer
    real(wp) :: work(lanes)
    real(wp) :: works(lanes, 3)
    integer :: k

    do k = 1, 3
      works(:, k) = steps%work_in_lanes(layer%forces(:, k), layer%past%forces(:, k), layer%change(:, k), &
                                        steps%kept*layer%past%change(:, k))
    end do
    work = works(:, 1) + works(:, 2) + works(:, 3)
  end function work_of

  !> Finds the onset of damage in undamaged stacks at the jumps at the end of a step.
  subroutine start_damage(batch, layers, stacks, plate, cohesive, u)
    type(stack_batch_t), intent(in) :: batch
    !> Layers with their unknowns at the end of the step
    type(layer_lanes_t), intent(in) :: layers(0:batch%n)
    !> The stacks; are damaged if an interface is
    type(interface_stacks_t), intent(inout) :: stacks
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    real(wp), intent(in) :: u(:, :)
    logical :: starts(lanes)
    integer :: j, lane

    starts = .false.
    do j = 1, batch%n
      associate (jump => layers(j)%u, stiffness => batch%layers(j)%stiffness)
        starts = starts .or. .not. stiffness(:, 1)*(jump(:, 1)**2 + jump(:, 2)**2) &
                 + stiffness(:, 2)*max(jump(:, 3), 0.0_wp)**2 < stacks%min_onset(batch%first + j)
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
    do p = stacks%first(i) + 1, stacks%first(i) + stacks%layers(i) - 1
      k = stacks%stiffness([1, 1, 2], p)
      associate (jump => u(1:3, p), point => cohesive%points(p), lost => stacks%history(p)%lost(2))
        if (k(1)*(jump(1)**2 + jump(2)**2) + k(3)*max(jump(3), 0.0_wp)**2 < stacks%min_onset(p)) cycle
        surfaces = cohesive%surfaces_of(plate, p)
        point%sliding%slip = jump(1:2)
        call surfaces%traction(jump, cohesive_point_t(sliding=point%sliding), traction, point)
        lost = lost + sum(k*jump**2)/2 - stacks%area(p)*(surfaces%stored(jump, point) + point%dissipated)
        if (point%damage > 0) begins = .true.
      end associate
    end do
    if (begins) call stacks%mark_damaged(i, plate, cohesive, u)
  end subroutine start_in_stack

  !> Updates damage and friction of damaged stacks, and adds the work of the tractions beyond what surfaces store and
  !> dissipate.
  pure subroutine update_damaged(batch, steps, plate, cohesive, layers)
    type(stack_batch_t), intent(in) :: batch
    type(step_lengths_t), intent(in) :: steps
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp), dimension(lanes) :: damage, dissipated, heat, before, in_contact, released
    real(wp) :: to(lanes, 3)
    integer :: j

    do j = 1, batch%n
      associate (layer => layers(j), surfaces => layers(j)%surfaces, constants => batch%layers(j), &
                 lost => layers(j)%past%lost)
        damage = surfaces%damage
        dissipated = surfaces%dissipated
        heat = surfaces%heat
        before = stored(constants, surfaces, layer%u(:, :3))
        to = layer%u(:, :3) + layer%change
        call grow_damage(batch, j, plate, cohesive, to, layer)
        call slip_surfaces(constants, steps, to, layer)
        in_contact = lost_in_contact(constants, steps, layer, surfaces%damage - damage)
        released = stored(constants, surfaces, to) - before + (surfaces%dissipated - dissipated) + surfaces%heat - heat
        lost(:, 1) = lost(:, 1) + in_contact
        lost(:, 2) = lost(:, 2) + (work_of(steps, layer) - in_contact - constants%area*released)
        layer%past%work = constants%area*layer%past%work
      end associate
    end do
  end subroutine update_damaged

  !> Damage, energy dissipated and work per area on the law with the jumps at the end.
  pure subroutine grow_damage(batch, j, plate, cohesive, to, layer)
    type(stack_batch_t), intent(in) :: batch
    !> The interface
    integer, intent(in) :: j
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Jumps at the end
    real(wp), intent(in) :: to(lanes, 3)
    !> The surfaces at the start; receive damage, energies and work
    type(layer_lanes_t), intent(inout) :: layer
    type(cohesive_surfaces_t) :: law
    type(cohesive_point_t) :: new
    real(wp) :: traction(3)
    logical :: grows(lanes)
    integer :: lane

    associate (state => layer%surfaces, work => layer%past%work, constants => batch%layers(j))
      work = (1 - state%damage)*energy_of(constants, state, to) &
             - (1 - state%damage)*energy_of(constants, state, layer%u(:, :3))
      where (.not. constants%contact) work = work + constants%closing/2* &
        ((1 - state%damage)*min(to(:, 3), 0.0_wp)**2 - (1 - state%damage)*min(layer%u(:, 3), 0.0_wp)**2)
      if (cohesive%is_held) return
      grows = may_grow(constants, state, to)
      if (.not. any(grows)) return
      do lane = 1, lanes
        if (.not. grows(lane)) cycle
        associate (old => cohesive%points(batch%first(lane) + j))
          law = cohesive%surfaces_of(plate, batch%first(lane) + j)
          call law%traction(to(lane, :), old, traction, new)
          state%damage(lane) = new%damage
          state%dissipated(lane) = new%dissipated
          work(lane) = law%work(layer%u(lane, :3), to(lane, :), old, new%damage)
        end associate
      end do
    end associate
  end subroutine grow_damage

  !> Energy per area stored by the jumps.
  pure function stored(constants, surfaces, jumps) result(energy)
    type(layer_constants_t), intent(in) :: constants
    type(surface_lanes_t), intent(in) :: surfaces
    real(wp), intent(in) :: jumps(lanes, 3)
    real(wp) :: energy(lanes)

    energy = (1 - surfaces%damage)*energy_of(constants, surfaces, jumps) &
             + merge(1.0_wp, 1 - surfaces%damage, constants%contact)*constants%closing*min(jumps(:, 3), 0.0_wp)**2/2 &
             + merge(sticking_energy(constants%shear, jumps, surfaces%slip), 0.0_wp, constants%friction > 0)
  end function stored

  !> Elastic energy per area of sticking surfaces.
  pure function sticking_energy(stiffness, jumps, slip) result(energy)
    !> Stiffness, pressure per jump
    real(wp), intent(in) :: stiffness(lanes)
    !> Jumps, and slip
    real(wp), intent(in) :: jumps(lanes, 3), slip(lanes, 2)
    real(wp) :: energy(lanes)

    energy = stiffness*((jumps(:, 1) - slip(:, 1))**2 + (jumps(:, 2) - slip(:, 2))**2)/2
  end function sticking_energy

  !> Work of the pressure of closed surfaces, a spring at the end of each step, beyond the energy that it stores. Closed
  !> surfaces without contact lose energy by growing damage, here by the trapezoidal rule.
  pure function lost_in_contact(constants, steps, layer, growth) result(lost)
    type(layer_constants_t), intent(in) :: constants
    type(step_lengths_t), intent(in) :: steps
    type(layer_lanes_t), intent(in) :: layer
    !> Growth of damage
    real(wp), intent(in) :: growth(lanes)
    real(wp) :: lost(lanes)
    real(wp), dimension(lanes) :: from, to

    from = min(layer%u(:, 3), 0.0_wp)
    to = min(layer%u(:, 3) + layer%change(:, 3), 0.0_wp)
    lost = merge(constants%stiffness(:, 2)*( &
      steps%work_in_lanes(to, from, layer%change(:, 3), steps%kept*layer%past%change(:, 3)) - (to**2 - from**2)/2), &
      constants%area*(constants%closing*growth*from*to/2), constants%contact)
  end function lost_in_contact

  !> Slip of surfaces, change of their elastic jumps, and heat, theory (T11): the work of friction less half of the
  !> change of the energy of sticking in this step and half of that in the step before, while forces depend on a slip.
  !> Negative values are subtracted from later heat.
  pure subroutine slip_surfaces(constants, steps, to, layer)
    type(layer_constants_t), intent(in) :: constants
    type(step_lengths_t), intent(in) :: steps
    !> Jumps at the end
    real(wp), intent(in) :: to(lanes, 3)
    !> The surfaces at the start; receive slip and heat
    type(layer_lanes_t), intent(inout) :: layer
    real(wp), dimension(lanes) :: before, after, work, heat
    logical, dimension(lanes) :: rubs, free, moves
    integer :: k

    rubs = constants%friction > 0
    associate (state => layer%surfaces, change => layer%change, last => steps%kept*layer%past%change, &
               recent => layer%past%sticking, remaining => layer%past%rubbing(:, 1), &
               sticking => layer%past%rubbing(:, 2), deficit => layer%past%rubbing(:, 3))
      if (.not. any(rubs)) then
        state%slip = 0
        state%heat = 0
        return
      end if
      before = sticking_energy(constants%shear, layer%u(:, :3), state%slip)
      free = .not. state%limit > 0
      moves = .false.
      do k = 1, 2
        heat = merge(to(:, k), merge(to(:, k) - state%elastic(:, k), state%slip(:, k), state%slips), free)
        moves = moves .or. abs(heat - state%slip(:, k)) > 0
        state%slip(:, k) = merge(heat, 0.0_wp, rubs)
        recent(:, k + 2) = merge(0.0_wp, recent(:, k), state%slips .or. free)
        ! Forces of slipping surfaces do not depend on the forces before the slip.
        recent(:, k) = merge(0.0_wp, change(:, k), state%slips .or. free)
      end do
      after = sticking_energy(constants%shear, to, state%slip) - before
      work = (state%friction(:, 1)*(change(:, 1) + last(:, 1)) + state%friction(:, 2)*(change(:, 2) + last(:, 2))) &
             /(2*constants%area)
      where (moves) remaining = real(memory, wp)
      where (rubs .and. remaining > 0)
        heat = work - (after + sticking)/2 - deficit
        state%heat = state%heat + max(0.0_wp, heat)
        remaining = remaining - 1
        deficit = max(0.0_wp, -heat)
      end where
      where (rubs) sticking = after
      where (.not. rubs) state%heat = 0
    end associate
  end subroutine slip_surfaces
end module stack_updates
