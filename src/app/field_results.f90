!> What the fields file holds of a run.
module field_results
  use kinds, only: wp
  use errors, only: error_t
  use models, only: model_t
  use marches, only: march_t
  use output_parameters, only: output_t
  use fields_file, only: fields_file_t
  use interface_results, only: write_interfaces
  use ply_results, only: write_failures, write_stresses
  implicit none
  private
  public :: write_mesh, write_fields

contains

  !> Writes points at the heights of their layers, and elements.
  subroutine write_mesh(model, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: coordinates(3, model%distribution%owned)
    integer :: plies(2, model%elements%elements)

    associate (mesh => model%mesh, share => model%distribution)
      coordinates(1:2, :) = mesh%node_coordinates(:, mesh%point_node(share%points(:share%owned)))
      coordinates(3, :) = heights(model)
      plies = mesh%element_plies(:, share%elements)
      call fields%write_mesh(share%points(:share%owned), mesh%points(), coordinates, share%elements, mesh%elements(), &
                             mesh%connectivity(:, share%elements), &
                             [character(len=10) :: 'first_ply', 'last_ply'], plies, error)
    end associate
  end subroutine write_mesh

  !> Heights at which the owned points are drawn: the middle of their layer, or of the laminate where
  !> there is one layer.
  pure function heights(model) result(z)
    !> The model
    type(model_t), intent(in) :: model
    !> Height of each owned point
    real(wp) :: z(model%distribution%owned)
    integer :: i, point, last

    z = 0
    if (.not. model%map%layered) return
    associate (mesh => model%mesh)
      do i = 1, model%distribution%owned
        point = model%distribution%points(i)
        last = mesh%first_point(mesh%point_node(point) + 1) - 1
        if (mesh%first_point(mesh%point_node(point)) == last) cycle
        z(i) = -model%thickness/2
        if (model%zone(i) > 0) z(i) = model%map%height(i)
        if (point < last) then
          z(i) = (z(i) + model%plies(mesh%zones(mesh%point_zone(point + 1))%below_ply)%z_bottom)/2
        else
          z(i) = (z(i) + model%thickness/2)/2
        end if
      end do
    end associate
  end function heights

  !> Writes the fields of the state reached that are wanted and whose physics is modelled.
  subroutine write_fields(model, march, output, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> Which fields
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: motion(:, :)

    call fields%begin(march%now%time, march%now%step, error)
    associate (owned => model%distribution%owned)
      motion = model%motion_of(march%now%motion%displacement)
      if (output%wants('displacement')) call fields%write_point_field('displacement', motion(1:3, :owned), error)
      if (output%wants('rotation')) call fields%write_point_field('rotation', motion(4:5, :owned), error)
      motion = model%motion_of(march%now%motion%velocity)
      if (output%wants('velocity')) call fields%write_point_field('velocity', motion(1:3, :owned), error)
    end associate
    if (model%map%layered) call write_interfaces(model, march, output, fields, error)
    if (model%scene%has_ply_damage .and. output%wants('ply_damage')) &
      call write_failures(model, march, fields, error)
    if (output%wants('stress') .or. output%wants('face_stress')) &
      call write_stresses(model, march, output, fields, error)
    call fields%finish(error)
  end subroutine write_fields
end module field_results
