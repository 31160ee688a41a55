!> Transverse shear stiffness matrices of a batch of elements.
module shear_tangents
  use kinds, only: wp
  use lagrange9, only: line_values, line_slopes, gauss2, row_samples, column_samples
  use plate_options, only: shear_assumed
  use element_batches, only: element_batches_t, lanes, shear_samples
  use slope_operators, only: slopes_and_values
  implicit none
  private
  public :: add_shear_tangent

contains

  !> Adds the shear stiffness of a batch to the blocks of node pairs a <= b.
  subroutine add_shear_tangent(batches, b, c, k)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(inout) :: k(lanes, 45, 45)

    if (batches%shear == shear_assumed) then
      call add_assumed_tangent(batches%shear_tangents(:, :, :, b), batches%inverse_jacobian(:, :, :, b), &
                               batches%weight(:, :, b), c(:, 19:21), k)
    else
      call add_integrated_tangent(batches%shear_points, batches%shear_inverse_jacobian(:, :, :, b), &
                                  batches%shear_weight(:, :, b), c(:, 19:21), k)
    end if
  end subroutine add_shear_tangent

  !> Stiffness of assumed strains: samples = operator * unknowns, energy = samples * sample stiffness * samples / 2.
  subroutine add_assumed_tangent(tangents, inverse, weight, s, k)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Shear stiffness
    real(wp), intent(in) :: s(lanes, 3)
    !> Stiffness, added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: operator(lanes, 9, shear_samples), samples(lanes, shear_samples, shear_samples)
    real(wp) :: forces(lanes, 45, shear_samples)
    integer :: dofs(9, shear_samples), first, last, i, j, m, lane

    call sample_operators(tangents, operator, dofs)
    call sample_stiffness(inverse, weight, s, samples)
    forces = 0.0_wp
    do j = 1, shear_samples
      do i = 1, shear_samples
        do m = 1, 9
          do lane = 1, lanes
            forces(lane, dofs(m, j), i) = forces(lane, dofs(m, j), i) + samples(lane, i, j)*operator(lane, m, j)
          end do
        end do
      end do
    end do
    do i = 1, shear_samples
      do j = 1, 45
        if (mod(j - 1, 5) < 2) cycle
        last = 5*((j - 1)/5) + 5
        do m = 1, 9
          first = dofs(m, i)
          if (first > last) cycle
          do lane = 1, lanes
            k(lane, first, j) = k(lane, first, j) + operator(lane, m, i)*forces(lane, j, i)
          end do
        end do
      end do
    end do
  end subroutine add_assumed_tangent

  !> Operator of each sample of the assumed strains on the unknowns w, theta_x, theta_y of the three nodes of its line.
  pure subroutine sample_operators(tangents, operator, dofs)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    !> Coefficients (lane, unknown of the line, sample)
    real(wp), intent(out) :: operator(lanes, 9, shear_samples)
    !> Unknown of the element that each of them multiplies
    integer, intent(out) :: dofs(9, shear_samples)
    real(wp) :: values(3), slopes(3), place
    integer :: s, line, m, node

    do s = 1, shear_samples
      line = mod(s - 1, 6)/2
      place = merge(-gauss2, gauss2, mod(s, 2) == 1)
      values = line_values(place)
      slopes = line_slopes(place)
      do m = 1, 3
        node = merge(3*line + m, line + 3*m - 2, s <= 6)
        dofs(3*m - 2:3*m, s) = 5*(node - 1) + [3, 4, 5]
        operator(:, 3*m - 2, s) = slopes(m)
        operator(:, 3*m - 1, s) = values(m)*tangents(:, s, 1)
        operator(:, 3*m, s) = values(m)*tangents(:, s, 2)
      end do
    end do
  end subroutine sample_operators

  !> Stiffness that links the samples of the assumed strains.
  pure subroutine sample_stiffness(inverse, weight, s, samples)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Shear stiffness
    real(wp), intent(in) :: s(lanes, 3)
    !> Stiffness (lane, sample, sample)
    real(wp), intent(out) :: samples(lanes, shear_samples, shear_samples)
    real(wp) :: covariant(lanes, 3), ix, ex, iy, ey
    integer :: g, i, j, lane

    samples = 0.0_wp
    do g = 1, 9
      do lane = 1, lanes
        ix = inverse(lane, g, 1)
        ex = inverse(lane, g, 2)
        iy = inverse(lane, g, 3)
        ey = inverse(lane, g, 4)
        covariant(lane, 1) = weight(lane, g)*(s(lane, 1)*ix*ix + 2.0_wp*s(lane, 2)*ix*iy + s(lane, 3)*iy*iy)
        covariant(lane, 2) = weight(lane, g)*(s(lane, 1)*ix*ex + s(lane, 2)*(ix*ey + iy*ex) + s(lane, 3)*iy*ey)
        covariant(lane, 3) = weight(lane, g)*(s(lane, 1)*ex*ex + 2.0_wp*s(lane, 2)*ex*ey + s(lane, 3)*ey*ey)
      end do
      do j = 1, 6
        do i = 1, 6
          do lane = 1, lanes
            samples(lane, i, j) = samples(lane, i, j) + row_samples(i, g)*row_samples(j, g)*covariant(lane, 1)
            samples(lane, i, j + 6) = samples(lane, i, j + 6) &
                                      + row_samples(i, g)*column_samples(j, g)*covariant(lane, 2)
            samples(lane, i + 6, j + 6) = samples(lane, i + 6, j + 6) &
                                          + column_samples(i, g)*column_samples(j, g)*covariant(lane, 3)
          end do
        end do
      end do
    end do
    do j = 1, 6
      do i = 1, 6
        samples(:, j + 6, i) = samples(:, i, j + 6)
      end do
    end do
  end subroutine sample_stiffness

  !> Stiffness of shear strains computed directly from the displacements.
  subroutine add_integrated_tangent(n, inverse, weight, s, k)
    !> Number of shear points, 9 or 4
    integer, intent(in) :: n
    real(wp), intent(in) :: inverse(lanes, n, 4)
    !> Area of each point
    real(wp), intent(in) :: weight(lanes, n)
    !> Shear stiffness
    real(wp), intent(in) :: s(lanes, 3)
    !> Stiffness, added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: x_slopes(lanes, n, 9), y_slopes(lanes, n, 9), values(9, n), x_force(lanes, 3), y_force(lanes, 3)
    integer :: g, a, b, column, row, lane

    call slopes_and_values(n, inverse, x_slopes, y_slopes, values)
    do g = 1, n
      do b = 1, 9
        do lane = 1, lanes
          x_force(lane, 1) = weight(lane, g)*(s(lane, 1)*x_slopes(lane, g, b) + s(lane, 2)*y_slopes(lane, g, b))
          y_force(lane, 1) = weight(lane, g)*(s(lane, 2)*x_slopes(lane, g, b) + s(lane, 3)*y_slopes(lane, g, b))
          x_force(lane, 2) = weight(lane, g)*s(lane, 1)*values(b, g)
          y_force(lane, 2) = weight(lane, g)*s(lane, 2)*values(b, g)
          x_force(lane, 3) = weight(lane, g)*s(lane, 2)*values(b, g)
          y_force(lane, 3) = weight(lane, g)*s(lane, 3)*values(b, g)
        end do
        do column = 1, 3
          do a = 1, b
            row = 5*(a - 1) + 3
            call add_shear_force(x_slopes(:, g, a), y_slopes(:, g, a), values(a, g), x_force(:, column), &
                                 y_force(:, column), k(:, row:row + 2, 5*(b - 1) + 2 + column))
          end do
        end do
      end do
    end do
  end subroutine add_integrated_tangent

  !> Adds the forces of transverse shear forces at a point on w, theta_x and theta_y of a node.
  pure subroutine add_shear_force(x_slope, y_slope, value, x_force, y_force, forces)
    !> Derivatives of the node's shape function with respect to x and y at the point
    real(wp), intent(in) :: x_slope(lanes), y_slope(lanes)
    !> Its value
    real(wp), intent(in) :: value
    !> Shear forces
    real(wp), intent(in) :: x_force(lanes), y_force(lanes)
    !> Forces on the node
    real(wp), intent(inout) :: forces(lanes, 3)
    integer :: lane

    do lane = 1, lanes
      forces(lane, 1) = forces(lane, 1) + x_slope(lane)*x_force(lane) + y_slope(lane)*y_force(lane)
      forces(lane, 2) = forces(lane, 2) + value*x_force(lane)
      forces(lane, 3) = forces(lane, 3) + value*y_force(lane)
    end do
  end subroutine add_shear_force
end module shear_tangents
