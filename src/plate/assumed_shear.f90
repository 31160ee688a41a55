!> Assumed transverse shear strains of the 9-node element (H. C. Huang, E. Hinton, Int. J. Numer. Meth. Eng. 22 (1986)
!> 73-92; theory (P8)): the covariant strain along xi is sampled at xi = -+1/sqrt(3) on the three rows of nodes eta =
!> -1, 0, 1 and interpolated, linearly in xi and quadratically in eta; the strain along eta likewise on the columns.
!> This removes locking without zero-energy modes.
module assumed_shear
  use kinds, only: wp
  use lagrange9, only: gauss2, gauss3, values3
  use element_batches, only: lanes, shear_samples
  implicit none
  private
  public :: assumed_shear_strains, add_assumed_shear_forces

  !> Half the Gauss abscissa over the sample abscissa.
  real(wp), parameter :: half_stretch = 0.5_wp*gauss3/gauss2
  !> Values of the end and middle nodes at a sample, summed over the two samples.
  real(wp), parameter :: sixth = 1.0_wp/6.0_wp, two_thirds = 2.0_wp/3.0_wp

contains

  !> Shear strains at the 3x3 Gauss points of a batch.
  pure subroutine assumed_shear_strains(tangents, inverse, r, strains)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 3, 3, 4)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Strains xz, yz at the Gauss points
    real(wp), intent(out) :: strains(lanes, 3, 3, 2)
    real(wp) :: rows(lanes, 3, 3), columns(lanes, 3, 3), along_xi, along_eta
    integer :: p, q, lane

    call sample_lines(tangents, r, 0, 1, 3, rows)
    call sample_lines(tangents, r, 6, 3, 1, columns)
    do q = 1, 3
      do p = 1, 3
        do lane = 1, lanes
          along_xi = values3(1, q)*rows(lane, p, 1) + values3(2, q)*rows(lane, p, 2) + values3(3, q)*rows(lane, p, 3)
          along_eta = values3(1, p)*columns(lane, q, 1) + values3(2, p)*columns(lane, q, 2) &
                      + values3(3, p)*columns(lane, q, 3)
          strains(lane, p, q, 1) = inverse(lane, p, q, 1)*along_xi + inverse(lane, p, q, 2)*along_eta
          strains(lane, p, q, 2) = inverse(lane, p, q, 3)*along_xi + inverse(lane, p, q, 4)*along_eta
        end do
      end do
    end do
  end subroutine assumed_shear_strains

  !> Adds the nodal forces of shear forces at the Gauss points.
  pure subroutine add_assumed_shear_forces(tangents, inverse, shear, f)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 3, 3, 4)
    !> Shear forces xz, yz at the Gauss points, times their areas
    real(wp), intent(in) :: shear(lanes, 3, 3, 2)
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: rows(lanes, 3, 3), columns(lanes, 3, 3), along_xi(lanes, 3, 3), along_eta(lanes, 3, 3)
    integer :: p, q, line, lane

    do q = 1, 3
      do p = 1, 3
        do lane = 1, lanes
          along_xi(lane, p, q) = inverse(lane, p, q, 1)*shear(lane, p, q, 1) &
                                 + inverse(lane, p, q, 3)*shear(lane, p, q, 2)
          along_eta(lane, q, p) = inverse(lane, p, q, 2)*shear(lane, p, q, 1) &
                                  + inverse(lane, p, q, 4)*shear(lane, p, q, 2)
        end do
      end do
    end do
    do line = 1, 3
      do p = 1, 3
        do lane = 1, lanes
          rows(lane, p, line) = values3(line, 1)*along_xi(lane, p, 1) + values3(line, 2)*along_xi(lane, p, 2) &
                                + values3(line, 3)*along_xi(lane, p, 3)
          columns(lane, p, line) = values3(line, 1)*along_eta(lane, p, 1) + values3(line, 2)*along_eta(lane, p, 2) &
                                   + values3(line, 3)*along_eta(lane, p, 3)
        end do
      end do
    end do
    call add_line_forces(tangents, rows, 0, 1, 3, f)
    call add_line_forces(tangents, columns, 6, 3, 1, f)
  end subroutine add_assumed_shear_forces

  !> Covariant strains along the three rows (or columns) of nodes, at the Gauss abscissae.
  pure subroutine sample_lines(tangents, r, offset, along, across, strains)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Samples before the first of these, steps in node number along and across the lines
    integer, intent(in) :: offset, along, across
    !> Strains (lane, abscissa, line)
    real(wp), intent(out) :: strains(lanes, 3, 3)
    real(wp) :: slope, change, x_mean, x_half, y_mean, y_half, minus, plus, half
    integer :: line, n1, n2, n3, s1, s2, lane

    do line = 1, 3
      n1 = 1 + (line - 1)*across
      n2 = n1 + along
      n3 = n2 + along
      s1 = offset + 2*line - 1
      s2 = s1 + 1
      do lane = 1, lanes
        slope = 0.5_wp*(r(lane, n3, 3) - r(lane, n1, 3))
        change = gauss2*(r(lane, n1, 3) + r(lane, n3, 3)) - 2.0_wp*gauss2*r(lane, n2, 3)
        x_mean = two_thirds*r(lane, n2, 4) + sixth*(r(lane, n1, 4) + r(lane, n3, 4))
        x_half = 0.5_wp*gauss2*(r(lane, n3, 4) - r(lane, n1, 4))
        y_mean = two_thirds*r(lane, n2, 5) + sixth*(r(lane, n1, 5) + r(lane, n3, 5))
        y_half = 0.5_wp*gauss2*(r(lane, n3, 5) - r(lane, n1, 5))
        minus = slope - change + tangents(lane, s1, 1)*(x_mean - x_half) + tangents(lane, s1, 2)*(y_mean - y_half)
        plus = slope + change + tangents(lane, s2, 1)*(x_mean + x_half) + tangents(lane, s2, 2)*(y_mean + y_half)
        half = half_stretch*(plus - minus)
        strains(lane, 1, line) = 0.5_wp*(minus + plus) - half
        strains(lane, 2, line) = 0.5_wp*(minus + plus)
        strains(lane, 3, line) = 0.5_wp*(minus + plus) + half
      end do
    end do
  end subroutine sample_lines

  !> Transpose of `sample_lines`.
  pure subroutine add_line_forces(tangents, shear, offset, along, across, f)
    real(wp), intent(in) :: tangents(lanes, shear_samples, 2)
    !> Forces conjugate to the strains (lane, abscissa, line)
    real(wp), intent(in) :: shear(lanes, 3, 3)
    !> Samples before the first of these, steps in node number along and across the lines
    integer, intent(in) :: offset, along, across
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: total, half, minus, plus, x_minus, x_plus, y_minus, y_plus, sums(lanes, 3, 3)
    integer :: line, n1, n2, n3, s1, s2, lane

    do line = 1, 3
      n1 = 1 + (line - 1)*across
      n2 = n1 + along
      n3 = n2 + along
      s1 = offset + 2*line - 1
      s2 = s1 + 1
      ! The loop over lanes is vectorised if it stores nothing to f: the compiler does not know that the nodes differ.
      do lane = 1, lanes
        total = 0.5_wp*(shear(lane, 1, line) + shear(lane, 2, line) + shear(lane, 3, line))
        half = half_stretch*(shear(lane, 3, line) - shear(lane, 1, line))
        minus = total - half
        plus = total + half
        x_minus = tangents(lane, s1, 1)*minus
        x_plus = tangents(lane, s2, 1)*plus
        y_minus = tangents(lane, s1, 2)*minus
        y_plus = tangents(lane, s2, 2)*plus
        sums(lane, 1, 1) = f(lane, n1, 3) + gauss2*(plus - minus) - 0.5_wp*(plus + minus)
        sums(lane, 1, 2) = f(lane, n2, 3) - 2.0_wp*gauss2*(plus - minus)
        sums(lane, 1, 3) = f(lane, n3, 3) + gauss2*(plus - minus) + 0.5_wp*(plus + minus)
        sums(lane, 2, 1) = f(lane, n1, 4) + sixth*(x_plus + x_minus) - 0.5_wp*gauss2*(x_plus - x_minus)
        sums(lane, 2, 2) = f(lane, n2, 4) + two_thirds*(x_plus + x_minus)
        sums(lane, 2, 3) = f(lane, n3, 4) + sixth*(x_plus + x_minus) + 0.5_wp*gauss2*(x_plus - x_minus)
        sums(lane, 3, 1) = f(lane, n1, 5) + sixth*(y_plus + y_minus) - 0.5_wp*gauss2*(y_plus - y_minus)
        sums(lane, 3, 2) = f(lane, n2, 5) + two_thirds*(y_plus + y_minus)
        sums(lane, 3, 3) = f(lane, n3, 5) + sixth*(y_plus + y_minus) + 0.5_wp*gauss2*(y_plus - y_minus)
      end do
      f(:, n1, 3:5) = sums(:, :, 1)
      f(:, n2, 3:5) = sums(:, :, 2)
      f(:, n3, 3:5) = sums(:, :, 3)
    end do
  end subroutine add_line_forces
end module assumed_shear
