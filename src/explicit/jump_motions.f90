!> Jumps between layers in a step: update, damage, and work of the tractions.
module jump_motions
  use cohesive_faces, only: cohesive_faces_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use cohesive_points, only: cohesive_point_t
  use face_friction, only: sliding_t
  use interface_stacks, only: interface_stacks_t
  use kinds, only: wp
  use models, only: model_t
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: advance_intact, advance_points

contains

  !> Updates the jumps of an undamaged stack, and finds the onset of damage.
  subroutine advance_intact(stacks, i, model, steps, forces, cohesive, u, v)
    !> The stacks
    type(interface_stacks_t), intent(inout) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(:, :)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    real(wp) :: change(3), k(3), jump(3)
    integer :: j, p

    do j = 1, size(forces, 2)
      p = stacks%first(i) + j
      change = steps%now*v(1:3, p)
      jump = u(1:3, p) + change
      k = stacks%stiffness([1, 1, 2], p)
      ! Work of a linear spring beyond its stored energy, as in `advance_points`.
      stacks%lost(2, p) = stacks%lost(2, p) + (k(1)*change(1)*(change(1) + stacks%change(1, p)) &
                                               + k(2)*change(2)*(change(2) + stacks%change(2, p)) &
                                               + k(3)*change(3)*(change(3) + stacks%change(3, p)))/2
      if (abs(steps%now - steps%last) > 0) &
        stacks%lost(2, p) = stacks%lost(2, p) + sum(forces(:, j)*steps%shift(stacks%change(:, p), change))
      u(1:3, p) = jump
      stacks%forces(:, p) = forces(:, j)
      stacks%change(:, p) = change
      if (k(1)*(jump(1)**2 + jump(2)**2) + k(3)*max(jump(3), 0.0_wp)**2 < stacks%min_onset(p)) cycle
      cohesive%points(p)%sliding%slip = u(1:2, p)
      call damage_point(stacks, model, p, u(1:3, p), 0.0_wp, cohesive)
      if (cohesive%points(p)%damage > 0) stacks%damaged(i) = .true.
    end do
    if (.not. stacks%damaged(i)) return
    do j = 1, size(forces, 2)
      p = stacks%first(i) + j
      cohesive%points(p)%sliding%slip = u(1:2, p)
    end do
  end subroutine advance_intact

  !> Damage of a point under new jumps; the dissipated energy is booked.
  subroutine damage_point(stacks, model, p, jumps, limit, cohesive)
    !> The stacks
    type(interface_stacks_t), intent(inout) :: stacks
    type(model_t), intent(in) :: model
    !> The point
    integer, intent(in) :: p
    !> Its jumps at the end of the step
    real(wp), intent(in) :: jumps(3)
    !> Friction limit, force per area
    real(wp), intent(in) :: limit
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    type(cohesive_faces_t) :: faces
    type(cohesive_point_t) :: old
    real(wp) :: traction(3), before

    faces = cohesive%faces_of(model, model%zone(p), cohesive%strength(p))
    old = cohesive%points(p)
    before = old%sliding%limit
    old%sliding%limit = limit
    call faces%traction(jumps, old, traction, cohesive%points(p))
    if (faces%friction > 0) call add_release_heat(faces%law%stiffness_shear, before, old%sliding, &
                                                  cohesive%points(p)%sliding)
    ! Energy dissipated by damage and slip, and their change of the stored energy, are subtracted from the numerical
    ! dissipation.
    stacks%lost(2, p) = stacks%lost(2, p) - stacks%area(p)*(faces%stored(jumps, cohesive%points(p)) - &
      faces%stored(jumps, old) + cohesive%points(p)%dissipated - old%dissipated + &
      cohesive%points(p)%sliding%heat - old%sliding%heat)
  end subroutine damage_point

  !> Adds the heat of slip under a friction limit that decreases within the step: the traction follows the decreasing
  !> limit, so that the elastic energy of sticking becomes heat.
  pure subroutine add_release_heat(stiffness, before, old, new)
    !> Stiffness of sticking faces, pressure per jump
    real(wp), intent(in) :: stiffness
    !> Limit at the start of the step
    real(wp), intent(in) :: before
    !> The faces at the start, with the limit of the end
    type(sliding_t), intent(in) :: old
    !> The faces at the end
    type(sliding_t), intent(inout) :: new
    real(wp) :: slipped, highest

    slipped = norm2(new%slip - old%slip)
    highest = min(old%limit + stiffness*slipped, max(before, old%limit))
    new%heat = new%heat + (highest - old%limit)*slipped/2
  end subroutine add_release_heat

  !> Updates jumps and damage of a damaged stack, and books the work of the tractions beyond the stored energy. The
  !> kinetic energy of the layers at whole steps changes by -(F dJ + (F - F_old) dJ_old/2) with the forces F on the
  !> jumps J (doc/theory/energy.md); the part that is neither stored nor dissipated is numerical dissipation.
  subroutine advance_points(stacks, i, model, steps, limit, forces, cohesive, u, v)
    !> The stacks
    type(interface_stacks_t), intent(inout) :: stacks
    !> Index of the stack
    integer, intent(in) :: i
    type(model_t), intent(in) :: model
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Friction limit, force, (n)
    real(wp), intent(in) :: limit(:)
    !> Forces on the jumps, (3, n)
    real(wp), intent(in) :: forces(:, :)
    !> The interfaces
    type(cohesive_interfaces_t), intent(inout) :: cohesive
    !> Unknowns and their rates, (5, points)
    real(wp), intent(inout) :: u(:, :), v(:, :)
    type(cohesive_faces_t) :: faces
    real(wp) :: change(3), work(3), stored(2), before(3)
    integer :: j, p

    do j = 1, size(forces, 2)
      p = stacks%first(i) + j
      faces = cohesive%faces_of(model, model%zone(p), cohesive%strength(p))
      change = steps%now*v(1:3, p)
      before = u(1:3, p)
      u(1:3, p) = before + change
      work = forces(:, j)*(change + steps%shift(stacks%change(:, p), change)) &
             + (forces(:, j) - stacks%forces(:, p))*stacks%change(:, p)/2
      stored(1) = stacks%area(p)*(faces%stored([0.0_wp, 0.0_wp, u(3, p)], without_slip(cohesive%points(p))) &
                                  - faces%stored([0.0_wp, 0.0_wp, before(3)], without_slip(cohesive%points(p))))
      stored(2) = stacks%area(p)*(faces%stored([u(1:2, p), 0.0_wp], cohesive%points(p)) &
                                  - faces%stored([before(1:2), 0.0_wp], cohesive%points(p)))
      stacks%lost(:, p) = stacks%lost(:, p) + [work(3) - stored(1), work(1) + work(2) - stored(2)]
      stacks%forces(:, p) = forces(:, j)
      stacks%change(:, p) = change
      call damage_point(stacks, model, p, u(1:3, p), limit(j)/stacks%area(p), cohesive)
    end do
  end subroutine advance_points

  !> The point without slip, which stores the energy of its opening only.
  pure function without_slip(point) result(plain)
    !> The point
    type(cohesive_point_t), intent(in) :: point
    !> The same with no slip
    type(cohesive_point_t) :: plain

    plain = point
    plain%sliding%slip = 0
  end function without_slip
end module jump_motions
