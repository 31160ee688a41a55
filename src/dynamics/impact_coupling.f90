!> Coupling of the impactor to the plate in a step, theory (F2) and (F14).
module impact_coupling
  use kinds, only: wp
  use errors, only: error_t
  use impact_force, only: contact_step_t, solve_impact_force
  use impact_parameters, only: indentation_law_t
  use tan_sun_indentation, only: indentation_t
  use impactor_integrators, only: predict, takes_mean_force
  use newmark_integrators, only: plate_integrator_t
  use composite_plates, only: composite_plate_t
  use newton_iterations, only: newton_iteration_t
  use states, only: state_t
  implicit none
  private
  public :: impact_coupling_t, begin_coupling

  !> The motion of the impactor and the indentation are affine in one unknown force.
  type :: impact_coupling_t
    !> Displacement of the impactor at the end of the step without force, and its decrease per unit of force
    real(wp) :: free_displacement = 0, compliance = 0
    !> True: the unknown is the mean force over the step; false: the force at its end
    logical :: mean = .false.
    !> The unknown force, and the force at the end of the step
    real(wp) :: unknown = 0, force_end = 0
    !> Weight of the unknown in the plate's load, and the part of the load that does not depend on it
    real(wp) :: share = 0, inherited = 0
    !> Force at the start of the step, and alpha_f of the equation of motion
    real(wp) :: start_force = 0, alpha_f = 0
  contains
    procedure :: load
    procedure :: forces_agree
    procedure :: solve
    procedure :: find_force
    procedure :: slope
  end type impact_coupling_t

  !> Increment of the deflection, relative to the indentation, for the derivative of the force. Its truncation error is
  !> then 1e-6 and its round-off 1e-10, which is sufficient for a tangent.
  real(wp), parameter :: deflection_increment = 1.0e-6_wp

contains

  !> Coupling in a step.
  pure function begin_coupling(plate, integrator, old, step) result(coupling)
    type(composite_plate_t), intent(in) :: plate
    type(plate_integrator_t), intent(in) :: integrator
    type(state_t), intent(in) :: old
    real(wp), intent(in) :: step
    type(impact_coupling_t) :: coupling

    call predict(plate%setup%impactor, old%impact%impactor, step, coupling%free_displacement, coupling%compliance)
    coupling%mean = takes_mean_force(plate%setup%impactor)
    coupling%unknown = old%impact%force
    coupling%force_end = old%impact%force
    coupling%start_force = old%impact%force
    coupling%alpha_f = integrator%alpha_f
    coupling%share = 1
    if (coupling%mean) return
    coupling%share = 1 - integrator%alpha_f
    coupling%inherited = integrator%alpha_f*old%impact%force
  end function begin_coupling

  !> Force on the plate in its equation of motion.
  pure real(wp) function load(self)
    class(impact_coupling_t), intent(in) :: self

    load = self%share*self%unknown + self%inherited
  end function load

  !> True: the load on the plate is the unknown force, so that one solution is sufficient. The mean force over a step is
  !> the plate's load only for alpha_f = 1/2.
  pure logical function forces_agree(self)
    class(impact_coupling_t), intent(in) :: self

    forces_agree = .not. self%mean .or. abs(self%alpha_f - 0.5_wp) <= 0
  end function forces_agree

  !> Solves for the contact force, given the correction of the plate for the force assumed. Where the tangent is the
  !> factored operator, the plate's response to the change of the force is known and added. Otherwise the correction
  !> includes the slope of the force, and the remaining difference to the indentation law is part of the next residual:
  !> the response of the factored operator would open contacts that have closed since the factorization.
  subroutine solve(self, at, is_factored, error)
    class(impact_coupling_t), intent(inout) :: self
    !> The iteration; receives the correction
    type(newton_iteration_t), intent(inout) :: at
    !> True: the tangent is the factored operator
    logical, intent(in) :: is_factored
    !> Set if numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: before
    integer :: iterations

    associate (model => at%model, operator => at%operator, new => at%new)
      before = self%unknown
      new%impact%patch_mean = new%contact_deflection(model%plate) + &
                              new%impact%patch%mean(model%plate%communicator, at%correction)
      call self%find_force(model%plate%setup%impactor%indentation, at%old%impact%indentation, new%impact%patch_mean, &
                           merge(operator%compliance, 0.0_wp, is_factored), iterations, error)
      if (is_factored) at%correction = at%correction + (self%share*(self%unknown - before))*operator%response
      new%iterations%force = new%iterations%force + iterations
    end associate
  end subroutine solve

  !> Decrease of the load with the deflection of the plate, including the motion of the impactor under that load.
  real(wp) function slope(self, law, indentation, patch_mean)
    class(impact_coupling_t), intent(in) :: self
    type(indentation_law_t), intent(in) :: law
    !> History variables of the indentation at the start of the step
    type(indentation_t), intent(in) :: indentation
    !> Mean deflection of the patch
    real(wp), intent(in) :: patch_mean
    type(impact_coupling_t) :: here, beyond
    type(error_t), allocatable :: error
    real(wp) :: step
    integer :: iterations

    slope = 0
    step = deflection_increment*abs(self%free_displacement - patch_mean)
    if (.not. step > 0) return
    here = self
    beyond = self
    call here%find_force(law, indentation, patch_mean, 0.0_wp, iterations, error)
    call beyond%find_force(law, indentation, patch_mean + step, 0.0_wp, iterations, error)
    if (.not. allocated(error)) slope = max(0.0_wp, (here%load() - beyond%load())/step)
  end function slope

  !> Finds the contact force for a mean deflection of the patch and the compliance of the patch.
  subroutine find_force(self, law, indentation, patch_mean, patch_compliance, iterations, error)
    class(impact_coupling_t), intent(inout) :: self
    type(indentation_law_t), intent(in) :: law
    !> History variables of the indentation at the start of the step
    type(indentation_t), intent(in) :: indentation
    !> Mean deflection of the patch with the previous force
    real(wp), intent(in) :: patch_mean
    !> Mean deflection of the patch per force on the plate
    real(wp), intent(in) :: patch_compliance
    !> Iterations taken
    integer, intent(out) :: iterations
    !> Set if numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    type(contact_step_t) :: step
    real(wp) :: alpha_end, compliance

    compliance = self%share*patch_compliance
    step = contact_step_t(law, indentation, start=indentation%alpha, &
                          free=self%free_displacement - patch_mean + self%unknown*compliance, &
                          compliance=self%compliance + compliance, is_mean=self%mean)
    call solve_impact_force(step, self%unknown, alpha_end, self%force_end, iterations, error)
    ! The equation of motion requires the force at 1 - alpha_f of the step, which is the mean force for alpha_f = 1/2
    ! only.
    if (self%mean) self%inherited = (0.5_wp - self%alpha_f)*(self%force_end - self%start_force)
  end subroutine find_force
end module impact_coupling
