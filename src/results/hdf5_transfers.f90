!> Transfers of any type of numbers between memory and an HDF5 file of a run: each rank has some of the columns (along
!> the last extent) of an array, which the first rank writes or reads for it. Every routine is collective.
module hdf5_transfers
  use communicators, only: communicator_t
  use hdf5, only: h5dclose_f, h5dcreate_f, h5dget_space_f, h5dopen_f, h5dread_f, h5dwrite_f, h5s_scalar_f, &
    h5s_select_set_f, h5sclose_f, h5screate_f, h5screate_simple_f, h5sget_simple_extent_dims_f, &
    h5sget_simple_extent_ndims_f, h5sselect_elements_f, h5sselect_hyperslab_f, h5sselect_none_f, hid_t, hsize_t, size_t
  use hdf5_file, only: hdf5_file_t
  use, intrinsic :: iso_c_binding, only: c_int8_t, c_loc, c_ptr
  use root_messages, only: receive_bytes, send_bytes
  implicit none
  private
  public :: put, get, stored_shape

  !> Columns of all ranks.
  type :: shares_t
    !> First and last place of the columns of each rank, from rank 0
    integer, allocatable :: first(:), last(:)
    !> The columns, in the order of ranks
    integer, allocatable :: columns(:)
  end type shares_t

