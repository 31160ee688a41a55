!> Fields of the field file, joined from the rows of each folder.
module field_results
  use section_bounds, only: uniform_stiffness
  use deck_contents, only: deck_t
  use errors, only: error_t
  use field_datasets, only: global_numbers_t
  use fields_file, only: fields_file_t
  use interface_fields, only: interface_field_rows, starters_above, write_interface_fields
  use kinds, only: wp
  use mesh_parameters, only: initial_deflection
  use composite_plates, only: composite_plate_t
  use motion_fields, only: motion_field_rows, write_motion_fields
  use output_clocks, only: shown_time
  use output_parameters, only: output_t
  use plate_deck, only: plate_group, key_symmetry
  use ply_fields, only: ply_field_rows, write_ply_fields
  use result_tables, only: result_row_length
  use text, only: lower_case
  use steppers, only: stepper_t
  use stringer_fields, only: stringer_field_rows, write_stringer_fields
  implicit none
  private
  public :: part_of, write_fields, write_mesh

  !> Constant fields of the mesh.
  character(len=*), parameter :: mesh_field_rows(*) = [character(len=result_row_length) :: &
    'first_ply | cells | - | - | - | First ply of the element''s layer, from the struck face.', &
    'last_ply | cells | - | - | - | Last ply of the element''s layer.', &
    'starter_above | cells | - | - | - | 1 in elements whose interface on top was delaminated before the run, else 0.']

  !> The table of fields.
  character(len=*), parameter, public :: field_rows(*) = [character(len=result_row_length) :: &
    mesh_field_rows, motion_field_rows, stringer_field_rows, interface_field_rows, ply_field_rows]

contains

  !> Modelled part of the plate.
  pure function part_of(deck) result(part)
    type(deck_t), intent(in) :: deck
    !> As symmetry names it, or 'whole'
    character(len=:), allocatable :: part

    part = lower_case(deck%settings%text_of(plate_group, key_symmetry))
    if (part == 'none') part = 'whole'
  end function part_of

  !> Writes points at the heights of their layers, and elements.
  subroutine write_mesh(plate, fields, error)
    type(composite_plate_t), intent(in) :: plate
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: coordinates(3, plate%distribution%owned)
    integer :: values(3, plate%elements%elements), i

    associate (mesh => plate%mesh, partition => plate%distribution)
      coordinates(1:2, :) = mesh%node_coordinates(:, mesh%point_node(partition%points(:partition%owned)))
      coordinates(3, :) = heights(plate)
      values(:2, :) = reshape([(mesh%plies_of(partition%elements(i)), i=1, size(values, 2))], [2, size(values, 2)])
      ! The layer of a doubler lies below the last ply of the laminate, and has none of them.
      values(2, :) = min(values(2, :), mesh%plies)
      values(3, :) = starters_above(plate)
      call fields%write_mesh(global_numbers_t(partition%points(:partition%owned), mesh%points()), &
                             global_numbers_t(partition%elements, mesh%elements()), coordinates, &
                             mesh%connectivity(:, partition%elements), &
                             [character(len=13) :: 'first_ply', 'last_ply', 'starter_above'], values, error)
    end associate
  end subroutine write_mesh

  !> Heights at which the owned points are drawn: the middle of their layer, or of the laminate where there is one
  !> layer, on the stress-free shape.
  pure function heights(plate) result(z)
    type(composite_plate_t), intent(in) :: plate
    !> Height of each owned point
    real(wp) :: z(plate%distribution%owned)
    integer :: i

    associate (mesh => plate%mesh, partition => plate%distribution)
      z = [(initial_deflection(plate%setup%plate, mesh%node_coordinates(:, mesh%point_node(partition%points(i)))), &
            i=1, partition%owned)]
    end associate
    if (plate%map%layered) z = z + middles_of_layers(plate)
  end function heights

  !> Heights of the middles of layers above the mid-plane.
  pure function middles_of_layers(plate) result(z)
    type(composite_plate_t), intent(in) :: plate
    !> Height of each owned point
    real(wp) :: z(plate%distribution%owned)
    real(wp) :: faces(2)
    integer :: i, point, last

    z = 0
    associate (mesh => plate%mesh)
      do i = 1, plate%distribution%owned
        point = plate%distribution%points(i)
        last = mesh%first_point(mesh%point_node(point) + 1) - 1
        if (mesh%first_point(mesh%point_node(point)) == last) cycle
        faces = [-1, 1]*plate%layup%thickness/2
        if (plate%zone(i) > 0) faces(1) = plate%map%height(i)
        if (point < last) faces(2) = plate%map%height(plate%distribution%local(point + 1))
        if (mesh%is_doubler(point)) then
          if (plate%zone(i) > 0) faces(2) = faces(1) + mesh%zones(mesh%point_zone(point))%thickness
          if (plate%zone(i) == 0) faces(1) = faces(2) - mesh%zones(mesh%point_zone(point + 1))%thickness
        end if
        z(i) = sum(faces)/2
      end do
    end associate
  end function middles_of_layers

  !> Writes the requested fields of the state reached, if their physics is modelled.
  subroutine write_fields(plate, stepper, output, fields, error)
    type(composite_plate_t), intent(in) :: plate
    class(stepper_t), intent(in) :: stepper
    type(output_t), intent(in) :: output
    type(fields_file_t), intent(inout) :: fields
    type(error_t), allocatable, intent(out) :: error

    if (.not. fields%is_on(plate%mesh%points())) call write_mesh(plate, fields, error)
    associate (now => stepper%now)
      call fields%begin(shown_time(now%time), now%step, error)
      call write_motion_fields(plate, now%motion, output, fields, error)
      call write_interface_fields(plate, uniform_stiffness(now%plies), now%interfaces, now%motion, output, fields, &
                                  error)
      call write_stringer_fields(plate, now%motion%displacement, output, fields, error)
      call write_ply_fields(plate, now%plies, now%motion%displacement, output, fields, error)
      call fields%finish(error)
    end associate
  end subroutine write_fields
end module field_results
