!> Strains of one ply of an element that determine its damage: means over its volume, and means of squares.
module ply_strains
  use crack_bands, only: band_strains_t
  use kinds, only: wp
  use plies, only: ply_t
  implicit none
  private
  public :: strain_moments_t, strain_moments, strains_of_ply, values_of, moments_from

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

  !> Means over an element of its strains and of their products.
  pure function strain_moments(weight, strains) result(moments)
    !> Area of each point
    real(wp), intent(in) :: weight(:)
    !> Strains exx, eyy, gxy, kxx, kyy, kxy, (points, 6)
    real(wp), intent(in) :: strains(:, :)
    !> The means
    type(strain_moments_t) :: moments
    real(wp) :: product(6), share, area
    integer :: g, i

    area = sum(weight)
    do g = 1, size(weight)
      share = weight(g)/area
      moments%mean = moments%mean + share*strains(g, :)
      do i = 1, 3
        product = share*strains(g, :)*strains(g, i)
        moments%membrane(:, i) = moments%membrane(:, i) + product(1:3)
        moments%mixed(:, i) = moments%mixed(:, i) + product(4:6)
        moments%curvature(:, i) = moments%curvature(:, i) + share*strains(g, 4:6)*strains(g, 3 + i)
      end do
    end do
  end function strain_moments

  !> The means in one array.
  pure function values_of(moments) result(values)
    !> The means
    type(strain_moments_t), intent(in) :: moments
    !> Strains, then products
    real(wp) :: values(moment_values)

    values = [moments%mean, reshape(moments%membrane, [9]), reshape(moments%mixed, [9]), &
              reshape(moments%curvature, [9])]
  end function values_of

  !> The means from the result of `values_of`.
  pure function moments_from(values) result(moments)
    !> Strains, then products
    real(wp), intent(in) :: values(moment_values)
    !> The means
    type(strain_moments_t) :: moments

    moments%mean = values(:6)
    moments%membrane = reshape(values(7:15), [3, 3])
    moments%mixed = reshape(values(16:24), [3, 3])
    moments%curvature = reshape(values(25:33), [3, 3])
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
