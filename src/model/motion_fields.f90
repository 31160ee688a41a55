!> Fields of the motion of the plate.
module motion_fields
  use errors, only: error_t
  use fields_file, only: fields_file_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use motions, only: motion_t
  use output_parameters, only: output_t, field_displacement, field_rotation, field_velocity
  use result_tables, only: result_row_length
  implicit none
  private
  public :: write_motion_fields

  !> The fields. All layers measure z from the mid-plane of the laminate.
  character(len=result_row_length), parameter, public :: motion_field_rows(*) = [character(len=result_row_length) :: &
    'displacement | points | length | '//field_displacement//' | - | Displacement u, v, w of each layer where z is 0, &
      &the mid-plane of the laminate; w is positive along the impact.', &
    'rotation_1 | points | radian | '//field_rotation//' | - | Rotation theta_x of the layer''s normal towards x: &
      &u(z) = u + z theta_x.', &
    'rotation_2 | points | radian | '//field_rotation//' | - | Rotation theta_y of the layer''s normal towards y: &
      &v(z) = v + z theta_y.', &
    'velocity | points | length/time | '//field_velocity//' | - | Velocity, the rate of the displacement.']

contains

  !> Writes the requested fields.
  subroutine write_motion_fields(plate, motion, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    type(motion_t), intent(in) :: motion
    type(output_t), intent(in) :: output
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: layers(:, :)

    layers = plate%motion_of(motion%displacement)
    if (output%requests(field_displacement)) call fields%write_point_field('displacement', layers(1:3, :), error)
    if (output%requests(field_rotation)) call fields%write_point_field('rotation', layers(4:5, :), error)
    layers = plate%motion_of(motion%velocity)
    if (output%requests(field_velocity)) call fields%write_point_field('velocity', layers(1:3, :), error)
  end subroutine write_motion_fields
end module motion_fields
