!> Energies of central differences: their ledger, damping, and the check that no energy is created.
!>
!> The ledger follows the exact energy identity of the method, theory (E5) and (E6).
!>
!> The kinetic energy at the end of a step is T = v M v/2 + h (F - B^T lambda) v/2, with the mid-step velocity v. T
!> changes by the work of the mean force of both ends, so that T plus strain energy of a linear plate without interfaces
!> is constant to round-off. Work of the tractions beyond the energy that interfaces store and dissipate is recorded as
!> algorithmic dissipation. The remaining error of the ledger is that of forces which are nonlinear within a step.
module central_difference_energies
  use central_differences, only: central_difference_t
  use errors, only: error_t, exit_convergence, fail
  use exact_sums, only: exact_sum_t
  use interface_stacks, only: last_layer
  use kinds, only: wp
  use mathematical_constants, only: pi
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use rank_totals, only: total_of, totals_of
  use short_numbers, only: short_text
  use states, only: state_t
  use text, only: rounded_text, to_text
  implicit none
  private
  public :: record_energies, damp_motion, check_stability

  !> Ratio of the final to the initial amplitude. That of energies is 1e-7, below the usual tolerance of 1e-6.
  real(wp), parameter :: final_ratio = 3.0e-4_wp
  !> Smallest duration of the damping in periods of a vibration: in fewer periods the vibration is overdamped and
  !> returns more slowly.
  real(wp), parameter, public :: min_periods = -log(final_ratio)/(2*pi)

  !> Ratio of the energy error to the largest energy so far above which a run ends. The present energy is no reference:
  !> it returns to zero in free vibration. An unstable mode grows exponentially, so the exact value is not important.
  !> The check of the ledger warns from a tenth of it, 1 %.
  real(wp), parameter :: max_energy_error = 0.1_wp

