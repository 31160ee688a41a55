!> Saves and loads the section stiffness of the damaged elements.
module section_stiffnesses
  use field_mappings, only: area_field
  use kinds, only: wp
  use archives, only: archive_t
  use element_batches, only: batch_of, lane_of
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: visit_stiffness

contains

  !> Saves or loads a section stiffness.
  subroutine visit_stiffness(archive, name, plate, stiffness)
    class(archive_t), intent(inout) :: archive
    !> Name of the item
    character(len=*), intent(in) :: name
    type(composite_plate_t), intent(in) :: plate
    !> Section stiffness of this rank's elements, (lanes, 21, batches)
    real(wp), intent(inout) :: stiffness(:, :, :)
    real(wp) :: values(21, plate%elements%elements)
    integer :: element

    do element = 1, size(values, 2)
      values(:, element) = stiffness(lane_of(element), :, batch_of(element))
    end do
    call archive%field(name, plate%distribution%elements, plate%mesh%elements(), values, area_field)
    do element = 1, size(values, 2)
      stiffness(lane_of(element), :, batch_of(element)) = values(:, element)
    end do
  end subroutine visit_stiffness
end module section_stiffnesses
