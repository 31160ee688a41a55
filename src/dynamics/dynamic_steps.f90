!> One time step of plate and impactor together, theory (T1), (T2) and (F14). Each equilibrium iteration solves for the
!> contact force by the compliance of impactor and plate.
module dynamic_steps
  use kinds, only: wp
  use errors, only: error_t, exit_convergence
  use impactor_integrators, only: advance
  use tan_sun_indentation, only: commit_indentation
  use newmark_integrators, only: plate_integrator_t
  use models, only: model_t
  use newton_iterations, only: newton_iteration_t
  use states, only: state_t
  use step_problems, only: step_problem_t
  use impact_coupling, only: impact_coupling_t, begin_coupling
  use residual_norms, only: relative_residual, sums_of_squares
  use dynamic_tangents, only: find_tangent, add_force_slope, is_exact
  use krylov_corrections, only: find_krylov_correction
  use tangent_products, only: tangent_product_t
  use energy_balance, only: record_step
  use line_motions, only: has_moved_lines, prescribe_lines, move_lines, line_displacement
  use motion_forces, only: weight_forces, weight_start_forces, find_internal_forces
  implicit none
  private
  public :: dynamic_step_t

  !> Interval of steps at which internal forces are computed from the displacement, so that round-off does not
  !> accumulate.
  integer, parameter :: between_checks = 16

  !> A step in time.
  type, extends(step_problem_t) :: dynamic_step_t
    !> Time step
    real(wp) :: step = 0
    !> Number of changed ties and contacts at which the operator is factorized again
    integer :: renewal = huge(1)
    !> True: factorized again before the next correction, as the step control requires or as the last correction took as
    !> many solves as a factorization costs
    logical :: factor_is_due = .false.
    type(plate_integrator_t) :: integrator
    !> Predictor of the displacement, (5, points); unallocated: constant velocity
    real(wp), allocatable :: guess(:, :)
    !> keeps_displacement: the predictor is the initial displacement, so that internal forces are known; keeps_velocity:
    !> it has the initial velocity, so that inertia forces are known
    logical :: keeps_displacement = .false., keeps_velocity = .false.
    !> True: internal forces follow from the equation of motion, as one correction solves the step
    logical :: skips_elements = .false.
    !> Sum of the squared patch weights of this rank's points
    real(wp) :: patch_square = 0
    !> Coupling to the impactor
    type(impact_coupling_t) :: coupling
  contains
    procedure :: begin
    procedure :: find_residual
    procedure :: residual_norm
    procedure :: may_stop
    procedure :: find_correction
    procedure :: find_force
    procedure :: complete
    procedure :: finish
  end type dynamic_step_t

