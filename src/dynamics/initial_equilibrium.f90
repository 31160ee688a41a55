!> Initial state of a run in time: equilibrium under residual stresses and under lines prescribed before the run.
!>
!> An unsupported plate has rigid-body modes. Residual stresses are self-equilibrated and do not excite them, so a small
!> mass in the operator removes the singularity; it reduces the correction of the softest elastic mode by a small
!> fraction.
module initial_equilibrium
  use errors, only: error_t, fail, exit_convergence
  use kinds, only: wp
  use krylov_corrections, only: solve_load_tangent
  use line_motions, only: has_moved_lines, prescribe_lines, line_displacement, move_lines
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use residual_norms, only: relative_residual, sums_of_squares
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: has_initial_motion, find_initial_equilibrium, find_acceleration

  !> Residual relative to the forces of the suppressed strains: loads 1e-5 times as large are still solved to the usual
  !> tolerance of 1e-6, and round-off, 1e-16, is far below it.
  real(wp), parameter :: tolerance = 1.0e-11_wp
  integer, parameter :: max_iterations = 100

  !> Data of the previous correction for Aitken's extrapolation.
  type :: aitken_t
    !> Its factor
    real(wp) :: factor = 1
    !> Work of the residual on it
    real(wp) :: work = 0
    !> The correction without the factor, (5, points)
    real(wp), allocatable :: correction(:, :)
  end type aitken_t

