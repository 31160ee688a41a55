!> Energy balance of a step, theory (E1) to (E4). Algorithmic dissipation is computed from the formulas of the
!> integrators, not as the remainder, so that the energy error shows every other error.
module energy_balance
  use cohesive_energies, only: stored_beyond_work
  use cohesive_sliding, only: heat_since
  use kinds, only: wp
  use impactors, only: impactor_energy
  use motions, only: motion_t
  use newmark_integrators, only: plate_integrator_t
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: record_step, record_failures

  !> Length of blocks of products that are summed together, a multiple of the vector length, as in residual_norms
  integer, parameter :: block_length = 8

  !> Products of fields of the step from which the energies are computed, summed over the modelled part.
  type :: products_t
    !> v.Mv at the end; strain energy at the end
    real(wp) :: kinetic = 0, strain = 0
    !> Change of displacement times: mean internal force, change of internal force, nodal force of full pressure,
    !> change of inertia force
    real(wp) :: mean_internal = 0, internal_change = 0, pressure = 0, inertia_change = 0
    !> a.Ma at the end and at the start; change of a times change of Ma
    real(wp) :: jerk_new = 0, jerk_old = 0, jerk_change = 0
    !> Energy that cohesive points store beyond the work on them
    real(wp) :: cohesive = 0
    !> Work of the forces between surfaces
    real(wp) :: contact = 0
    !> Work of the lines, and change of displacement times change of force of lines with a given force
    real(wp) :: lines = 0, lines_change = 0
  end type products_t

