!> What the fields file holds of a run.
module field_results
  use kinds, only: wp
  use errors, only: error_t
  use text, only: to_text
  use element_stresses, only: element_strains, stresses_of_ply
  use models, only: model_t
  use time_stepping, only: time_stepper_t
  use output_parameters, only: output_t, field_displacement, field_rotation, field_velocity, field_gap, &
                               field_contact_pressure, field_delamination, field_energy_release, field_ply_damage, &
                               field_stress, field_face_stress
  use fields_file, only: fields_file_t
  use interface_results, only: jumps, delaminated_above, release_ahead
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
  subroutine write_fields(model, stepper, output, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(time_stepper_t), intent(in) :: stepper
    !> Which fields
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: motion(:, :)

    associate (now => stepper%now)
      call fields%begin(now%time, now%step, error)
      motion = model%motion_of(now%motion%displacement)
      if (output%wants(field_displacement)) call fields%write_point_field(field_displacement, motion(1:3, :), error)
      if (output%wants(field_rotation)) call fields%write_point_field(field_rotation, motion(4:5, :), error)
      motion = model%motion_of(now%motion%velocity)
      if (output%wants(field_velocity)) call fields%write_point_field(field_velocity, motion(1:3, :), error)
      if (model%map%layered) then
        if (output%wants(field_gap)) call fields%write_point_field('jump', jumps(model, now), error)
        if (output%wants(field_contact_pressure)) call fields%write_point_field(field_contact_pressure, &
          reshape(now%interfaces%faces%pressure, [1, size(now%interfaces%faces%pressure)]), error)
        if (output%wants(field_delamination)) &
          call fields%write_cell_field('delaminated_above', delaminated_above(model, now), error)
        if (output%wants(field_energy_release)) &
          call fields%write_cell_field('energy_release_above', release_ahead(model, now), error)
      end if
    end associate
    call write_plies(model, stepper, output, fields, error)
    call fields%finish(error)
  end subroutine write_fields

  !> Writes the failures of every ply, 1 for fibre failure, 2 for matrix cracking, 4 for crushing, added up, and its
  !> stresses in its own axes: all in its mid-plane, and those in the plane on its faces.
  subroutine write_plies(model, stepper, output, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(time_stepper_t), intent(in) :: stepper
    !> Which fields
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=*), parameter :: components(5) = [character(len=7) :: 'sigma11', 'sigma22', 'tau12', 'tau13', 'tau23']
    character(len=*), parameter :: places(3) = [character(len=7) :: '', '_top', '_bottom']
    logical :: wanted(3)
    real(wp), allocatable :: strains(:, :), stresses(:, :, :)
    integer :: ply, place, i

    wanted(1) = output%wants(field_stress)
    wanted(2:3) = output%wants(field_face_stress)
    if (any(wanted)) strains = element_strains(model, stepper%failures, stepper%now%motion%displacement)
    do ply = 1, size(model%plies)
      associate (name => 'ply_'//to_text(ply)//'_')
        if (output%wants(field_ply_damage) .and. model%scene%has_ply_damage) &
          call fields%write_cell_field(name//'failure', failure_code(stepper%failures%onset%failed(ply)), error)
        if (any(wanted)) stresses = stresses_of_ply(model, stepper%failures, strains, ply)
        do place = 1, 3
          if (.not. wanted(place)) cycle
          do i = 1, merge(5, 3, place == 1)
            call fields%write_cell_field(name//trim(components(i))//trim(places(place)), stresses(i:i, place, :), error)
          end do
        end do
      end associate
    end do
  end subroutine write_plies

  !> 1 for fibre failure, 2 for matrix cracking, 4 for crushing, added up.
  pure function failure_code(failed) result(code)
    !> What failed in one ply, (3, elements)
    logical, intent(in) :: failed(:, :)
    !> The sum, (1, elements)
    real(wp) :: code(1, size(failed, 2))

    code(1, :) = merge(1, 0, failed(1, :)) + merge(2, 0, failed(2, :)) + merge(4, 0, failed(3, :))
  end function failure_code
end module field_results
