!> Discrete Fourier transforms, and sums of sines of arbitrary frequencies computed by these.
module fourier_transforms
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: fourier, roots_of_unity, sums_of_sines

  !> Number of grid points on either side over which a sine is distributed: 12 give twelve digits with a grid twice as
  !> fine as needed (L. Greengard, J.-Y. Lee, Accelerating the nonuniform fast Fourier transform, SIAM Review 46 (2004),
  !> table 1).
  integer, parameter :: spread_points = 12

contains

  !> exp(-2 pi i j/number) for j = 0 to number/2 - 1, for transforms of `number` values or of a number that divides it.
  pure function roots_of_unity(number) result(roots)
    !> Number of values, a power of two
    integer, intent(in) :: number
    !> The roots
    complex(wp), allocatable :: roots(:)
    integer :: j

    roots = [(exp(cmplx(0.0_wp, -2*pi*j/number, wp)), j=0, number/2 - 1)]
  end function roots_of_unity

  !> Transforms values in place, to sum_k value_k exp(-2 pi i j k/number), by Stockham's method.
  pure subroutine fourier(values, roots)
    !> The values; their number is a power of two
    complex(wp), intent(inout), contiguous :: values(0:)
    !> `roots_of_unity` for this number, or for a power of two times it
    complex(wp), intent(in), contiguous :: roots(0:)
    complex(wp), allocatable :: other(:)
    integer :: half, together, stride

    allocate (other(size(values)))
    half = size(values)/2
    together = 1
    stride = 2*size(roots)/size(values)
    do while (half >= 1)
      call halve(half, together, roots(0::stride*together), values, other)
      half = half/2
      together = 2*together
      if (half >= 1) then
        call halve(half, together, roots(0::stride*together), other, values)
      else
        values = other
      end if
      half = half/2
      together = 2*together
    end do
  end subroutine fourier

  !> One pass of a transform.
  pure subroutine halve(half, together, roots, from, to)
    !> Number of pairs, and of adjacent values in each
    integer, intent(in) :: half, together
    !> Root of unity of each pair
    complex(wp), intent(in) :: roots(0:)
    !> Values before
    complex(wp), intent(in) :: from(together, 0:half - 1, 0:1)
    !> Values after
    complex(wp), intent(out) :: to(together, 0:1, 0:half - 1)
    integer :: j

    do j = 0, half - 1
      to(:, 0, j) = from(:, j, 0) + from(:, j, 1)
      to(:, 1, j) = roots(j)*(from(:, j, 0) - from(:, j, 1))
    end do
  end subroutine halve

  !> Sums of weight sin(n angle) over all angles for n = 1 to number, each to about twelve digits of the sum of the
  !> weights. Each angle is distributed over a grid as a Gaussian, and the transform of the grid is divided by that of
  !> the Gaussian.
  pure function sums_of_sines(angle, weight, number) result(sums)
    !> Angles, from 0 to pi, and their weights
    real(wp), intent(in) :: angle(:), weight(:)
    !> Number of sums, a power of two
    integer, intent(in) :: number
    real(wp) :: sums(number)
    complex(wp), allocatable :: grid(:)
    real(wp) :: bell(1 - spread_points:spread_points), narrow(1 - spread_points:spread_points)
    real(wp) :: width, apart, place, ratio
    integer :: i, j, nearest, points

    points = 4*number
    apart = 2*pi/points
    ! Width of the Gaussian that makes both truncation errors equal, for a grid twice as fine.
    width = pi*spread_points/(3*real(number, wp)**2*4)
    allocate (grid(0:points - 1), source=(0.0_wp, 0.0_wp))
    narrow = [(exp(-(j*apart)**2/(4*width)), j=1 - spread_points, spread_points)]
    do i = 1, size(angle)
      nearest = int(angle(i)/apart)
      place = angle(i) - nearest*apart
      ratio = exp(place*apart/(2*width))
      bell(0) = weight(i)*exp(-place**2/(4*width))
      do j = 1, spread_points
        bell(j) = bell(j - 1)*ratio
      end do
      do j = -1, 1 - spread_points, -1
        bell(j) = bell(j + 1)/ratio
      end do
      bell = bell*narrow
      do j = 1 - spread_points, spread_points
        associate (point => grid(iand(nearest + j, points - 1)))
          point = point + bell(j)
        end associate
      end do
    end do
    call fourier(grid, roots_of_unity(points))
    sums = [(-sqrt(pi/width)*exp(width*real(i, wp)**2)/points*aimag(grid(i)), i=1, number)]
  end function sums_of_sines
end module fourier_transforms
