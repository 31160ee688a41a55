!> Transfers of any type of numbers between memory and a shared HDF5 file: each rank writes or reads some of the columns
!> (along the last extent) of an array. Every routine is collective; `name` is a path inside the file.
module hdf5_transfers
  use hdf5, only: h5dclose_f, h5dcreate_f, h5dget_space_f, h5dopen_f, h5dread_f, h5dwrite_f, h5s_scalar_f, &
    h5s_select_set_f, h5sclose_f, h5screate_f, h5screate_simple_f, h5sget_simple_extent_dims_f, &
    h5sget_simple_extent_ndims_f, h5sselect_elements_f, h5sselect_hyperslab_f, h5sselect_none_f, hid_t, hsize_t, size_t
  use hdf5_file, only: hdf5_file_t
  use, intrinsic :: iso_c_binding, only: c_ptr
  implicit none
  private
  public :: put, get, stored_shape

contains

  !> Extents of a stored array; none for a scalar or if it is not there.
  function stored_shape(file, name) result(extents)
    type(hdf5_file_t), intent(in) :: file
    character(len=*), intent(in) :: name
    integer, allocatable :: extents(:)
    integer(hid_t) :: dataset, space
    integer(hsize_t), allocatable :: now(:), most(:)
    integer :: rank, status

    allocate (extents(0))
    if (.not. file%exists(name)) return
    call h5dopen_f(file%id, name, dataset, status)
    if (status < 0) return
    call h5dget_space_f(dataset, space, status)
    call h5sget_simple_extent_ndims_f(space, rank, status)
    allocate (now(rank), most(rank))
    call h5sget_simple_extent_dims_f(space, now, most, status)
    if (status >= 0) extents = int(now)
    call h5sclose_f(space, status)
    call h5dclose_f(dataset, status)
  end function stored_shape

  !> Creates a dataset and writes this rank's columns of it.
  subroutine put(file, name, stored_type, native_type, address, extents, columns)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> Type of the numbers in the file
    integer(hid_t), intent(in) :: stored_type
    !> Type of the numbers in memory
    integer(hid_t), intent(in) :: native_type
    !> Address of this rank's columns in memory, contiguous
    type(c_ptr), intent(in) :: address
    integer, intent(in) :: extents(:)
    !> Columns (along the last extent, from 1, ascending) of this rank
    integer, intent(in) :: columns(:)
    integer(hid_t) :: dataset, space, memory
    integer :: status, closed

    if (.not. file%succeeded()) return
    call make_spaces(extents, columns, space, memory)
    call h5dcreate_f(file%id, name, stored_type, space, dataset, status, file%undated, file%with_groups)
    call file%check_status(status, name//' could not be made')
    if (file%succeeded()) then
      call h5dwrite_f(dataset, native_type, address, status, memory, space, file%together)
      ! On one rank HDF5 keeps small data in memory and writes them here, which fails on a full disk.
      call h5dclose_f(dataset, closed)
      status = min(status, closed)
    end if
    call h5sclose_f(space, closed)
    call h5sclose_f(memory, closed)
    call file%check_status(status, name//' could not be written')
  end subroutine put

  !> Reads this rank's columns of a dataset.
  subroutine get(file, name, native_type, address, extents, columns)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> Type of the numbers in memory
    integer(hid_t), intent(in) :: native_type
    !> Address for this rank's columns in memory, contiguous
    type(c_ptr), intent(in) :: address
    !> Required extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> Columns (along the last extent, from 1, ascending) of this rank
    integer, intent(in) :: columns(:)
    integer(hid_t) :: dataset, space, memory
    integer, allocatable :: found(:)
    type(c_ptr) :: place
    integer :: status, closed

    if (.not. file%succeeded()) return
    call h5dopen_f(file%id, name, dataset, status)
    call file%check_status(status, name//' is missing')
    found = stored_shape(file, name)
    status = -1
    if (size(found) == size(extents)) status = merge(0, -1, all(found == extents))
    call file%check_status(status, name//' has another shape')
    if (.not. file%succeeded()) return
    call make_spaces(extents, columns, space, memory)
    place = address
    call h5dread_f(dataset, native_type, place, status, memory, space, file%together)
    call h5dclose_f(dataset, closed)
    call h5sclose_f(space, closed)
    call h5sclose_f(memory, closed)
    call file%check_status(status, name//' could not be read')
  end subroutine get

  !> Describes an array in the file with this rank's columns chosen, and those columns in memory.
  subroutine make_spaces(extents, columns, space, memory)
    integer, intent(in) :: extents(:)
    !> Columns of this rank (from 1, ascending)
    integer, intent(in) :: columns(:)
    !> The array in the file
    integer(hid_t), intent(out) :: space
    !> The columns in memory
    integer(hid_t), intent(out) :: memory
    integer(hsize_t) :: whole(size(extents)), mine(size(extents)), start(size(extents))
    integer :: rank, status

    rank = size(extents)
    if (rank == 0) then
      call h5screate_f(h5s_scalar_f, space, status)
      call h5screate_f(h5s_scalar_f, memory, status)
    else
      whole = extents
      mine = whole
      mine(rank) = size(columns)
      call h5screate_simple_f(rank, whole, space, status)
      call h5screate_simple_f(rank, mine, memory, status)
    end if
    if (size(columns) == 0 .or. any(extents == 0)) then
      call h5sselect_none_f(space, status)
      call h5sselect_none_f(memory, status)
    else if (rank > 0) then
      if (columns(size(columns)) - columns(1) == size(columns) - 1) then
        start = 0
        start(rank) = columns(1) - 1
        call h5sselect_hyperslab_f(space, h5s_select_set_f, start, mine, status)
      else
        call select_scattered(space, rank, product(extents(:rank - 1)), columns)
      end if
    end if
  end subroutine make_spaces

  !> Selects scattered columns of a list or table number by number: the time grows in proportion to their number, that
  !> for a union of blocks with its square.
  subroutine select_scattered(space, rank, height, columns)
    !> The list or table in the file
    integer(hid_t), intent(in) :: space
    !> 1: a list, 2: a table
    integer, intent(in) :: rank
    !> Numbers per column
    integer, intent(in) :: height
    !> Columns of this rank (from 1, ascending)
    integer, intent(in) :: columns(:)
    integer(hsize_t), allocatable :: places(:, :)
    integer :: i, j, status

    allocate (places(rank, height*size(columns)))
    do i = 1, size(columns)
      do j = 1, height
        places(1, (i - 1)*height + j) = j
        places(rank, (i - 1)*height + j) = columns(i)
      end do
    end do
    call h5sselect_elements_f(space, h5s_select_set_f, rank, size(places, 2, size_t), places, status)
  end subroutine select_scattered
end module hdf5_transfers