contains

  !> Finds the equilibrium of a plate at rest with its residual stresses, and then with lines prescribed before the run,
  !> whose work is recorded. Collective.
  subroutine find_initial_equilibrium(model, operator, state, error)
    type(model_t), intent(in) :: model
    !> The factored operator; not ready for steps afterwards
    type(tangent_operator_t), intent(inout) :: operator
    !> The state at rest; receives displacement, forces and energies
    type(state_t), intent(inout) :: state
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: energy

    energy = 0
    if (model%plate%setup%thermal%is_present) then
      call equilibrate(model, operator, .false., state, error)
      if (allocated(error)) return
      energy = energy_of(state)
      state%ledger%initial = state%ledger%initial + energy
      state%ledger%residual = energy
    end if
    if (.not. lines_precede(model)) return
    call equilibrate(model, operator, .true., state, error)
    if (allocated(error)) return
    state%ledger%external_work = energy_of(state) - energy
  end subroutine find_initial_equilibrium

  !> Energy stored and dissipated in a plate at rest.
  pure real(wp) function energy_of(state) result(energy)
    type(state_t), intent(in) :: state

    energy = state%ledger%strain + state%ledger%ply_damage + state%ledger%delamination
  end function energy_of

  !> True: residual stresses or lines deform the plate before a run in time.
  pure logical function has_initial_motion(model)
    type(model_t), intent(in) :: model

    has_initial_motion = model%plate%setup%thermal%is_present .or. lines_precede(model)
  end function has_initial_motion

  !> True: lines are displaced before a run in time.
  pure logical function lines_precede(model)
    type(model_t), intent(in) :: model
    integer :: i

    lines_precede = model%plate%setup%has_inertia() &
                    .and. any([(model%loads%lines(i)%load%precedes(), i=1, size(model%loads%lines))])
  end function lines_precede

  !> Finds the equilibrium of a plate at rest. Collective.
  subroutine equilibrate(model, operator, moved, state, error)
    type(model_t), intent(in) :: model
    !> The factored operator; not ready for steps afterwards
    type(tangent_operator_t), intent(inout) :: operator
    !> True: lines have their displacement of time 0; false: zero displacement
    logical, intent(in) :: moved
    !> The state at rest; receives displacement, forces and energies
    type(state_t), intent(inout) :: state
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error
    type(state_t) :: before
    real(wp), allocatable :: residual(:, :), correction(:, :)
    real(wp) :: energy, damage, references(2, 2), largest(2)
    type(aitken_t) :: aitken
    integer :: iteration

    allocate (residual, correction, mold=state%motion%displacement)
    before = state
    if (moved) call guess_motion(model, state)
    largest = 0
    references(:, 2) = [square_of_forces(model%plate), 0.0_wp]
    do iteration = 0, max_iterations
      call find_residual(model, moved, before, state, energy, residual)
      if (iteration == 0) references(:, 1) = sums_of_squares(operator%numbering, state%motion%internal)
      if (relative_residual(model%plate, operator, equilibrium_t(tolerance=tolerance), residual, references, &
                            state%motion%displacement, .true., largest) <= tolerance) exit
      if (iteration == max_iterations) call fail(error, exit_convergence, &
        'No equilibrium at the start, under the residual stresses of &thermal or &line of history = ''fixed''.')
      if (allocated(error)) return
      call operator%renew(model, state, 1.0_wp, mass_factor(model), error)
      if (.not. allocated(error)) call solve_load_tangent(operator, model, state, residual, correction, error)
      if (allocated(error)) return
      if (model%plate%setup%has_crack_bands()) call extrapolate(model%plate, residual, aitken, correction)
      call state%interfaces%contact%constrain_correction(model%plate, correction)
      state%motion%displacement = state%motion%displacement + correction
    end do
    call state%plies%record(model%plate, damage)
    if (allocated(state%plies%bands)) then
      call state%plies%bands%commit()
      call state%plies%total_dissipation(model%plate)
      damage = damage + state%plies%permanent_shear - before%plies%permanent_shear
    end if
    call model%plate%communicator%sum(energy)
    state%ledger%strain = energy*model%plate%mesh%multiplicity
    state%ledger%ply_damage = state%ledger%ply_damage + damage
    state%ledger%delamination = state%ledger%delamination &
                                + state%interfaces%cohesive%dissipation(model%plate, before%interfaces%cohesive)
    state%impact%deflection = model%plate%deflection(state%motion%displacement)
    ! The impactor starts at first contact with the deflected plate.
    if (model%plate%setup%impactor%is_present) &
      state%impact%patch%offset = -state%impact%patch%mean(model%plate%communicator, state%motion%displacement)
    if (allocated(model%nose)) state%impact%patch%touched_at = model%nose%first_contact( &
      model%plate%communicator, state%motion%displacement(3, :))
    state%impact%patch_mean = state%contact_deflection(model%plate)
    operator%ready = .false.
  end subroutine equilibrate

  !> Moves the nodes of prescribed lines to their displacement of time 0, the first guess of the equilibrium. Where a
  !> line moves a lower layer, the layers above move with it: from a guess with open interfaces the iteration would
  !> converge to a delaminated plate, or not at all.
  subroutine guess_motion(model, state)
    type(model_t), intent(in) :: model
    !> The state; receives the displacement
    type(state_t), intent(inout) :: state
    real(wp), allocatable :: change(:, :)
    integer :: i

    associate (displacement => state%motion%displacement, cohesive => state%interfaces%cohesive)
      change = displacement
      call prescribe_lines(model, state%interfaces, 0.0_wp, line_displacement, displacement)
      if (.not. allocated(cohesive%cohesive)) return
      change = displacement - change
      do i = model%plate%distribution%owned, 1, -1
        if (.not. cohesive%cohesive(i) .or. cohesive%points(i)%damage >= 1) cycle
        displacement(1:3, i) = displacement(1:3, i) - change(1:3, i)
        associate (above => model%plate%map%above(i))
          change(1:3, above) = change(1:3, above) + change(1:3, i)
          displacement(1:3, above) = displacement(1:3, above) + change(1:3, i)
        end associate
      end do
      call model%plate%halo%update(displacement)
    end associate
  end subroutine guess_motion

  !> Residual of a plate at rest.
  subroutine find_residual(model, moved, before, state, energy, residual)
    type(model_t), intent(in) :: model
    !> True: lines have their displacement of time 0; false: zero displacement
    logical, intent(in) :: moved
    !> The state before
    type(state_t), intent(in) :: before
    !> The state; receives internal forces
    type(state_t), intent(inout) :: state
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    real(wp), intent(inout) :: residual(:, :)
    real(wp), allocatable :: lines(:, :)

    call state%find_internal(model, before, energy)
    residual = -state%motion%internal
    if (moved) then
      allocate (lines, mold=residual)
      call model%loads%line_forces(state%motion%displacement, 0.0_wp, lines, prescribed=.true.)
      residual = residual + lines
    else
      call model%loads%add_holding_lines(state%motion%displacement, residual)
    end if
    call state%interfaces%add_to_residual(model, state%motion%displacement, residual)
  end subroutine find_residual

  !> Extrapolates a correction by the secant stiffness of softening plies, which alone converges linearly, by Aitken's
  !> method in the energy norm (B. M. Irons, R. C. Tuck, Int. J. Numer. Meth. Eng. 1 (1969) 275-277). Where corrections
  !> decrease quadratically, the factor tends to 1.
  !>
  !> With the secant and tangent stiffness Ks and Kt, A = inv(Ks) Kt and a correction d the factor is
  !> (d, A d)/(A d, A d) in the product (a, b) = a Ks b. It is the step length of Barzilai and Borwein (IMA J. Numer.
  !> Anal. 8 (1988) 141-148) and lies between the reciprocals of the extreme eigenvalues of A. A factor of 9 thus means
  !> that the tangent stiffness is a ninth of the secant one. It needs no bound: it converges wherever A is positive
  !> definite (M. Raydan, IMA J. Numer. Anal. 13 (1993) 321-326). Elsewhere a negative factor is replaced by 1, and only
  !> the residual ends the iteration. Collective.
  subroutine extrapolate(plate, residual, aitken, correction)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: residual(:, :)
    !> The correction before; receives this one
    type(aitken_t), intent(inout) :: aitken
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    real(wp) :: works(2), change, factor

    works = 0
    if (allocated(aitken%correction)) works(1) = plate%product(aitken%correction, residual)
    works(2) = plate%product(correction, residual)
    call plate%communicator%sum(works)
    change = aitken%work - 2*works(1) + works(2)
    factor = 1
    if (allocated(aitken%correction) .and. change > 0) factor = aitken%factor*(aitken%work - works(1))/change
    if (.not. factor > 0) factor = 1
    aitken = aitken_t(factor, works(2), correction)
    correction = factor*correction
  end subroutine extrapolate

  !> Initial acceleration of the plate under pressure and forces applied at time 0, and initial velocity of prescribed
  !> lines. Collective.
  subroutine find_acceleration(model, operator, mass_factor, state, error)
    type(model_t), intent(in) :: model
    !> The factored operator; not ready for steps afterwards
    type(tangent_operator_t), intent(inout) :: operator
    !> Factor of the mass in a step, in the same operator as the springs of prescribed lines
    real(wp), intent(in) :: mass_factor
    !> The state at the start; receives acceleration and velocity
    type(state_t), intent(inout) :: state
    !> Set if the mass matrix is singular
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: loads(:, :)
    real(wp) :: work

    allocate (loads, mold=state%motion%displacement)
    ! Prescribed lines are already in equilibrium with the plate; their springs in the operator hold them.
    call model%loads%line_forces(state%motion%displacement, 0.0_wp, loads, prescribed=.false.)
    if (allocated(model%loads%pressure)) loads = loads + model%plate%setup%pressure%amplitude(0.0_wp) &
                                                 *model%loads%pressure
    associate (motion => state%motion)
      call operator%renew(model, state, 0.0_wp, mass_factor, error)
      if (allocated(error)) return
      call operator%correct(model%plate, loads, motion%acceleration, error)
      operator%solves = operator%solves + 1
      motion%acceleration = mass_factor*motion%acceleration
      call model%inertia(motion%acceleration, motion%inertia)
      operator%ready = .false.
      if (allocated(error) .or. .not. has_moved_lines(model)) return
      call move_lines(model, state%interfaces, 0.0_wp, motion, work)
    end associate
    state%ledger%kinetic = work
    state%ledger%external_work = state%ledger%external_work + work
  end subroutine find_acceleration

  !> Sum over this rank's elements of the squared nodal forces that suppress the stress-free strains, before assembly:
  !> after assembly those at unconstrained unknowns may vanish.
  pure real(wp) function square_of_forces(plate) result(total)
    type(composite_plate_t), intent(in) :: plate
    integer :: b

    total = 0
    if (.not. allocated(plate%layup%free)) return
    do b = 1, plate%elements%batches
      total = total + sum(sum(plate%elements%weight(:, :, b), 2)*sum(plate%layup%free(:, 1:3, b)**2, 2))
    end do
  end function square_of_forces

  !> Mass in the operator: with it the operator of a free plate is definite, and each iteration reduces the error in the
  !> lowest mode to a thousandth.
  pure real(wp) function mass_factor(model) result(factor)
    type(model_t), intent(in) :: model

    factor = 0
    if (model%plate%setup%has_inertia()) factor = model%plate%negligible_stiffness()/model%plate%layup%section%mass(1)
  end function mass_factor
end module initial_equilibrium