contains

  !> Extents of a stored array; none for a scalar or if it is not there.
  function stored_shape(file, name) result(extents)
    !> The file
    type(hdf5_file_t), intent(in) :: file
    !> Path inside the file
    character(len=*), intent(in) :: name
    !> The extents
    integer, allocatable :: extents(:)
    integer(hid_t) :: dataset
    integer :: rank, status

    allocate (extents(0))
    if (.not. file%exists(name)) return
    if (file%communicator%is_root()) then
      call h5dopen_f(file%id, name, dataset, status)
      if (status >= 0) then
        call read_shape(dataset, extents)
        call h5dclose_f(dataset, status)
      end if
    end if
    rank = size(extents)
    call file%communicator%broadcast(rank)
    if (.not. file%communicator%is_root()) extents = spread(0, 1, rank)
    call file%communicator%broadcast(extents)
  end function stored_shape

  !> Extents of an open dataset.
  subroutine read_shape(dataset, extents)
    !> The dataset
    integer(hid_t), intent(in) :: dataset
    !> The extents; none for a scalar
    integer, allocatable, intent(out) :: extents(:)
    integer(hid_t) :: space
    integer(hsize_t), allocatable :: now(:), most(:)
    integer :: rank, status

    allocate (extents(0))
    call h5dget_space_f(dataset, space, status)
    call h5sget_simple_extent_ndims_f(space, rank, status)
    allocate (now(rank), most(rank))
    call h5sget_simple_extent_dims_f(space, now, most, status)
    if (status >= 0) extents = int(now)
    call h5sclose_f(space, status)
  end subroutine read_shape

  !> Makes a dataset and writes each rank's columns of it.
  subroutine put(file, name, stored_type, native_type, bytes, address, extents, columns)
    !> The file
    type(hdf5_file_t), intent(inout) :: file
    !> Path inside the file
    character(len=*), intent(in) :: name
    !> Type of the numbers in the file, on the first rank
    integer(hid_t), intent(in) :: stored_type
    !> Type of the numbers in memory, on the first rank
    integer(hid_t), intent(in) :: native_type
    !> Bytes of a number in memory
    integer, intent(in) :: bytes
    !> Address of this rank's columns in memory, contiguous
    type(c_ptr), intent(in) :: address
    !> Extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> Columns (along the last extent, from 1, ascending) of this rank
    integer, intent(in) :: columns(:)
    type(shares_t) :: shares
    integer(hid_t) :: dataset, space, memory
    integer :: rank, status, closed

    if (.not. file%succeeded()) return
    status = 0
    if (file%communicator%is_root()) then
      call make_spaces(extents, columns, space, memory)
      call h5dcreate_f(file%id, name, stored_type, space, dataset, status, file%undated, file%with_groups)
      call close_spaces(space, memory)
    end if
    call file%check_status(status, name//' could not be made')
    if (.not. file%succeeded()) return
    shares = shares_of_ranks(file%communicator, columns)
    if (file%communicator%is_root()) then
      do rank = 0, file%communicator%size - 1
        associate (share => shares%columns(shares%first(rank):shares%last(rank)))
          if (rank == 0 .or. size(share) > 0) &
            call write_share(file%communicator, dataset, native_type, bytes, address, extents, share, rank, status)
        end associate
      end do
      ! HDF5 keeps small data in memory and writes them here, which fails on a full disk.
      call h5dclose_f(dataset, closed)
      status = min(status, closed)
    else if (size(columns) > 0) then
      call send_bytes(file%communicator, 0, address, bytes*height(extents)*size(columns))
    end if
    call file%check_status(status, name//' could not be written')
  end subroutine put

  !> Writes the columns of a rank, on the first rank; after a failure they are received only.
  subroutine write_share(communicator, dataset, native_type, bytes, address, extents, columns, rank, status)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The open dataset
    integer(hid_t), intent(in) :: dataset
    !> Type of the numbers in memory
    integer(hid_t), intent(in) :: native_type
    !> Bytes of a number in memory
    integer, intent(in) :: bytes
    !> Address of the columns of the first rank
    type(c_ptr), intent(in) :: address
    !> Extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> The columns
    integer, intent(in) :: columns(:)
    !> The rank
    integer, intent(in) :: rank
    !> Negative after a failure
    integer, intent(inout) :: status
    integer(c_int8_t), allocatable, target :: received(:)
    integer(hid_t) :: space, memory
    type(c_ptr) :: place

    place = address
    if (rank > 0) then
      allocate (received(bytes*height(extents)*size(columns)))
      place = c_loc(received)
      call receive_bytes(communicator, rank, place, size(received))
    end if
    if (status < 0) return
    call make_spaces(extents, columns, space, memory)
    call h5dwrite_f(dataset, native_type, place, status, memory, space)
    call close_spaces(space, memory)
  end subroutine write_share

  !> Reads each rank's columns of a dataset.
  subroutine get(file, name, native_type, bytes, address, extents, columns)
    !> The file
    type(hdf5_file_t), intent(inout) :: file
    !> Path inside the file
    character(len=*), intent(in) :: name
    !> Type of the numbers in memory, on the first rank
    integer(hid_t), intent(in) :: native_type
    !> Bytes of a number in memory
    integer, intent(in) :: bytes
    !> Address for this rank's columns in memory, contiguous
    type(c_ptr), intent(in) :: address
    !> Required extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> Columns (along the last extent, from 1, ascending) of this rank
    integer, intent(in) :: columns(:)
    type(shares_t) :: shares
    integer(hid_t) :: dataset
    integer, allocatable :: found(:)
    integer :: rank, status, closed

    if (.not. file%succeeded()) return
    call file%check_status(merge(0, -1, file%exists(name)), name//' is missing')
    found = stored_shape(file, name)
    status = -1
    if (size(found) == size(extents)) status = merge(0, -1, all(found == extents))
    call file%check_status(status, name//' has another shape')
    if (.not. file%succeeded()) return
    shares = shares_of_ranks(file%communicator, columns)
    if (file%communicator%is_root()) then
      call h5dopen_f(file%id, name, dataset, status)
      do rank = 0, file%communicator%size - 1
        associate (share => shares%columns(shares%first(rank):shares%last(rank)))
          if (rank == 0 .or. size(share) > 0) &
            call read_share(file%communicator, dataset, native_type, bytes, address, extents, share, rank, status)
        end associate
      end do
      call h5dclose_f(dataset, closed)
    else if (size(columns) > 0) then
      call receive_bytes(file%communicator, 0, address, bytes*height(extents)*size(columns))
    end if
    call file%check_status(status, name//' could not be read')
  end subroutine get

  !> Reads the columns of a rank, on the first rank; after a failure zeros are sent.
  subroutine read_share(communicator, dataset, native_type, bytes, address, extents, columns, rank, status)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The open dataset
    integer(hid_t), intent(in) :: dataset
    !> Type of the numbers in memory
    integer(hid_t), intent(in) :: native_type
    !> Bytes of a number in memory
    integer, intent(in) :: bytes
    !> Address for the columns of the first rank
    type(c_ptr), intent(in) :: address
    !> Extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> The columns
    integer, intent(in) :: columns(:)
    !> The rank
    integer, intent(in) :: rank
    !> Negative after a failure
    integer, intent(inout) :: status
    integer(c_int8_t), allocatable, target :: sent(:)
    integer(hid_t) :: space, memory
    type(c_ptr) :: place

    place = address
    if (rank > 0) then
      allocate (sent(bytes*height(extents)*size(columns)), source=0_c_int8_t)
      place = c_loc(sent)
    end if
    if (status >= 0) then
      call make_spaces(extents, columns, space, memory)
      call h5dread_f(dataset, native_type, place, status, memory, space)
      call close_spaces(space, memory)
    end if
    if (rank > 0) call send_bytes(communicator, rank, place, size(sent))
  end subroutine read_share

  !> Columns of all ranks, on each of them.
  function shares_of_ranks(communicator, columns) result(shares)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Columns of this rank
    integer, intent(in) :: columns(:)
    !> The columns of all
    type(shares_t) :: shares
    integer, allocatable :: counts(:)
    integer :: i

    call communicator%allgather([size(columns)], counts)
    allocate (shares%first(0:size(counts) - 1), shares%last(0:size(counts) - 1))
    shares%last = [(sum(counts(:i)), i=1, size(counts))]
    shares%first = shares%last - counts + 1
    call communicator%allgather(columns, shares%columns)
  end function shares_of_ranks

  !> Numbers of a column.
  pure integer function height(extents)
    !> Extents of the array; none: a scalar
    integer, intent(in) :: extents(:)

    height = product(extents(:size(extents) - 1))
  end function height

  !> Describes an array in the file with some columns chosen, and those columns in memory.
  subroutine make_spaces(extents, columns, space, memory)
    !> Extents of the array; none: a scalar
    integer, intent(in) :: extents(:)
    !> Columns (from 1, ascending)
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

  !> Ends the description of an array.
  subroutine close_spaces(space, memory)
    !> The array in the file, the columns in memory
    integer(hid_t), intent(in) :: space, memory
    integer :: closed

    call h5sclose_f(space, closed)
    call h5sclose_f(memory, closed)
  end subroutine close_spaces

  !> Chooses scattered columns of a list or table number by number: the time taken grows with their number,
  !> whereas that of a union of blocks grows with its square.
  subroutine select_scattered(space, rank, height, columns)
    !> The list or table in the file
    integer(hid_t), intent(in) :: space
    !> 1: a list, 2: a table
    integer, intent(in) :: rank
    !> Numbers per column
    integer, intent(in) :: height
    !> Columns (from 1, ascending)
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
