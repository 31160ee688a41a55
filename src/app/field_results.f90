!> What the fields file holds of a run.
module field_results
  use kinds, only: wp
  use errors, only: error_t
  use text, only: to_text
  use models, only: model_t
  use marches, only: march_t
  use fields_file, only: fields_file_t
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

  !> Writes the fields of the state reached.
  subroutine write_fields(model, march, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: motion(:, :)

    call fields%begin(march%now%time, march%now%step, error)
    if (allocated(error)) return
    associate (owned => model%distribution%owned)
      motion = model%motion_of(march%now%motion%displacement)
      call fields%write_point_field('displacement', motion(1:3, :owned), error)
      if (allocated(error)) return
      call fields%write_point_field('rotation', motion(4:5, :owned), error)
      if (allocated(error)) return
      motion = model%motion_of(march%now%motion%velocity)
      call fields%write_point_field('velocity', motion(1:3, :owned), error)
      if (allocated(error)) return
    end associate
    if (model%map%layered) call write_interfaces(model, march, fields, error)
    if (allocated(error)) return
    if (allocated(march%failures%failed)) call write_failures(model, march, fields, error)
    if (allocated(error)) return
    call fields%finish(error)
  end subroutine write_fields

  !> Writes jumps, contact pressure and delaminated cells of the interfaces.
  subroutine write_interfaces(model, march, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: jumps(:, :), pressure(:, :), delaminated(:, :)
    integer :: i, element, cell

    associate (owned => model%distribution%owned, mine => model%distribution%elements)
      allocate (jumps(3, owned), pressure(1, owned), delaminated(1, size(mine)), source=0.0_wp)
      do i = 1, owned
        if (model%zone(i) == 0) cycle
        jumps(:, i) = march%now%motion%displacement(1:3, i)
        pressure(1, i) = march%now%separation%pressure(i)
      end do
      do i = 1, size(mine)
        element = mine(i)
        cell = model%mesh%element_cell(element) - 1
        delaminated(1, i) = merge(1, 0, delaminated_above(model, march, element, &
                                                          1 + modulo(cell, model%mesh%cells(1)), &
                                                          1 + cell/model%mesh%cells(1)))
      end do
    end associate
    call fields%write_point_field('jump', jumps, error)
    if (.not. allocated(error)) call fields%write_point_field('contact_pressure', pressure, error)
    if (.not. allocated(error)) call fields%write_cell_field('delaminated_above', delaminated, error)
  end subroutine write_interfaces

  !> True if the interface above an element has come apart.
  pure logical function delaminated_above(model, march, element, column, row)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> Element of the mesh
    integer, intent(in) :: element
    !> Place of its cell
    integer, intent(in) :: column, row
    integer :: zone

    delaminated_above = .false.
    do zone = 1, size(model%mesh%zones)
      if (model%mesh%zones(zone)%below_ply /= model%mesh%element_plies(1, element) - 1) cycle
      delaminated_above = march%now%separation%regions(zone)%is_delaminated(column, row)
    end do
  end function delaminated_above

  !> Writes the failures of every ply: 1 for fibre failure, 2 for matrix cracking, 4 for crushing, added up.
  subroutine write_failures(model, march, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(out) :: error
    real(wp), allocatable :: code(:, :)
    integer :: ply

    allocate (code(1, model%elements%elements))
    do ply = 1, size(model%plies)
      associate (failed => march%failures%failed(:, ply, :))
        code(1, :) = merge(1, 0, failed(1, :)) + merge(2, 0, failed(2, :)) + merge(4, 0, failed(3, :))
      end associate
      call fields%write_cell_field('ply_'//to_text(ply)//'_failure', code, error)
      if (allocated(error)) return
    end do
  end subroutine write_failures
end module field_results
