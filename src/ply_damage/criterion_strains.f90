!> Strains for the failure criteria: means over each element.
module criterion_strains
  use kinds, only: wp
  use element_batches, only: lanes, first_element
  use strain_recovery, only: mean_strains
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: mean_strains_of_elements

contains

  !> Mean strains of this rank's elements.
  function mean_strains_of_elements(plate, displacement) result(strains)
    type(composite_plate_t), intent(in) :: plate
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Membrane exx, eyy, gxy; curvature kxx, kyy, kxy; transverse shear gxz, gyz of the plate, (8, elements)
    real(wp), allocatable :: strains(:, :)
    real(wp) :: means(lanes, 8)
    real(wp), allocatable :: motion(:, :)
    integer :: b, lane

    allocate (strains(8, plate%elements%elements))
    motion = plate%motion_of(displacement)
    do b = 1, plate%elements%batches
      call mean_strains(plate%elements, b, plate%setup%mesh%kinematics, motion, means)
      do lane = 1, plate%elements%lanes_used(b)
        strains(:, first_element(b) + lane - 1) = means(lane, :)
      end do
    end do
  end function mean_strains_of_elements
end module criterion_strains
