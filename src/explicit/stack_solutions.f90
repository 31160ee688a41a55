!> Forces between the layers of nodes at the end of a step, over lanes of stacks.
!>
!> A traction at one interface accelerates the layers above and below it, and so changes the jumps there and at the two
!> adjacent interfaces. With the force lambda = k s + g on the jump s at the end of a step, s = s* - H C lambda, where
!> s* is the jump without tractions and H the square of the step: (1 + k H C) lambda = k s* + g, theory (T7).
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
  use stack_batches, only: layer_constants_t, layer_lanes_t, stack_batch_t, surface_lanes_t
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: newest, past_jumps, past_openings, past_weights
  implicit none
  private
  public :: energy_of, may_grow, solve_damaged, solve_intact, solve_openings, solve_tractions

  !> Of layers that frames do not hold.
  real(wp), parameter :: unheld(lanes) = 0

contains

  !> Forces of undamaged stacks, by the factors of their systems.
  pure subroutine solve_intact(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j

    do j = 1, batch%n
      associate (layer => layers(j), above => batch%layers(j - 1))
        ! `past_jumps`, expanded here to be vectorized.
        layer%forces = layer%trial + (past_weights(1)*layer%u(:, :3) - past_weights(2)*layer%past%change &
                                      - past_weights(3)*layer%past%earlier)/newest
        if (j > 1) layer%forces = layer%forces - above%multiplier*layers(j - 1)%forces
      end associate
    end do
    do j = batch%n, 1, -1
      associate (layer => layers(j), factors => batch%layers(j))
        layer%forces = factors%pivot*layer%forces
        if (j < batch%n) layer%forces = layer%forces - factors%multiplier*layers(j + 1)%forces
      end associate
    end do
  end subroutine solve_intact

  !> Forces along one direction, for any stiffnesses, including zero, and given parts of the forces.
  pure subroutine solve_tractions(batch, k, stiffness, given, lowest, layers)
    type(stack_batch_t), intent(in) :: batch
    !> Direction, 1 to 3
    integer, intent(in) :: k
    !> Force per jump in this direction, and forces without it
    real(wp), intent(in) :: stiffness(lanes, batch%n), given(lanes, batch%n)
    !> Compliance that the lowest layer does not have: its own where it is held
    real(wp), intent(in) :: lowest(lanes)
    !> Layers with their jumps without tractions; receive the forces
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp) :: above(lanes, 0:batch%n), pivot(lanes), diagonal(lanes)
    integer :: j

    above(:, 0) = 0
    do j = 1, batch%n
      associate (layer => layers(j), beside => batch%layers(j - 1)%off_diagonal(:, k))
        diagonal = batch%layers(j)%diagonal(:, k)
        if (j == batch%n) diagonal = diagonal - lowest
        pivot = 1 + stiffness(:, j)*(diagonal - beside*above(:, j - 1))
        layer%forces(:, k) = (stiffness(:, j)*(layer%trial(:, k) - beside*layers(j - 1)%forces(:, k)) + given(:, j)) &
                             /pivot
        if (j < batch%n) above(:, j) = stiffness(:, j)*batch%layers(j)%off_diagonal(:, k)/pivot
      end associate
    end do
    do j = batch%n - 1, 1, -1
      layers(j)%forces(:, k) = layers(j)%forces(:, k) - above(:, j)*layers(j + 1)%forces(:, k)
    end do
  end subroutine solve_tractions

  !> Forces of damaged stacks, with corrections where damage grows.
  pure subroutine solve_damaged(batch, steps, plate, cohesive, layers)
    type(stack_batch_t), intent(in) :: batch
    type(step_lengths_t), intent(in) :: steps
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    logical :: grows(lanes), any_grows
    real(wp) :: jumps(lanes, 3, batch%n)
    integer :: j, k, lane

    do j = 1, batch%n
      call weigh_jumps(batch%layers(j), layers(j))
    end do
    call solve_openings(batch, unheld, layers)
    call limit_friction(batch, layers)
    call solve_shears(batch, layers)
    if (cohesive%is_held) return
    do k = 1, 3
      jumps(:, k, :) = jumps_of(batch, k, layers)
    end do
    any_grows = .false.
    do j = 1, batch%n
      grows = may_grow(batch%layers(j), layers(j)%surfaces, jumps(:, :, j))
      if (.not. any(grows)) cycle
      do lane = 1, lanes
        if (grows(lane)) call correct_force(batch, j, lane, steps, plate, cohesive, jumps(lane, :, j), layers(j), &
                                            grows(lane))
      end do
      any_grows = any_grows .or. any(grows)
    end do
    if (.not. any_grows) return
    call solve_openings(batch, unheld, layers)
    call limit_friction(batch, layers)
    call solve_shears(batch, layers)
  end subroutine solve_damaged

  !> Stiffness of the weighted jumps and contribution of the earlier ones, with the damage at the start.
  pure subroutine weigh_jumps(constants, layer)
    type(layer_constants_t), intent(in) :: constants
    type(layer_lanes_t), intent(inout) :: layer
    real(wp) :: intact(lanes)
    integer :: k

    associate (surfaces => layer%surfaces, past => layer%past)
      intact = 1 - surfaces%damage
      layer%secant(:, 1) = intact*constants%stiffness(:, 1)
      layer%secant(:, 2) = intact*surfaces%loosened*constants%stiffness(:, 2)
      do k = 1, 2
        surfaces%past_elastic(:, k) = past_jumps(layer%u(:, k) - surfaces%slip(:, k), past%sticking(:, k), &
                                                 past%sticking(:, k + 2))
        layer%given(:, k) = layer%secant(:, 1)*past_jumps(layer%u(:, k), past%change(:, k), past%earlier(:, k))
      end do
      layer%given(:, 3) = layer%secant(:, 2)*merge( &
        past_openings(layer%u(:, 3), past%change(:, 3), past%earlier(:, 3)), &
        past_jumps(layer%u(:, 3), past%change(:, 3), past%earlier(:, 3)), constants%contact)
      layer%secant = newest*layer%secant
    end associate
  end subroutine weigh_jumps

  !> Forces normal to the surfaces. The active set of contacts is that of the last solution, until it no longer changes;
  !> the law is monotonic, so the iteration converges. Lanes that have converged repeat their solution.
  pure subroutine solve_openings(batch, lowest, layers)
    type(stack_batch_t), intent(in) :: batch
    !> Compliance that the lowest layer does not have: its own where it is held
    real(wp), intent(in) :: lowest(lanes)
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp), dimension(lanes, batch%n) :: normal, given, openings
    logical :: closed(lanes, batch%n), now(lanes), changed
    integer :: iteration, j

    do j = 1, batch%n
      closed(:, j) = layers(j)%u(:, 3) < 0 .and. batch%layers(j)%contact
      given(:, j) = layers(j)%given(:, 3)
    end do
    do iteration = 0, batch%n + 1
      do j = 1, batch%n
        normal(:, j) = merge(batch%layers(j)%stiffness(:, 2), layers(j)%secant(:, 2), closed(:, j))
      end do
      call solve_tractions(batch, 3, normal, given, lowest, layers)
      openings = jumps_of(batch, 3, layers)
      openings(:, batch%n) = openings(:, batch%n) + lowest*layers(batch%n)%forces(:, 3)
      changed = .false.
      do j = 1, batch%n
        now = openings(:, j) < 0 .and. batch%layers(j)%contact
        changed = changed .or. any(now .neqv. closed(:, j))
        closed(:, j) = now
      end do
      if (.not. changed) exit
    end do
  end subroutine solve_openings

  !> Limits of friction by the pressure.
  pure subroutine limit_friction(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    integer :: j

    do j = 1, batch%n
      layers(j)%surfaces%limit = merge(batch%layers(j)%friction*layers(j)%surfaces%damage &
                                       *max(0.0_wp, -layers(j)%forces(:, 3)), 0.0_wp, batch%layers(j)%contact)
    end do
  end subroutine limit_friction

  !> Jumps in one direction at the end of the step with the forces found.
  pure function jumps_of(batch, k, layers) result(jumps)
    type(stack_batch_t), intent(in) :: batch
    !> Direction, 1 to 3
    integer, intent(in) :: k
    type(layer_lanes_t), intent(in) :: layers(0:batch%n)
    real(wp) :: jumps(lanes, batch%n)
    real(wp) :: reduction(lanes)
    integer :: j

    do j = 1, batch%n
      associate (constants => batch%layers(j))
        reduction = constants%diagonal(:, k)*layers(j)%forces(:, k)
        if (j > 1) reduction = reduction + batch%layers(j - 1)%off_diagonal(:, k)*layers(j - 1)%forces(:, k)
        if (j < batch%n) reduction = reduction + constants%off_diagonal(:, k)*layers(j + 1)%forces(:, k)
        jumps(:, j) = layers(j)%trial(:, k) - reduction
      end associate
    end do
  end function jumps_of

  !> Tangential forces: of the cohesive law, and of friction with elastic sticking up to its limit.
  pure subroutine solve_shears(batch, layers)
    type(stack_batch_t), intent(in) :: batch
    type(layer_lanes_t), intent(inout) :: layers(0:batch%n)
    real(wp) :: stiffness(lanes, batch%n), given(lanes, batch%n, 2), jumps(lanes, batch%n, 2), sticking(lanes)
    logical :: slips
    integer :: j, k

    do j = 1, batch%n
      associate (surfaces => layers(j)%surfaces)
        sticking = merge(batch%layers(j)%stiffness(:, 1), 0.0_wp, surfaces%limit > 0)
        stiffness(:, j) = layers(j)%secant(:, 1) + newest*sticking
        do k = 1, 2
          given(:, j, k) = layers(j)%given(:, k) + sticking*(surfaces%past_elastic(:, k) - newest*surfaces%slip(:, k))
        end do
      end associate
    end do
    do k = 1, 2
      call solve_tractions(batch, k, stiffness, given(:, :, k), unheld, layers)
      jumps(:, :, k) = jumps_of(batch, k, layers)
    end do
    slips = .false.
    do j = 1, batch%n
      associate (surfaces => layers(j)%surfaces)
        surfaces%elastic = jumps(:, j, :) - surfaces%slip
        call return_to_limit(batch%layers(j)%stiffness(:, 1), surfaces)
        if (.not. any(surfaces%slips)) cycle
        slips = .true.
        stiffness(:, j) = merge(layers(j)%secant(:, 1), stiffness(:, j), surfaces%slips)
        do k = 1, 2
          given(:, j, k) = merge(layers(j)%given(:, k) + surfaces%friction(:, k), given(:, j, k), surfaces%slips)
        end do
      end associate
    end do
    if (.not. slips) return
    do k = 1, 2
      call solve_tractions(batch, k, stiffness, given(:, :, k), unheld, layers)
    end do
  end subroutine solve_shears

  !> Friction force of an elastic jump, returned to the limit.
  pure subroutine return_to_limit(stiffness, surfaces)
    !> Stiffness of sticking surfaces, force per jump
    real(wp), intent(in) :: stiffness(lanes)
    !> The surfaces with the elastic jumps if they stick; receive friction and elastic jumps
    type(surface_lanes_t), intent(inout) :: surfaces
    real(wp) :: trial(lanes), part(lanes)
    integer :: k

    do k = 1, 2
      surfaces%friction(:, k) = merge(stiffness*(newest*surfaces%elastic(:, k) + surfaces%past_elastic(:, k)), 0.0_wp, &
                                      surfaces%limit > 0)
    end do
    trial = sqrt(surfaces%friction(:, 1)**2 + surfaces%friction(:, 2)**2)
    surfaces%slips = trial > surfaces%limit
    if (.not. any(surfaces%slips)) return
    part = merge(surfaces%limit/max(trial, tiny(trial)), 1.0_wp, surfaces%slips)
    do k = 1, 2
      surfaces%friction(:, k) = surfaces%friction(:, k)*part
      where (surfaces%slips) surfaces%elastic(:, k) = surfaces%friction(:, k)/stiffness
    end do
  end subroutine return_to_limit

  !> False where jumps certainly do not increase the damage, as `may_grow` of `cohesive_points`.
  pure function may_grow(constants, surfaces, jumps) result(grows)
    type(layer_constants_t), intent(in) :: constants
    type(surface_lanes_t), intent(in) :: surfaces
    real(wp), intent(in) :: jumps(lanes, 3)
    logical :: grows(lanes)
    real(wp) :: ratio(lanes)

    ratio = surfaces%failure_ratio/(surfaces%failure_ratio - surfaces%damage*(surfaces%failure_ratio - 1))
    grows = surfaces%damage < 1 .and. .not. surfaces%failure_ratio*energy_of(constants, surfaces, jumps) &
            < (1 - rounding)*constants%toughness*ratio**2
  end function may_grow

  !> Energy per area of jumps of an undamaged interface, without that of closing.
  pure function energy_of(constants, surfaces, jumps) result(energy)
    type(layer_constants_t), intent(in) :: constants
    type(surface_lanes_t), intent(in) :: surfaces
    real(wp), intent(in) :: jumps(lanes, 3)
    real(wp) :: energy(lanes)

    energy = (constants%shear*(jumps(:, 1)**2 + jumps(:, 2)**2) + surfaces%opening*max(jumps(:, 3), 0.0_wp)**2)/2
  end function energy_of

  !> Corrects a force so that it does a given work over the mean motion of this step and the one before.
  pure subroutine correct_force(batch, j, lane, steps, plate, cohesive, jumps, layer, grows)
    type(stack_batch_t), intent(in) :: batch
    !> Interface and lane
    integer, intent(in) :: j, lane
    type(step_lengths_t), intent(in) :: steps
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Jumps at the end
    real(wp), intent(in) :: jumps(3)
    !> The layer; the given part of its force is corrected
    type(layer_lanes_t), intent(inout) :: layer
    !> True: the damage grows
    logical, intent(out) :: grows
    type(cohesive_surfaces_t) :: surfaces
    type(cohesive_point_t) :: point
    real(wp) :: start(3), moved(3), motion(3), force(3), damage, energy

    surfaces = cohesive%surfaces_of(plate, batch%first(lane) + j)
    point = cohesive%points(batch%first(lane) + j)
    damage = grown_damage(surfaces%law, separation_of(surfaces%law, jumps), point)
    grows = damage > point%damage
    start = layer%u(lane, :3)
    moved = jumps - start
    ! Jumps that are prescribed, as between prescribed layers, do no work, though flaws may damage the interface.
    if (.not. (grows .and. sum(moved**2) > 0)) return
    energy = (batch%layers(j)%area(lane)*surfaces%work(start, jumps, point, damage) + layer%past%work(lane))/2
    motion = (moved + steps%kept*layer%past%change(lane, :))/2
    force = layer%secant(lane, [1, 1, 2])*opened(jumps) + layer%given(lane, :)
    if (.not. surfaces%closing) then
      force(3) = layer%secant(lane, 2)*jumps(3) + layer%given(lane, 3)
    else if (jumps(3) < 0) then
      motion(3) = 0
    end if
    ! Where a jump has reversed, its mean motion is small; the motion of this step limits the correction.
    layer%given(lane, :) = layer%given(lane, :) &
                           + motion*((energy - sum(force*motion))/max(sum(motion**2), sum(moved**2)/4))
  end subroutine correct_force
end module stack_solutions
