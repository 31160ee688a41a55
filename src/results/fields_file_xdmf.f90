!> NAME.xdmf: description of the content of NAME.h5 for ParaView and similar programs.
module fields_file_xdmf
  use errors, only: error_t, exit_files, fail
  use files, only: rename_file
  use hdf5_data, only: read_integers, read_reals
  use hdf5_file, only: hdf5_file_t
  use hdf5_transfers, only: stored_shape
  use kinds, only: wp
  use output_streams, only: output_stream_t
  use text, only: line_t, to_text
  implicit none
  private
  public :: grid_of_time, write_xdmf, numbered

contains

  !> Describes one time as an XDMF grid, from the open file.
  subroutine grid_of_time(file, name, time_group, grid)
    !> The open file
    type(hdf5_file_t), intent(inout) :: file
    !> Name of the file, without its folder
    character(len=*), intent(in) :: name
    !> Path of the group of that time
    character(len=*), intent(in) :: time_group
    !> The XML text; empty after an error
    character(len=:), allocatable, intent(out) :: grid
    character(len=:), allocatable :: mesh
    integer, allocatable :: shape_of_cells(:), shape_of_points(:), mesh_number(:), step(:)
    real(wp), allocatable :: time(:)

    call read_reals(file, time_group//'/time', time, [integer ::])
    call read_integers(file, time_group//'/step', step, [integer ::])
    call read_integers(file, time_group//'/mesh', mesh_number, [integer ::])
    mesh = 'meshes/'//numbered(mesh_number(1))
    shape_of_cells = stored_shape(file, mesh//'/connectivity')
    shape_of_points = stored_shape(file, mesh//'/coordinates')
    grid = ''
    if (.not. file%succeeded()) return
    grid = line(2, '<Grid Name="plate" GridType="Uniform">') &
      //line(3, '<Time Value="'//to_text(time(1))//'"/>') &
      //line(3, '<Information Name="step" Value="'//to_text(step(1))//'"/>') &
      //line(3, '<Topology TopologyType="Quadrilateral_9" NumberOfElements="' &
             //to_text(shape_of_cells(size(shape_of_cells)))//'">') &
      //line(4, data_item(name, mesh//'/connectivity', shape_of_cells, 'Int')) &
      //line(3, '</Topology>') &
      //line(3, '<Geometry GeometryType="XYZ">') &
      //line(4, data_item(name, mesh//'/coordinates', shape_of_points, 'Float')) &
      //line(3, '</Geometry>')
    call add_attributes(file, name, mesh//'/cells', 'Cell', 'Int', grid)
    call add_attributes(file, name, time_group//'/points', 'Node', 'Float', grid)
    call add_attributes(file, name, time_group//'/cells', 'Cell', 'Float', grid)
    grid = grid//line(2, '</Grid>')
  end subroutine grid_of_time

  !> Adds all fields of a group to a grid.
  subroutine add_attributes(file, name, group, centre, kind_of_number, grid)
    !> The open file
    type(hdf5_file_t), intent(inout) :: file
    !> Name of the file, without its folder
    character(len=*), intent(in) :: name
    !> Path of the group
    character(len=*), intent(in) :: group
    !> Node or Cell
    character(len=*), intent(in) :: centre
    !> Float or Int
    character(len=*), intent(in) :: kind_of_number
    !> The XML text
    character(len=:), allocatable, intent(inout) :: grid
    type(line_t), allocatable :: names(:)
    character(len=:), allocatable :: form
    integer, allocatable :: extents(:)
    integer :: i

    call file%members(group, names)
    do i = 1, size(names)
      extents = stored_shape(file, group//'/'//names(i)%text)
      form = merge('Scalar', 'Vector', size(extents) == 1)
      grid = grid//line(3, '<Attribute Name="'//escaped(names(i)%text)//'" AttributeType="'//form//'" Center="' &
                        //centre//'">') &
        //line(4, data_item(name, group//'/'//names(i)%text, extents, kind_of_number)) &
        //line(3, '</Attribute>')
    end do
  end subroutine add_attributes

  !> Writes the document to another file and renames it.
  subroutine write_xdmf(path, part, grids, error)
    !> Path of the document
    character(len=*), intent(in) :: path
    !> Part of the plate in the file
    character(len=*), intent(in) :: part
    !> One grid per time
    type(line_t), intent(in) :: grids(:)
    type(error_t), allocatable, intent(inout) :: error
    type(output_stream_t) :: file
    integer :: i

    call file%open(path//'.tmp', 'w')
    call file%put(line(0, '<?xml version="1.0"?>')//line(0, '<Xdmf Version="3.0">')//line(0, '<Domain>'))
    call file%put(line(1, '<Information Name="part of the plate" Value="'//part//'"/>'))
    call file%put(line(1, '<Grid Name="times" GridType="Collection" CollectionType="Temporal">'))
    do i = 1, size(grids)
      call file%put(grids(i)%text)
    end do
    call file%put(line(1, '</Grid>')//line(0, '</Domain>')//line(0, '</Xdmf>'))
    call file%close()
    if (file%failed) call fail(error, exit_files, "Cannot write "//path//'.tmp: '//file%reason//'.')
    if (.not. allocated(error)) call rename_file(path//'.tmp', path, error)
  end subroutine write_xdmf

  !> Reference to an array in the HDF5 file.
  pure function data_item(name, path, extents, kind_of_number) result(item)
    !> Name of the file
    character(len=*), intent(in) :: name
    !> Path of the array
    character(len=*), intent(in) :: path
    !> Its extents, the fastest first
    integer, intent(in) :: extents(:)
    !> Float or Int
    character(len=*), intent(in) :: kind_of_number
    !> The XML text
    character(len=:), allocatable :: item
    integer :: i

    item = '<DataItem Dimensions="'
    do i = size(extents), 1, -1
      item = item//to_text(extents(i))
      if (i > 1) item = item//' '
    end do
    item = item//'" NumberType="'//kind_of_number//'" Precision="'//merge('8', '4', kind_of_number == 'Float') &
      //'" Format="HDF">'//escaped(name)//':/'//escaped(path)//'</DataItem>'
  end function data_item

  !> Name of the n-th group of its kind; such names in alphabetical order are in order.
  pure function numbered(number) result(name)
    !> The number, from 1
    integer, intent(in) :: number
    character(len=8) :: name

    write (name, '(i8.8)') number
  end function numbered

  !> A line of the document.
  pure function line(depth, content)
    !> Depth of indentation
    integer, intent(in) :: depth
    !> Its content
    character(len=*), intent(in) :: content
    !> The line with its end
    character(len=:), allocatable :: line

    line = repeat('  ', depth)//content//new_line('a')
  end function line

  !> A name with the special characters of XML escaped.
  pure function escaped(name)
    character(len=*), intent(in) :: name
    !> As XML requires it
    character(len=:), allocatable :: escaped
    integer :: i

    escaped = ''
    do i = 1, len(name)
      select case (name(i:i))
      case ('&')
        escaped = escaped//'&amp;'
      case ('<')
        escaped = escaped//'&lt;'
      case ('"')
        escaped = escaped//'&quot;'
      case default
        escaped = escaped//name(i:i)
      end select
    end do
  end function escaped
end module fields_file_xdmf
