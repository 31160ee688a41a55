!> Forces in stacks of layers with damaged interfaces.
!>
!> Tractions are those of the damage at the start of the step and of weighted jumps. Where damage grows, the trapezoidal
!> rule misses the corners of the law at onset, failure and reloading, and softening changes the energy that the
!> weighted jumps store. The force along the motion of the jumps is then corrected, so that its work is the energy that
!> the law stores and dissipates, theory (T10): a discrete gradient, as in O. Gonzalez, Journal of Nonlinear Science 6
!> (1996) 449-467.
module damaged_stacks
  use cohesive_surfaces, only: cohesive_surfaces_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: grown_damage, opened, separation_of
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
    type(cohesive_surfaces_t) :: surfaces
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
      surfaces = cohesive%surfaces_of(model, p + j)
      work%closing(j) = surfaces%closing
      work%friction(j)%coefficient = surfaces%friction
      associate (sticking => stacks%history%sticking(:, p + j))
        work%friction(j)%past = past_jumps(work%start(1:2, j) - work%points(j)%sliding%slip, sticking(1:2), &
                                           sticking(3:4))
      end associate
      associate (change => stacks%history%change(:, p + j), earlier => stacks%history%earlier(:, p + j))
        work%given(:, j) = past_jumps(work%start(:, j), change, earlier)
        if (surfaces%closing) work%given(3, j) = past_openings(work%start(3, j), change(3), earlier(3))
      end associate
      work%secant(:, j) = (1 - work%points(j)%damage)*[1.0_wp, cohesive%opening(p + j)]*work%stiffness(:, j)
      work%given(:, j) = work%secant([1, 1, 2], j)*work%given(:, j)
      work%secant(:, j) = newest*work%secant(:, j)
    end do
  end subroutine load_stack

  !> Forces of a damaged stack, with corrections where damage grows.
  pure subroutine solve_damaged(stacks, work, model, steps, cohesive, p)
    type(interface_stacks_t), intent(in) :: stacks
    !> The stack; receives the forces
    type(stack_t), intent(inout) :: work
    type(model_t), intent(in) :: model
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> First point of the stack
    integer, intent(in) :: p
    type(cohesive_surfaces_t) :: surfaces
    real(wp) :: jumps(3, work%n), energy, damage
    logical :: grows
    integer :: j

    call solve_openings(work)
    call solve_shears(work)
    jumps = jumps_of(work)
    grows = .false.
    do j = 1, work%n
      if (.not. work%points(j)%damage < 1) cycle
      surfaces = cohesive%surfaces_of(model, p + j)
      associate (law => surfaces%law)
        energy = (law%stiffness_shear*(jumps(1, j)**2 + jumps(2, j)**2) &
                  + law%stiffness_opening*max(jumps(3, j), 0.0_wp)**2)/2
        ! N Y = G_c at the onset; the toughness of a mixture of modes is at least that of the weaker pure mode.
        if (energy*law%failure_ratio < min(law%toughness_opening, law%toughness_shear)) cycle
      end associate
      damage = grown_damage(surfaces%law, separation_of(surfaces%law, jumps(:, j)), work%points(j))
      if (.not. damage > work%points(j)%damage) cycle
      grows = .true.
      energy = surfaces%work(work%start(:, j), jumps(:, j), work%points(j), damage)
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
