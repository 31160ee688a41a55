!> Section forces and moments of a batch of elements from its generalised strains, theory (P4) and (P5).
module batch_resultants
  use kinds, only: wp
  use element_batches, only: lanes
  implicit none
  private
  public :: in_plane_resultants, shear_resultants, add_free_energy, take_free_resultants, element_means, mean_resultants

contains

  !> Turns membrane strains and curvatures into membrane forces and moments times the areas of the Gauss points.
  pure subroutine in_plane_resultants(c, weight, s, energies)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Strains on entry, resultants on return (lane, point, component)
    real(wp), intent(inout) :: s(lanes, 9, 6)
    real(wp), intent(inout) :: energies(lanes)
    real(wp) :: exx, eyy, gxy, kxx, kyy, kxy, nxx, nyy, nxy, mxx, myy, mxy
    integer :: g, lane

    do g = 1, 9
      do lane = 1, lanes
        exx = s(lane, g, 1)*weight(lane, g)
        eyy = s(lane, g, 2)*weight(lane, g)
        gxy = s(lane, g, 3)*weight(lane, g)
        kxx = s(lane, g, 4)*weight(lane, g)
        kyy = s(lane, g, 5)*weight(lane, g)
        kxy = s(lane, g, 6)*weight(lane, g)
        nxx = c(lane, 1)*exx + c(lane, 2)*eyy + c(lane, 3)*gxy + c(lane, 7)*kxx + c(lane, 8)*kyy + c(lane, 9)*kxy
        nyy = c(lane, 2)*exx + c(lane, 4)*eyy + c(lane, 5)*gxy + c(lane, 8)*kxx + c(lane, 10)*kyy + c(lane, 11)*kxy
        nxy = c(lane, 3)*exx + c(lane, 5)*eyy + c(lane, 6)*gxy + c(lane, 9)*kxx + c(lane, 11)*kyy + c(lane, 12)*kxy
        mxx = c(lane, 7)*exx + c(lane, 8)*eyy + c(lane, 9)*gxy + c(lane, 13)*kxx + c(lane, 14)*kyy + c(lane, 15)*kxy
        myy = c(lane, 8)*exx + c(lane, 10)*eyy + c(lane, 11)*gxy + c(lane, 14)*kxx + c(lane, 16)*kyy + c(lane, 17)*kxy
        mxy = c(lane, 9)*exx + c(lane, 11)*eyy + c(lane, 12)*gxy + c(lane, 15)*kxx + c(lane, 17)*kyy + c(lane, 18)*kxy
        energies(lane) = energies(lane) + 0.5_wp*(s(lane, g, 1)*nxx + s(lane, g, 2)*nyy + s(lane, g, 3)*nxy &
                                                  + s(lane, g, 4)*mxx + s(lane, g, 5)*myy + s(lane, g, 6)*mxy)
        s(lane, g, 1) = nxx
        s(lane, g, 2) = nyy
        s(lane, g, 3) = nxy
        s(lane, g, 4) = mxx
        s(lane, g, 5) = myy
        s(lane, g, 6) = mxy
      end do
    end do
  end subroutine in_plane_resultants

  !> Means of the strains of the elements of a batch.
  pure function element_means(weight, strains) result(means)
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    !> The means, (lane, component)
    real(wp) :: means(lanes, 6)
    real(wp) :: share(lanes)
    integer :: i, lane

    do lane = 1, lanes
      associate (w => weight(lane, :))
        share(lane) = 1/(tiny(share) + w(1) + w(2) + w(3) + w(4) + w(5) + w(6) + w(7) + w(8) + w(9))
      end associate
    end do
    do i = 1, 6
      do lane = 1, lanes
        associate (w => weight(lane, :), s => strains(lane, :, i))
          means(lane, i) = share(lane)*(w(1)*s(1) + w(2)*s(2) + w(3)*s(3) + w(4)*s(4) + w(5)*s(5) + w(6)*s(6) &
                                        + w(7)*s(7) + w(8)*s(8) + w(9)*s(9))
        end associate
      end do
    end do
  end function element_means

  !> Forces and moments of mean strains.
  pure function mean_resultants(c, e) result(f)
    !> Changes of the sections against mean strains: A, B, D
    real(wp), intent(in) :: c(lanes, 18)
    !> Mean strains
    real(wp), intent(in) :: e(lanes, 6)
    !> Nxx to Mxy
    real(wp) :: f(lanes, 6)
    integer :: i

    do i = 1, lanes
      f(i, 1) = c(i, 1)*e(i, 1) + c(i, 2)*e(i, 2) + c(i, 3)*e(i, 3) + c(i, 7)*e(i, 4) + c(i, 8)*e(i, 5) &
                + c(i, 9)*e(i, 6)
      f(i, 2) = c(i, 2)*e(i, 1) + c(i, 4)*e(i, 2) + c(i, 5)*e(i, 3) + c(i, 8)*e(i, 4) + c(i, 10)*e(i, 5) &
                + c(i, 11)*e(i, 6)
      f(i, 3) = c(i, 3)*e(i, 1) + c(i, 5)*e(i, 2) + c(i, 6)*e(i, 3) + c(i, 9)*e(i, 4) + c(i, 11)*e(i, 5) &
                + c(i, 12)*e(i, 6)
      f(i, 4) = c(i, 7)*e(i, 1) + c(i, 8)*e(i, 2) + c(i, 9)*e(i, 3) + c(i, 13)*e(i, 4) + c(i, 14)*e(i, 5) &
                + c(i, 15)*e(i, 6)
      f(i, 5) = c(i, 8)*e(i, 1) + c(i, 10)*e(i, 2) + c(i, 11)*e(i, 3) + c(i, 14)*e(i, 4) + c(i, 16)*e(i, 5) &
                + c(i, 17)*e(i, 6)
      f(i, 6) = c(i, 9)*e(i, 1) + c(i, 11)*e(i, 2) + c(i, 12)*e(i, 3) + c(i, 15)*e(i, 4) + c(i, 17)*e(i, 5) &
                + c(i, 18)*e(i, 6)
    end do
  end function mean_resultants

  !> Adds the contribution of stress-free strains to the strain energy.
  pure subroutine add_free_energy(free, weight, s, energies)
    !> Resultants Nxx to Mxy of the stress-free strains, and their energy per area
    real(wp), intent(in) :: free(lanes, 7)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Strains (lane, point, component)
    real(wp), intent(in) :: s(lanes, 9, 6)
    real(wp), intent(inout) :: energies(lanes)
    integer :: g, i

    do g = 1, 9
      energies = energies + weight(:, g)*free(:, 7)
      do i = 1, 6
        energies = energies - weight(:, g)*free(:, i)*s(:, g, i)
      end do
    end do
  end subroutine add_free_energy

  !> Subtracts the resultants of the stress-free strains from those of the total strains.
  pure subroutine take_free_resultants(free, weight, s)
    !> Resultants Nxx to Mxy of the stress-free strains, and their energy per area
    real(wp), intent(in) :: free(lanes, 7)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Resultants times the areas (lane, point, component)
    real(wp), intent(inout) :: s(lanes, 9, 6)
    integer :: g, i

    do i = 1, 6
      do g = 1, 9
        s(:, g, i) = s(:, g, i) - weight(:, g)*free(:, i)
      end do
    end do
  end subroutine take_free_resultants

  !> Turns shear strains into shear forces times the areas of the shear points.
  pure subroutine shear_resultants(n, c, weight, s, energies)
    !> Number of shear points
    integer, intent(in) :: n
    real(wp), intent(in) :: c(lanes, 21)
    !> Area of each shear point
    real(wp), intent(in) :: weight(lanes, n)
    !> Strains on entry, shear forces on return (lane, point, component)
    real(wp), intent(inout) :: s(lanes, n, 2)
    real(wp), intent(inout) :: energies(lanes)
    real(wp) :: xz, yz
    integer :: g, lane

    do g = 1, n
      do lane = 1, lanes
        xz = weight(lane, g)*(c(lane, 19)*s(lane, g, 1) + c(lane, 20)*s(lane, g, 2))
        yz = weight(lane, g)*(c(lane, 20)*s(lane, g, 1) + c(lane, 21)*s(lane, g, 2))
        energies(lane) = energies(lane) + 0.5_wp*(s(lane, g, 1)*xz + s(lane, g, 2)*yz)
        s(lane, g, 1) = xz
        s(lane, g, 2) = yz
      end do
    end do
  end subroutine shear_resultants
end module batch_resultants