contains

  !> Computes the ledger of a state. Collective.
  subroutine record_energies(method, model, now)
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state; receives its ledger
    type(state_t), intent(inout) :: now
    type(exact_sum_t) :: sums(8)
    real(wp) :: totals(8)

    call add_kinetic(method, model%plate, now, 1.0_wp, sums(1), sums(2))
    call sums(3)%add(method%strain)
    call add_stored(method, model, now, sums(3))
    associate (owned => model%plate%distribution%owned, history => method%stacks%history)
      if (allocated(now%interfaces%cohesive%points)) then
        associate (points => now%interfaces%cohesive%points(:owned), area => method%stacks%area(:owned))
          call sums(4)%add(area*points%dissipated)
          call sums(5)%add(area*points%sliding%heat)
        end associate
      end if
      call sums(6)%add(history(:owned)%lost(1) + method%rigs%frame_loss(:owned))
      call sums(7)%add(history(:owned)%lost(2) + method%rigs%step_loss(:owned))
      call sums(8)%add(method%lines%work(:owned))
    end associate
    totals = totals_of(model%plate%communicator, sums)*model%plate%mesh%multiplicity
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
        call now%plies%total_dissipation(model%plate)
        ledger%ply_damage = sum(now%plies%dissipated) + now%plies%permanent_shear
      end if
      if (model%plate%setup%impactor%is_present) then
        ledger%indentation = now%impact%indentation%work
        if (.not. model%plate%setup%impactor%travel > 0) &
          ledger%impactor = method%impact%energy(model, method%steps%now, now)
      end if
      call ledger%note_largest()
    end associate
  end subroutine record_energies

  !> Kinetic energy of the plate at the end of the last step. Collective.
  real(wp) function kinetic_energy(method, plate, now, kept) result(energy)
    type(central_difference_t), intent(in) :: method
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Factor by which damping has multiplied its velocities
    real(wp), intent(in) :: kept
    type(exact_sum_t) :: kinetic, scaled

    call add_kinetic(method, plate, now, kept, kinetic, scaled)
    energy = total_of(plate%communicator, kinetic)*plate%mesh%multiplicity
  end function kinetic_energy

  !> Adds the kinetic energy of this rank's points, and the part of it that belongs to scaled inertia.
  subroutine add_kinetic(method, plate, now, kept, kinetic, scaled)
    type(central_difference_t), intent(in) :: method
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    !> Factor by which damping has multiplied its velocities
    real(wp), intent(in) :: kept
    !> Total kinetic energy, and, with scaled inertia, that of in-plane motion and rotation
    type(exact_sum_t), intent(inout) :: kinetic, scaled
    real(wp), allocatable :: layer(:, :)
    real(wp), dimension(plate%distribution%owned) :: plane, total
    integer :: i

    layer = plate%motion_of(now%motion%velocity)
    do i = 1, plate%distribution%owned
      associate (m => method%inertia%mass(:, i), v => layer(:, i), change => method%stacks%history(i)%change, &
                 lambda => method%stacks%history(i)%forces, force => method%force(:, i))
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
    do i = 1, size(method%lines%points)
      associate (p => method%lines%points(i))
        call kinetic%add(method%lines%reaction(:, p)*method%lines%change(:, p)/2)
      end associate
    end do
  end subroutine add_kinetic

  !> Adds the energy stored in this rank's interfaces, springs and loaded clamps.
  subroutine add_stored(method, model, now, stored)
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> The energy
    type(exact_sum_t), intent(inout) :: stored
    real(wp) :: energies(model%plate%distribution%owned)
    integer :: i

    energies = 0
    associate (cohesive => now%interfaces%cohesive, u => now%motion%displacement)
      do i = 1, model%plate%distribution%owned
        if (allocated(method%inertia%springs)) call stored%add(sum(method%inertia%springs(:, i)*u(:, i)**2)/2)
        if (model%rig%elastic) then
          if (model%rig%clamp_preload(i) > 0) &
            call stored%add(-model%rig%clamp_preload(i)*sum(u(3, i:last_layer(model%plate%map%above, i))))
        end if
        if (.not. allocated(cohesive%cohesive)) cycle
        if (.not. (model%plate%zone(i) > 0 .and. method%stacks%area(i) > 0)) cycle
        if (cohesive%points(i)%damage > 0 .or. cohesive%by_energy(i)) then
          associate (surfaces => cohesive%surfaces_of(model%plate, i))
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

  !> Reduces the velocities at the start of a step. The changes of coordinates in the last step, half of which enter the
  !> kinetic energy with the forces (central_difference_energies), are reduced by the same factor there. Collective.
  subroutine damp_motion(method, plate, now, duration, kept)
    !> Central differences, after a step
    type(central_difference_t), intent(inout) :: method
    type(composite_plate_t), intent(in) :: plate
    !> The state; its ledger receives the energy
    type(state_t), intent(inout) :: now
    !> Duration of the damping; motions with a longer period are damped less
    real(wp), intent(in) :: duration
    !> Factor by which the velocities have been multiplied, for the next step
    real(wp), intent(out) :: kept
    real(wp) :: before

    kept = 1
    if (.not. method%steps%now > 0) return
    kept = exp(2*log(final_ratio)*method%steps%now/duration)
    before = kinetic_energy(method, plate, now, 1.0_wp)
    now%motion%velocity = kept*now%motion%velocity
    method%stacks%history%work = kept*method%stacks%history%work
    method%stacks%history%rubbing(2) = kept*method%stacks%history%rubbing(2)
    method%rigs%approach = kept*method%rigs%approach
    method%lines%change = kept*method%lines%change
    now%ledger%damping = now%ledger%damping + before - kinetic_energy(method, plate, now, kept)
  end subroutine damp_motion

  !> Sets an error if the energy error shows unstable growth. Collective.
  subroutine check_stability(plate, now, error)
    type(composite_plate_t), intent(in) :: plate
    !> The state, with its ledger
    type(state_t), intent(in) :: now
    !> Set if the motion is unstable; the same on every rank
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: created, energy
    character(len=:), allocatable :: amount

    created = now%ledger%error()
    energy = now%ledger%largest + now%ledger%residual
    if (created <= max_energy_error*energy .and. abs(created) <= huge(created)) return
    amount = 'the energy has become infinite'
    if (abs(created) <= huge(created)) &
      amount = rounded_text(created)//' of energy have been created, of a total of '//rounded_text(energy)
    call fail(error, exit_convergence, 'Central differences have become unstable by time '//rounded_text(now%time)// &
              ': '//amount//'; the largest velocity is '//fastest_point(plate, now%motion%velocity)// &
              '. Take a smaller &time step_factor.')
  end subroutine check_stability

  !> Point of the largest transverse velocity. Collective.
  function fastest_point(plate, velocity) result(place)
    type(composite_plate_t), intent(in) :: plate
    !> Rates of the unknowns, (5, points)
    real(wp), intent(in) :: velocity(:, :)
    !> Coordinates and layer
    character(len=:), allocatable :: place
    real(wp), allocatable :: rates(:)
    real(wp) :: largest
    integer :: i, point

    associate (partition => plate%distribution)
      rates = abs(velocity(3, :partition%owned))
      where (.not. rates <= huge(rates)) rates = huge(rates)
      largest = maxval(rates)
      call plate%communicator%maximum(largest)
      point = huge(point)
      do i = 1, partition%owned
        if (rates(i) >= largest) point = min(point, partition%points(i))
      end do
    end associate
    call plate%communicator%minimum(point)
    associate (node => plate%mesh%point_node(point))
      place = 'at x = '//short_text(plate%mesh%node_coordinates(1, node))//', y = '// &
              short_text(plate%mesh%node_coordinates(2, node))//', layer '// &
              to_text(point - plate%mesh%first_point(node) + 1)
    end associate
  end function fastest_point
end module central_difference_energies
