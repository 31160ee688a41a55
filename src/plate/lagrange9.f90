!> Tables of the 9-node Lagrange element. Nodes and Gauss points are in tensor order:
!> a = 1 + i + 3 j with i along xi and j along eta. Tables of two dimensions are products of those of one.
module lagrange9
  use kinds, only: wp
  implicit none
  private
  public :: line_values, line_slopes, shape_gradients

  !> Outer abscissa of the 3-point Gauss rule.
  real(wp), parameter, public :: gauss3 = sqrt(0.6_wp)
  !> Abscissa of the 2-point Gauss rule.
  real(wp), parameter, public :: gauss2 = 1.0_wp/sqrt(3.0_wp)

  !> Weights of the 3-point rule.
  real(wp), parameter, public :: weights3(3) = [5.0_wp, 8.0_wp, 5.0_wp]/9.0_wp
  !> Quadratics of the three nodes of a line at the 3-point rule (node, point), and their slopes.
  real(wp), parameter, public :: values3(3, 3) = reshape( &
    [0.3_wp + 0.5_wp*gauss3, 0.4_wp, 0.3_wp - 0.5_wp*gauss3, 0.0_wp, 1.0_wp, 0.0_wp, &
     0.3_wp - 0.5_wp*gauss3, 0.4_wp, 0.3_wp + 0.5_wp*gauss3], [3, 3])
  real(wp), parameter :: slopes3(3, 3) = reshape( &
    [-gauss3 - 0.5_wp, 2.0_wp*gauss3, -gauss3 + 0.5_wp, -0.5_wp, 0.0_wp, 0.5_wp, &
     gauss3 - 0.5_wp, -2.0_wp*gauss3, gauss3 + 0.5_wp], [3, 3])
  !> The same at the 2-point rule.
  real(wp), parameter :: values2(3, 2) = reshape( &
    [(1.0_wp/3.0_wp + gauss2)/2.0_wp, 2.0_wp/3.0_wp, (1.0_wp/3.0_wp - gauss2)/2.0_wp, &
     (1.0_wp/3.0_wp - gauss2)/2.0_wp, 2.0_wp/3.0_wp, (1.0_wp/3.0_wp + gauss2)/2.0_wp], [3, 2])
  real(wp), parameter :: slopes2(3, 2) = reshape( &
    [-gauss2 - 0.5_wp, 2.0_wp*gauss2, -gauss2 + 0.5_wp, &
     gauss2 - 0.5_wp, -2.0_wp*gauss2, gauss2 + 0.5_wp], [3, 2])

  !> Index along xi and eta of each of nine nodes or Gauss points, and of each of four Gauss points.
  integer, parameter :: i9(9) = [1, 2, 3, 1, 2, 3, 1, 2, 3], j9(9) = [1, 1, 1, 2, 2, 2, 3, 3, 3]
  integer, parameter :: i4(4) = [1, 2, 1, 2], j4(4) = [1, 1, 2, 2]
  !> Index along and across the lines of each of six samples, two on each of three lines.
  integer, parameter :: p6(6) = [1, 2, 1, 2, 1, 2], line6(6) = [1, 1, 2, 2, 3, 3]

  !> Weights of the 3x3 Gauss rule; those of the 2x2 rule are one.
  real(wp), parameter, public :: gauss_weights(9) = weights3(i9)*weights3(j9)
  !> Shape functions at the 3x3 Gauss points (node, point).
  real(wp), parameter, public :: gauss_shapes(9, 9) = values3(i9, i9)*values3(j9, j9)
  !> Their derivatives with respect to xi and eta (node, point).
  real(wp), parameter, public :: gauss_xi_slopes(9, 9) = slopes3(i9, i9)*values3(j9, j9)
  real(wp), parameter, public :: gauss_eta_slopes(9, 9) = values3(i9, i9)*slopes3(j9, j9)
  !> Shape functions at the 2x2 Gauss points (node, point).
  real(wp), parameter, public :: gauss2_shapes(9, 4) = values2(i9, i4)*values2(j9, j4)
  !> Their derivatives with respect to xi and eta (node, point).
  real(wp), parameter, public :: gauss2_xi_slopes(9, 4) = slopes2(i9, i4)*values2(j9, j4)
  real(wp), parameter, public :: gauss2_eta_slopes(9, 4) = values2(i9, i4)*slopes2(j9, j4)
  !> Values at the 3-point rule of straight lines through values at the 2-point rule (point of the 2-point rule, of the
  !> 3-point rule).
  real(wp), parameter :: lines2(2, 3) = reshape( &
    [0.5_wp + 0.5_wp*gauss3/gauss2, 0.5_wp - 0.5_wp*gauss3/gauss2, 0.5_wp, 0.5_wp, &
     0.5_wp - 0.5_wp*gauss3/gauss2, 0.5_wp + 0.5_wp*gauss3/gauss2], [2, 3])
  !> Values at the 3x3 Gauss points from those at the 2x2 Gauss points (point of the 2x2 rule, of the 3x3 rule).
  real(wp), parameter, public :: gauss2_to_gauss3(4, 9) = lines2(i4, i9)*lines2(j4, j9)
  !> Values at the 3x3 Gauss points of strains sampled at xi = -+1/sqrt(3), eta = -1, 0, 1 (sample p + 2 j, point).
  real(wp), parameter, public :: row_samples(6, 9) = lines2(p6, i9)*values3(line6, j9)
  !> The same sampled at xi = -1, 0, 1, eta = -+1/sqrt(3) (sample p + 2 i, point).
  real(wp), parameter, public :: column_samples(6, 9) = lines2(p6, j9)*values3(line6, i9)
  !> Values at the three nodes of a line of the least-squares straight line through the values at its Gauss points
  !> (point, node). It intersects the parabola through these values at the points of the 2-point rule.
  real(wp), parameter :: fitted3(3, 3) = reshape( &
    [5.0_wp/18.0_wp + gauss3/1.2_wp, 4.0_wp/9.0_wp, 5.0_wp/18.0_wp - gauss3/1.2_wp, &
     5.0_wp/18.0_wp, 4.0_wp/9.0_wp, 5.0_wp/18.0_wp, &
     5.0_wp/18.0_wp - gauss3/1.2_wp, 4.0_wp/9.0_wp, 5.0_wp/18.0_wp + gauss3/1.2_wp], [3, 3])
  !> Values at the nodes from those at the 3x3 Gauss points, bilinear through the 2x2 Gauss points (point, node).
  real(wp), parameter, public :: superconvergent_nodes(9, 9) = fitted3(i9, i9)*fitted3(j9, j9)

