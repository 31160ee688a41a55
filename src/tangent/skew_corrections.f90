!> Corrections for an unsymmetric tangent from a symmetric factor.
!>
!> A cohesive law whose toughness depends on the mixture of modes has an unsymmetric tangent where damage grows. The
!> factor holds its symmetric part S; the rest R, a few small blocks, is followed by generalised conjugate residuals on
!> (1 + S**-1 R) x = S**-1 f (S. C. Eisenstat, H. C. Elman, M. H. Schultz, SIAM Journal on Numerical Analysis 20 (1983)
!> 345-357). Each takes a solve, a tenth of a factorization; without them Newton's iteration takes four times as many
!> of these.
module skew_corrections
  use kinds, only: wp
  use errors, only: error_t
  use models, only: model_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: follow_skew

  !> Part of a solution that may be left wrong. Beside a limit two large solutions make a small correction: with 1e-3
  !> its error was 1.5 times what there was to correct, and no step however short converged (input/verify/dcb_ubm.nml).
  real(wp), parameter :: left_over = 1.0e-6_wp
  !> Most directions.
  integer, parameter :: most = 20

contains

  !> Turns a solution for the symmetric part into one for the whole tangent.
  subroutine follow_skew(operator, model, cohesive, solution, error)
    !> The operator, just factored
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The interfaces with their tangents
    type(cohesive_interfaces_t), intent(in) :: cohesive
    !> Solution, ghosts included, (5, points)
    real(wp), intent(inout) :: solution(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: direction(:, :, :), image(:, :, :), left(:, :), force(:, :)
    real(wp) :: first, part
    integer :: k, j

    if (.not. allocated(cohesive%tangents)) return
    allocate (direction(5, size(solution, 2), most), image(5, size(solution, 2), most))
    allocate (force, mold=solution)
    left = solution
    first = product_of(operator, model, left, left)
    solution = 0
    do k = 1, most
      direction(:, :, k) = left
      call skew_forces(model, cohesive%tangents, left, force)
      image(:, :, k) = 0
      call operator%correct(model, force, image(:, :, k), error)
      if (allocated(error)) return
      image(:, :, k) = image(:, :, k) + left
      do j = 1, k - 1
        part = product_of(operator, model, image(:, :, k), image(:, :, j))
        image(:, :, k) = image(:, :, k) - part*image(:, :, j)
        direction(:, :, k) = direction(:, :, k) - part*direction(:, :, j)
      end do
      part = sqrt(product_of(operator, model, image(:, :, k), image(:, :, k)))
      if (.not. part > 0) exit
      image(:, :, k) = image(:, :, k)/part
      direction(:, :, k) = direction(:, :, k)/part
      part = product_of(operator, model, left, image(:, :, k))
      solution = solution + part*direction(:, :, k)
      left = left - part*image(:, :, k)
      if (product_of(operator, model, left, left) <= left_over**2*first) exit
    end do
  end subroutine follow_skew

  !> Forces of the skew parts of the tangents.
  pure subroutine skew_forces(model, tangents, displacement, force)
    type(model_t), intent(in) :: model
    !> Force per jump, (3, 3, points)
    real(wp), intent(in) :: tangents(:, :, :)
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Forces at the owned points, (5, points)
    real(wp), intent(out) :: force(:, :)
    integer :: i

    force = 0
    do i = 1, model%distribution%owned
      if (model%zone(i) == 0) cycle
      force(1:3, i) = matmul(tangents(:, :, i) - transpose(tangents(:, :, i)), displacement(1:3, i))/2
    end do
  end subroutine skew_forces

  !> Product of two fields of displacements, weighted by the operator's diagonal so that lengths and angles compare; the
  !> same on every rank.
  real(wp) function product_of(operator, model, a, b) result(total)
    !> The operator
    type(tangent_operator_t), intent(in) :: operator
    type(model_t), intent(in) :: model
    !> The fields, (5, points)
    real(wp), intent(in) :: a(:, :), b(:, :)

    associate (owned => model%distribution%owned)
      total = sum(operator%diagonal(:, :owned)*a(:, :owned)*b(:, :owned))
    end associate
    call model%communicator%sum(total)
  end function product_of
end module skew_corrections
