!> Books the energies of a step. What the integrators take out of the motion is computed from their
!> own algebra, not as the remainder, so that the ledger's error shows every other mistake.
module step_ledgers
  use kinds, only: wp
  use impactors, only: impactor_energy
  use plate_integrators, only: plate_integrator_t
  use models, only: model_t
  use pressure_histories, only: pressure_amplitude
  use states, only: state_t
  implicit none
  private
  public :: book_step

  !> Products of the step's fields that the energies are made of, summed over the modelled part.
  type :: products_t
    !> v.Mv at the end; strain energy at the end
    real(wp) :: kinetic = 0, strain = 0
    !> Change of displacement times: mean internal force, change of internal force, nodal force of full pressure,
    !> change of inertia force
    real(wp) :: mean_internal = 0, internal_change = 0, pressure = 0, inertia_change = 0
    !> a.Ma at the end and at the start; change of a times change of Ma
    real(wp) :: jerk_new = 0, jerk_old = 0, jerk_change = 0
    !> Work of the forces between faces
    real(wp) :: faces = 0
  end type products_t

contains

  !> Books a step.
  subroutine book_step(model, integrator, old, step, force, energy, new)
    !> The model
    type(model_t), intent(in) :: model
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> State at the start
    type(state_t), intent(in) :: old
    !> Time step
    real(wp), intent(in) :: step
    !> Force of the impactor in the plate's equation of motion
    real(wp), intent(in) :: force
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the end; receives its ledger
    type(state_t), intent(inout) :: new
    type(products_t) :: products
    real(wp) :: amplitudes(2), gain, impactor, taken

    products = step_products(model, old, energy, new)
    amplitudes = [pressure_amplitude(model%scene, old%time), pressure_amplitude(model%scene, new%time)]
    new%ledger%kinetic = products%kinetic/2
    new%ledger%strain = products%strain
    new%ledger%contact = old%ledger%contact - products%faces
    new%ledger%external_work = old%ledger%external_work + sum(amplitudes)/2*products%pressure
    gain = integrator_gain(integrator, step, products, amplitudes(2) - amplitudes(1)) &
           + (products%strain - old%ledger%strain - products%mean_internal)
    ! What fracture takes has been booked, and taken off here, when the ties were let go.
    call new%ties%book(model, old%ties, new%motion%displacement - old%motion%displacement, taken)
    new%ledger%algorithmic = old%ledger%algorithmic - gain + taken
    if (.not. model%scene%has_impactor) return
    impactor = impactor_energy(model%scene%impactor, new%impactor)
    new%ledger%impactor = impactor
    new%ledger%indentation = new%indentation%work
    new%ledger%algorithmic = new%ledger%algorithmic - (force*(new%patch_mean - old%patch_mean) &
      + impactor - old%ledger%impactor + new%ledger%indentation - old%ledger%indentation)
  end subroutine book_step

  !> Energy that the plate's integrator adds to a linear plate in a step: the Newmark formulas and the
  !> weighted equation of motion combined. Zero for alpha_m = alpha_f = gamma = 1/2, beta = 1/4.
  pure real(wp) function integrator_gain(integrator, step, products, pressure_change) result(gain)
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> Time step
    real(wp), intent(in) :: step
    !> Products of the step's fields
    type(products_t), intent(in) :: products
    !> Change of the pressure over its full value
    real(wp), intent(in) :: pressure_change

    associate (m => integrator%alpha_m, f => integrator%alpha_f, beta => integrator%beta, gamma => integrator%gamma)
      gain = (0.5_wp - f)*(pressure_change*products%pressure - products%internal_change) &
             + (gamma - 1 + m)*products%inertia_change &
             - step**2*(beta - gamma/2)*((products%jerk_new - products%jerk_old)/2 &
                                         + (gamma - 0.5_wp)*products%jerk_change)
    end associate
  end function integrator_gain

  !> Products of the step's fields, of the whole plate.
  function step_products(model, old, energy, new) result(products)
    !> The model
    type(model_t), intent(in) :: model
    !> State at the start
    type(state_t), intent(in) :: old
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the end
    type(state_t), intent(in) :: new
    !> The products
    type(products_t) :: products
    real(wp), allocatable :: change(:, :), momentum(:, :)
    real(wp) :: sums(10)

    allocate (momentum, mold=old%motion%displacement)
    call model%inertia(new%motion%velocity, momentum)
    change = new%motion%displacement - old%motion%displacement
    sums = 0
    sums(1:2) = [model%product(new%motion%velocity, momentum), energy]
    sums(3) = model%product(change, new%motion%internal + old%motion%internal)/2
    sums(4) = model%product(change, new%motion%internal - old%motion%internal)
    if (allocated(model%pressure)) sums(5) = model%product(change, model%pressure)
    sums(6) = model%product(change, new%motion%inertia - old%motion%inertia)
    sums(7) = model%product(new%motion%acceleration, new%motion%inertia)
    sums(8) = model%product(old%motion%acceleration, old%motion%inertia)
    sums(9) = model%product(new%motion%acceleration - old%motion%acceleration, &
                            new%motion%inertia - old%motion%inertia)
    if (model%map%layered) sums(10) = new%separation%work(model, new%motion%displacement, change)
    call model%communicator%sum(sums)
    sums = sums*model%mesh%multiplicity
    products = products_t(sums(1), sums(2), sums(3), sums(4), sums(5), sums(6), sums(7), sums(8), sums(9), sums(10))
  end function step_products
end module step_ledgers