contains

  !> Quadratic shape functions of the nodes -1, 0, 1 of a line.
  pure function line_values(x) result(values)
    !> Coordinate from -1 to 1
    real(wp), intent(in) :: x
    !> Value of each
    real(wp) :: values(3)

    values = [0.5_wp*x*(x - 1.0_wp), 1.0_wp - x*x, 0.5_wp*x*(x + 1.0_wp)]
  end function line_values

  !> Derivatives of the quadratic shape functions of the nodes -1, 0, 1 of a line.
  pure function line_slopes(x) result(slopes)
    !> Coordinate from -1 to 1
    real(wp), intent(in) :: x
    !> Derivative of each
    real(wp) :: slopes(3)

    slopes = [x - 0.5_wp, -2.0_wp*x, x + 0.5_wp]
  end function line_slopes

  !> Derivatives of the shape functions.
  pure function shape_gradients(xi, eta) result(gradients)
    !> Natural coordinates of a point
    real(wp), intent(in) :: xi, eta
    !> Derivatives with respect to xi (first column) and eta (second), one row per node
    real(wp) :: gradients(9, 2)

    gradients(:, 1) = products(line_slopes(xi), line_values(eta))
    gradients(:, 2) = products(line_values(xi), line_slopes(eta))
  end function shape_gradients

  !> Tensor product of two lines.
  pure function products(along_xi, along_eta) result(both)
    !> Values along xi and along eta
    real(wp), intent(in) :: along_xi(3), along_eta(3)
    !> Products in tensor order
    real(wp) :: both(9)

    both = along_xi(i9)*along_eta(j9)
  end function products
end module lagrange9
