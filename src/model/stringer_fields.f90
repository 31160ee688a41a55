!> Fields of stringers: forces, moments and strains at the cells beside them.
module stringer_fields
  use element_batches, only: first_element, lanes
  use errors, only: error_t
  use fields_file, only: fields_file_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use output_parameters, only: field_displacement, output_t
  use reference_fields, only: gather
  use result_tables, only: result_row_length
  use stiffened_elements, only: strains_of_beam
  use stringer_columns, only: columns, resultants
  implicit none
  private
  public :: write_stringer_fields

  !> Columns of a row between unit and meaning.
  character(len=*), parameter :: requested = field_displacement//' | - | '
  !> The fields.
  character(len=*), parameter, public :: stringer_field_rows(*) = [character(len=result_row_length) :: &
    'stringer_force | cells | force | '//requested//'Axial force of the &stringer at the element, the largest in &
      &magnitude, positive in tension; 0 elsewhere.', &
    'stringer_moment | cells | energy | '//requested//'Its bending moment about the centroid.', &
    'stringer_torque | cells | energy | '//requested//'Its torsional moment.', &
    'stringer_strain | cells | - | '//requested//'Strain along it at its free edge.']
  !> Names of the fields.
  character(len=*), parameter :: names(columns) = [character(len=15) :: 'stringer_force', 'stringer_moment', &
                                                   'stringer_torque', 'stringer_strain']

contains

  !> Writes them if there are stringers.
  subroutine write_stringer_fields(plate, displacement, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    type(output_t), intent(in) :: output
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: values(columns, plate%elements%elements)
    integer :: i

    if (.not. allocated(plate%setup%stringers)) return
    if (size(plate%setup%stringers) == 0 .or. .not. output%requests(field_displacement)) return
    call find_values(plate, displacement, values)
    do i = 1, columns
      call fields%write_cell_field(trim(names(i)), values(i:i, :), error)
    end do
  end subroutine write_stringer_fields

  !> The largest value in magnitude at each of this rank's elements.
  subroutine find_values(plate, displacement, values)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> (column, element)
    real(wp), intent(out) :: values(:, :)
    real(wp) :: r(lanes, 9, 5), found(columns, 3)
    real(wp), allocatable :: motion(:, :)
    integer :: b, k, i

    values = 0
    motion = plate%motion_of(displacement)
    do b = 1, plate%elements%batches
      if (.not. plate%elements%has_beams(b)) cycle
      call gather(plate%elements%points(:, :, b), motion, r)
      do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
        found = resultants(plate, k, strains_of_beam(plate%elements, k, plate%setup%mesh%kinematics, r))
        associate (value => values(:, first_element(b) + plate%elements%beams(k)%lane - 1))
          do i = 1, 3
            where (abs(found(:, i)) > abs(value)) value = found(:, i)
          end do
        end associate
      end do
    end do
  end subroutine find_values
end module stringer_fields
