!> What the fields file holds of the plies.
module ply_results
  use kinds, only: wp
  use errors, only: error_t
  use text, only: to_text
  use element_stresses, only: element_strains, stresses_of_ply
  use models, only: model_t
  use marches, only: march_t
  use output_parameters, only: output_t
  use fields_file, only: fields_file_t
  implicit none
  private
  public :: write_failures, write_stresses

contains

  !> Writes the failures of every ply: 1 for fibre failure, 2 for matrix cracking, 4 for crushing, added up.
  subroutine write_failures(model, march, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error
    real(wp), allocatable :: code(:, :)
    integer :: ply

    allocate (code(1, model%elements%elements))
    do ply = 1, size(model%plies)
      associate (failed => march%failures%onset%failed(ply))
        code(1, :) = merge(1, 0, failed(1, :)) + merge(2, 0, failed(2, :)) + merge(4, 0, failed(3, :))
      end associate
      call fields%write_cell_field('ply_'//to_text(ply)//'_failure', code, error)
    end do
  end subroutine write_failures

  !> Writes the stresses of every ply in its own axes: all in its mid-plane, and those in the plane on its faces.
  subroutine write_stresses(model, march, output, fields, error)
    !> The model
    type(model_t), intent(in) :: model
    !> The march
    type(march_t), intent(in) :: march
    !> Which of them
    type(output_t), intent(in) :: output
    !> The file
    type(fields_file_t), intent(inout) :: fields
    !> Set if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=7), parameter :: components(5) = [character(len=7) :: 'sigma11', 'sigma22', 'tau12', 'tau13', 'tau23']
    real(wp), allocatable :: strains(:, :), stresses(:, :, :)
    integer :: ply

    strains = element_strains(model, march%failures, march%now%motion%displacement)
    do ply = 1, size(model%plies)
      stresses = stresses_of_ply(model, march%failures, strains, ply)
      if (output%wants('stress')) call write_components(5, 1, '')
      if (.not. output%wants('face_stress')) cycle
      call write_components(3, 2, '_top')
      call write_components(3, 3, '_bottom')
    end do

  contains

    !> Writes the first components at one place of the ply.
    subroutine write_components(number, place, suffix)
      !> How many
      integer, intent(in) :: number
      !> Mid-plane, top or bottom
      integer, intent(in) :: place
      !> What follows in their names
      character(len=*), intent(in) :: suffix
      integer :: i

      do i = 1, number
        call fields%write_cell_field('ply_'//to_text(ply)//'_'//trim(components(i))//suffix, stresses(i:i, place, :), &
                                     error)
      end do
    end subroutine write_components
  end subroutine write_stresses
end module ply_results
