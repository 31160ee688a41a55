!> Datasets of fields in a shared HDF5 file, with their units and meanings. Every routine is collective.
module field_datasets
  use errors, only: error_t, exit_internal, fail
  use hdf5_attributes, only: write_unit_and_meaning
  use hdf5_data, only: write_real_columns
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use result_tables, only: cell, field_meaning, field_row, field_unit
  use text, only: to_text
  implicit none
  private
  public :: global_numbers_t, write_field, explain_dataset

  !> Points or elements that are distributed over the ranks.
  type :: global_numbers_t
    !> Global numbers (from 1) of those of this rank
    integer, allocatable :: own(:)
    !> Their number on all ranks
    integer :: total = 0
  end type global_numbers_t

contains

  !> Writes a scalar or vector field unchanged, any other by components.
  subroutine write_field(file, rows, path, columns, values, error)
    type(hdf5_file_t), intent(inout) :: file
    !> Table of the fields; unallocated: they have no units
    character(len=*), allocatable, intent(in) :: rows(:)
    !> Path of the field in the file
    character(len=*), intent(in) :: path
    !> The leading columns
    type(global_numbers_t), intent(in) :: columns
    !> The field (components by columns)
    real(wp), intent(in) :: values(:, :)
    !> Raised if the table has no row for it
    type(error_t), allocatable, intent(inout) :: error
    integer :: i

    select case (size(values, 1))
    case (1, 3)
      call write_real_columns(file, path, columns%own, columns%total, values)
      call explain_dataset(file, rows, path, error)
    case default
      do i = 1, size(values, 1)
        associate (component => path//'_'//to_text(i))
          call write_real_columns(file, component, columns%own, columns%total, values(i:i, :))
          call explain_dataset(file, rows, component, error)
        end associate
      end do
    end select
  end subroutine write_field

  !> Adds unit and meaning of the table to a dataset.
  subroutine explain_dataset(file, rows, path, error)
    type(hdf5_file_t), intent(inout) :: file
    !> Table of the fields; unallocated: they have no units
    character(len=*), allocatable, intent(in) :: rows(:)
    !> Path of the dataset in the file
    character(len=*), intent(in) :: path
    !> Raised if the table has no row for it
    type(error_t), allocatable, intent(inout) :: error
    integer :: row

    if (.not. allocated(rows)) return
    row = field_row(rows, path(index(path, '/', back=.true.) + 1:))
    if (row == 0) then
      call fail(error, exit_internal, 'There is no row for '//path//' in the table of fields.')
    else
      call write_unit_and_meaning(file, path, cell(rows(row), field_unit), cell(rows(row), field_meaning))
    end if
  end subroutine explain_dataset
end module field_datasets
