!> Forces between the layers of nodes at the end of a step, over lanes of stacks.
!>
!> Contact is a function of the jumps at the end of the step; cohesive tractions and friction are functions of weighted
!> jumps, with the damage at the start, theory (T7) to (T9). Their stiffness therefore does not limit the step. Openings
!> are solved first; their pressure limits friction in the same step (return mapping of the trial shear traction).
!>
!> Where damage grows, the trapezoidal rule misses the corners of the law at onset, failure and reloading, and softening
!> changes the energy that the weighted jumps store. The force along the motion of the jumps is then corrected, so that
!> its work is the energy that the law stores and dissipates, theory (T10): a discrete gradient, as in O. Gonzalez,
!> Journal of Nonlinear Science 6 (1996) 449-467.
module stack_solutions
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t, grown_damage, opened, separation_of
  use cohesive_surfaces, only: cohesive_surfaces_t
  use element_batches, only: lanes
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use roundings, only: rounding
  use stack_batches, only: stack_batch_t, surface_lanes_t, surface_states_t
  use step_lengths, only: step_lengths_t
  use tridiagonal_systems, only: solve_factored, solve_tractions
  use weighted_jumps, only: newest, past_jumps, past_openings, past_weights
  implicit none
  private
  public :: friction_t, energy_of, may_grow, solve_damaged, solve_intact

  !> Friction of an interface in a step, a value for each lane.
  type :: friction_t
    !> Friction limit of this step, force
    real(wp) :: limit(lanes)
    !> Part of earlier elastic jumps in the weighted mean; elastic jumps at the end of the step
    real(wp) :: past(lanes, 2), elastic(lanes, 2)
    !> Friction force
    real(wp) :: force(lanes, 2)
    !> True: slips in this step
    logical :: slips(lanes)
  end type friction_t

