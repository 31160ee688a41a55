!> Derivatives of the shape functions with respect to x and y, for kernels that need them node by node.
module slope_operators
  use kinds, only: wp
  use lagrange9, only: gauss_shapes, gauss_xi_slopes, gauss_eta_slopes, &
    gauss2_shapes, gauss2_xi_slopes, gauss2_eta_slopes
  use element_batches, only: lanes
  implicit none
  private
  public :: slopes_and_values

contains

  !> Slopes and values of the shape functions of a batch at its 3x3 or 2x2 Gauss points.
  pure subroutine slopes_and_values(n, inverse, x_slopes, y_slopes, values)
    !> Number of points, 9 or 4
    integer, intent(in) :: n
    real(wp), intent(in) :: inverse(lanes, n, 4)
    !> Derivatives with respect to x and y (lane, point, node)
    real(wp), intent(out) :: x_slopes(lanes, n, 9), y_slopes(lanes, n, 9)
    !> Values (node, point)
    real(wp), intent(out) :: values(9, n)
    real(wp) :: xi_slopes(9, n), eta_slopes(9, n)
    integer :: a, g, lane

    if (n == 4) then
      values = gauss2_shapes
      xi_slopes = gauss2_xi_slopes
      eta_slopes = gauss2_eta_slopes
    else
      values = gauss_shapes
      xi_slopes = gauss_xi_slopes
      eta_slopes = gauss_eta_slopes
    end if
    do g = 1, n
      do a = 1, 9
        do lane = 1, lanes
          x_slopes(lane, g, a) = inverse(lane, g, 1)*xi_slopes(a, g) + inverse(lane, g, 2)*eta_slopes(a, g)
          y_slopes(lane, g, a) = inverse(lane, g, 3)*xi_slopes(a, g) + inverse(lane, g, 4)*eta_slopes(a, g)
        end do
      end do
    end do
  end subroutine slopes_and_values
end module slope_operators
