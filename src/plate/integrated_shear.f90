!> Transverse shear strains from the displacements at 3x3 or 2x2 points: full integration, which locks, and selective
!> integration, which has one zero-energy mode, for comparison with the assumed strains.
module integrated_shear
  use kinds, only: wp
  use element_batches, only: lanes
  use slope_operators, only: slopes_and_values
  implicit none
  private
  public :: integrated_shear_strains, add_integrated_shear_forces

contains

  !> Shear strains of a batch at its shear points.
  pure subroutine integrated_shear_strains(n, inverse, r, strains)
    !> Number of points, 9 or 4
    integer, intent(in) :: n
    real(wp), intent(in) :: inverse(lanes, n, 4)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Strains xz, yz
    real(wp), intent(out) :: strains(lanes, n, 2)
    real(wp) :: x_slopes(lanes, n, 9), y_slopes(lanes, n, 9), values(9, n)
    integer :: a, g, lane

    call slopes_and_values(n, inverse, x_slopes, y_slopes, values)
    strains = 0.0_wp
    do g = 1, n
      do a = 1, 9
        do lane = 1, lanes
          strains(lane, g, 1) = strains(lane, g, 1) + x_slopes(lane, g, a)*r(lane, a, 3) + values(a, g)*r(lane, a, 4)
          strains(lane, g, 2) = strains(lane, g, 2) + y_slopes(lane, g, a)*r(lane, a, 3) + values(a, g)*r(lane, a, 5)
        end do
      end do
    end do
  end subroutine integrated_shear_strains

  !> Adds the nodal forces of shear forces at the shear points.
  pure subroutine add_integrated_shear_forces(n, inverse, shear, f)
    !> Number of points, 9 or 4
    integer, intent(in) :: n
    real(wp), intent(in) :: inverse(lanes, n, 4)
    !> Shear forces xz, yz, times the areas of the points
    real(wp), intent(in) :: shear(lanes, n, 2)
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: x_slopes(lanes, n, 9), y_slopes(lanes, n, 9), values(9, n)
    integer :: a, g, lane

    call slopes_and_values(n, inverse, x_slopes, y_slopes, values)
    do g = 1, n
      do a = 1, 9
        do lane = 1, lanes
          f(lane, a, 3) = f(lane, a, 3) + x_slopes(lane, g, a)*shear(lane, g, 1) &
                          + y_slopes(lane, g, a)*shear(lane, g, 2)
          f(lane, a, 4) = f(lane, a, 4) + values(a, g)*shear(lane, g, 1)
          f(lane, a, 5) = f(lane, a, 5) + values(a, g)*shear(lane, g, 2)
        end do
      end do
    end do
  end subroutine add_integrated_shear_forces
end module integrated_shear
