!> Data of Newton's method for a step: model, operator, states at the start and end of the step, residual, correction.
module newton_iterations
  use kinds, only: wp
  use models, only: model_t
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: newton_iteration_t, new_newton_iteration

  !> One iteration of a step.
  type :: newton_iteration_t
    !> Mesh, numbering and interfaces of the plate
    type(model_t), pointer :: model => null()
    !> The factored operator
    type(tangent_operator_t), pointer :: operator => null()
    !> State at the start of the step, which is not changed, and at its end
    type(state_t), pointer :: old => null(), new => null()
    !> Required convergence
    type(equilibrium_t) :: equilibrium
    !> Residual at the owned points, (5, points)
    real(wp), allocatable :: residual(:, :)
    !> Residual without ties and contacts; allocated if lines are searched
    real(wp), allocatable :: smooth(:, :)
    !> Correction of the displacement, (5, points)
    real(wp), allocatable :: correction(:, :)
    !> True: the correction is a direction of negative curvature of the tangent
    logical :: negative_curvature = .false.
    !> Norm of the residual, and of that before the last correction; 0: there was none, or the multipliers are new
    real(wp) :: norm = 0, previous_norm = 0
    !> True: multipliers were updated after the last correction
    logical :: multipliers_changed = .false.
    !> Strain energy of this rank's elements
    real(wp) :: energy = 0
  end type newton_iteration_t

contains

  !> Iteration of a step before its first residual, with pointers to the model, the operator and both states.
  function new_newton_iteration(model, equilibrium, operator, old, new) result(self)
    type(model_t), target, intent(in) :: model
    type(equilibrium_t), intent(in) :: equilibrium
    type(tangent_operator_t), target, intent(in) :: operator
    type(state_t), target, intent(in) :: old
    type(state_t), target, intent(in) :: new
    type(newton_iteration_t) :: self

    self%model => model
    self%operator => operator
    self%old => old
    self%new => new
    self%equilibrium = equilibrium
    allocate (self%residual, self%correction, mold=old%motion%displacement)
  end function new_newton_iteration
end module newton_iterations
