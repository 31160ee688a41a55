!> Bounds that exclude elements in which no ply can be damaged.
module strain_bounds
  use element_batches, only: lanes
  use kinds, only: wp
  use plies, only: ply_t
  implicit none
  private
  public :: largest_strains

contains

  !> Bounds of the strains in the planes of all plies of a batch, root mean squares over each ply's volume.
  pure function largest_strains(plies, weight, strains) result(bounds)
    !> Plies of the laminate
    type(ply_t), intent(in) :: plies(:)
    !> Area of each Gauss point
    real(wp), intent(in) :: weight(lanes, 9)
    !> Strains exx, eyy, gxy, kxx, kyy, kxy (lane, point, component)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    !> In the measure of onset_strain, (lane)
    real(wp) :: bounds(lanes)
    real(wp) :: membrane(lanes), curvature(lanes), area(lanes), height
    integer :: g

    membrane = 0
    curvature = 0
    area = tiny(area)
    do g = 1, 9
      area = area + weight(:, g)
      membrane = membrane + weight(:, g)*(strains(:, g, 1)**2 + strains(:, g, 2)**2 + strains(:, g, 3)**2/2)
      curvature = curvature + weight(:, g)*(strains(:, g, 4)**2 + strains(:, g, 5)**2 + strains(:, g, 6)**2/2)
    end do
    height = max(abs(plies(1)%z_top), abs(plies(size(plies))%z_bottom))
    bounds = sqrt(membrane/area) + height*sqrt(curvature/area)
  end function largest_strains
end module strain_bounds
