!> Corrections within a step in time where cohesive laws hold faces: impact force and softening points together.
module condensed_steps
  use condensed_corrections, only: condensed_correction_t, new_condensed_correction
  use errors, only: error_t
  use impact_coupling, only: impact_coupling_t
  use impact_parameters, only: indentation_law_t
  use tan_sun_indentation, only: indentation_t
  use kinds, only: wp
  use models, only: model_t
  use outside_forces, only: outside_force_t
  use softening_corrections, only: softening_memory_t
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: condense

  !> Times that points join the unknowns of one correction: fronts pass over a few rings of points in a step.
  integer, parameter :: most_rounds = 10
  !> Change of a motion over itself at which the slope of a force is taken.
  real(wp), parameter :: nudge = 1.0e-6_wp

  !> The impactor's force as the plate's motion sees it.
  type, extends(outside_force_t) :: impactor_force_t
    !> The impactor's side of the step
    type(impact_coupling_t) :: coupling
    !> Indentation law
    type(indentation_law_t) :: law
    !> Memory of the indentation at the start of the step
    type(indentation_t) :: indentation
    !> Mean deflection of the patch before the correction, and per motion
    real(wp) :: patch_mean = 0, parts = 1
    !> Force on the plate that the residual holds
    real(wp) :: before = 0
    !> Iterations taken
    integer :: iterations = 0
    !> Set if numbers are not finite
    type(error_t), allocatable :: error
  contains
    procedure :: at
  end type impactor_force_t

contains

  !> The force at a motion of the plate.
  subroutine at(self, motion, force, slope)
    !> The force
    class(impactor_force_t), intent(inout) :: self
    !> Change of the patch's mean deflection over the parts of the plate
    real(wp), intent(in) :: motion
    !> Change of the force, and its slope
    real(wp), intent(out) :: force, slope
    type(impact_coupling_t) :: aside
    real(wp) :: mean, step
    integer :: iterations

    mean = self%patch_mean + self%parts*motion
    call self%coupling%find_force(self%law, self%indentation, mean, 0.0_wp, iterations, self%error)
    self%iterations = self%iterations + iterations
    force = self%coupling%load() - self%before
    aside = self%coupling
    step = nudge*max(abs(self%coupling%free_displacement - mean), abs(self%parts*motion))
    call aside%find_force(self%law, self%indentation, mean + step, 0.0_wp, iterations, self%error)
    slope = 0
    if (step > 0) slope = min(0.0_wp, self%parts*(aside%load() - self%coupling%load())/step)
  end subroutine at

  !> Betters the operator's answer to a residual: the impact force that goes with it, and cohesive points in
  !> equilibrium.
  subroutine condense(memory, may_burst, coupling, model, operator, old, new, residual, correction, error)
    !> What earlier corrections of the step have found about crowds of points
    type(softening_memory_t), intent(inout) :: memory
    !> False: a burst is only told of, by the memory
    logical, intent(in) :: may_burst
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    type(model_t), intent(in) :: model
    !> The factored operator; receives answers to unit forces that it lacks
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> The residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails or numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    type(condensed_correction_t) :: condensed
    type(impact_coupling_t) :: before
    real(wp), allocatable :: guess(:)
    real(wp), allocatable :: answer(:, :)
    integer, allocatable :: equations(:)
    logical :: crowded
    integer :: round

    answer = correction
    before = coupling
    crowded = memory%crowded
    allocate (guess(0))
    do round = 1, most_rounds
      if (crowded) exit
      call operator%timers%start('condensation')
      coupling = before
      correction = answer
      call new_condensed_correction(operator, model, old%interfaces%cohesive, new%motion%displacement, answer, guess, &
                                    condensed)
      call solve_together(condensed, coupling, model, operator, old, new, correction, error)
      memory%bursts = memory%bursts .or. condensed%system%snaps
      if (memory%bursts .and. .not. may_burst) then
        call operator%timers%stop('condensation')
        return
      end if
      call condensed%wanting(operator, model, old%interfaces%cohesive, new%motion%displacement, correction, equations, &
                             crowded)
      call operator%timers%stop('condensation')
      if (size(equations) == 0 .or. crowded .or. allocated(error)) exit
      if (condensed%columns > 0) guess = condensed%change(:condensed%columns)
      call operator%find_columns(model, equations, error)
      if (allocated(error)) return
    end do
    if (.not. crowded .or. allocated(error)) return
    coupling = before
    correction = answer
    memory%crowded = .true.
    call soften(memory, coupling, model, operator, old, new, residual, correction, error)
  end subroutine condense

  !> The same where many points soften at once.
  subroutine soften(memory, coupling, model, operator, old, new, residual, correction, error)
    !> What earlier corrections of the step have found
    type(softening_memory_t), intent(inout) :: memory
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    type(model_t), intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> The residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails or numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    class(outside_force_t), allocatable :: outside

    call follow_impactor(coupling, model, old, new, outside)
    call memory%correct(operator, model, old%interfaces%cohesive, new%motion%displacement, outside, residual, &
                        correction, error)
    call take_force(outside, coupling, new, error)
  end subroutine soften

  !> The impactor's force as it follows the plate; none without an impactor.
  subroutine follow_impactor(coupling, model, old, new, outside)
    !> The impactor's side of the step
    type(impact_coupling_t), intent(in) :: coupling
    type(model_t), intent(in) :: model
    !> State at the start, and at the end before the correction
    type(state_t), intent(in) :: old, new
    !> The force; unallocated: there is no impactor
    class(outside_force_t), allocatable, intent(out) :: outside

    if (.not. model%scene%has_impactor) return
    allocate (outside, source=impactor_force_t(coupling=coupling, law=model%scene%indentation, &
                                               indentation=old%indentation, before=coupling%load(), &
                                               patch_mean=model%contact_deflection(new%motion%displacement), &
                                               parts=real(model%mesh%multiplicity, wp)))
  end subroutine follow_impactor

  !> Takes over the force found.
  subroutine take_force(outside, coupling, new, error)
    !> The force; unallocated: there is no impactor
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    !> State at the end, which counts iterations
    type(state_t), intent(inout) :: new
    !> Set if numbers were not finite
    type(error_t), allocatable, intent(inout) :: error

    if (.not. allocated(outside)) return
    select type (outside)
    type is (impactor_force_t)
      coupling = outside%coupling
      new%force_iterations = new%force_iterations + outside%iterations
      if (allocated(outside%error) .and. .not. allocated(error)) call move_alloc(outside%error, error)
    end select
  end subroutine take_force

  !> Finds force and points together.
  subroutine solve_together(condensed, coupling, model, operator, old, new, correction, error)
    !> The points
    type(condensed_correction_t), intent(inout) :: condensed
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    type(model_t), intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    class(outside_force_t), allocatable :: outside

    if (condensed%columns == 0) then
      if (model%scene%has_impactor) call coupling%solve(model, operator, old, new, correction, error)
      return
    end if
    call follow_impactor(coupling, model, old, new, outside)
    call condensed%solve(outside)
    call condensed%field(operator, correction)
    call take_force(outside, coupling, new, error)
  end subroutine solve_together
end module condensed_steps
