!> The fewest decimal digits that distinguish a double from all others, in a twentieth of the time of writing and
!> reading it. Cases that double the precision cannot decide are reported.
module shortest_digits
  use, intrinsic :: iso_fortran_env, only: real128
  use kinds, only: long, wp
  implicit none
  private
  public :: find_shortest

  !> Largest decimal exponent of the numbers that are treated; for larger ones the powers of ten exceed the range of
  !> doubles.
  integer, parameter :: most = 280
  !> Relative distance from a bound within which a case is not decided; the products are exact to 1e-15 of a last digit.
  real(wp), parameter :: tie_tolerance = 1.0e-12_wp

contains

  !> The nearest number of 15 digits if it reads back as the same double, otherwise that of 16 digits, otherwise that of
  !> 17.
  pure subroutine find_shortest(value, digits, exponent, known)
    !> The number, > 0
    real(wp), intent(in) :: value
    !> Its digits as an integer
    integer(long), intent(out) :: digits
    !> Power of ten of the last digit
    integer, intent(out) :: exponent
    !> False: undecided in this precision
    logical, intent(out) :: known
    integer :: power
    ! Exact up to 10**48, and to 34 digits beyond.
    real(real128), parameter :: ten(-most:most + 20) = [(10.0_real128**power, power=-most, most + 20)]
    real(real128) :: scaled
    real(wp) :: bound(2), part, off
    integer(long) :: whole, unit
    integer :: dropped

    digits = 0
    exponent = 0
    known = value > 10.0_wp**(1 - most) .and. value < 10.0_wp**(most - 1)
    if (.not. known) return
    ! 17 digits before the point
    exponent = floor(log10(value)) - 16
    if (value*ten(-exponent) >= ten(17)) exponent = exponent + 1
    if (value*ten(-exponent) < ten(16)) exponent = exponent - 1
    scaled = value*ten(-exponent)
    whole = int(scaled, long)
    ! A number closer than half the distance to the next double reads back. Below a power of two doubles are denser.
    bound(2) = real(spacing(value)*ten(-exponent), wp)/2
    bound(1) = bound(2)
    if (.not. abs(fraction(value)) > 0.5_wp) bound(1) = bound(2)/2
    do dropped = 2, 0, -1
      unit = 10_long**dropped
      part = real(mod(whole, unit), wp) + real(scaled - whole, wp)
      digits = whole/unit
      if (2*part > unit) digits = digits + 1
      off = min(part, unit - part)
      if (dropped > 0 .and. off > bound(2)*(1 + tie_tolerance)) cycle
      known = abs(2*part - unit) > tie_tolerance*unit .and. (dropped == 0 .or. off < bound(1)*(1 - tie_tolerance))
      exit
    end do
    exponent = exponent + dropped
  end subroutine find_shortest
end module shortest_digits
