!> Geometric stiffness of a batch of elements by von Karman's strains: the coupling of the slopes with the membrane
!> strains and curvatures, and the membrane forces acting on the slopes.
module geometric_tangents
  use kinds, only: wp
  use element_batches, only: lanes
  implicit none
  private
  public :: add_geometric_tangent

contains

  !> Adds these terms to the blocks of node pairs a <= b.
  subroutine add_geometric_tangent(c, weight, x_slopes, y_slopes, slopes, forces, k)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Derivatives of the shape functions with respect to x and y (lane, point, node)
    real(wp), intent(in) :: x_slopes(lanes, 9, 9), y_slopes(lanes, 9, 9)
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> Membrane forces Nxx, Nyy, Nxy times the areas; moments follow and are not used
    real(wp), intent(in) :: forces(lanes, 9, 6)
    !> Stiffness (lane, row, column), added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: coupling(lanes, 4, 9, 9)
    integer :: a, b, m

    call add_slope_stiffness(c, weight, x_slopes, y_slopes, slopes, forces, k)
    coupling = 0.0_wp
    call add_coupling(c(:, 1:6), 1, weight, x_slopes, y_slopes, slopes, coupling)
    call add_coupling(c(:, 7:12), 3, weight, x_slopes, y_slopes, slopes, coupling)
    do b = 1, 9
      do a = 1, b
        do m = 1, 2
          k(:, 5*a - 5 + m, 5*b - 2) = k(:, 5*a - 5 + m, 5*b - 2) + coupling(:, m, a, b)
          k(:, 5*a - 2 + m, 5*b - 2) = k(:, 5*a - 2 + m, 5*b - 2) + coupling(:, 2 + m, a, b)
          k(:, 5*a - 2, 5*b - 5 + m) = k(:, 5*a - 2, 5*b - 5 + m) + coupling(:, m, b, a)
          k(:, 5*a - 2, 5*b - 2 + m) = k(:, 5*a - 2, 5*b - 2 + m) + coupling(:, 2 + m, b, a)
        end do
      end do
    end do
  end subroutine add_geometric_tangent

  !> Adds the geometric stiffness between w and w: membrane stiffness through the slopes, and membrane forces.
  subroutine add_slope_stiffness(c, weight, x_slopes, y_slopes, slopes, forces, k)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Derivatives of the shape functions with respect to x and y (lane, point, node)
    real(wp), intent(in) :: x_slopes(lanes, 9, 9), y_slopes(lanes, 9, 9)
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> Membrane forces Nxx, Nyy, Nxy times the areas; moments follow and are not used
    real(wp), intent(in) :: forces(lanes, 9, 6)
    !> Stiffness (lane, row, column), added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: h(lanes, 3), x_force(lanes), y_force(lanes), xx, xy, yy
    integer :: g, a, b, lane

    do g = 1, 9
      do lane = 1, lanes
        xx = weight(lane, g)*slopes(lane, g, 1)*slopes(lane, g, 1)
        xy = weight(lane, g)*slopes(lane, g, 1)*slopes(lane, g, 2)
        yy = weight(lane, g)*slopes(lane, g, 2)*slopes(lane, g, 2)
        h(lane, 1) = c(lane, 1)*xx + 2.0_wp*c(lane, 3)*xy + c(lane, 6)*yy + forces(lane, g, 1)
        h(lane, 2) = c(lane, 3)*xx + (c(lane, 2) + c(lane, 6))*xy + c(lane, 5)*yy + forces(lane, g, 3)
        h(lane, 3) = c(lane, 6)*xx + 2.0_wp*c(lane, 5)*xy + c(lane, 4)*yy + forces(lane, g, 2)
      end do
      do b = 1, 9
        do lane = 1, lanes
          x_force(lane) = h(lane, 1)*x_slopes(lane, g, b) + h(lane, 2)*y_slopes(lane, g, b)
          y_force(lane) = h(lane, 2)*x_slopes(lane, g, b) + h(lane, 3)*y_slopes(lane, g, b)
        end do
        do a = 1, b
          do lane = 1, lanes
            k(lane, 5*a - 2, 5*b - 2) = k(lane, 5*a - 2, 5*b - 2) + x_slopes(lane, g, a)*x_force(lane) &
                                        + y_slopes(lane, g, a)*y_force(lane)
          end do
        end do
      end do
    end do
  end subroutine add_slope_stiffness

  !> Adds the coupling of the slopes with the strains of u, v (by A) or of theta_x, theta_y (by B).
  subroutine add_coupling(c, first, weight, x_slopes, y_slopes, slopes, coupling)
    !> Stiffness 11, 12, 16, 22, 26, 66
    real(wp), intent(in) :: c(lanes, 6)
    !> First row of the coupling that is added to: 1 for u, v, 3 for the rotations
    integer, intent(in) :: first
    real(wp), intent(in) :: weight(lanes, 9)
    !> Derivatives of the shape functions with respect to x and y (lane, point, node)
    real(wp), intent(in) :: x_slopes(lanes, 9, 9), y_slopes(lanes, 9, 9)
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> Stiffness of (u, v, theta_x, theta_y) of node a against w of node b (lane, component, a, b)
    real(wp), intent(inout) :: coupling(lanes, 4, 9, 9)
    real(wp) :: stress(lanes, 3), exx, eyy, gxy
    integer :: g, a, b, lane

    do g = 1, 9
      do b = 1, 9
        do lane = 1, lanes
          exx = weight(lane, g)*slopes(lane, g, 1)*x_slopes(lane, g, b)
          eyy = weight(lane, g)*slopes(lane, g, 2)*y_slopes(lane, g, b)
          gxy = weight(lane, g)*(slopes(lane, g, 2)*x_slopes(lane, g, b) + slopes(lane, g, 1)*y_slopes(lane, g, b))
          stress(lane, 1) = c(lane, 1)*exx + c(lane, 2)*eyy + c(lane, 3)*gxy
          stress(lane, 2) = c(lane, 2)*exx + c(lane, 4)*eyy + c(lane, 5)*gxy
          stress(lane, 3) = c(lane, 3)*exx + c(lane, 5)*eyy + c(lane, 6)*gxy
        end do
        do a = 1, 9
          do lane = 1, lanes
            coupling(lane, first, a, b) = coupling(lane, first, a, b) + x_slopes(lane, g, a)*stress(lane, 1) &
                                          + y_slopes(lane, g, a)*stress(lane, 3)
            coupling(lane, first + 1, a, b) = coupling(lane, first + 1, a, b) + y_slopes(lane, g, a)*stress(lane, 2) &
                                              + x_slopes(lane, g, a)*stress(lane, 3)
          end do
        end do
      end do
    end do
  end subroutine add_coupling
end module geometric_tangents
