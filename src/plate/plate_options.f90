!> Choices of the element.
module plate_options
  use kinds, only: wp
  implicit none
  private

  !> Transverse shear of the element: assumed strains (Huang-Hinton), 3x3 integration, 2x2 integration.
  integer, parameter, public :: shear_assumed = 1, shear_full = 2, shear_selective = 3
  !> Strains: linear, or von Karman's (squares of the slopes kept).
  integer, parameter, public :: kinematics_linear = 1, kinematics_von_karman = 2
  !> Largest rotation with a cosine of about 1, as assumed by von Karman's strains: the error is 2 %.
  real(wp), parameter, public :: max_slope = 0.2_wp
  !> Mass: consistent, or lumped at the nodes by nodal quadrature.
  integer, parameter, public :: mass_consistent = 1, mass_lumped = 2
end module plate_options
