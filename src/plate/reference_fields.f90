!> Values and derivatives of nodal fields at the 3x3 Gauss points of a batch of elements, and the transposed
!> operations that turn generalised stresses into nodal forces. Each is done line by line, as the shape functions are
!> products; a line of nodal values r1, r2, r3 is the parabola r2 + slope x + curvature x^2.
module reference_fields
  use kinds, only: wp
  use lagrange9, only: gauss3
  use element_batches, only: lanes
  implicit none
  private
  public :: gather, scatter, reference_values, add_value_forces, reference_gradient, add_gradient_forces

contains

  !> Unknowns of the nodes of a batch.
  pure subroutine gather(points, u, r)
    !> Point of each node
    integer, intent(in) :: points(lanes, 9)
    real(wp), contiguous, intent(in) :: u(:, :)
    real(wp), intent(out) :: r(lanes, 9, 5)
    integer :: lane, a

    do a = 1, 9
      do lane = 1, lanes
        r(lane, a, :) = u(:, points(lane, a))
      end do
    end do
  end subroutine gather

  !> Adds nodal forces of a batch to those of the points, element by element, so that the order of sums does not depend
  !> on the batches.
  pure subroutine scatter(targets, r, f)
    !> Column of each node
    integer, intent(in) :: targets(lanes, 9)
    !> Forces on the nodes (lane, node, component)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Forces on all points
    real(wp), contiguous, intent(inout) :: f(:, :)
    integer :: lane, a

    do lane = 1, lanes
      do a = 1, 9
        f(:, targets(lane, a)) = f(:, targets(lane, a)) + r(lane, a, :)
      end do
    end do
  end subroutine scatter

  !> Values of a nodal field at the Gauss points.
  pure subroutine reference_values(r, values)
    !> Nodal values
    real(wp), intent(in) :: r(lanes, 3, 3)
    !> Values at the Gauss points
    real(wp), intent(out) :: values(lanes, 3, 3)
    real(wp) :: along_xi(lanes, 3, 3)
    integer :: j

    do j = 1, 3
      call line_values(r(:, 1, j), r(:, 2, j), r(:, 3, j), along_xi(:, 1, j), along_xi(:, 2, j), along_xi(:, 3, j))
    end do
    do j = 1, 3
      call line_values(along_xi(:, j, 1), along_xi(:, j, 2), along_xi(:, j, 3), &
                       values(:, j, 1), values(:, j, 2), values(:, j, 3))
    end do
  end subroutine reference_values

  !> Transpose of `reference_values`: adds the nodal forces of loads at the Gauss points.
  pure subroutine add_value_forces(values, f)
    !> Loads at the Gauss points
    real(wp), intent(in) :: values(lanes, 3, 3)
    !> Nodal forces
    real(wp), intent(inout) :: f(lanes, 3, 3)
    real(wp) :: along_xi(lanes, 3, 3), line(lanes, 3)
    integer :: j

    do j = 1, 3
      call spread_values(values(:, j, 1), values(:, j, 2), values(:, j, 3), &
                         along_xi(:, j, 1), along_xi(:, j, 2), along_xi(:, j, 3))
    end do
    do j = 1, 3
      call spread_values(along_xi(:, 1, j), along_xi(:, 2, j), along_xi(:, 3, j), line(:, 1), line(:, 2), line(:, 3))
      f(:, :, j) = f(:, :, j) + line
    end do
  end subroutine add_value_forces

  !> Derivatives of a nodal field with respect to xi and eta at the Gauss points.
  pure subroutine reference_gradient(r, gradient)
    !> Nodal values
    real(wp), intent(in) :: r(lanes, 3, 3)
    !> Derivatives (lane, point, xi or eta)
    real(wp), intent(out) :: gradient(lanes, 3, 3, 2)
    real(wp) :: values(lanes, 3, 3), slopes(lanes, 3, 3)
    integer :: j

    do j = 1, 3
      call line_values(r(:, 1, j), r(:, 2, j), r(:, 3, j), values(:, 1, j), values(:, 2, j), values(:, 3, j))
      call line_slopes(r(:, 1, j), r(:, 2, j), r(:, 3, j), slopes(:, 1, j), slopes(:, 2, j), slopes(:, 3, j))
    end do
    do j = 1, 3
      call line_values(slopes(:, j, 1), slopes(:, j, 2), slopes(:, j, 3), &
                       gradient(:, j, 1, 1), gradient(:, j, 2, 1), gradient(:, j, 3, 1))
      call line_slopes(values(:, j, 1), values(:, j, 2), values(:, j, 3), &
                       gradient(:, j, 1, 2), gradient(:, j, 2, 2), gradient(:, j, 3, 2))
    end do
  end subroutine reference_gradient

  !> Transpose of `reference_gradient`: adds the nodal forces of stresses conjugate to the derivatives.
  pure subroutine add_gradient_forces(gradient, f)
    !> Stresses (lane, point, xi or eta)
    real(wp), intent(in) :: gradient(lanes, 3, 3, 2)
    !> Nodal forces
    real(wp), intent(inout) :: f(lanes, 3, 3)
    real(wp) :: values(lanes, 3, 3), slopes(lanes, 3, 3), line(lanes, 3)
    integer :: j

    do j = 1, 3
      call spread_values(gradient(:, j, 1, 1), gradient(:, j, 2, 1), gradient(:, j, 3, 1), &
                         slopes(:, j, 1), slopes(:, j, 2), slopes(:, j, 3))
      call spread_slopes(gradient(:, j, 1, 2), gradient(:, j, 2, 2), gradient(:, j, 3, 2), &
                         values(:, j, 1), values(:, j, 2), values(:, j, 3))
    end do
    do j = 1, 3
      call spread_values(values(:, 1, j), values(:, 2, j), values(:, 3, j), line(:, 1), line(:, 2), line(:, 3))
      f(:, :, j) = f(:, :, j) + line
      call spread_slopes(slopes(:, 1, j), slopes(:, 2, j), slopes(:, 3, j), line(:, 1), line(:, 2), line(:, 3))
      f(:, :, j) = f(:, :, j) + line
    end do
  end subroutine add_gradient_forces

  !> Values of a parabola at the three Gauss points of a line.
  pure subroutine line_values(r1, r2, r3, v1, v2, v3)
    !> Nodal values
    real(wp), intent(in) :: r1(lanes), r2(lanes), r3(lanes)
    !> Values at the Gauss points
    real(wp), intent(out) :: v1(lanes), v2(lanes), v3(lanes)
    real(wp) :: mean, half
    integer :: lane

    do lane = 1, lanes
      mean = 0.4_wp*r2(lane) + 0.3_wp*(r1(lane) + r3(lane))
      half = 0.5_wp*gauss3*(r3(lane) - r1(lane))
      v1(lane) = mean - half
      v2(lane) = r2(lane)
      v3(lane) = mean + half
    end do
  end subroutine line_values

  !> Transpose of `line_values`.
  pure subroutine spread_values(v1, v2, v3, f1, f2, f3)
    !> Loads at the Gauss points
    real(wp), intent(in) :: v1(lanes), v2(lanes), v3(lanes)
    !> Nodal forces
    real(wp), intent(out) :: f1(lanes), f2(lanes), f3(lanes)
    real(wp) :: total, half
    integer :: lane

    do lane = 1, lanes
      total = v1(lane) + v3(lane)
      half = 0.5_wp*gauss3*(v3(lane) - v1(lane))
      f1(lane) = 0.3_wp*total - half
      f2(lane) = 0.4_wp*total + v2(lane)
      f3(lane) = 0.3_wp*total + half
    end do
  end subroutine spread_values

  !> Slopes of a parabola at the three Gauss points of a line.
  pure subroutine line_slopes(r1, r2, r3, s1, s2, s3)
    !> Nodal values
    real(wp), intent(in) :: r1(lanes), r2(lanes), r3(lanes)
    !> Slopes at the Gauss points
    real(wp), intent(out) :: s1(lanes), s2(lanes), s3(lanes)
    real(wp) :: centre, change
    integer :: lane

    do lane = 1, lanes
      centre = 0.5_wp*(r3(lane) - r1(lane))
      change = gauss3*(r1(lane) + r3(lane)) - 2.0_wp*gauss3*r2(lane)
      s1(lane) = centre - change
      s2(lane) = centre
      s3(lane) = centre + change
    end do
  end subroutine line_slopes

  !> Transpose of `line_slopes`.
  pure subroutine spread_slopes(s1, s2, s3, f1, f2, f3)
    !> Stresses at the Gauss points
    real(wp), intent(in) :: s1(lanes), s2(lanes), s3(lanes)
    !> Nodal forces
    real(wp), intent(out) :: f1(lanes), f2(lanes), f3(lanes)
    real(wp) :: half, change
    integer :: lane

    do lane = 1, lanes
      half = 0.5_wp*(s1(lane) + s2(lane) + s3(lane))
      change = gauss3*(s3(lane) - s1(lane))
      f1(lane) = change - half
      f2(lane) = -2.0_wp*change
      f3(lane) = change + half
    end do
  end subroutine spread_slopes
end module reference_fields
