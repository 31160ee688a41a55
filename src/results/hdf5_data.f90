!> Numbers and text in a shared HDF5 file: arrays known to every rank, and tables with columns distributed over the
!> ranks and stored in global order. Every routine is collective; `name` is a path inside the file.
module hdf5_data
  use hdf5, only: h5dclose_f, h5dget_type_f, h5dopen_f, h5t_fortran_s1, h5t_ieee_f64le, h5t_native_double, &
    h5t_native_integer, h5t_std_i32le, h5tclose_f, h5tcopy_f, h5tget_size_f, h5tset_size_f, hid_t, size_t
  use hdf5_file, only: hdf5_file_t
  use hdf5_transfers, only: get, put
  use, intrinsic :: iso_c_binding, only: c_char, c_loc
  use kinds, only: wp
  implicit none
  private
  public :: write_reals, read_reals, write_integers, read_integers, write_text, read_text
  public :: write_real_columns, read_real_columns, write_integer_columns

contains

  !> Writes reals known to every rank.
  subroutine write_reals(file, name, values, extents)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The numbers, in array element order
    real(wp), intent(in) :: values(:)
    integer, intent(in) :: extents(:)
    real(wp), allocatable, target :: buffer(:)

    buffer = [values, 0.0_wp]
    call put(file, name, h5t_ieee_f64le, h5t_native_double, c_loc(buffer), extents, shares_of_root(file, extents))
  end subroutine write_reals

  !> Reads reals to every rank.
  subroutine read_reals(file, name, values, extents)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The numbers, in array element order
    real(wp), allocatable, intent(out) :: values(:)
    !> Extents the stored array must have; none: a scalar
    integer, intent(in) :: extents(:)
    real(wp), allocatable, target :: buffer(:)

    allocate (buffer(product(extents) + 1), source=0.0_wp)
    call get(file, name, h5t_native_double, c_loc(buffer), extents, all_columns(extents))
    values = buffer(:product(extents))
  end subroutine read_reals

  !> Writes integers known to every rank.
  subroutine write_integers(file, name, values, extents)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The numbers, in array element order
    integer, intent(in) :: values(:)
    integer, intent(in) :: extents(:)
    integer, allocatable, target :: buffer(:)

    buffer = [values, 0]
    call put(file, name, h5t_std_i32le, h5t_native_integer, c_loc(buffer), extents, shares_of_root(file, extents))
  end subroutine write_integers

  !> Reads integers to every rank.
  subroutine read_integers(file, name, values, extents)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The numbers, in array element order
    integer, allocatable, intent(out) :: values(:)
    !> Extents the stored array must have; none: a scalar
    integer, intent(in) :: extents(:)
    integer, allocatable, target :: buffer(:)

    allocate (buffer(product(extents) + 1), source=0)
    call get(file, name, h5t_native_integer, c_loc(buffer), extents, all_columns(extents))
    values = buffer(:product(extents))
  end subroutine read_integers

  !> Writes a text known to every rank.
  subroutine write_text(file, name, value)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The text; an empty one is stored as a blank
    character(len=*), intent(in) :: value
    character(kind=c_char), allocatable, target :: buffer(:)
    integer(hid_t) :: text_type
    integer :: i, status

    if (.not. file%succeeded()) return
    allocate (buffer(max(1, len(value))), source=' ')
    do i = 1, len(value)
      buffer(i) = value(i:i)
    end do
    call h5tcopy_f(h5t_fortran_s1, text_type, status)
    call h5tset_size_f(text_type, int(size(buffer), size_t), status)
    call put(file, name, text_type, text_type, c_loc(buffer), [integer ::], shares_of_root(file, [integer ::]))
    call h5tclose_f(text_type, status)
  end subroutine write_text

  !> Reads a text to every rank; empty if it is not there.
  subroutine read_text(file, name, value)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> The text
    character(len=:), allocatable, intent(out) :: value
    character(kind=c_char), allocatable, target :: buffer(:)
    integer(hid_t) :: dataset, text_type
    integer(size_t) :: length
    integer :: i, status, closed

    value = ''
    if (.not. file%succeeded()) return
    call h5dopen_f(file%id, name, dataset, status)
    call file%check_status(status, name//' is missing')
    if (.not. file%succeeded()) return
    call h5dget_type_f(dataset, text_type, status)
    call h5tget_size_f(text_type, length, status)
    call h5dclose_f(dataset, closed)
    allocate (buffer(length), source=' ')
    call get(file, name, text_type, c_loc(buffer), [integer ::], [1])
    call h5tclose_f(text_type, closed)
    value = repeat(' ', int(length))
    do i = 1, int(length)
      value(i:i) = buffer(i)
    end do
  end subroutine read_text

  !> Writes a table of reals with columns distributed over the ranks.
  subroutine write_real_columns(file, name, columns, global_columns, values)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> Global numbers (from 1) of the leading columns of `values`; no other rank has them
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    !> The table; columns after size(columns) are ignored
    real(wp), intent(in) :: values(:, :)
    real(wp), allocatable, target :: buffer(:)
    integer, allocatable :: order(:)

    order = ascending_order(columns)
    buffer = [values(:, order), 0.0_wp]
    call put(file, name, h5t_ieee_f64le, h5t_native_double, c_loc(buffer), &
             table_extents(size(values, 1), global_columns), columns(order))
  end subroutine write_real_columns

  !> Reads a table of reals with columns distributed over the ranks.
  subroutine read_real_columns(file, name, columns, global_columns, values)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> Global numbers (from 1) of the leading columns of `values`
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    !> The table; columns after size(columns) are unchanged, and all after an error
    real(wp), intent(inout) :: values(:, :)
    real(wp), allocatable, target :: buffer(:)
    integer, allocatable :: order(:)
    integer :: height, i

    height = size(values, 1)
    order = ascending_order(columns)
    allocate (buffer(height*size(columns) + 1), source=0.0_wp)
    call get(file, name, h5t_native_double, c_loc(buffer), table_extents(height, global_columns), &
             columns(order))
    if (.not. file%succeeded()) return
    do i = 1, size(columns)
      values(:, order(i)) = buffer((i - 1)*height + 1:i*height)
    end do
  end subroutine read_real_columns

  !> Writes a table of integers with columns distributed over the ranks.
  subroutine write_integer_columns(file, name, columns, global_columns, values)
    type(hdf5_file_t), intent(inout) :: file
    character(len=*), intent(in) :: name
    !> Global numbers (from 1) of the leading columns of `values`; no other rank has them
    integer, intent(in) :: columns(:)
    integer, intent(in) :: global_columns
    !> The table; columns after size(columns) are ignored
    integer, intent(in) :: values(:, :)
    integer, allocatable, target :: buffer(:)
    integer, allocatable :: order(:)

    order = ascending_order(columns)
    buffer = [values(:, order), 0]
    call put(file, name, h5t_std_i32le, h5t_native_integer, c_loc(buffer), &
             table_extents(size(values, 1), global_columns), columns(order))
  end subroutine write_integer_columns

  !> Extents of a stored table: one number per column is a list.
  pure function table_extents(height, global_columns) result(extents)
    !> Numbers per column
    integer, intent(in) :: height
    integer, intent(in) :: global_columns
    integer, allocatable :: extents(:)

    extents = [height, global_columns]
    if (height == 1) extents = [global_columns]
  end function table_extents

  !> Order in which scattered columns ascend.
  pure function ascending_order(columns) result(order)
    !> Distinct column numbers
    integer, intent(in) :: columns(:)
    !> Positions such that columns(order) ascends
    integer :: order(size(columns))
    integer, allocatable :: position(:)
    integer :: i

    if (size(columns) == 0) return
    allocate (position(minval(columns):maxval(columns)), source=0)
    position(columns) = [(i, i=1, size(columns))]
    order = pack(position, position > 0)
  end function ascending_order

  !> Columns that this rank writes of an array known to every rank: all on the first rank.
  pure function shares_of_root(file, extents) result(columns)
    type(hdf5_file_t), intent(in) :: file
    integer, intent(in) :: extents(:)
    integer, allocatable :: columns(:)

    columns = all_columns(extents)
    if (.not. file%communicator%is_root()) columns = columns(:0)
  end function shares_of_root

  !> All columns of an array.
  pure function all_columns(extents) result(columns)
    integer, intent(in) :: extents(:)
    integer, allocatable :: columns(:)
    integer :: i

    if (size(extents) == 0) then
      columns = [1]
    else
      columns = [(i, i=1, extents(size(extents)))]
    end if
  end function all_columns
end module hdf5_data
