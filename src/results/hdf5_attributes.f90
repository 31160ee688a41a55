!> Text attributes of a dataset in a shared HDF5 file. Collective: every rank gives the same texts.
module hdf5_attributes
  use hdf5, only: h5aclose_f, h5acreate_f, h5awrite_f, h5dclose_f, h5dopen_f, h5s_scalar_f, h5sclose_f, h5screate_f, &
    h5t_fortran_s1, h5tclose_f, h5tcopy_f, h5tset_size_f, hid_t, size_t
  use hdf5_file, only: hdf5_file_t
  use, intrinsic :: iso_c_binding, only: c_char, c_loc
  implicit none
  private
  public :: write_unit_and_meaning

contains

  !> Gives a dataset the attributes `unit` and `meaning`.
  subroutine write_unit_and_meaning(file, name, unit, meaning)
    type(hdf5_file_t), intent(inout) :: file
    !> Path of the dataset inside the file
    character(len=*), intent(in) :: name
    !> Its unit
    character(len=*), intent(in) :: unit
    !> Meaning of the dataset
    character(len=*), intent(in) :: meaning
    integer(hid_t) :: dataset
    integer :: statuses(2), status

    if (.not. file%succeeded()) return
    statuses = 0
    call h5dopen_f(file%id, name, dataset, status)
    if (status >= 0) then
      call write_attribute(dataset, 'unit', unit, statuses(1))
      call write_attribute(dataset, 'meaning', meaning, statuses(2))
      call h5dclose_f(dataset, status)
    end if
    call file%check_status(min(status, minval(statuses)), name//' could not be given its unit and meaning')
  end subroutine write_unit_and_meaning

  !> Gives an open dataset an attribute.
  subroutine write_attribute(dataset, name, value, status)
    !> The dataset
    integer(hid_t), intent(in) :: dataset
    !> Name of the attribute
    character(len=*), intent(in) :: name
    !> Its text, not empty
    character(len=*), intent(in) :: value
    !> Negative if it cannot be written
    integer, intent(out) :: status
    character(kind=c_char), allocatable, target :: buffer(:)
    integer(hid_t) :: attribute, space, text_type
    integer :: i, closed

    allocate (buffer(len(value)))
    do i = 1, len(value)
      buffer(i) = value(i:i)
    end do
    call h5screate_f(h5s_scalar_f, space, status)
    call h5tcopy_f(h5t_fortran_s1, text_type, status)
    call h5tset_size_f(text_type, int(len(value), size_t), status)
    call h5acreate_f(dataset, name, text_type, space, attribute, status)
    if (status >= 0) then
      call h5awrite_f(attribute, text_type, c_loc(buffer), status)
      call h5aclose_f(attribute, closed)
    end if
    call h5tclose_f(text_type, closed)
    call h5sclose_f(space, closed)
  end subroutine write_attribute
end module hdf5_attributes
