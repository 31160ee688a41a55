!> Steps of stacks without damage, several nodes at a time: the formulas of `stack_motions` for stacks on no frame and
!> no line, whose interfaces have a constant stiffness, over lanes of stacks with the same number of layers.
module intact_stacks
  use element_batches, only: lanes
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use nodal_inertia, only: nodal_inertia_t
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: newest, past_weights
  implicit none
  private
  public :: intact_batch_t, create_intact_batches, move_intact

  !> Stacks of equal numbers of layers, and their constants in a step of the present length.
  type :: intact_batch_t
    !> Number of interfaces
    integer :: n = 0
    !> Stack and first point of each lane; the last stack fills the remaining lanes
    integer :: stack(lanes) = 0, first(lanes) = 0
    !> Height of the interface below each layer, (lanes, n)
    real(wp), allocatable :: height(:, :)
    !> Inverse inertia of the layers, (lanes, 7, n + 1)
    real(wp), allocatable :: inverse(:, :, :)
    !> Stiffness of shear and opening, force per jump, (lanes, 2, n)
    real(wp), allocatable :: stiffness(:, :, :)
    !> Factors of the tridiagonal systems, (lanes, 2, 3, n)
    real(wp), allocatable :: factors(:, :, :, :)
  end type intact_batch_t