contains

  !> Forces of undamaged stacks.
  pure subroutine solve_intact(n, factors, start, last, earlier, trial, forces)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Factors of the systems
    real(wp), intent(in) :: factors(lanes, 2, 3, n)
    !> Jumps at the start, and their changes in the last step and in the one before
    real(wp), intent(in) :: start(lanes, 3, n), last(lanes, 3, n), earlier(lanes, 3, n)
    !> Jumps at the end without tractions
    real(wp), intent(in) :: trial(lanes, 3, n)
    !> Forces on the jumps
    real(wp), intent(out) :: forces(lanes, 3, n)

    ! `past_jumps`, expanded here to be vectorized.
    forces = trial + (past_weights(1)*start - past_weights(2)*last - past_weights(3)*earlier)/newest
    call solve_factored(n, factors, forces)
  end subroutine solve_intact

  !> Forces of damaged stacks, with corrections where damage grows.
  pure subroutine solve_damaged(batch, states, steps, plate, cohesive, trial, forces, friction, normal, given)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    type(step_lengths_t), intent(in) :: steps
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Jumps at the end without tractions
    real(wp), intent(in) :: trial(lanes, 3, batch%n)
    !> Forces on the jumps
    real(wp), intent(out) :: forces(lanes, 3, batch%n)
    type(friction_t), intent(out) :: friction(batch%n)
    !> Force per opening with the contacts found, and parts of the forces that do not depend on the jumps at the end
    real(wp), intent(out) :: normal(lanes, batch%n), given(lanes, 3, batch%n)
    real(wp) :: secant(lanes, 2, batch%n), jumps(lanes, 3, batch%n)
    logical :: grows(lanes), any_grows
    integer :: j, lane

    call weigh_jumps(batch, states, secant, given, friction)
    call solve_openings(batch, states, secant, given, trial, forces, friction, normal)
    call solve_shears(batch, states, secant, given, trial, forces, friction)
    if (cohesive%is_held) return
    call find_jumps(batch, trial, forces, jumps)
    any_grows = .false.
    do j = 1, batch%n
      grows = may_grow(batch%surfaces(j), states(j), jumps(:, :, j))
      if (.not. any(grows)) cycle
      do lane = 1, lanes
        if (.not. grows(lane)) cycle
        associate (p => batch%first(lane) + j)
          call correct_force(cohesive%surfaces_of(plate, p), cohesive%points(p), batch%surfaces(j)%area(lane), &
                             states(j)%work(lane), states(j)%start(lane, :), jumps(lane, :, j), &
                             steps%kept*states(j)%last(lane, :), secant(lane, :, j), given(lane, :, j), grows(lane))
        end associate
      end do
      any_grows = any_grows .or. any(grows)
    end do
    if (.not. any_grows) return
    call solve_openings(batch, states, secant, given, trial, forces, friction, normal)
    call solve_shears(batch, states, secant, given, trial, forces, friction)
  end subroutine solve_damaged

  !> Stiffness of the weighted jumps and contribution of the earlier ones, with the damage at the start.
  pure subroutine weigh_jumps(batch, states, secant, given, friction)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    !> Force per jump at the end of the step, shear and opening, and the part of the forces that does not depend on
    !> these jumps
    real(wp), intent(out) :: secant(lanes, 2, batch%n), given(lanes, 3, batch%n)
    !> Friction; receives the part of earlier elastic jumps
    type(friction_t), intent(inout) :: friction(batch%n)
    real(wp) :: intact(lanes)
    integer :: j, k

    do j = 1, batch%n
      associate (state => states(j))
        intact = 1 - state%damage
        secant(:, 1, j) = intact*batch%stiffness(:, 1, j)
        secant(:, 2, j) = intact*state%part*batch%stiffness(:, 2, j)
        do k = 1, 2
          friction(j)%past(:, k) = past_jumps(state%start(:, k) - state%slip(:, k), state%sticking(:, k), &
                                              state%sticking(:, k + 2))
          given(:, k, j) = secant(:, 1, j)*past_jumps(state%start(:, k), state%last(:, k), state%earlier(:, k))
        end do
        given(:, 3, j) = secant(:, 2, j)*merge( &
          past_openings(state%start(:, 3), state%last(:, 3), state%earlier(:, 3)), &
          past_jumps(state%start(:, 3), state%last(:, 3), state%earlier(:, 3)), batch%surfaces(j)%contact)
        secant(:, :, j) = newest*secant(:, :, j)
      end associate
    end do
  end subroutine weigh_jumps

  !> Forces normal to the surfaces. The active set of contacts is that of the last solution, until it no longer changes;
  !> the law is monotonic, so the iteration converges. Lanes that have converged repeat their solution.
  pure subroutine solve_openings(batch, states, secant, given, trial, forces, friction, normal)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    !> Force per jump, and forces without it
    real(wp), intent(in) :: secant(lanes, 2, batch%n), given(lanes, 3, batch%n)
    !> Jumps at the end without tractions
    real(wp), intent(in) :: trial(lanes, 3, batch%n)
    !> Forces on the jumps; the normal ones are set
    real(wp), intent(inout) :: forces(lanes, 3, batch%n)
    !> Friction; receives its limit
    type(friction_t), intent(inout) :: friction(batch%n)
    !> Force per opening with the contacts found
    real(wp), intent(out) :: normal(lanes, batch%n)
    logical :: closed(lanes, batch%n), now(lanes), changed
    real(wp) :: reduction(lanes, batch%n)
    integer :: iteration, j

    do j = 1, batch%n
      closed(:, j) = states(j)%start(:, 3) < 0 .and. batch%surfaces(j)%contact
    end do
    do iteration = 0, batch%n + 1
      normal = merge(batch%stiffness(:, 2, :), secant(:, 2, :), closed)
      call solve_tractions(batch%n, 3, normal, given, batch%diagonal, batch%off_diagonal, trial, forces)
      call find_reduction(batch, 3, forces, reduction)
      changed = .false.
      do j = 1, batch%n
        now = trial(:, 3, j) - reduction(:, j) < 0 .and. batch%surfaces(j)%contact
        changed = changed .or. any(now .neqv. closed(:, j))
        closed(:, j) = now
      end do
      if (.not. changed) exit
    end do
    do j = 1, batch%n
      friction(j)%limit = merge(batch%surfaces(j)%friction*states(j)%damage*max(0.0_wp, -forces(:, 3, j)), 0.0_wp, &
                                batch%surfaces(j)%contact)
    end do
  end subroutine solve_openings

  !> Jumps at the end of the step with the forces found.
  pure subroutine find_jumps(batch, trial, forces, jumps)
    type(stack_batch_t), intent(in) :: batch
    !> Jumps without tractions, and forces
    real(wp), intent(in) :: trial(lanes, 3, batch%n), forces(lanes, 3, batch%n)
    !> Two shears and opening
    real(wp), intent(out) :: jumps(lanes, 3, batch%n)
    real(wp) :: reduction(lanes, batch%n)
    integer :: k

    do k = 1, 3
      call find_reduction(batch, k, forces, reduction)
      jumps(:, k, :) = trial(:, k, :) - reduction
    end do
  end subroutine find_jumps

  !> Change of the jumps by the forces.
  pure subroutine find_reduction(batch, k, forces, reduction)
    type(stack_batch_t), intent(in) :: batch
    !> Direction, 1 to 3
    integer, intent(in) :: k
    !> The forces
    real(wp), intent(in) :: forces(lanes, 3, batch%n)
    !> H C lambda
    real(wp), intent(out) :: reduction(lanes, batch%n)
    integer :: j

    reduction = batch%diagonal(:, k, :)*forces(:, k, :)
    do j = 1, batch%n - 1
      reduction(:, j) = reduction(:, j) + batch%off_diagonal(:, k, j)*forces(:, k, j + 1)
      reduction(:, j + 1) = reduction(:, j + 1) + batch%off_diagonal(:, k, j)*forces(:, k, j)
    end do
  end subroutine find_reduction

  !> Tangential forces: of the cohesive law, and of friction with elastic sticking up to its limit.
  pure subroutine solve_shears(batch, states, secant, given, trial, forces, friction)
    type(stack_batch_t), intent(in) :: batch
    type(surface_states_t), intent(in) :: states(batch%n)
    !> Force per jump, and forces without it
    real(wp), intent(in) :: secant(lanes, 2, batch%n), given(lanes, 3, batch%n)
    !> Jumps at the end without tractions
    real(wp), intent(in) :: trial(lanes, 3, batch%n)
    !> Forces on the jumps; the tangential ones are set
    real(wp), intent(inout) :: forces(lanes, 3, batch%n)
    !> Friction with its limits; receives the forces
    type(friction_t), intent(inout) :: friction(batch%n)
    real(wp) :: stiffness(lanes, batch%n), parts(lanes, 3, batch%n), reduction(lanes, batch%n, 2), sticking(lanes)
    logical :: slips
    integer :: j, k

    parts = given
    do j = 1, batch%n
      sticking = merge(batch%stiffness(:, 1, j), 0.0_wp, friction(j)%limit > 0)
      stiffness(:, j) = secant(:, 1, j) + newest*sticking
      do k = 1, 2
        parts(:, k, j) = parts(:, k, j) + sticking*(friction(j)%past(:, k) - newest*states(j)%slip(:, k))
      end do
    end do
    call solve_both(batch, stiffness, parts, trial, forces)
    do k = 1, 2
      call find_reduction(batch, k, forces, reduction(:, :, k))
    end do
    slips = .false.
    do j = 1, batch%n
      do k = 1, 2
        friction(j)%elastic(:, k) = trial(:, k, j) - reduction(:, j, k) - states(j)%slip(:, k)
      end do
      call return_to_limit(batch%stiffness(:, 1, j), friction(j))
      if (.not. any(friction(j)%slips)) cycle
      slips = .true.
      stiffness(:, j) = merge(secant(:, 1, j), stiffness(:, j), friction(j)%slips)
      do k = 1, 2
        parts(:, k, j) = merge(given(:, k, j) + friction(j)%force(:, k), parts(:, k, j), friction(j)%slips)
      end do
    end do
    if (slips) call solve_both(batch, stiffness, parts, trial, forces)
  end subroutine solve_shears

  !> Friction force of an elastic jump, returned to the limit.
  pure subroutine return_to_limit(stiffness, friction)
    !> Stiffness of sticking surfaces, force per jump
    real(wp), intent(in) :: stiffness(lanes)
    !> The friction of an interface, with the elastic jumps if the surfaces stick; receives force and elastic jumps
    type(friction_t), intent(inout) :: friction
    real(wp) :: trial(lanes), part(lanes)
    integer :: k

    do k = 1, 2
      friction%force(:, k) = merge(stiffness*(newest*friction%elastic(:, k) + friction%past(:, k)), 0.0_wp, &
                                   friction%limit > 0)
    end do
    trial = sqrt(friction%force(:, 1)**2 + friction%force(:, 2)**2)
    friction%slips = trial > friction%limit
    if (.not. any(friction%slips)) return
    part = merge(friction%limit/max(trial, tiny(trial)), 1.0_wp, friction%slips)
    do k = 1, 2
      friction%force(:, k) = friction%force(:, k)*part
      where (friction%slips) friction%elastic(:, k) = friction%force(:, k)/stiffness
    end do
  end subroutine return_to_limit

  !> Solves along x and along y.
  pure subroutine solve_both(batch, stiffness, given, trial, forces)
    type(stack_batch_t), intent(in) :: batch
    !> Stiffness, and given parts of the forces
    real(wp), intent(in) :: stiffness(lanes, batch%n), given(lanes, 3, batch%n)
    !> Jumps at the end without tractions
    real(wp), intent(in) :: trial(lanes, 3, batch%n)
    !> Forces on the jumps; the tangential ones are set
    real(wp), intent(inout) :: forces(lanes, 3, batch%n)
    integer :: k

    do k = 1, 2
      call solve_tractions(batch%n, k, stiffness, given, batch%diagonal, batch%off_diagonal, trial, forces)
    end do
  end subroutine solve_both

  !> False where jumps certainly do not increase the damage, as `may_grow` of `cohesive_points`.
  pure function may_grow(surface, state, jumps) result(grows)
    type(surface_lanes_t), intent(in) :: surface
    type(surface_states_t), intent(in) :: state
    !> Two shears and opening
    real(wp), intent(in) :: jumps(lanes, 3)
    !> One for each lane
    logical :: grows(lanes)
    real(wp) :: ratio(lanes)

    ratio = state%failure_ratio/(state%failure_ratio - state%damage*(state%failure_ratio - 1))
    grows = state%damage < 1 .and. .not. state%failure_ratio*energy_of(surface, state, jumps) &
            < (1 - rounding)*surface%toughness*ratio**2
  end function may_grow

  !> Energy per area of jumps of an undamaged interface, without that of closing.
  pure function energy_of(surface, state, jumps) result(energy)
    type(surface_lanes_t), intent(in) :: surface
    type(surface_states_t), intent(in) :: state
    !> Two shears and opening
    real(wp), intent(in) :: jumps(lanes, 3)
    !> One for each lane
    real(wp) :: energy(lanes)

    energy = (surface%shear*(jumps(:, 1)**2 + jumps(:, 2)**2) &
              + state%opening*max(jumps(:, 3), 0.0_wp)**2)/2
  end function energy_of

  !> Corrects a force so that it does a given work over the mean motion of this step and the one before.
  pure subroutine correct_force(surfaces, point, area, before, start, jumps, change, secant, given, grows)
    !> The surfaces at the point, and its state
    type(cohesive_surfaces_t), intent(in) :: surfaces
    type(cohesive_point_t), intent(in) :: point
    !> Area, and work on the law in the step before
    real(wp), intent(in) :: area, before
    !> Jumps at the start and at the end, and their change in the step before
    real(wp), intent(in) :: start(3), jumps(3), change(3)
    !> Force per jump, shear and opening
    real(wp), intent(in) :: secant(2)
    !> Given part of the force; is corrected
    real(wp), intent(inout) :: given(3)
    !> True: the damage grows
    logical, intent(out) :: grows
    real(wp) :: moved(3), motion(3), force(3), damage, energy

    damage = grown_damage(surfaces%law, separation_of(surfaces%law, jumps), point)
    grows = damage > point%damage
    moved = jumps - start
    ! Jumps that are prescribed, as between prescribed layers, do no work, though flaws may damage the interface.
    if (.not. (grows .and. sum(moved**2) > 0)) return
    energy = (area*surfaces%work(start, jumps, point, damage) + before)/2
    motion = (moved + change)/2
    force = secant([1, 1, 2])*opened(jumps) + given
    if (.not. surfaces%closing) then
      force(3) = secant(2)*jumps(3) + given(3)
    else if (jumps(3) < 0) then
      motion(3) = 0
    end if
    ! Where a jump has reversed, its mean motion is small; the motion of this step limits the correction.
    given = given + motion*((energy - sum(force*motion))/max(sum(motion**2), sum(moved**2)/4))
  end subroutine correct_force
end module stack_solutions
