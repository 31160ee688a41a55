!> Numbers of mathematics.
module mathematical_constants
  use kinds, only: wp
  implicit none
  private

  !> Half of a turn, and a degree, in radians
  real(wp), parameter, public :: pi = acos(-1.0_wp), degree = pi/180
end module mathematical_constants
