!> One step of plate and impactor together: the nested iterations of the paper's Fig. 7. The impact
!> force is found anew within each iteration of equilibrium, from the compliance of impactor and plate.
module dynamic_steps
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use impactors, only: advance
  use tan_sun_hertz_indentation, only: commit_indentation
  use stepping_parameters, only: stepping_t, adapt_t
  use newmark_integrators, only: plate_integrator_t
  use models, only: model_t
  use states, only: state_t
  use impact_coupling, only: impact_coupling_t, begin_coupling
  use tangent_operators, only: tangent_operator_t
  use residual_norms, only: relative_residual
  use energy_balance, only: book_step
  implicit none
  private
  public :: attempt_step

  !> Distance of pressures and gaps from contact (complementarity) at which they have settled: the gaps left are
  !> this part of the largest pressure over the layers' stiffness.
  real(wp), parameter :: contact_tolerance = 5.0e-7_wp

contains

  !> Tries a step. On return either `converged` and `new` is the state at its end, or nothing of it counts.
  subroutine attempt_step(model, stepping, integrator, operator, old, step, new, converged, error, guess)
    !> The model
    type(model_t), intent(in) :: model
    !> How steps are taken
    type(stepping_t), intent(in) :: stepping
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> The factored operator; renewed on the way if convergence asks for it
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> Time step
    real(wp), intent(in) :: step
    !> State at the end
    type(state_t), intent(inout) :: new
    !> True if equilibrium was reached
    logical, intent(out) :: converged
    !> Set if the solver fails for good
    type(error_t), allocatable, intent(out) :: error
    !> Displacement to start from, (5, points); left out: the motion goes on as it was
    real(wp), intent(in), optional :: guess(:, :)
    type(impact_coupling_t) :: coupling
    real(wp), allocatable :: residual(:, :), correction(:, :)
    real(wp) :: norm, energy, patch_square

    new = old
    new%time = old%time + step
    call new%interfaces%ties%fade(model, step)
    allocate (residual, correction, mold=old%motion%displacement)
    correction = 0
    patch_square = sum((model%patch/model%mesh%multiplicity)**2)
    if (model%scene%has_impactor) coupling = begin_coupling(model, integrator, old, step)
    call predict_motion(model, integrator, old, step, new, guess)
    call operator%anderson%forget()
    operator%switches = 0
    converged = .false.
    do
      call operator%timers%start('element forces')
      call find_residual(model, integrator, old, new, coupling%load(), residual, energy)
      call new%interfaces%ties%act(model, residual)
      call new%interfaces%faces%act(model, new%motion%displacement, residual)
      call operator%timers%stop('element forces')
      norm = relative_residual(model%communicator, operator%numbering, residual, new%motion%internal, &
                               new%motion%inertia, patch_square*coupling%load()**2, &
                               operator%diagonal*new%motion%displacement, stepping%equilibrium%tolerance, &
                               model%thickness, new%largest_forces)
      ! The force answers to the motion only within an iteration, so an impact needs one.
      converged = norm <= stepping%equilibrium%tolerance .and. (new%iterations > 0 .or. .not. model%scene%has_impactor)
      if (converged) then
        call new%interfaces%faces%settle(model, new%motion%displacement, contact_tolerance, new%contact_iterations, &
                                   converged)
        if (converged) exit
        call operator%anderson%pause()
        if (new%contact_iterations < stepping%equilibrium%max_iterations) cycle
      end if
      if (.not. norm <= huge(norm) .or. new%iterations >= stepping%equilibrium%max_iterations) exit
      call prepare_operator(model, stepping%adapt, integrator, operator, step, new, error)
      if (unsolvable(error)) return
      call operator%correct(model, residual, correction, error)
      if (unsolvable(error)) return
      call improve(model, integrator, operator, old, new, coupling, correction, error)
      if (allocated(error)) then
        ! Numbers have run away, or the operator is not positive: a shorter step may cure it.
        deallocate (error)
        return
      end if
      new%motion%displacement = new%motion%displacement + correction
      call integrator%complete(step, old%motion, new%motion%displacement, new%motion%velocity, new%motion%acceleration)
      new%iterations = new%iterations + 1
    end do
    if (converged) call finish(model, integrator, old, step, coupling, energy, new)
  end subroutine attempt_step

  !> Turns the correction for the force assumed into one for the force that goes with it, and betters it by
  !> what earlier iterations showed.
  subroutine improve(model, integrator, operator, old, new, coupling, correction, error)
    !> The model
    type(model_t), intent(in) :: model
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> The factored operator, with its memory
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> The strike
    type(impact_coupling_t), intent(inout) :: coupling
    !> Correction of the displacement, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if numbers are not finite
    type(error_t), allocatable, intent(inout) :: error

    if (model%scene%has_impactor) call coupling%solve(model, integrator, operator, old, new, correction, error)
    call new%interfaces%faces%hold(model, correction)
    if (allocated(error)) return
    call operator%anderson%accelerate(model%communicator, operator%diagonal(:, :model%distribution%owned), correction, &
                             coupling%unknown)
    ! The law of the force is not linear: the force must be found for the displacement that it has become.
    if (model%scene%has_impactor .and. operator%anderson%kept > 0) then
      call coupling%solve(model, integrator, operator, old, new, correction, error)
      call new%interfaces%faces%hold(model, correction)
    end if
    call operator%anderson%note(correction)
  end subroutine improve

  !> Makes the operator follow ties and contacts, or renews it where that or its age asks for it.
  subroutine prepare_operator(model, adapt, integrator, operator, step, new, error)
    !> The model
    type(model_t), intent(in) :: model
    !> Rule for renewing the operator
    type(adapt_t), intent(in) :: adapt
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    !> Time step
    real(wp), intent(in) :: step
    !> State at the end
    type(state_t), intent(in) :: new
    !> Set if the solver fails
    type(error_t), allocatable, intent(inout) :: error
    logical :: follows

    follows = modulo(new%iterations + 1, adapt%iterations) > 0
    if (follows) call operator%follow(model, new%interfaces%faces, follows, error)
    if (follows .or. allocated(error)) return
    call operator%renew(model, new%interfaces%faces, new%motion%displacement, integrator%stiffness_factor(), &
                        integrator%mass_factor(step), error)
  end subroutine prepare_operator

  !> True if the solver failed; lack of convergence is dropped, since a shorter step may cure it.
  logical function unsolvable(error)
    !> Error of the solver
    type(error_t), allocatable, intent(inout) :: error

    unsolvable = allocated(error)
    if (.not. unsolvable) return
    if (error%code == exit_convergence) deallocate (error)
  end function unsolvable

  !> First guess: the velocity stays what it is, touching faces stay together, and held jumps stay where they are,
  !> also those glued in motion.
  subroutine predict_motion(model, integrator, old, step, new, guess)
    !> The model
    type(model_t), intent(in) :: model
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> State at the start
    type(state_t), intent(in) :: old
    !> Time step
    real(wp), intent(in) :: step
    !> State at the end
    type(state_t), intent(inout) :: new
    !> A better guess of the displacement, (5, points)
    real(wp), intent(in), optional :: guess(:, :)

    if (present(guess)) then
      new%motion%displacement = guess
    else
      new%motion%displacement = step*old%motion%velocity
      call new%interfaces%faces%hold(model, new%motion%displacement)
      new%motion%displacement = old%motion%displacement + new%motion%displacement
      call new%interfaces%faces%keep_touching(model, new%motion%displacement)
    end if
    call integrator%complete(step, old%motion, new%motion%displacement, new%motion%velocity, new%motion%acceleration)
    new%iterations = 0
    new%force_iterations = 0
    new%contact_iterations = 0
  end subroutine predict_motion

  !> Residual of the equation of motion (Eq. 1 with the exact internal force).
  subroutine find_residual(model, integrator, old, new, force, residual, energy)
    !> The model
    type(model_t), intent(in) :: model
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end; receives internal and inertia forces
    type(state_t), intent(inout) :: new
    !> Force of the impactor
    real(wp), intent(in) :: force
    !> Residual at the owned points, (5, points)
    real(wp), intent(inout) :: residual(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    real(wp) :: amplitude

    call model%internal(new%motion%displacement, new%motion%internal, energy)
    call model%inertia(new%motion%acceleration, new%motion%inertia)
    associate (m => integrator%alpha_m, f => integrator%alpha_f)
      residual = -(1 - m)*new%motion%inertia - m*old%motion%inertia - (1 - f)*new%motion%internal &
                 - f*old%motion%internal
      residual(3, :) = residual(3, :) + force/model%mesh%multiplicity*model%patch
      if (.not. allocated(model%pressure)) return
      amplitude = (1 - f)*model%scene%pressure%amplitude(new%time) + f*model%scene%pressure%amplitude(old%time)
      residual(3, :) = residual(3, :) + amplitude*model%pressure(3, :)
    end associate
  end subroutine find_residual

  !> Completes an accepted step: impactor, indentation and ledger.
  subroutine finish(model, integrator, old, step, coupling, energy, new)
    !> The model
    type(model_t), intent(in) :: model
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    !> State at the start
    type(state_t), intent(in) :: old
    !> Time step
    real(wp), intent(in) :: step
    !> The strike
    type(impact_coupling_t), intent(in) :: coupling
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: energy
    !> State at the end
    type(state_t), intent(inout) :: new

    new%step = old%step + 1
    new%all_iterations = old%all_iterations + new%iterations
    new%all_force_iterations = old%all_force_iterations + new%force_iterations
    new%all_contact_iterations = old%all_contact_iterations + new%contact_iterations
    new%deflection = model%deflection(new%motion%displacement)
    new%patch_mean = model%patch_mean(new%motion%displacement)
    if (model%scene%has_impactor) then
      new%impactor = advance(model%scene%impactor, old%impactor, step, coupling%unknown, coupling%force_end)
      new%force = coupling%force_end
      call commit_indentation(model%scene%indentation, new%indentation, new%impactor%displacement - new%patch_mean)
    end if
    call book_step(model, integrator, old, step, coupling%load(), energy, new)
  end subroutine finish
end module dynamic_steps
