!> Load steps of a static analysis: Newton's iteration with a fresh tangent, around it that of the contact
!> pressures.
module static_steps
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use plate_options, only: kinematics_linear
  use delamination_parameters, only: contact_none
  use stepping_parameters, only: equilibrium_t
  use models, only: model_t
  use states, only: state_t
  use residual_norms, only: relative_residual
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: attempt_load

  !> Distance of pressures and gaps from contact (complementarity) at which they have settled.
  real(wp), parameter :: contact_tolerance = 5.0e-10_wp

contains

  !> Tries to reach a load factor. On return either `converged` and `new` is the state there, or nothing of it counts.
  subroutine attempt_load(model, equilibrium, operator, old, load_factor, new, converged, error)
    !> The model
    type(model_t), intent(in) :: model
    !> Convergence asked for
    type(equilibrium_t), intent(in) :: equilibrium
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the load before
    type(state_t), intent(in) :: old
    !> Load over the full load
    real(wp), intent(in) :: load_factor
    !> State at this load
    type(state_t), intent(inout) :: new
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: residual(:, :), correction(:, :)
    real(wp) :: energy, norm
    logical :: pressures_new

    new = old
    new%time = load_factor
    new%iterations = 0
    new%contact_iterations = 0
    allocate (residual, correction, mold=old%motion%displacement)
    correction = 0
    pressures_new = .false.
    do
      call model%internal(new%motion%displacement, new%motion%internal, energy)
      residual = load_factor*model%pressure - new%motion%internal
      call new%interfaces%faces%act(model, new%motion%displacement, residual)
      norm = relative_residual(model%communicator, operator%numbering, residual, new%motion%internal, &
                               load_factor*model%pressure, 0.0_wp, &
                               operator%diagonal*new%motion%displacement, equilibrium%tolerance, &
                               model%thickness, new%largest_forces)
      ! New pressures may be too little a change for the tolerance; only a correction can make them fit the gaps.
      converged = norm <= equilibrium%tolerance .and. .not. pressures_new
      pressures_new = .false.
      if (converged) then
        call new%interfaces%faces%settle(model, new%motion%displacement, contact_tolerance, new%contact_iterations, &
                                   converged)
        if (converged) exit
        pressures_new = .true.
        if (new%contact_iterations < equilibrium%max_iterations) cycle
      end if
      if (.not. norm <= huge(norm) .or. new%iterations >= equilibrium%max_iterations) exit
      if (.not. operator%ready .or. changes(model, new%iterations)) &
        call operator%renew(model, new%interfaces%faces, new%motion%displacement, 1.0_wp, 0.0_wp, error)
      if (.not. allocated(error)) call operator%correct(model, residual, correction, error)
      if (allocated(error)) then
        if (error%code == exit_convergence .and. model%scene%kinematics /= kinematics_linear) deallocate (error)
        return
      end if
      call new%interfaces%faces%hold(model, correction)
      new%motion%displacement = new%motion%displacement + correction
      new%iterations = new%iterations + 1
    end do
    if (converged) call finish(model, old, energy, new)
  end subroutine attempt_load

  !> True if the tangent may not be what it was at the iteration before.
  pure logical function changes(model, iterations)
    !> The model
    type(model_t), intent(in) :: model
    !> Iterations of this step so far
    integer, intent(in) :: iterations

    changes = model%scene%kinematics /= kinematics_linear
    ! Plies may have failed since the step before; later only contacts change.
    if (.not. changes) changes = iterations == 0 .and. (model%scene%has_ply_damage .or. model%map%layered)
    if (changes .or. .not. model%map%layered) return
    changes = any(model%scene%delaminations%contact /= contact_none)
  end function changes

  !> Completes an accepted load step.
  subroutine finish(model, old, energy, new)
    !> The model
    type(model_t), intent(in) :: model
    !> State at the load before
    type(state_t), intent(in) :: old
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at this load
    type(state_t), intent(inout) :: new
    real(wp) :: sums(5), faces
    real(wp), allocatable :: change(:, :)

    change = new%motion%displacement - old%motion%displacement
    sums(1) = energy
    sums(2) = model%product(change, new%motion%internal + old%motion%internal)/2
    sums(3) = (new%time + old%time)/2*model%product(change, model%pressure)
    sums(4:5) = 0
    if (model%map%layered) then
      faces = old%interfaces%faces%work(model, old%motion%displacement, change)
      sums(4) = (faces + new%interfaces%faces%work(model, new%motion%displacement, change))/2
      sums(5) = faces/2
    end if
    ! Plies that failed left the state before out of equilibrium. What that sets free would go into motion.
    sums(5) = sums(5) + model%product(change, old%time*model%pressure - old%motion%internal)/2
    if (.not. model%scene%has_ply_damage) sums(5) = 0
    call model%communicator%sum(sums)
    sums = sums*model%mesh%multiplicity
    new%step = old%step + 1
    new%all_iterations = old%all_iterations + new%iterations
    new%all_contact_iterations = old%all_contact_iterations + new%contact_iterations
    new%deflection = model%deflection(new%motion%displacement)
    new%patch_mean = model%patch_mean(new%motion%displacement)
    new%ledger%strain = sums(1)
    new%ledger%external_work = old%ledger%external_work + sums(3)
    new%ledger%contact = old%ledger%contact - sums(4)
    new%ledger%algorithmic = old%ledger%algorithmic - (sums(1) - old%ledger%strain - sums(2)) + sums(5)
  end subroutine finish
end module static_steps
