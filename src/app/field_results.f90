!> What the fields file holds of a run.
module field_results
  use kinds, only: wp
  use errors, only: error_t
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
      coordinates(3, :) = 0
      plies = mesh%element_plies(:, share%elements)
      call fields%write_mesh(share%points(:share%owned), mesh%points(), coordinates, share%elements, mesh%elements(), &
                             mesh%connectivity(:, share%elements), &
                             [character(len=10) :: 'first_ply', 'last_ply'], plies, error)
    end associate
  end subroutine write_mesh

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

    call fields%begin(march%now%time, march%now%step, error)
    if (allocated(error)) return
    associate (owned => model%distribution%owned, motion => march%now%motion)
      call fields%write_point_field('displacement', motion%displacement(1:3, :owned), error)
      if (allocated(error)) return
      call fields%write_point_field('rotation', motion%displacement(4:5, :owned), error)
      if (allocated(error)) return
      call fields%write_point_field('velocity', motion%velocity(1:3, :owned), error)
      if (allocated(error)) return
    end associate
    call fields%finish(error)
  end subroutine write_fields
end module field_results
