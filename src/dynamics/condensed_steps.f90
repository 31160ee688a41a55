!> Corrections within a step in time where cohesive laws hold faces: impact force and softening points together.
module condensed_steps
  use condensed_corrections, only: condensed_correction_t, new_condensed_correction
  use errors, only: error_t
  use impact_coupling, only: impact_coupling_t
  use kinds, only: wp
  use models, only: model_t
  use newmark_integrators, only: plate_integrator_t
  use states, only: state_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: condense

  !> Times that points join the unknowns of one correction: fronts pass over a few rings of points in a step.
  integer, parameter :: most_rounds = 10
  !> Times that force and points are found after each other, and the change of the force at which they agree.
  integer, parameter :: most_exchanges = 10
  real(wp), parameter :: agreed = 1.0e-6_wp

contains

  !> Betters the operator's answer to a residual: the impact force that goes with it, and cohesive points in equilibrium.
  subroutine condense(coupling, integrator, model, operator, old, new, correction, error)
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    type(model_t), intent(in) :: model
    !> The factored operator; receives answers to unit forces that it lacks
    type(tangent_operator_t), intent(inout) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> The operator's answer on entry, the correction on return, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails or numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    type(condensed_correction_t) :: condensed
    real(wp), allocatable :: answer(:, :)
    integer, allocatable :: equations(:)
    real(wp) :: before, patch_change
    integer :: round

    answer = correction
    patch_change = model%patch_mean(answer)
    before = coupling%unknown
    do round = 1, most_rounds
      call operator%timers%start('condensation')
      call new_condensed_correction(operator, model, old%interfaces%cohesive, new%motion%displacement, answer, condensed)
      call exchange(condensed, before, patch_change, coupling, integrator, model, operator, old, new, error)
      correction = answer
      call condensed%field(operator, coupling%share*(coupling%unknown - before), correction)
      call condensed%wanting(operator, model, old%interfaces%cohesive, new%motion%displacement, correction, equations)
      call operator%timers%stop('condensation')
      if (size(equations) == 0 .or. allocated(error)) exit
      call operator%find_columns(model, equations, error)
      if (allocated(error)) return
    end do
    call condensed%respond(operator)
  end subroutine condense

  !> Finds force and points after each other until they agree.
  subroutine exchange(condensed, before, patch_change, coupling, integrator, model, operator, old, new, error)
    !> The points
    type(condensed_correction_t), intent(inout) :: condensed
    !> Force that the residual holds, and change of the patch's mean deflection by the operator's answer
    real(wp), intent(in) :: before, patch_change
    !> The impactor's side of the step
    type(impact_coupling_t), intent(inout) :: coupling
    !> Integrator of the plate
    type(plate_integrator_t), intent(in) :: integrator
    type(model_t), intent(in) :: model
    !> The factored operator
    type(tangent_operator_t), intent(in) :: operator
    !> State at the start
    type(state_t), intent(in) :: old
    !> State at the end, before the correction
    type(state_t), intent(inout) :: new
    !> Set if numbers are not finite
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: force
    integer :: i

    do i = 1, most_exchanges
      force = coupling%unknown
      call condensed%solve(operator, model, coupling%share*(force - before))
      if (.not. model%scene%has_impactor) return
      call coupling%find_force(model, integrator, old, new, patch_change + condensed%patch_change, &
                               condensed%compliance, error)
      if (allocated(error) .or. abs(coupling%unknown - force) <= agreed*abs(force)) exit
    end do
  end subroutine exchange
end module condensed_steps
