!> A load step of a static analysis: full Newton iterations, within those of the augmented Lagrangian.
module static_steps
  use cohesive_sliding, only: heat_since
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use plate_options, only: kinematics_linear
  use delamination_parameters, only: contact_none, law_cohesive
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use newton_iterations, only: newton_iteration_t
  use states, only: state_t
  use step_problems, only: step_problem_t
  use residual_norms, only: relative_residual, sums_of_squares
  use slow_impactors, only: add_impactor_force, find_force_change, force_mismatch, move_slow_impactor
  use krylov_corrections, only: solve_load_tangent
  implicit none
  private
  public :: static_step_t, new_static_step

  !> A load step.
  type, extends(step_problem_t) :: static_step_t
    !> Time at the end of the step: the progress of the run
    real(wp) :: time = 0
    !> Load relative to the full load
    real(wp) :: load_factor = 0
  contains
    procedure :: begin
    procedure :: find_residual
    procedure :: residual_norm
    procedure :: may_stop
    procedure :: find_correction
    procedure :: complete_correction
    procedure :: correction_factor
    procedure :: complete
    procedure :: finish
  end type static_step_t

contains

  !> Step to a load.
  pure function new_static_step(plate, time, load_factor) result(self)
    type(composite_plate_t), intent(in) :: plate
    !> Time at the end of the step
    real(wp), intent(in) :: time
    !> Load relative to the full load
    real(wp), intent(in) :: load_factor
    type(static_step_t) :: self

    self%may_be_shortened = plate%setup%mesh%kinematics /= kinematics_linear .or. plate%setup%is_bimodular()
    self%time = time
    self%load_factor = load_factor
  end function new_static_step

  !> Predictor: the previous state.
  subroutine begin(self, at)
    class(static_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (new => at%new)
      new%time = self%time
      new%load_factor = self%load_factor
    end associate
  end subroutine begin

  !> Load less internal forces.
  subroutine find_residual(self, at)
    class(static_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (model => at%model, old => at%old, new => at%new, residual => at%residual)
      call new%find_internal(model, old, at%energy)
      call model%loads%static_loads(new%motion%displacement, new%load_factor, residual)
      call add_impactor_force(model%plate, new, new%impact%force, residual)
      residual = residual - new%motion%internal
    end associate
  end subroutine find_residual

  !> Residual relative to internal forces and load.
  real(wp) function residual_norm(self, at)
    class(static_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp), allocatable :: loads(:, :)
    real(wp) :: references(2, 2)

    associate (model => at%model, operator => at%operator, new => at%new)
      allocate (loads, mold=at%residual)
      call model%loads%static_loads(new%motion%displacement, new%load_factor, loads)
      call add_impactor_force(model%plate, new, new%impact%force, loads)
      references(:, 1) = sums_of_squares(operator%numbering, new%motion%internal)
      references(:, 2) = sums_of_squares(operator%numbering, loads)
      ! A second iteration removes the round-off of the first, so it is required.
      residual_norm = relative_residual(model%plate, operator, at%equilibrium, at%residual, references, &
                                        new%motion%displacement, new%iterations%equilibrium > 1, new%largest_forces)
      if (model%plate%setup%impactor%is_present) residual_norm = max(residual_norm, force_mismatch(model%plate, new))
    end associate
  end function residual_norm

  !> A change of multipliers may be below the tolerance of the residual; it needs a correction nevertheless.
  pure logical function may_stop(self, at)
    class(static_step_t), intent(in) :: self
    type(newton_iteration_t), intent(in) :: at

    may_stop = .not. at%multipliers_changed
  end function may_stop

  !> Solves for a correction, with a new factorization if the tangent may have changed.
  subroutine find_correction(self, at, tolerance, error)
    class(static_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp), intent(in) :: tolerance
    type(error_t), allocatable, intent(inout) :: error

    at%negative_curvature = .false.
    associate (model => at%model, operator => at%operator, new => at%new)
      if (.not. operator%ready .or. tangent_changes(model, new%iterations%equilibrium)) &
        call operator%renew(model, new, 1.0_wp, 0.0_wp, error)
      if (.not. allocated(error)) &
        call solve_load_tangent(operator, model, new, at%residual, at%correction, error)
      if (.not. allocated(error)) call self%complete_correction(at, error)
      if (.not. allocated(error)) call new%interfaces%contact%constrain_correction(model%plate, at%correction)
    end associate
  end subroutine find_correction

  !> Adds the response to the change of the impactor's force, and scales the correction.
  subroutine complete_correction(self, at, error)
    class(static_step_t), intent(inout) :: self
    !> The iteration; receives the correction
    type(newton_iteration_t), intent(inout) :: at
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error

    associate (model => at%model, operator => at%operator, new => at%new, correction => at%correction)
      if (model%plate%setup%impactor%is_present) &
        call find_force_change(model, operator, self%correction_factor(new%iterations%equilibrium), new, correction, &
                               error)
      if (allocated(error)) error%code = exit_convergence
      correction = self%correction_factor(new%iterations%equilibrium)*correction
    end associate
  end subroutine complete_correction

  !> True if the tangent may differ from that of the previous iteration.
  pure logical function tangent_changes(model, iterations)
    type(model_t), intent(in) :: model
    !> Iterations of this step so far
    integer, intent(in) :: iterations

    tangent_changes = model%plate%setup%mesh%kinematics /= kinematics_linear .or. model%rig%unilateral
    if (model%plate%map%layered) tangent_changes = tangent_changes &
                                                   .or. any(model%plate%setup%delaminations%law == law_cohesive)
    ! Plies may have failed since the step before; later only contacts change.
    if (.not. tangent_changes) tangent_changes = iterations == 0 .and. (model%plate%setup%ply_damage%is_present &
                                                                        .or. model%plate%map%layered)
    tangent_changes = tangent_changes .or. model%plate%setup%has_crack_bands() .or. model%plate%setup%is_bimodular()
    if (tangent_changes .or. .not. model%plate%map%layered) return
    tangent_changes = any(model%plate%setup%delaminations%contact /= contact_none)
  end function tangent_changes

  !> Factor of a correction. Newton iterations may alternate between two sets of points whose damage grows. Once there
  !> have been more corrections than convergence usually takes, every other one is halved, which ends the alternation.
  elemental real(wp) function correction_factor(self, iterations) result(part)
    class(static_step_t), intent(in) :: self
    !> Iterations of the step so far
    integer, intent(in) :: iterations

    part = 1
    if (iterations >= self%controls%alternating_iterations .and. modulo(iterations, 2) == 0) part = 0.5_wp
  end function correction_factor

  !> Load steps have no velocity to be completed.
  subroutine complete(self, at)
    class(static_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
  end subroutine complete

  !> Completes an accepted load step.
  subroutine finish(self, at)
    class(static_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp) :: sums(6), contact, fracture, heat, damage, excess
    real(wp), allocatable :: change(:, :), loads(:, :), loads_before(:, :)

    associate (model => at%model, old => at%old, new => at%new)
      allocate (loads, loads_before, mold=old%motion%internal)
      call model%loads%static_loads(new%motion%displacement, new%load_factor, loads)
      call loads_carried(model, old, loads_before)
      change = new%motion%displacement - old%motion%displacement
      sums(1) = at%energy
      sums(2) = model%plate%product(change, new%motion%internal + old%motion%internal)/2
      sums(3) = model%plate%product(change, loads + loads_before)/2
      sums(4:5) = 0
      if (model%has_point_stiffness) then
        contact = old%interfaces%contact_work(model, old%motion%displacement, change)
        sums(4) = (contact + new%interfaces%contact_work(model, new%motion%displacement, change))/2
        sums(5) = contact/2
      end if
      sums(6) = model%plate%product(change, loads - loads_before)/2
      ! After failures of plies or a change of the contact area the previous state is not in equilibrium; the energy
      ! released would become kinetic energy.
      call add_impactor_force(model%plate, old, old%impact%force, loads_before)
      sums(5) = sums(5) + model%plate%product(change, loads_before - old%motion%internal)/2
      if (.not. (model%plate%setup%ply_damage%is_present .or. allocated(model%nose))) sums(5) = 0
      call model%plate%communicator%sum(sums)
      sums = sums*model%plate%mesh%multiplicity
      call new%count_step(old)
      new%impact%deflection = model%plate%deflection(new%motion%displacement)
      new%impact%patch_mean = new%contact_deflection(model%plate)
      new%ledger%strain = sums(1)
      new%ledger%external_work = old%ledger%external_work + sums(3)
      new%ledger%contact = old%ledger%contact - sums(4)
      fracture = new%interfaces%cohesive%dissipation(model%plate, old%interfaces%cohesive)
      heat = heat_since(model%plate, old%interfaces%cohesive, new%interfaces%cohesive)
      new%ledger%friction = old%ledger%friction + heat
      if (model%plate%setup%impactor%is_present) call move_slow_impactor(model%plate, old, new)
      sums(6) = sums(6) + (new%impact%force - old%impact%force)*(new%impact%patch_mean - old%impact%patch_mean)/2
      call new%plies%record(model%plate, damage)
      new%ledger%ply_damage = old%ledger%ply_damage + damage
      new%ledger%delamination = old%ledger%delamination + fracture
      excess = sums(1) - old%ledger%strain - sums(2)
      ! Without dissipation the strain energy is the work of the loads along the equilibrium path, theory (E3), which
      ! the trapezoidal rule over a step approximates. For a monotonic load the work lies between the products of
      ! displacement increment and load before and after the step. Outside these bounds the plate has jumped to another
      ! equilibrium, and the energy that would become kinetic is recorded as dissipated by the load step.
      if (.not. allocated(model%nose) .and. fracture + heat + new%ledger%ply_damage <= 0 &
          .and. .not. abs(excess) > abs(sums(6))) then
        new%ledger%external_work = new%ledger%external_work + excess
        excess = 0
      end if
      new%ledger%algorithmic = old%ledger%algorithmic - excess + sums(5) - fracture - heat - damage
      call new%ledger%note_largest()
    end associate
  end subroutine finish

  !> Loads of an accepted state without the impactor's force. Before the first step only prescribed lines act.
  subroutine loads_carried(model, state, loads)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: state
    !> Forces on the unknowns, (5, points)
    real(wp), intent(inout) :: loads(:, :)

    if (state%step > 0) then
      call model%loads%static_loads(state%motion%displacement, state%load_factor, loads)
    else
      loads = 0
      call model%loads%add_holding_lines(state%motion%displacement, loads)
    end if
  end subroutine loads_carried
end module static_steps
