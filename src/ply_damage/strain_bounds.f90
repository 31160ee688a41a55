!> Strains of a batch of elements that determine the damage of their plies, and bounds that exclude elements in which no
!> ply can be damaged.
module strain_bounds
  use element_batches, only: lanes
  use kinds, only: wp
  use ply_strains, only: moment_values
  implicit none
  private
  public :: strain_sizes, strain_moments

contains

  !> Root mean squares of the membrane strains and of the curvatures of a batch over each element's area, in the measure
  !> of `onset_strain`. At a distance z from the middle surface strains are at most the first plus z times the second.
  pure function strain_sizes(weight, strains) result(sizes)
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    !> (lane, membrane and curvature)
    real(wp) :: sizes(lanes, 2)
    real(wp) :: area(lanes), membrane(lanes), curvature(lanes)
    integer :: g

    membrane = 0
    curvature = 0
    area = tiny(area)
    do g = 1, 9
      area = area + weight(:, g)
      membrane = membrane + weight(:, g)*(strains(:, g, 1)**2 + strains(:, g, 2)**2 + strains(:, g, 3)**2/2)
      curvature = curvature + weight(:, g)*(strains(:, g, 4)**2 + strains(:, g, 5)**2 + strains(:, g, 6)**2/2)
    end do
    sizes(:, 1) = sqrt(membrane/area)
    sizes(:, 2) = sqrt(curvature/area)
  end function strain_sizes

  !> Means over each element of its strains and of their products.
  pure function strain_moments(weight, strains) result(moments)
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    !> In the order of `moments_from`
    real(wp) :: moments(lanes, moment_values)
    real(wp) :: share(lanes), area(lanes), mean(lanes, 6)
    real(wp), dimension(lanes, 3, 3) :: membrane, mixed, curvature
    integer :: g, i, k, lane

    area = tiny(area)
    do g = 1, 9
      area = area + weight(:, g)
    end do
    mean = 0
    membrane = 0
    mixed = 0
    curvature = 0
    do g = 1, 9
      share = weight(:, g)/area
      do k = 1, 6
        do lane = 1, lanes
          mean(lane, k) = mean(lane, k) + share(lane)*strains(lane, g, k)
        end do
      end do
      do i = 1, 3
        do k = 1, 3
          do lane = 1, lanes
            membrane(lane, k, i) = membrane(lane, k, i) + share(lane)*strains(lane, g, k)*strains(lane, g, i)
            mixed(lane, k, i) = mixed(lane, k, i) + share(lane)*strains(lane, g, 3 + k)*strains(lane, g, i)
            curvature(lane, k, i) = curvature(lane, k, i) + share(lane)*strains(lane, g, 3 + k)*strains(lane, g, 3 + i)
          end do
        end do
      end do
    end do
    moments(:, :6) = mean
    do i = 1, 3
      moments(:, 3*i + 4:3*i + 6) = membrane(:, :, i)
      moments(:, 3*i + 13:3*i + 15) = mixed(:, :, i)
      moments(:, 3*i + 22:3*i + 24) = curvature(:, :, i)
    end do
  end function strain_moments
end module strain_bounds
