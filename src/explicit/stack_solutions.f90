!> Forces between the layers of one node at the end of a step.
!>
!> Contact is a function of the jumps at the end of the step; cohesive tractions and friction are functions of weighted
!> jumps, with the damage at the start, theory (T7) to (T9). Their stiffness therefore does not limit the step. Openings
!> are solved first; their pressure limits friction in the same step (return mapping of the trial shear traction).
module stack_solutions
  use cohesive_points, only: cohesive_point_t
  use cohesive_surfaces, only: cohesive_surfaces_t
  use kinds, only: wp
  use tridiagonal_systems, only: solve_tractions
  use weighted_jumps, only: newest
  implicit none
  private
  public :: friction_t, stack_t, jumps_of, solve_openings, solve_shears

  !> Friction of an interface in a step.
  type :: friction_t
    !> Coefficient of friction
    real(wp) :: coefficient = 0
    !> Friction limit of this step, force
    real(wp) :: limit = 0
    !> Part of earlier elastic jumps in the weighted mean; elastic jumps at the end of the step
    real(wp) :: past(2) = 0, elastic(2) = 0
    !> Friction force
    real(wp) :: force(2) = 0
    !> True: slips in this step
    logical :: slips = .false.
  end type friction_t

  !> The interfaces of one node in a step, from the struck side downwards, (n) each.
  type :: stack_t
    !> Number of interfaces
    integer :: n = 0
    !> Undamaged stiffness of shear and opening, force per jump, (2, n)
    real(wp), allocatable :: stiffness(:, :)
    !> Square of the step times the compliance of the layers along x, y and z: diagonal, and off-diagonal entries,
    !> (3, n)
    real(wp), allocatable :: diagonal(:, :), off_diagonal(:, :)
    !> Jumps at the end of the step without tractions, and those at its start, (3, n)
    real(wp), allocatable :: trial(:, :), start(:, :)
    !> Force per jump at the end of the step, shear and opening, (2, n), and the part of the forces that does not depend
    !> on these jumps, (3, n)
    real(wp), allocatable :: secant(:, :), given(:, :)
    !> Damage and sliding at the start
    type(cohesive_point_t), allocatable :: points(:)
    !> Their laws at the start
    type(cohesive_surfaces_t), allocatable :: surfaces(:)
    !> True: surfaces do not penetrate each other
    logical, allocatable :: closing(:)
    !> Friction
    type(friction_t), allocatable :: friction(:)
    !> Forces on the jumps, (3, n)
    real(wp), allocatable :: forces(:, :)
    !> Force per opening with the contacts found, (n)
    real(wp), allocatable :: normal_stiffness(:)
  end type stack_t

