!> Solutions with the tangent of a load step, whose symmetric part has just been factored.
!>
!> A cohesive law whose toughness depends on the mixture of modes has an unsymmetric tangent where damage grows. The
!> rest, a few small blocks, is followed by generalised minimal residuals.
module static_tangents
  use cohesive_interfaces, only: cohesive_interfaces_t
  use errors, only: error_t
  use kinds, only: wp
  use krylov_corrections, only: find_krylov_correction
  use models, only: model_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: solve_tangent

  !> Part of a solution that may be left wrong. Beside a limit two large solutions make a small correction: with 1e-3
  !> its error was 1.5 times what there was to correct, and no step however short converged (input/verify/dcb_ubm.nml).
  real(wp), parameter :: left_over = 1.0e-6_wp

contains

  !> Solution under forces, ghosts included. Collective.
  subroutine solve_tangent(operator, model, cohesive, forces, solution, error)
    !> The operator, just factored
    type(tangent_operator_t), target, intent(inout) :: operator
    !> Mesh, numbering and interfaces of the plate
    type(model_t), target, intent(in) :: model
    !> The interfaces with their tangents
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Forces at the owned points, (5, points)
    real(wp), intent(in) :: forces(:, :)
    !> Solution, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    type(tangent_product_t) :: tangent
    real(wp), allocatable :: diagonal(:, :)

    tangent%model => model
    tangent%operator => operator
    tangent%displacement => operator%displacement
    if (allocated(cohesive%tangents)) call tangent%set_skew_part(cohesive%tangents)
    diagonal = operator%diagonal
    diagonal(:3, :) = diagonal(:3, :) + abs(operator%added)
    call find_krylov_correction(operator, model, tangent, diagonal, forces, left_over, solution, error)
  end subroutine solve_tangent
end module static_tangents
