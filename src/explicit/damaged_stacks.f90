!> Forces in stacks of layers with damaged interfaces.
!>
!> Tractions are those of the damage at the start of the step and of weighted jumps. Where damage grows, the trapezoidal
!> rule misses the corners of the law at onset, failure and reloading, and softening changes the energy that the
!> weighted jumps store. The force along the motion of the jumps is then corrected, so that its work is the energy that
!> the law stores and dissipates, theory (T10): a discrete gradient, as in O. Gonzalez, Journal of Nonlinear Science 6
!> (1996) 449-467.
module damaged_stacks
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: grown_damage, may_grow, opened, separation_of
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use models, only: model_t
  use stack_solutions, only: jumps_of, solve_openings, solve_shears, stack_t
  use step_lengths, only: step_lengths_t
  use weighted_jumps, only: newest, past_jumps, past_openings
  implicit none
  private
  public :: load_stack, solve_damaged

contains

  !> Copies a damaged stack from the state.
  pure subroutine load_stack(stacks, work, model, cohesive, p, u, trial)
    type(interface_stacks_t), intent(in) :: stacks
    !> Receives it
    type(stack_t), intent(inout) :: work
    type(model_t), intent(in) :: model
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> First point of the stack
    integer, intent(in) :: p
    !> Unknowns, (5, points)
    real(wp), intent(in) :: u(:, :)
    !> Jumps without tractions, (3, n)
    real(wp), intent(in) :: trial(:, :)
    integer :: j

    associate (q => p + work%n)
      work%stiffness = stacks%stiffness(:, p + 1:q)
      work%diagonal = stacks%diagonal(:, p + 1:q)
      work%off_diagonal = stacks%off_diagonal(:, p + 1:q)
      work%trial = trial
      work%start = u(1:3, p + 1:q)
      work%points = cohesive%points(p + 1:q)
    end associate
    do j = 1, work%n
      work%surfaces(j) = cohesive%surfaces_of(model, p + j)
      work%closing(j) = work%surfaces(j)%closing
      work%friction(j)%coefficient = work%surfaces(j)%friction
      associate (sticking => stacks%history%sticking(:, p + j))
        work%friction(j)%past = past_jumps(work%start(1:2, j) - work%points(j)%sliding%slip, sticking(1:2), &
                                           sticking(3:4))
      end associate
      associate (change => stacks%history%change(:, p + j), earlier => stacks%history%earlier(:, p + j))
        work%given(:, j) = past_jumps(work%start(:, j), change, earlier)
        if (work%closing(j)) work%given(3, j) = past_openings(work%start(3, j), change(3), earlier(3))
      end associate
      work%secant(:, j) = (1 - work%points(j)%damage)*[1.0_wp, cohesive%opening(p + j)]*work%stiffness(:, j)
      work%given(:, j) = work%secant([1, 1, 2], j)*work%given(:, j)
      work%secant(:, j) = newest*work%secant(:, j)
    end do
  end subroutine load_stack

  !> Forces of a damaged stack, with corrections where damage grows.
  pure subroutine solve_damaged(stacks, work, steps, p)
    type(interface_stacks_t), intent(in) :: stacks
    !> The stack; receives the forces
    type(stack_t), intent(inout) :: work
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> First point of the stack
    integer, intent(in) :: p
    real(wp) :: jumps(3, work%n), energy, damage
    logical :: grows
    integer :: j

    call solve_openings(work)
    call solve_shears(work)
    jumps = jumps_of(work)
    grows = .false.
    do j = 1, work%n
      associate (law => work%surfaces(j)%law)
        if (.not. may_grow(law, jumps(:, j), work%points(j))) cycle
        damage = grown_damage(law, separation_of(law, jumps(:, j)), work%points(j))
      end associate
      if (.not. damage > work%points(j)%damage) cycle
      grows = .true.
      energy = work%surfaces(j)%work(work%start(:, j), jumps(:, j), work%points(j), damage)
      call correct_force(work, j, jumps(:, j), stacks%history%last_change(p + j, steps%kept), &
                         (stacks%area(p + j)*energy + stacks%history%work(p + j))/2)
    end do
    if (.not. grows) return
    call solve_openings(work)
    call solve_shears(work)
  end subroutine solve_damaged

  !> Corrects a force so that it does a given work over the mean motion of this step and the one before.
  pure subroutine correct_force(work, j, jumps, change, energy)
    !> The stack; receives the given part of the force
    type(stack_t), intent(inout) :: work
    !> The interface
    integer, intent(in) :: j
    !> Jumps at the end of the step, and their change in the step before
    real(wp), intent(in) :: jumps(3), change(3)
    !> The work: mean of the law's work in both steps
    real(wp), intent(in) :: energy
    real(wp) :: moved(3), motion(3), force(3)

    moved = jumps - work%start(:, j)
    ! Jumps that are prescribed, as between prescribed layers, do no work, though flaws may damage the interface.
    if (.not. sum(moved**2) > 0) return
    motion = (moved + change)/2
    force = work%secant([1, 1, 2], j)*opened(jumps) + work%given(:, j)
    if (.not. work%closing(j)) then
      force(3) = work%secant(2, j)*jumps(3) + work%given(3, j)
    else if (jumps(3) < 0) then
      motion(3) = 0
    end if
    ! Where a jump has reversed, its mean motion is small; the motion of this step limits the correction.
    work%given(:, j) = work%given(:, j) + motion*((energy - sum(force*motion))/max(sum(motion**2), sum(moved**2)/4))
  end subroutine correct_force
end module damaged_stacks
