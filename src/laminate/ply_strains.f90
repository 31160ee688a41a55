!> Strains of one ply of an element that determine its damage: means over its volume, and means of squares.
module ply_strains
  use crack_bands, only: band_strains_t
  use kinds, only: wp
  use plies, only: ply_t
  implicit none
  private
  public :: strain_moments_t, strains_of_ply, moments_from, invariant_measure

  !> Number of values of the means.
  integer, parameter, public :: moment_values = 33

  !> Means over an element's area.
  type :: strain_moments_t
    !> Strains exx, eyy, gxy, kxx, kyy, kxy
    real(wp) :: mean(6) = 0
    !> Products of membrane strains, of membrane strains and curvatures, and of curvatures
    real(wp) :: membrane(3, 3) = 0, mixed(3, 3) = 0, curvature(3, 3) = 0
  end type strain_moments_t

contains

  !> Root mean square of strains in the measure of `onset_strain`, which is invariant under rotation.
  pure real(wp) function invariant_measure(products) result(size)
    !> Means of their products
    real(wp), intent(in) :: products(3, 3)

    size = sqrt(products(1, 1) + products(2, 2) + products(3, 3)/2)
  end function invariant_measure

  !> The means from one array.
  pure function moments_from(values) result(moments)
    !> Strains, then the three products
    real(wp), intent(in) :: values(moment_values)
    type(strain_moments_t) :: moments
    integer :: i

    moments%mean = values(:6)
    do i = 1, 3
      moments%membrane(:, i) = values(3*i + 4:3*i + 6)
      moments%mixed(:, i) = values(3*i + 13:3*i + 15)
      moments%curvature(:, i) = values(3*i + 22:3*i + 24)
    end do
  end function moments_from

  !> Strains of a ply in its material axes, minus stress-free strains.
  pure function strains_of_ply(ply, moments) result(strains)
    type(ply_t), intent(in) :: ply
    !> Strains of the element
    type(strain_moments_t), intent(in) :: moments
    !> Means over the ply's volume in the element
    type(band_strains_t) :: strains
    real(wp) :: along(3), across(3), shear(3), squares(3, 3), middle, spread

    associate (c => ply%cosine, s => ply%sine)
      along = [c*c, s*s, c*s]
      across = [s*s, c*c, -c*s]
      shear = [-2*c*s, 2*c*s, c*c - s*s]
    end associate
    middle = (ply%z_top + ply%z_bottom)/2
    spread = middle**2 + (ply%z_bottom - ply%z_top)**2/12
    squares = moments%membrane + middle*(moments%mixed + transpose(moments%mixed)) + spread*moments%curvature
    strains%mean = [dot_product(along, moments%mean(1:3) + middle*moments%mean(4:6)), &
                    dot_product(across, moments%mean(1:3) + middle*moments%mean(4:6))]
    strains%square = [dot_product(along, matmul(squares, along)), dot_product(across, matmul(squares, across)), &
                      dot_product(along, matmul(squares, across))]
    strains%rise = (ply%z_bottom - ply%z_top)*[dot_product(along, moments%mean(4:6)), &
                                               dot_product(across, moments%mean(4:6))]
    strains%sub_plies = ply%sub_plies
    associate (mean => strains%mean, free => ply%free_strain(:2))
      strains%square = strains%square - [(2*mean(1) - free(1))*free(1), (2*mean(2) - free(2))*free(2), &
                                         mean(1)*free(2) + mean(2)*free(1) - free(1)*free(2)]
      mean = mean - free
    end associate
    strains%shear_mean = dot_product(shear, moments%mean(1:3) + middle*moments%mean(4:6))
    strains%shear_square = max(0.0_wp, dot_product(shear, matmul(squares, shear)))
  end function strains_of_ply
end module ply_strains
