!> Choices of the element.
module plate_options
  implicit none
  private

  !> Transverse shear of the element: assumed strains (Huang-Hinton), 3x3 integration, 2x2 integration.
  integer, parameter, public :: shear_assumed = 1, shear_full = 2, shear_selective = 3
  !> Strains: linear, or von Karman's (squares of the slopes kept).
  integer, parameter, public :: kinematics_linear = 1, kinematics_von_karman = 2
  !> Mass: consistent, or lumped at the nodes by nodal quadrature.
  integer, parameter, public :: mass_consistent = 1, mass_lumped = 2
end module plate_options
