!> Energy ledger of central differences, by the method's own algebra.
!>
!> The kinetic energy at the end of a step is T = v M v/2 + h (F - B^T lambda) v/2, v the velocity in the middle of the step:
!> in a linear plate without interfaces T and the strain energy together stay what they are to the last digit, and T changes
!> by the work of the mean of the forces at both ends. What tractions do beyond what interfaces store and dissipate is
!> booked as lost. So the ledger's error shows what is left: forces that are not linear within a step.
module central_difference_energies
  use central_differences, only: central_difference_t
  use kinds, only: wp
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: book_energies, scaled_share

contains

  !> Finds the ledger of a state. Collective.
  subroutine book_energies(method, model, now)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state; receives its ledger
    type(state_t), intent(inout) :: now
    real(wp) :: sums(8)

    sums(1:2) = kinetic_energies(method, model, now)
    sums(3) = method%strain + interface_energy(method, model, now) + spring_energy(method, model, now)
    sums(4:5) = 0
    if (allocated(now%interfaces%cohesive%points)) then
      associate (points => now%interfaces%cohesive%points)
        sums(4) = sum(method%stacks%area*points%dissipated)
        sums(5) = sum(method%stacks%area*points%sliding%heat)
      end associate
    end if
    sums(6) = sum(method%stacks%lost(1, :)) + sum(method%rigs%frame_loss)
    sums(7) = sum(method%stacks%lost(2, :)) + sum(method%rigs%spring_loss)
    sums(8) = sum(method%lines%work)
    call model%communicator%sum(sums)
    sums = sums*model%mesh%multiplicity
    associate (ledger => now%ledger)
      ledger%kinetic = sums(1)
      ledger%strain = sums(3)
      ledger%delamination = sums(4)
      ledger%friction = sums(5)
      ledger%contact = sums(6)
      ledger%algorithmic = sums(7)
      ledger%external_work = method%initial_work + method%travel_work + sums(8)
      if (allocated(now%plies%bands)) then
        call now%plies%total_dissipation(model)
        ledger%ply_damage = sum(now%plies%dissipated)
      end if
      if (.not. model%scene%has_impactor) return
      ledger%indentation = now%indentation%work
      if (model%scene%impactor%travel > 0) return
      associate (parameters => model%scene%impactor, v => method%impactor_velocity)
        ledger%impactor = parameters%mass*(v*(v + method%steps%now*(parameters%gravity - now%force/parameters%mass))/2 &
                                           - parameters%gravity*now%impactor%displacement)
      end associate
    end associate
  end subroutine book_energies

  !> Kinetic energy of this rank's points, and the part of it in motions whose inertia is scaled.
  function kinetic_energies(method, model, now) result(energies)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    !> All, and in the plane and of rotation
    real(wp) :: energies(2)
    real(wp), allocatable :: layer(:, :)
    real(wp) :: plane
    integer :: i

    layer = model%motion_of(now%motion%velocity)
    energies = 0
    do i = 1, model%distribution%owned
      associate (m => method%inertia%mass(:, i), v => layer(:, i))
        plane = (m(1)*(v(1)**2 + v(2)**2) + m(3)*(v(4)**2 + v(5)**2))/2 + m(2)*(v(1)*v(4) + v(2)*v(5))
        energies(1) = energies(1) + m(4)*v(3)**2/2 + plane + method%steps%now/2*dot_product(method%force(:, i), v)
        energies(2) = energies(2) + plane
      end associate
    end do
    energies(1) = energies(1) - sum(method%stacks%forces*method%stacks%change)/2 &
                  - sum(method%rigs%reaction*method%rigs%approach)/2
    if (size(method%lines%pins) > 0) &
      energies(1) = energies(1) + sum(method%lines%pins%reaction*method%lines%pins%change)/2
    if (allocated(method%inertia%springs)) energies(1) = energies(1) - method%steps%now/2* &
      sum(method%inertia%springs*now%motion%displacement*now%motion%velocity)
  end function kinetic_energies

  !> Largest share of the kinetic energy that scaled motions hold in a state. Collective.
  real(wp) function scaled_share(method, model, now) result(share)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    real(wp) :: energies(2)

    energies = kinetic_energies(method, model, now)
    call model%communicator%sum(energies)
    share = 0
    if (energies(1) > 0) share = energies(2)/energies(1)
  end function scaled_share

  !> Energy that this rank's interfaces store.
  real(wp) function interface_energy(method, model, now) result(energy)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now
    integer :: i

    energy = 0
    associate (cohesive => now%interfaces%cohesive, u => now%motion%displacement)
      if (.not. allocated(cohesive%cohesive)) return
      do i = 1, model%distribution%owned
        if (.not. (model%zone(i) > 0 .and. method%stacks%area(i) > 0)) cycle
        if (cohesive%points(i)%damage > 0) then
          associate (faces => cohesive%faces_of(model, model%zone(i), cohesive%strength(i)))
            energy = energy + method%stacks%area(i)*faces%stored(u(1:3, i), cohesive%points(i))
          end associate
        else
          energy = energy + sum(method%stacks%stiffness([1, 1, 2], i)*u(1:3, i)**2)/2
        end if
      end do
    end associate
  end function interface_energy

  !> Energy that springs of clamps and edges store.
  real(wp) function spring_energy(method, model, now) result(energy)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    !> The state
    type(state_t), intent(in) :: now

    energy = 0
    if (allocated(method%inertia%springs)) energy = sum(method%inertia%springs*now%motion%displacement**2)/2
    if (model%rig%elastic) energy = energy - sum(model%rig%presses(:model%distribution%owned) &
                                                 *now%motion%displacement(3, :model%distribution%owned))
  end function spring_energy
end module central_difference_energies