contains

  !> Forces normal to the surfaces. The active set of contacts is that of the last solution, until it no longer changes;
  !> the law is monotonic, so the iteration converges.
  pure subroutine solve_openings(stack)
    !> The stack; receives normal forces and the limits of friction
    type(stack_t), intent(inout) :: stack
    logical :: closed(stack%n), before(stack%n)
    real(wp) :: opening(stack%n)
    integer :: iteration, j

    closed = stack%start(3, :) < 0
    do iteration = 0, stack%n + 1
      stack%normal_stiffness = merge(stack%stiffness(2, :), stack%secant(2, :), closed .and. stack%closing)
      call solve_tractions(stack%n, stack%normal_stiffness, stack%given(3, :), stack%diagonal(3, :), &
                           stack%off_diagonal(3, :), stack%trial(3, :), stack%forces(3, :))
      opening = stack%trial(3, :) - jump_reduction(stack, 3)
      before = closed
      closed = opening < 0
      if (all((before .eqv. closed) .or. .not. stack%closing)) exit
    end do
    do j = 1, stack%n
      associate (friction => stack%friction(j))
        friction%limit = 0
        if (stack%closing(j)) &
          friction%limit = friction%coefficient*stack%points(j)%damage*max(0.0_wp, -stack%forces(3, j))
      end associate
    end do
  end subroutine solve_openings

  !> Jumps at the end of the step with the forces found.
  pure function jumps_of(stack) result(jumps)
    !> The stack with its forces
    type(stack_t), intent(in) :: stack
    !> Two shears and opening, (3, n)
    real(wp) :: jumps(3, stack%n)
    integer :: k

    do k = 1, 3
      jumps(k, :) = stack%trial(k, :) - jump_reduction(stack, k)
    end do
  end function jumps_of

  !> Change of the jumps by the forces.
  pure function jump_reduction(stack, k) result(change)
    !> The stack with its forces
    type(stack_t), intent(in) :: stack
    !> Direction, 1 to 3
    integer, intent(in) :: k
    !> H C lambda, (n)
    real(wp) :: change(stack%n)
    integer :: j

    change = stack%diagonal(k, :)*stack%forces(k, :)
    do j = 1, stack%n - 1
      change(j) = change(j) + stack%off_diagonal(k, j)*stack%forces(k, j + 1)
      change(j + 1) = change(j + 1) + stack%off_diagonal(k, j)*stack%forces(k, j)
    end do
  end function jump_reduction

  !> Tangential forces: of the cohesive law, and of friction with elastic sticking up to its limit.
  pure subroutine solve_shears(stack)
    !> The stack with the limits of friction; receives the forces
    type(stack_t), intent(inout) :: stack
    real(wp) :: stiffness(stack%n), given(2, stack%n), jumps(3, stack%n)
    integer :: j

    stiffness = stack%secant(1, :)
    given = stack%given(:2, :)
    do j = 1, stack%n
      stack%friction(j)%force = 0
      stack%friction(j)%slips = .false.
      if (.not. stack%friction(j)%limit > 0) cycle
      associate (k => stack%stiffness(1, j))
        stiffness(j) = stiffness(j) + newest*k
        given(:, j) = given(:, j) + k*(stack%friction(j)%past - newest*stack%points(j)%sliding%slip)
      end associate
    end do
    call solve_both(stack, stiffness, given)
    if (.not. any(stack%friction%limit > 0)) return
    jumps = jumps_of(stack)
    do j = 1, stack%n
      associate (friction => stack%friction(j))
        if (.not. friction%limit > 0) cycle
        call return_to_limit(friction, stack%stiffness(1, j), jumps(1:2, j) - stack%points(j)%sliding%slip)
        if (.not. friction%slips) cycle
        stiffness(j) = stack%secant(1, j)
        given(:, j) = stack%given(:2, j) + friction%force
      end associate
    end do
    if (any(stack%friction%slips)) call solve_both(stack, stiffness, given)
  end subroutine solve_shears

  !> Friction force of an elastic jump, returned to the limit.
  pure subroutine return_to_limit(friction, stiffness, elastic)
    !> The friction of an interface; receives force and elastic jumps
    type(friction_t), intent(inout) :: friction
    !> Stiffness of sticking surfaces, force per jump
    real(wp), intent(in) :: stiffness
    !> Elastic jumps at the end of the step if the surfaces stick
    real(wp), intent(in) :: elastic(2)
    real(wp) :: trial

    friction%elastic = elastic
    friction%force = stiffness*(newest*elastic + friction%past)
    trial = norm2(friction%force)
    friction%slips = trial > friction%limit
    if (.not. friction%slips) return
    friction%force = friction%force*(friction%limit/trial)
    friction%elastic = friction%force/stiffness
  end subroutine return_to_limit

  !> Solves along x and along y.
  pure subroutine solve_both(stack, stiffness, given)
    !> The stack; receives the forces
    type(stack_t), intent(inout) :: stack
    !> Stiffness, and given parts of the forces along x and y
    real(wp), intent(in) :: stiffness(:), given(:, :)
    integer :: k

    do k = 1, 2
      call solve_tractions(stack%n, stiffness, given(k, :), stack%diagonal(k, :), stack%off_diagonal(k, :), &
                           stack%trial(k, :), stack%forces(k, :))
    end do
  end subroutine solve_both
end module stack_solutions
