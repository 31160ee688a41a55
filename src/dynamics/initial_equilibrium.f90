!> The state that a plate takes by itself before anything loads it: in equilibrium under its residual stresses.
!>
!> A plate that no support holds has rigid motions. Residual stresses balance among themselves and don't drive them, so
!> a little mass in the operator is enough: it holds the rigid motions, and costs the softest mode of the plate a small
!> part of each correction.
module initial_equilibrium
  use errors, only: error_t, fail, exit_convergence
  use kinds, only: wp
  use models, only: model_t
  use residual_norms, only: relative_residual
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: find_initial_equilibrium

  !> Mass over that which would double the lowest frequency of a bending plate as long as this one.
  real(wp), parameter :: little = 1.0e-3_wp
  !> Residual over the forces of the suppressed strains: loads to come may be much smaller than these.
  real(wp), parameter :: tolerance = 1.0e-11_wp
  integer, parameter :: most_iterations = 100

contains

  !> Brings a plate at rest into equilibrium with its residual stresses. Collective.
  subroutine find_initial_equilibrium(model, operator, state, error)
    type(model_t), intent(in) :: model
    !> The factored operator; not ready for steps afterwards
    type(tangent_operator_t), intent(inout) :: operator
    !> The state at rest; receives displacement, forces and energies
    type(state_t), intent(inout) :: state
    !> Set if there is no equilibrium
    type(error_t), allocatable, intent(out) :: error
    type(state_t) :: before
    real(wp), allocatable :: residual(:, :), correction(:, :), suppressing(:, :)
    real(wp) :: energy, damage, force_square, largest(2)
    integer :: iteration

    allocate (residual, correction, mold=state%motion%displacement)
    correction = 0
    before = state
    largest = 0
    force_square = square_of_forces(model)
    do iteration = 0, most_iterations
      call state%find_internal(model, before, energy)
      residual = -state%motion%internal
      call model%add_holding_lines(state%motion%displacement, residual)
      call state%interfaces%act(model, state%motion%displacement, residual)
      if (iteration == 0) suppressing = state%motion%internal
      if (relative_residual(model%communicator, operator%numbering, residual, suppressing, suppressing, force_square, &
                            operator%diagonal, state%motion%displacement, .true., tolerance, model%thickness, &
                            largest) <= tolerance) exit
      if (iteration == most_iterations) call fail(error, exit_convergence, &
        'No equilibrium under the residual stresses of &thermal.')
      if (.not. allocated(error)) call operator%renew(model, state%plies%stiffness, state%interfaces, &
        state%motion%displacement, 1.0_wp, mass_factor(model), error)
      if (.not. allocated(error)) call operator%correct(model, residual, correction, error)
      if (allocated(error)) return
      call state%interfaces%faces%hold(model, correction)
      state%motion%displacement = state%motion%displacement + correction
    end do
    call state%plies%book(model, damage)
    if (allocated(state%plies%bands)) call state%plies%bands%commit()
    call model%communicator%sum(energy)
    state%ledger%strain = energy*model%mesh%multiplicity
    state%ledger%ply_damage = damage
    state%ledger%initial = state%ledger%initial + state%ledger%strain + damage
    state%deflection = model%deflection(state%motion%displacement)
    state%patch_mean = model%contact_deflection(state%motion%displacement)
    operator%ready = .false.
  end subroutine find_initial_equilibrium

  !> Square of the forces on this rank's elements that suppress the strains, were they not balanced by neighbours and
  !> supports: those left over at the free unknowns may be none.
  pure real(wp) function square_of_forces(model) result(total)
    type(model_t), intent(in) :: model
    integer :: b

    total = 0
    do b = 1, model%elements%batches
      total = total + sum(sum(model%elements%weight(:, :, b), 2)*sum(model%free(:, 1:3, b)**2, 2))
    end do
  end function square_of_forces

  !> Mass in the operator.
  pure real(wp) function mass_factor(model) result(factor)
    type(model_t), intent(in) :: model
    real(wp), parameter :: pi = acos(-1.0_wp)

    factor = 0
    if (model%scene%has_static) return
    factor = little*min(model%section%stiffness(13), model%section%stiffness(16))/model%section%mass(1) &
             *(pi/maxval(model%scene%plate%length))**4
  end function mass_factor
end module initial_equilibrium