contains

  !> Records a step.
  subroutine record_step(model, integrator, old, step, force, energy, new)
    type(model_t), intent(in) :: model
    type(plate_integrator_t), intent(in) :: integrator
    type(state_t), intent(in) :: old
    real(wp), intent(in) :: step
    !> Force of the impactor in the plate's equation of motion
    real(wp), intent(in) :: force
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the end; receives its ledger
    type(state_t), intent(inout) :: new
    type(products_t) :: products
    real(wp) :: amplitudes(2), gain, impactor, taken, fracture, heat, damage

    call find_products(model, integrator, old, step, energy, new, products)
    amplitudes = model%plate%setup%pressure%amplitude([old%time, new%time])
    new%ledger%kinetic = products%kinetic/2
    new%ledger%strain = products%strain
    new%ledger%contact = old%ledger%contact - products%contact
    new%ledger%external_work = old%ledger%external_work + sum(amplitudes)/2*products%pressure + products%lines
    call new%ledger%note_largest()
    gain = integrator_gain(integrator, step, products, amplitudes(2) - amplitudes(1)) &
           + (products%strain - old%ledger%strain - products%mean_internal)
    new%ledger%algorithmic = old%ledger%algorithmic - gain
    call new%plies%record(model%plate, damage)
    new%ledger%ply_damage = new%ledger%ply_damage + damage
    fracture = new%interfaces%cohesive%dissipation(model%plate, old%interfaces%cohesive)
    new%ledger%delamination = new%ledger%delamination + fracture
    heat = heat_since(model%plate, old%interfaces%cohesive, new%interfaces%cohesive)
    new%ledger%friction = new%ledger%friction + heat
    new%ledger%algorithmic = new%ledger%algorithmic - (damage + fracture + heat)
    call new%plies%measure_lag(damage, products%strain - old%ledger%strain - products%mean_internal &
                               - products%cohesive, &
                         new%ledger%largest + new%ledger%residual)
    if (model%plate%map%layered) then
      ! Subtracts the fracture energy, which is recorded when ties are released.
      call new%interfaces%ties%record(model%plate, old%interfaces%ties, &
                                    new%motion%displacement - old%motion%displacement, taken)
      new%ledger%algorithmic = new%ledger%algorithmic + taken
    end if
    if (.not. model%plate%setup%impactor%is_present) return
    impactor = impactor_energy(model%plate%setup%impactor, new%impact%impactor)
    new%ledger%impactor = impactor
    new%ledger%indentation = new%impact%indentation%work
    new%ledger%algorithmic = new%ledger%algorithmic - (force*(new%impact%patch_mean - old%impact%patch_mean) &
      + impactor - old%ledger%impactor + new%ledger%indentation - old%ledger%indentation)
  end subroutine record_step

  !> Records the strain energy dissipated by failed plies, and computes the remaining forces. The energy error of
  !> softening plies by the lag of damage is recorded as algorithmic dissipation.
  subroutine record_failures(model, now, trial)
    type(model_t), intent(in) :: model
    !> The state before the step
    type(state_t), intent(in) :: now
    !> The state after it
    type(state_t), intent(inout) :: trial
    real(wp) :: energy, lost, dissipated

    call trial%find_internal(model, now, energy)
    call model%plate%communicator%sum(energy)
    energy = energy*model%plate%mesh%multiplicity
    lost = trial%ledger%strain - energy
    dissipated = lost
    if (allocated(trial%plies%bands)) then
      call trial%plies%record(model%plate, dissipated)
      call trial%plies%bands%commit()
    end if
    trial%ledger%ply_damage = trial%ledger%ply_damage + dissipated
    trial%ledger%algorithmic = trial%ledger%algorithmic + lost - dissipated
    trial%ledger%strain = energy
  end subroutine record_failures

  !> Energy that the plate's integrator adds to a linear plate in a step, theory (E2): the Newmark formulas and the
  !> weighted equation of motion combined. Zero for alpha_m = alpha_f = gamma = 1/2, beta = 1/4.
  pure real(wp) function integrator_gain(integrator, step, products, pressure_change) result(gain)
    type(plate_integrator_t), intent(in) :: integrator
    real(wp), intent(in) :: step
    !> Products of the step's fields
    type(products_t), intent(in) :: products
    !> Change of the pressure over its full value
    real(wp), intent(in) :: pressure_change

    associate (m => integrator%alpha_m, f => integrator%alpha_f, beta => integrator%beta, gamma => integrator%gamma)
      gain = (0.5_wp - f)*(pressure_change*products%pressure + products%lines_change - products%internal_change) &
             + (gamma - 1 + m)*products%inertia_change &
             - step**2*(beta - gamma/2)*((products%jerk_new - products%jerk_old)/2 &
                                         + (gamma - 0.5_wp)*products%jerk_change)
    end associate
  end function integrator_gain

  !> Products of the step's fields, of the full plate.
  subroutine find_products(model, integrator, old, step, energy, new, products)
    type(model_t), intent(in) :: model
    type(plate_integrator_t), intent(in) :: integrator
    type(state_t), intent(in) :: old
    real(wp), intent(in) :: step
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the end; receives mass times velocity
    type(state_t), intent(inout) :: new
    type(products_t), intent(out) :: products
    real(wp) :: sums(13)

    sums = 0
    call multiply_fields(model%plate%distribution%owned, integrator, step, old%motion, new%motion, sums(:7))
    sums(8) = energy
    if (allocated(model%loads%pressure)) &
      sums(9) = model%plate%product(new%motion%displacement - old%motion%displacement, model%loads%pressure)
    if (model%has_point_stiffness) sums(10) = new%interfaces%contact_work(model, new%motion%displacement, &
                                                                new%motion%displacement - old%motion%displacement)
    if (size(model%loads%lines) > 0) sums(11:12) = line_products(model, old, new)
    if (model%plate%setup%has_crack_bands()) &
      sums(13) = stored_beyond_work(new%interfaces%cohesive, model%plate, old%interfaces%cohesive, &
                                    old%motion%displacement, new%motion%displacement)
    call model%plate%communicator%sum(sums)
    sums = sums*model%plate%mesh%multiplicity
    products = products_t(kinetic=sums(1), mean_internal=sums(2)/2, internal_change=sums(3), inertia_change=sums(4), &
                          jerk_new=sums(5), jerk_old=sums(6), jerk_change=sums(7), strain=sums(8), pressure=sums(9), &
                          contact=sums(10), lines=sums(11), lines_change=sums(12), cohesive=sums(13))
  end subroutine find_products

  !> Work of the lines, and change of displacement times change of force of lines with a given force, of this rank's
  !> points. The reaction of a prescribed line is constant over the step.
  pure function line_products(model, old, new) result(sums)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: old
    type(state_t), intent(in) :: new
    real(wp) :: sums(2)
    real(wp), allocatable :: before(:, :), after(:, :), holding(:, :), change(:, :)

    allocate (before, after, holding, mold=old%motion%displacement)
    call model%loads%line_forces(old%motion%displacement, old%load_factor, before, prescribed=.false.)
    call model%loads%line_forces(new%motion%displacement, new%load_factor, after, prescribed=.false.)
    call model%loads%line_forces(new%motion%displacement, new%load_factor, holding, prescribed=.true.)
    change = new%motion%displacement - old%motion%displacement
    sums = [model%plate%product(change, before + after)/2 + model%plate%product(change, holding), &
            model%plate%product(change, after - before)]
  end function line_products

  !> Products of fields over this rank's points: v.Mv at the end; change of displacement times sum and change of
  !> internal force and times change of inertia force; a.Ma at the end and at the start, and change of a times change of
  !> Ma, where the integrator requires them.
  pure subroutine multiply_fields(owned, integrator, step, old, new, sums)
    !> Number of points that this rank owns
    integer, intent(in) :: owned
    type(plate_integrator_t), intent(in) :: integrator
    real(wp), intent(in) :: step
    !> Motion at the start of the step
    type(motion_t), intent(in) :: old
    !> Motion at its end; receives mass times velocity
    type(motion_t), intent(inout) :: new
    !> The products
    real(wp), intent(out) :: sums(7)
    real(wp) :: works(block_length, 4), jerks(block_length, 3)

    works = 0
    call add_works(5*owned, step*[1 - integrator%gamma, integrator%gamma], old%displacement, old%internal, &
                   old%inertia, old%momentum, new%displacement, new%velocity, new%internal, new%inertia, &
                   new%momentum, works)
    jerks = 0
    if (abs(2*integrator%beta - integrator%gamma) > 0) &
      call add_jerks(5*owned, old%acceleration, old%inertia, new%acceleration, new%inertia, jerks)
    sums = [sum(works, 1), sum(jerks, 1)]
  end subroutine multiply_fields

  !> Mass times velocity by Newmark's formula for the velocity, which saves a loop over elements, and the four products
  !> of fields, each added to the partial sums of a block so that the compiler vectorises them.
  pure subroutine add_works(number, weights, u, f, i, p, u_new, v_new, f_new, i_new, p_new, sums)
    !> Number of values
    integer, intent(in) :: number
    !> Weights of the inertia forces at the start and at the end in the change of mass times velocity
    real(wp), intent(in) :: weights(2)
    !> Displacement, internal and inertia force and mass times velocity at the start
    real(wp), intent(in) :: u(number), f(number), i(number), p(number)
    !> Displacement, velocity, internal and inertia force at the end
    real(wp), intent(in) :: u_new(number), v_new(number), f_new(number), i_new(number)
    !> Mass times velocity at the end
    real(wp), intent(inout) :: p_new(number)
    !> Sums of the four products
    real(wp), intent(inout) :: sums(block_length, 4)
    integer :: start, k, n

    do start = 0, number - 1, block_length
      do k = 1, min(block_length, number - start)
        n = start + k
        p_new(n) = p(n) + (weights(1)*i(n) + weights(2)*i_new(n))
        sums(k, 1) = sums(k, 1) + v_new(n)*p_new(n)
        sums(k, 2) = sums(k, 2) + (u_new(n) - u(n))*(f_new(n) + f(n))
        sums(k, 3) = sums(k, 3) + (u_new(n) - u(n))*(f_new(n) - f(n))
        sums(k, 4) = sums(k, 4) + (u_new(n) - u(n))*(i_new(n) - i(n))
      end do
    end do
  end subroutine add_works

  !> Products of accelerations and inertia forces, added to partial sums in the same way.
  pure subroutine add_jerks(number, a, i, a_new, i_new, sums)
    !> Number of values
    integer, intent(in) :: number
    !> Acceleration and inertia force at the start
    real(wp), intent(in) :: a(number), i(number)
    !> The same at the end
    real(wp), intent(in) :: a_new(number), i_new(number)
    !> Sums of the three products
    real(wp), intent(inout) :: sums(block_length, 3)
    integer :: start, k, n

    do start = 0, number - 1, block_length
      do k = 1, min(block_length, number - start)
        n = start + k
        sums(k, 1) = sums(k, 1) + a_new(n)*i_new(n)
        sums(k, 2) = sums(k, 2) + a(n)*i(n)
        sums(k, 3) = sums(k, 3) + (a_new(n) - a(n))*(i_new(n) - i(n))
      end do
    end do
  end subroutine add_jerks
end module energy_balance
