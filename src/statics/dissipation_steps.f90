!> A load step controlled by the dissipated energy, theory (N6): the load factor is an unknown, and the energy that
!> damage dissipates in the step is prescribed. The equilibrium path is traced through softening and snap-back (M. A.
!> Gutierrez, Communications in Numerical Methods in Engineering 20 (2004) 19-29; C. V. Verhoosel, J. J. C. Remmers, M.
!> A. Gutierrez, International Journal for Numerical Methods in Engineering 77 (2009) 1290-1321).
!>
!> These papers derive the dissipated energy from loads and displacements, for geometrically linear problems that unload
!> to the origin. Here it is summed over the cohesive points, which includes contact and large deflections.
module dissipation_steps
  use kinds, only: wp
  use errors, only: error_t
  use composite_plates, only: composite_plate_t
  use newton_iterations, only: newton_iteration_t
  use static_steps, only: static_step_t, new_static_step
  use krylov_corrections, only: solve_load_tangent
  use slow_impactors, only: add_impactor_force, travel_for
  implicit none
  private
  public :: dissipation_step_t, new_dissipation_step

  !> A step that dissipates a prescribed energy.
  type, extends(static_step_t) :: dissipation_step_t
    !> Energy that the step is to dissipate
    real(wp) :: target_dissipation = 0
    !> Largest change of the load factor; a larger change may lead to another branch of equilibrium that is not
    !> connected with the present one
    real(wp) :: max_load_change = 0
  contains
    procedure :: begin
    procedure :: find_residual
    procedure :: residual_norm
    procedure :: complete_correction
  end type dissipation_step_t

contains

  !> Step to a time, with the energy to be dissipated.
  pure function new_dissipation_step(plate, time, target_dissipation, max_load_change) result(self)
    type(composite_plate_t), intent(in) :: plate
    !> Time at its end
    real(wp), intent(in) :: time
    !> Energy to dissipate, of the full plate
    real(wp), intent(in) :: target_dissipation
    !> Largest change of the load factor
    real(wp), intent(in) :: max_load_change
    type(dissipation_step_t) :: self

    self%static_step_t = new_static_step(plate, time, 0.0_wp)
    self%may_be_shortened = .true.
    self%target_dissipation = target_dissipation
    self%max_load_change = max_load_change
  end function new_dissipation_step

  !> Predictor: the last step, scaled by the ratio of the energies.
  subroutine begin(self, at)
    class(dissipation_step_t), intent(inout) :: self
    type(newton_iteration_t), intent(inout) :: at
    real(wp) :: part

    associate (old => at%old, new => at%new)
      part = min(1.0_wp, self%target_dissipation/old%path%dissipated)
      self%load_factor = old%load_factor + part*old%path%factor_change
      call self%static_step_t%begin(at)
      new%motion%displacement = old%motion%displacement + part*old%path%change
      new%impact%force = old%impact%force + part*old%path%force_change
    end associate
  end subroutine begin

  !> Load less internal forces, and the energy dissipated.
  subroutine find_residual(self, at)
    class(dissipation_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (model => at%model, old => at%old, new => at%new)
      call self%static_step_t%find_residual(at)
      new%path%dissipated = new%interfaces%cohesive%dissipation(model%plate, old%interfaces%cohesive)
    end associate
  end subroutine find_residual

  !> Residual relative to internal forces and load, or the error of the dissipated energy, scaled to the same tolerance.
  real(wp) function residual_norm(self, at)
    class(dissipation_step_t), intent(in) :: self
    type(newton_iteration_t), intent(inout) :: at

    associate (model => at%model, new => at%new)
      if (model%plate%setup%impactor%is_present) then
        ! The impactor's travel follows from its force.
        if (new%impact%force < 0) then
          residual_norm = huge(residual_norm)
          return
        end if
        new%load_factor = travel_for(model%plate, new)/model%plate%setup%impactor%travel
      end if
      residual_norm = self%static_step_t%residual_norm(at)
      residual_norm = max(residual_norm, &
                          abs(new%path%dissipated/self%target_dissipation - 1) &
                          /at%equilibrium%controls%dissipation_tolerance*at%equilibrium%tolerance)
    end associate
  end function residual_norm

  !> Adds the change of the load by which the step dissipates the prescribed energy.
  subroutine complete_correction(self, at, error)
    class(dissipation_step_t), intent(inout) :: self
    !> The iteration; receives the correction
    type(newton_iteration_t), intent(inout) :: at
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: loads(:, :), response(:, :), slopes(:, :)
    real(wp) :: sums(2), change, factor

    associate (model => at%model, operator => at%operator, old => at%old, new => at%new, &
               correction => at%correction)
      allocate (loads, response, slopes, mold=correction)
      response = 0
      slopes = 0
      loads = 0
      if (model%plate%setup%impactor%is_present) then
        call add_impactor_force(model%plate, new, 1.0_wp, loads)
      else
        call model%loads%load_slopes(loads)
      end if
      call solve_load_tangent(operator, model, new, loads, response, error)
      if (allocated(error)) return
      call new%interfaces%cohesive%add_dissipation_slopes(model%plate, old%interfaces%cohesive, &
                                                          new%motion%displacement, slopes)
      sums = [model%plate%product(slopes, correction), model%plate%product(slopes, response)]
      call model%plate%communicator%sum(sums)
      sums = sums*model%plate%mesh%multiplicity
      change = 0
      if (abs(sums(2)) > 0) change = (self%target_dissipation - new%path%dissipated - sums(1))/sums(2)
      if (model%plate%setup%impactor%is_present) then
        new%impact%force = new%impact%force + self%correction_factor(new%iterations%equilibrium)*change
      else
        ! Near a limit point a correction may be so large that the iteration diverges.
        factor = new%load_factor + self%correction_factor(new%iterations%equilibrium)*change
        factor = min(max(factor, old%load_factor - self%max_load_change), old%load_factor + self%max_load_change)
        change = (factor - new%load_factor)/self%correction_factor(new%iterations%equilibrium)
        new%load_factor = factor
      end if
      correction = self%correction_factor(new%iterations%equilibrium)*(correction + change*response)
    end associate
  end subroutine complete_correction
end module dissipation_steps