contains

  !> Predictor. If the operator is exact the predictor keeps the displacement, which saves element loops. Otherwise it
  !> keeps the velocity: an acceleration would add energy where contact is stiff. Closed contacts stay closed; tied
  !> jumps keep their values.
  subroutine begin(self, at)
    class(dynamic_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (model => at%model, operator => at%operator, old => at%old, new => at%new)
      new%time = old%time + self%step
      new%load_factor = new%time/model%plate%setup%loading%ramp_time
      call new%interfaces%ties%ramp_down(model%plate, self%step)
      self%patch_square = sum((new%impact%patch%weights(new%impact%patch%points)/model%plate%mesh%multiplicity)**2)
      if (model%plate%setup%impactor%is_present) &
        self%coupling = begin_coupling(model%plate, self%integrator, old, self%step)
      self%keeps_velocity = model%plate%setup%impactor%is_present .and. &
                            .not. (allocated(self%guess) .or. model%has_point_stiffness)
      self%keeps_displacement = self%keeps_velocity &
        .and. is_exact(model%plate, operator, self%integrator%mass_factor(self%step))
      self%skips_elements = self%keeps_displacement .and. modulo(old%step + 1, between_checks) > 0 &
        .and. .not. (model%plate%map%layered .or. operator%numbering%has_dependent_points .or. &
        allocated(model%rig%constrained_by) .or. allocated(model%loads%pressure) .or. size(model%loads%lines) > 0)
      if (self%skips_elements) self%skips_elements = self%coupling%forces_agree()
      call predict(self, model, old, new)
      if (.not. self%keeps_velocity) call self%complete(at)
      self%uses_element_tangents = .false.
      self%uses_line_search = allocated(new%interfaces%cohesive%cohesive)
      if (.not. self%keeps_displacement) call self%find_force(at)
    end associate
  end subroutine begin

  !> Predictor of the displacement.
  subroutine predict(self, model, old, new)
    class(dynamic_step_t), intent(in) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: old
    type(state_t), intent(inout) :: new

    if (allocated(self%guess)) then
      new%motion%displacement = self%guess
    else if (.not. self%keeps_displacement) then
      new%motion%displacement = self%step*old%motion%velocity
      call new%interfaces%contact%constrain_correction(model%plate, new%motion%displacement)
      new%motion%displacement = old%motion%displacement + new%motion%displacement
      call new%interfaces%keep_contact_closed(model, new%motion%displacement)
      if (has_moved_lines(model)) &
        call prescribe_lines(model, new%interfaces, new%time, line_displacement, new%motion%displacement)
    end if
  end subroutine predict

  !> Residual of the equation of motion (Eq. 1 with the exact internal force).
  subroutine find_residual(self, at)
    class(dynamic_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp), allocatable :: lines(:, :), lines_before(:, :)
    real(wp) :: amplitude

    associate (model => at%model, old => at%old, new => at%new, residual => at%residual)
      associate (m => self%integrator%alpha_m, f => self%integrator%alpha_f)
        if (self%keeps_displacement .and. new%iterations%equilibrium == 0) then
          at%energy = 0
          call weight_start_forces(size(residual), [(1 - m)/(self%integrator%beta*self%step), &
                                                      (1 - m)*0.5_wp/self%integrator%beta - 1], old%motion%momentum, &
                                   old%motion%inertia, old%motion%internal, residual)
        else if (self%skips_elements .and. new%iterations%equilibrium == 1) then
          call find_internal_from_motion(self, model, old, new, at%energy)
          residual = 0
          return
        else
          call new%find_internal(model, old, at%energy)
          if (self%keeps_velocity .and. new%iterations%equilibrium == 0) then
            ! Newmark's acceleration if the velocity at the end is that at the start.
            new%motion%inertia = (1 - 0.5_wp/self%integrator%beta)*old%motion%inertia
          else
            call model%inertia(new%motion%acceleration, new%motion%inertia)
          end if
          call weight_forces(size(residual), [1 - m, m, 1 - f, f], new%motion%inertia, old%motion%inertia, &
                             new%motion%internal, old%motion%internal, residual)
        end if
        call new%impact%patch%add_force(self%coupling%load()/model%plate%mesh%multiplicity, residual)
        if (size(model%loads%lines) > 0) then
          allocate (lines, lines_before, mold=residual)
          call model%loads%line_forces(new%motion%displacement, new%load_factor, lines, prescribed=.false.)
          call model%loads%line_forces(old%motion%displacement, old%load_factor, lines_before, prescribed=.false.)
          residual = residual + (1 - f)*lines + f*lines_before
          ! Prescribed lines act with a constant force over the step.
          call model%loads%line_forces(new%motion%displacement, new%load_factor, lines, prescribed=.true.)
          residual = residual + lines
        end if
        if (.not. allocated(model%loads%pressure)) return
        amplitude = (1 - f)*model%plate%setup%pressure%amplitude(new%time) + &
                    f*model%plate%setup%pressure%amplitude(old%time)
        residual(3, :) = residual(3, :) + amplitude*model%loads%pressure(3, :)
      end associate
    end associate
  end subroutine find_residual

  !> Internal forces from the equation of motion, after a correction that solves it to round-off: saves an element loop.
  subroutine find_internal_from_motion(self, model, old, new, energy)
    class(dynamic_step_t), intent(in) :: self
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: old
    !> State at the end; receives internal and inertia forces
    type(state_t), intent(inout) :: new
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy

    call model%inertia(new%motion%acceleration, new%motion%inertia)
    associate (m => self%integrator%alpha_m, f => self%integrator%alpha_f)
      new%motion%internal = 0
      call new%impact%patch%add_force(self%coupling%load()/model%plate%mesh%multiplicity, new%motion%internal)
      call find_internal_forces(size(new%motion%internal), [1 - m, m, 1 - f, f], new%motion%inertia, &
                                old%motion%inertia, old%motion%internal, new%motion%internal)
    end associate
    energy = model%plate%product(new%motion%displacement, new%motion%internal)/2
    if (.not. model%plate%setup%thermal%is_present) return
    ! Residual stresses store energy that is not the work of these forces: their work is added to the energy at the
    ! start. Done for all decks this would make linear steps 6 % slower.
    energy = model%plate%product(new%motion%displacement - old%motion%displacement, &
                           new%motion%internal + old%motion%internal)/2
    if (model%plate%communicator%is_root()) energy = energy + old%ledger%strain/model%plate%mesh%multiplicity
  end subroutine find_internal_from_motion

  !> Residual relative to internal, inertia and contact forces.
  real(wp) function residual_norm(self, at)
    class(dynamic_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp) :: references(2, 3)

    associate (model => at%model, operator => at%operator, new => at%new)
      if (self%keeps_displacement .and. new%iterations%equilibrium == 0) then
        ! At least one iteration is needed.
        residual_norm = huge(residual_norm)
        return
      else if (self%skips_elements .and. new%iterations%equilibrium == 1) then
        residual_norm = 0
        return
      end if
      references(:, 1) = sums_of_squares(operator%numbering, new%motion%internal)
      references(:, 2) = sums_of_squares(operator%numbering, new%motion%inertia)
      references(:, 3) = [self%patch_square*self%coupling%load()**2, 0.0_wp]
      residual_norm = relative_residual(model%plate, operator, at%equilibrium, at%residual, references, &
                                        new%motion%displacement, self%may_stop(at), new%largest_forces)
    end associate
  end function residual_norm

  !> The impactor's force is updated only within an iteration, so an impact needs at least one.
  pure logical function may_stop(self, at)
    class(dynamic_step_t), intent(in) :: self
    type(newton_iteration_t), intent(in) :: at

    may_stop = at%new%iterations%equilibrium > 0 .or. .not. at%model%plate%setup%impactor%is_present
  end function may_stop

  !> Solves for a correction by the tangent, and for the impactor's force.
  subroutine find_correction(self, at, tolerance, error)
    class(dynamic_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp), intent(in) :: tolerance
    type(error_t), allocatable, intent(inout) :: error
    type(tangent_product_t) :: tangent
    logical :: converged

    at%negative_curvature = .false.
    associate (integrator => self%integrator, has_impactor => at%model%plate%setup%impactor%is_present)
      call find_tangent(at, [integrator%stiffness_factor(), integrator%mass_factor(self%step)], &
                        self%factor_is_due, self%renewal, self%uses_element_tangents, tangent, error)
      if (allocated(error)) return
      if (has_impactor .and. .not. tangent%is_factored()) call add_force_slope(at, self%coupling, tangent)
      call find_krylov_correction(tangent, at%residual, tolerance, at%correction, error, at%negative_curvature, &
                                  converged)
      if (allocated(error)) return
      self%factor_is_due = .not. converged
      if (has_impactor) call self%coupling%solve(at, tangent%is_factored(), error)
      if (allocated(error)) error%code = exit_convergence
      call at%new%interfaces%contact%constrain_correction(at%model%plate, at%correction)
    end associate
  end subroutine find_correction

  !> Finds the impactor's force for a displacement.
  subroutine find_force(self, at)
    class(dynamic_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at
    type(error_t), allocatable :: error
    integer :: iterations

    associate (model => at%model, old => at%old, new => at%new)
      if (.not. model%plate%setup%impactor%is_present) return
      new%impact%patch_mean = new%contact_deflection(model%plate)
      call self%coupling%find_force(model%plate%setup%impactor%indentation, old%impact%indentation, &
                                    new%impact%patch_mean, 0.0_wp, iterations, error)
      new%iterations%force = new%iterations%force + iterations
    end associate
  end subroutine find_force

  !> Velocity and acceleration at the end of the step.
  subroutine complete(self, at)
    class(dynamic_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (old => at%old, new => at%new)
      call self%integrator%complete(self%step, old%motion, new%motion%displacement, new%motion%velocity, &
                                    new%motion%acceleration)
    end associate
  end subroutine complete

  !> Completes an accepted step: impactor, indentation and ledger.
  subroutine finish(self, at)
    class(dynamic_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp) :: work

    associate (model => at%model, old => at%old, new => at%new)
      call new%count_step(old)
      new%impact%deflection = model%plate%deflection(new%motion%displacement)
      new%impact%patch_mean = new%contact_deflection(model%plate)
      if (model%plate%setup%impactor%is_present) then
        new%impact%impactor = advance(model%plate%setup%impactor, old%impact%impactor, self%step, &
                                      self%coupling%unknown, self%coupling%force_end)
        new%impact%force = self%coupling%force_end
        call commit_indentation(model%plate%setup%impactor%indentation, new%impact%indentation, &
                                new%impact%impactor%displacement - new%impact%patch_mean)
      end if
      call model%plate%profile%enter('energy ledger')
      call record_step(model, self%integrator, old, self%step, self%coupling%load(), at%energy, new)
      call model%plate%profile%leave()
      if (.not. has_moved_lines(model)) return
      call move_lines(model, new%interfaces, new%time, new%motion, work)
      new%ledger%kinetic = new%ledger%kinetic + work
      new%ledger%external_work = new%ledger%external_work + work
    end associate
  end subroutine finish
end module dynamic_steps
