!> Energy ledger of central differences, by the exact energy identity of the method, theory (E5) and (E6).
!>
!> The kinetic energy at the end of a step is T = v M v/2 + h (F - B^T lambda) v/2, with the mid-step velocity v. T
!> changes by the work of the mean force of both ends, so that T plus strain energy of a linear plate without interfaces
!> is constant to round-off. Work of the tractions beyond the energy that interfaces store and dissipate is recorded as
!> algorithmic dissipation. The remaining error of the ledger is that of forces which are nonlinear within a step.
module central_difference_energies
  use central_differences, only: central_difference_t
  use exact_sums, only: exact_sum_t
  use interface_stacks, only: last_layer
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: total_of, totals_of
  use states, only: state_t
  implicit none
  private
  public :: record_energies, kinetic_energy

contains

  !> Computes the ledger of a state. Collective.
  subroutine record_energies(method, model, now)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state; receives its ledger
    type(state_t), intent(inout) :: now
    type(exact_sum_t) :: sums(8)
    real(wp) :: totals(8)

    call add_kinetic(method, model, now, 1.0_wp, sums(1), sums(2))
    call sums(3)%add(method%strain)
    call add_stored(method, model, now, sums(3))
    associate (owned => model%distribution%owned, lost => method%stacks%history%lost)
      if (allocated(now%interfaces%cohesive%points)) then
        associate (points => now%interfaces%cohesive%points(:owned), area => method%stacks%area(:owned))
          call sums(4)%add(area*points%dissipated)
          call sums(5)%add(area*points%sliding%heat)
        end associate
      end if
      call sums(6)%add(lost(1, :owned) + method%rigs%frame_loss(:owned))
      call sums(7)%add(lost(2, :owned) + method%rigs%step_loss(:owned))
      call sums(8)%add(method%lines%work(:owned))
    end associate
    totals = totals_of(model%communicator, sums)*model%mesh%multiplicity
    associate (ledger => now%ledger)
      ledger%kinetic = totals(1)
      ledger%scaled = totals(2)
      ledger%strain = totals(3)
      ledger%delamination = totals(4)
      ledger%friction = totals(5)
      ledger%contact = totals(6)
      ledger%algorithmic = totals(7) + method%impact%loss
      ledger%external_work = method%initial_work + method%impact%work + totals(8)
      if (allocated(now%plies%bands)) then
        call now%plies%total_dissipation(model)
        ledger%ply_damage = sum(now%plies%dissipated) + now%plies%permanent_shear
      end if
      if (model%setup%has_impactor) then
        ledger%indentation = now%indentation%work
        if (.not. model%setup%impactor%travel > 0) ledger%impactor = method%impact%energy(model, method%steps%now, now)
      end if
      call ledger%note_largest()
    end associate
  end subroutine record_energies

  !> Kinetic energy of the plate at the end of the last step. Collective.
  real(wp) function kinetic_energy(method, model, now, kept) result(energy)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> Factor by which damping has multiplied its velocities
    real(wp), intent(in) :: kept
    type(exact_sum_t) :: kinetic, scaled

    call add_kinetic(method, model, now, kept, kinetic, scaled)
    energy = total_of(model%communicator, kinetic)*model%mesh%multiplicity
  end function kinetic_energy

  !> Adds the kinetic energy of this rank's points, and the part of it that belongs to scaled inertia.
  subroutine add_kinetic(method, model, now, kept, kinetic, scaled)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> Factor by which damping has multiplied its velocities
    real(wp), intent(in) :: kept
    !> Total kinetic energy, and, with scaled inertia, that of in-plane motion and rotation
    type(exact_sum_t), intent(inout) :: kinetic, scaled
    real(wp), allocatable :: layer(:, :)
    real(wp), dimension(model%distribution%owned) :: plane, total
    integer :: i

    layer = model%motion_of(now%motion%velocity)
    do i = 1, model%distribution%owned
      associate (m => method%inertia%mass(:, i), v => layer(:, i), change => method%stacks%history%change(:, i), &
                 lambda => method%stacks%history%forces(:, i), force => method%force(:, i))
        plane(i) = (m(1)*(v(1)**2 + v(2)**2) + m(3)*(v(4)**2 + v(5)**2))/2 + m(2)*(v(1)*v(4) + v(2)*v(5))
        total(i) = m(4)*v(3)**2/2 + plane(i) + method%steps%now/2*(force(1)*v(1) + force(2)*v(2) + force(3)*v(3) &
                                                                  + force(4)*v(4) + force(5)*v(5)) &
                   - (kept*(lambda(1)*change(1) + lambda(2)*change(2) + lambda(3)*change(3)) &
                      + method%rigs%reaction(i)*method%rigs%approach(i))/2
      end associate
    end do
    if (allocated(method%inertia%springs)) then
      do i = 1, size(total)
        total(i) = total(i) - method%steps%now/2* &
                   sum(method%inertia%springs(:, i)*now%motion%displacement(:, i)*now%motion%velocity(:, i))
      end do
    end if
    if (method%parameters%mass_scaling > 1) call scaled%add(plane)
    call kinetic%add(total)
    do i = 1, size(method%lines%dofs)
      call kinetic%add(method%lines%dofs(i)%reaction*method%lines%dofs(i)%change/2)
    end do
  end subroutine add_kinetic

  !> Adds the energy stored in this rank's interfaces, springs and loaded clamps.
  subroutine add_stored(method, model, now, stored)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> The energy
    type(exact_sum_t), intent(inout) :: stored
    real(wp) :: energies(model%distribution%owned)
    integer :: i

    energies = 0
    associate (cohesive => now%interfaces%cohesive, u => now%motion%displacement)
      do i = 1, model%distribution%owned
        if (allocated(method%inertia%springs)) call stored%add(sum(method%inertia%springs(:, i)*u(:, i)**2)/2)
        if (model%rig%elastic) &
          call stored%add(-model%rig%clamp_preload(i)*sum(u(3, i:last_layer(model%map%above, i))))
        if (.not. allocated(cohesive%cohesive)) cycle
        if (.not. (model%zone(i) > 0 .and. method%stacks%area(i) > 0)) cycle
        if (cohesive%points(i)%damage > 0 .or. cohesive%by_energy(i)) then
          associate (surfaces => cohesive%surfaces_of(model, i))
            energies(i) = method%stacks%area(i)*surfaces%stored(u(1:3, i), cohesive%points(i))
          end associate
        else
          associate (k => method%stacks%stiffness(:, i))
            energies(i) = (k(1)*u(1, i)**2 + k(1)*u(2, i)**2 + k(2)*u(3, i)**2)/2
          end associate
        end if
      end do
    end associate
    call stored%add(energies)
  end subroutine add_stored
end module central_difference_energies
