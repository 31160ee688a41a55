!> The motion of the plate and its forces.
module motions
  use kinds, only: wp
  implicit none
  private
  public :: motion_t

  !> Motion of the plate at one time; fields over this rank's points, (5, points).
  type :: motion_t
    !> Displacement, velocity and acceleration
    real(wp), allocatable :: displacement(:, :), velocity(:, :), acceleration(:, :)
    !> Internal forces, mass times acceleration and mass times velocity, summed at the owned points
    real(wp), allocatable :: internal(:, :), inertia(:, :), momentum(:, :)
  end type motion_t
end module motions