contains

  !> Batches of the undamaged stacks among some. Stacks of the same number of layers share batches.
  pure function create_intact_batches(stacks, inertia, candidates) result(batches)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    !> Indices of the stacks
    integer, intent(in) :: candidates(:)
    !> The batches
    type(intact_batch_t), allocatable :: batches(:)
    integer, allocatable :: equal(:)
    integer :: layers, i, total

    allocate (batches(size(candidates)))
    total = 0
    do layers = 2, maxval([1, stacks%layers])
      equal = pack(candidates, stacks%layers(candidates) == layers .and. .not. stacks%damaged(candidates))
      do i = 1, size(equal), lanes
        total = total + 1
        batches(total) = new_batch(stacks, inertia, equal(i:min(i + lanes - 1, size(equal))))
      end do
    end do
    batches = batches(:total)
  end function create_intact_batches

  !> A batch of stacks.
  pure function new_batch(stacks, inertia, members) result(self)
    type(interface_stacks_t), intent(in) :: stacks
    !> Lumped inertia, inverted for this step
    type(nodal_inertia_t), intent(in) :: inertia
    !> Indices of at least one and at most `lanes` stacks
    integer, intent(in) :: members(:)
    type(intact_batch_t) :: self
    integer :: lane, p

    self%n = stacks%layers(members(1)) - 1
    allocate (self%height(lanes, self%n), self%inverse(lanes, 7, self%n + 1), self%stiffness(lanes, 2, self%n), &
              self%factors(lanes, 2, 3, self%n))
    do lane = 1, lanes
      self%stack(lane) = members(min(lane, size(members)))
      p = stacks%first(self%stack(lane))
      self%first(lane) = p
      self%height(lane, :) = stacks%height(p + 1:p + self%n)
      self%inverse(lane, :, :) = inertia%inverse(:, p:p + self%n)
      self%stiffness(lane, :, :) = stacks%stiffness(:, p + 1:p + self%n)
      self%factors(lane, :, :, :) = stacks%factors(:, :, p + 1:p + self%n)
    end do
  end function new_batch

  !> Updates the stacks of a batch, and the history of their jumps.
  pure subroutine move_intact(batch, steps, force, stacks, u, v, reaches_onset)
    type(intact_batch_t), intent(in) :: batch
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the layers without tractions, (5, points)
    real(wp), contiguous, intent(in) :: force(:, :)
    !> The stacks; their history is updated
    type(interface_stacks_t), intent(inout) :: stacks
    !> Unknowns and their rates, (5, points)
    real(wp), contiguous, intent(inout) :: u(:, :), v(:, :)
    !> True for stacks in which damage may start, (lanes)
    logical, intent(out) :: reaches_onset(lanes)
    real(wp), dimension(lanes, 5, batch%n + 1) :: displacement, rates, loads, velocity
    real(wp), dimension(lanes, 3, batch%n) :: tractions, before, change, last
    real(wp) :: lost(lanes, 2, batch%n), min_onset(lanes, batch%n)

    associate (n => batch%n, history => stacks%history, points => size(stacks%height))
      call take(5, points, u, batch%first, n + 1, displacement)
      call take(5, points, v, batch%first, n + 1, rates)
      call take(5, points, force, batch%first, n + 1, loads)
      call take(3, points, history%change, batch%first + 1, n, last)
      call take(3, points, history%earlier, batch%first + 1, n, change)
      call take(3, points, history%forces, batch%first + 1, n, before)
      call take(2, points, history%lost, batch%first + 1, n, lost)
      call take(1, points, stacks%min_onset, batch%first + 1, n, min_onset)
      call find_velocities(n, batch%height, rates, velocity)
      call accelerate(n + 1, batch%inverse, steps%mean(), loads, velocity)
      call find_tractions(n, batch%height, batch%factors, steps%now, velocity, displacement, last, change, tractions)
      call find_resultants(n, batch%height, tractions, loads)
      call accelerate(n + 1, batch%inverse, steps%mean(), loads, velocity)
      call find_changes(n, batch%height, steps%now, velocity, rates, change)
      call find_losses(n, batch%stiffness, steps, displacement, change, last, tractions, before, lost)
      displacement = displacement + steps%now*rates
      reaches_onset = may_start(n, batch%stiffness, min_onset, displacement)
      call put(5, points, displacement, batch%first, n + 1, u)
      call put(5, points, rates, batch%first, n + 1, v)
      call put(3, points, last, batch%first + 1, n, history%earlier)
      call put(3, points, change, batch%first + 1, n, history%change)
      call put(3, points, tractions, batch%first + 1, n, history%forces)
      call put(2, points, lost, batch%first + 1, n, history%lost)
    end associate
  end subroutine move_intact

  !> Values of consecutive points from the first of each lane on. Arrays of explicit shape, here and in `put`, let the
  !> compiler unroll the loop over the values of a point.
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

  !> Reverse of `take`.
  pure subroutine put(values, points, taken, first, rows, field)
    !> Number of values of a point, and of points
    integer, intent(in) :: values, points
    !> The first point of each lane, and number of consecutive points
    integer, intent(in) :: first(lanes), rows
    !> Values of the lanes
    real(wp), intent(in) :: taken(lanes, values, rows)
    !> Those of all points
    real(wp), intent(inout) :: field(values, points)
    integer :: lane, l

    do l = 1, rows
      do lane = 1, lanes
        field(:, first(lane) + l - 1) = taken(lane, :, l)
      end do
    end do
  end subroutine put

  !> Velocities of the layers from the rates of the unknowns.
  pure subroutine find_velocities(n, height, rates, velocity)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces
    real(wp), intent(in) :: height(lanes, n)
    !> Rates of the unknowns
    real(wp), intent(in) :: rates(lanes, 5, n + 1)
    !> Velocities of the layers
    real(wp), intent(out) :: velocity(lanes, 5, n + 1)
    integer :: l

    velocity(:, :, 1) = rates(:, :, 1)
    do l = 2, n + 1
      associate (above => velocity(:, :, l - 1), z => height(:, l - 1))
        velocity(:, 1, l) = rates(:, 1, l) + above(:, 1) + z*(above(:, 4) - rates(:, 4, l))
        velocity(:, 2, l) = rates(:, 2, l) + above(:, 2) + z*(above(:, 5) - rates(:, 5, l))
        velocity(:, 3, l) = rates(:, 3, l) + above(:, 3)
      end associate
      velocity(:, 4:5, l) = rates(:, 4:5, l)
    end do
  end subroutine find_velocities

  !> Adds the change of the layers' velocities by forces during a time.
  pure subroutine accelerate(layers, inverse, time, force, velocity)
    !> Number of layers
    integer, intent(in) :: layers
    !> Inverse inertia
    real(wp), intent(in) :: inverse(lanes, 7, layers)
    !> The time
    real(wp), intent(in) :: time
    !> Forces and moments
    real(wp), intent(in) :: force(lanes, 5, layers)
    !> Velocities of the layers
    real(wp), intent(inout) :: velocity(lanes, 5, layers)
    integer :: l

    do l = 1, layers
      associate (m => inverse(:, :, l), f => force(:, :, l), v => velocity(:, :, l))
        v(:, 1) = v(:, 1) + time*(m(:, 1)*f(:, 1) + m(:, 2)*f(:, 4))
        v(:, 4) = v(:, 4) + time*(m(:, 2)*f(:, 1) + m(:, 3)*f(:, 4))
        v(:, 2) = v(:, 2) + time*(m(:, 4)*f(:, 2) + m(:, 5)*f(:, 5))
        v(:, 5) = v(:, 5) + time*(m(:, 5)*f(:, 2) + m(:, 6)*f(:, 5))
        v(:, 3) = v(:, 3) + time*m(:, 7)*f(:, 3)
      end associate
    end do
  end subroutine accelerate

  !> Forces on the jumps, from the jumps without tractions and the earlier ones.
  pure subroutine find_tractions(n, height, factors, step, velocity, displacement, last, earlier, forces)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces, and factors of the systems
    real(wp), intent(in) :: height(lanes, n), factors(lanes, 2, 3, n)
    !> Length of the step
    real(wp), intent(in) :: step
    !> Velocities of the layers without tractions, and unknowns
    real(wp), intent(in) :: velocity(lanes, 5, n + 1), displacement(lanes, 5, n + 1)
    !> Changes of the jumps in the last step, and in the one before
    real(wp), intent(in) :: last(lanes, 3, n), earlier(lanes, 3, n)
    !> The forces
    real(wp), intent(out) :: forces(lanes, 3, n)
    real(wp) :: rate(lanes, 3)
    integer :: j

    do j = 1, n
      call find_jump_rates(height(:, j), velocity(:, :, j), velocity(:, :, j + 1), rate)
      associate (jump => displacement(:, :3, j + 1))
        forces(:, :, j) = jump + step*rate + &
          (past_weights(1)*jump - past_weights(2)*last(:, :, j) - past_weights(3)*earlier(:, :, j))/newest
      end associate
      if (j > 1) forces(:, :, j) = forces(:, :, j) - factors(:, 2, :, j - 1)*forces(:, :, j - 1)
    end do
    forces(:, :, n) = factors(:, 1, :, n)*forces(:, :, n)
    do j = n - 1, 1, -1
      forces(:, :, j) = factors(:, 1, :, j)*forces(:, :, j) - factors(:, 2, :, j)*forces(:, :, j + 1)
    end do
  end subroutine find_tractions

  !> Rates of the jumps between two layers.
  pure subroutine find_jump_rates(height, upper, lower, rate)
    !> Height of the interface
    real(wp), intent(in) :: height(lanes)
    !> Velocities of the layers
    real(wp), intent(in) :: upper(lanes, 5), lower(lanes, 5)
    !> The rates
    real(wp), intent(out) :: rate(lanes, 3)

    rate(:, 1) = lower(:, 1) - upper(:, 1) + height*(lower(:, 4) - upper(:, 4))
    rate(:, 2) = lower(:, 2) - upper(:, 2) + height*(lower(:, 5) - upper(:, 5))
    rate(:, 3) = lower(:, 3) - upper(:, 3)
  end subroutine find_jump_rates

  !> Forces of the tractions on the layers.
  pure subroutine find_resultants(n, height, forces, resultants)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces, and forces on the jumps
    real(wp), intent(in) :: height(lanes, n), forces(lanes, 3, n)
    !> Forces and moments on the layers
    real(wp), intent(out) :: resultants(lanes, 5, n + 1)
    integer :: j

    resultants(:, :, 1) = 0
    do j = 1, n
      resultants(:, 1:3, j) = resultants(:, 1:3, j) + forces(:, :, j)
      resultants(:, 4, j) = resultants(:, 4, j) + height(:, j)*forces(:, 1, j)
      resultants(:, 5, j) = resultants(:, 5, j) + height(:, j)*forces(:, 2, j)
      resultants(:, 1:3, j + 1) = -forces(:, :, j)
      resultants(:, 4, j + 1) = -height(:, j)*forces(:, 1, j)
      resultants(:, 5, j + 1) = -height(:, j)*forces(:, 2, j)
    end do
  end subroutine find_resultants

  !> Rates of the unknowns from the velocities of the layers, and changes of the jumps.
  pure subroutine find_changes(n, height, step, velocity, rates, change)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Heights of the interfaces
    real(wp), intent(in) :: height(lanes, n)
    !> Length of the step
    real(wp), intent(in) :: step
    !> Velocities of the layers
    real(wp), intent(in) :: velocity(lanes, 5, n + 1)
    !> Rates of the unknowns
    real(wp), intent(out) :: rates(lanes, 5, n + 1)
    !> Changes of the jumps
    real(wp), intent(out) :: change(lanes, 3, n)
    integer :: j

    rates(:, :, 1) = velocity(:, :, 1)
    do j = 1, n
      call find_jump_rates(height(:, j), velocity(:, :, j), velocity(:, :, j + 1), rates(:, :3, j + 1))
      rates(:, 4:5, j + 1) = velocity(:, 4:5, j + 1)
      change(:, :, j) = step*rates(:, :3, j + 1)
    end do
  end subroutine find_changes

  !> Adds the work of the tractions beyond the stored energy k (jump**2 - u**2)/2.
  pure subroutine find_losses(n, stiffness, steps, displacement, change, last, forces, before, lost)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Stiffness of shear and opening
    real(wp), intent(in) :: stiffness(lanes, 2, n)
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Unknowns at the start of the step
    real(wp), intent(in) :: displacement(lanes, 5, n + 1)
    !> Changes of the jumps in this step and in the last
    real(wp), intent(in) :: change(lanes, 3, n), last(lanes, 3, n)
    !> Forces on the jumps in this step and in the last
    real(wp), intent(in) :: forces(lanes, 3, n), before(lanes, 3, n)
    !> By contact, and algorithmic
    real(wp), intent(inout) :: lost(lanes, 2, n)
    real(wp) :: work(lanes, 3), stored(lanes, 3), damped(lanes), shift(lanes)
    integer :: j, k

    shift = 0
    do j = 1, n
      do k = 1, 3
        damped = steps%kept*last(:, k, j)
        if (abs(steps%now - steps%last) > 0) shift = steps%shift(damped, change(:, k, j))
        work(:, k) = forces(:, k, j)*(change(:, k, j) + shift) + (forces(:, k, j) - before(:, k, j))*damped/2
        stored(:, k) = stiffness(:, merge(2, 1, k == 3), j)*change(:, k, j) &
                       *(displacement(:, k, j + 1) + (displacement(:, k, j + 1) + change(:, k, j)))
      end do
      lost(:, 2, j) = lost(:, 2, j) + (work(:, 1) + work(:, 2) + work(:, 3)) &
                      - (stored(:, 1) + stored(:, 2) + stored(:, 3))/2
    end do
  end subroutine find_losses

  !> Stacks with an interface whose energy is not below the smallest at which damage starts.
  pure function may_start(n, stiffness, min_onset, displacement) result(starts)
    !> Number of interfaces
    integer, intent(in) :: n
    !> Stiffness of shear and opening; twice the smallest energy
    real(wp), intent(in) :: stiffness(lanes, 2, n), min_onset(lanes, n)
    !> Unknowns
    real(wp), intent(in) :: displacement(lanes, 5, n + 1)
    !> True for such stacks
    logical :: starts(lanes)
    integer :: j

    starts = .false.
    do j = 1, n
      associate (jump => displacement(:, :3, j + 1))
        starts = starts .or. .not. stiffness(:, 1, j)*(jump(:, 1)**2 + jump(:, 2)**2) &
                 + stiffness(:, 2, j)*max(jump(:, 3), 0.0_wp)**2 < min_onset(:, j)
      end associate
    end do
  end function may_start
end module intact_stacks
