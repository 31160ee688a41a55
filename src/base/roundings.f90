!> Tolerance within which numbers count as equal in spite of round-off.
module roundings
  use kinds, only: wp
  implicit none
  private

  !> Relative difference of two lengths, areas or sums below which they are equal: above 1e-10, the round-off of a sum
  !> of 1e6 numbers with a precision of 1e-16, and below the last digit of a deck and any part of a cell.
  real(wp), parameter, public :: rounding = 1.0e-9_wp
end module roundings
