!> NAME.h5 and NAME.xdmf: fields over the plate at chosen times, for ParaView and for scripts. The file is open only
!> while a time is written. Every routine is collective; after an error they do nothing, except that `finish` closes
!> open files.
!>
!> In NAME.h5: `provenance`, `part`, `restarts/N` (provenance of restarts), `meshes/N` (coordinates, connectivity,
!> cells/...), `times/N` (time, step, mesh, points/..., cells/..., interfaces/...). Fields have the attributes `unit`
!> and `meaning` if there is a table of them.
module fields_file
  use communicators, only: communicator_t
  use errors, only: error_t, exit_files, fail
  use field_datasets, only: explain_dataset, global_numbers_t, write_field
  use fields_file_xdmf, only: grid_of_time, numbered, write_xdmf
  use files, only: file_exists
  use hdf5_data, only: read_reals, read_text, write_integer_columns, write_integers, write_real_columns, write_reals, &
                       write_text
  use hdf5_file, only: hdf5_file_t
  use kinds, only: wp
  use result_tables, only: result_row_length
  use run_provenance, only: provenance_t
  use stored_provenance, only: write_provenance
  use text, only: append, line_t
  implicit none
  private
  public :: fields_file_t

  !> Nodes of an element in XDMF's order, corners, sides, middle, as numbers in the order 1 + i + 3 j.
  integer, parameter :: xdmf_order(9) = [1, 3, 9, 7, 2, 6, 8, 4, 5]

  !> The fields of one run.
  type :: fields_file_t
    private
    !> The ranks
    type(communicator_t) :: communicator
    !> Folder and name, without suffix
    character(len=:), allocatable :: base
    !> Name of the HDF5 file, without its folder
    character(len=:), allocatable :: name
    !> Modelled part of the plate: whole, quarter, half_x, half_y or point
    character(len=:), allocatable :: part
    type(hdf5_file_t) :: file
    !> Table of the fields, one row each; unallocated: they have no units
    character(len=result_row_length), allocatable :: rows(:)
    !> XDMF text of each time written
    type(line_t), allocatable :: grids(:)
    !> Number of the mesh of the fields
    integer :: mesh = 0
    !> Group of the time being written
    character(len=:), allocatable :: time_group
    !> Points and elements of the mesh
    type(global_numbers_t) :: points, cells
  contains
    procedure :: describe
    procedure :: create, resume
    procedure, nopass :: check_deck
    procedure :: write_mesh
    procedure :: is_on, is_empty
    procedure :: begin, finish
    procedure :: write_point_field, write_cell_field, write_figures
    procedure, private :: name_files, open_file, close_file, drop_times_after
  end type fields_file_t

contains

  !> Sets the table of the fields: each then has its unit and meaning, and a field without a row is refused.
  pure subroutine describe(self, rows)
    class(fields_file_t), intent(inout) :: self
    !> Rows as in result_tables
    character(len=result_row_length), intent(in) :: rows(:)

    self%rows = rows
  end subroutine describe

  !> Starts the file, replacing one of that name.
  subroutine create(self, communicator, base, provenance, part, error)
    class(fields_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: base
    !> The run
    type(provenance_t), intent(in) :: provenance
    !> Modelled part of the plate: whole, quarter, half_x, half_y or point
    character(len=*), intent(in) :: part
    !> Raised if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(error)) return
    call self%name_files(communicator, base, part)
    call self%file%create(communicator, base//'.h5', 0)
    call write_provenance(self%file, 'provenance', provenance)
    call write_text(self%file, 'part', part)
    call self%file%make_group('meshes')
    call self%file%make_group('times')
    call self%file%make_group('restarts')
    call self%close_file(error)
  end subroutine create

  !> Checks, before any change, that an existing file is that of the deck.
  subroutine check_deck(communicator, base, deck, error)
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: base
    character(len=*), intent(in) :: deck
    !> Set if it is that of another deck
    type(error_t), allocatable, intent(inout) :: error
    type(hdf5_file_t) :: file
    character(len=:), allocatable :: found
    logical :: present

    present = communicator%any(communicator%is_root() .and. file_exists(base//'.h5'))
    if (.not. present) return
    call file%open(communicator, base//'.h5', writable=.false.)
    call read_text(file, 'provenance/deck', found)
    if (file%succeeded() .and. found /= deck) &
      call fail(error, exit_files, 'The fields '//base//'.h5 belong to another deck than the checkpoint; '// &
                'move the file away, or use the checkpoint of its run.')
    call file%close()
  end subroutine check_deck

  !> Continues an existing file: times after the checkpoint are removed. Without a file a new one is started.
  subroutine resume(self, communicator, base, provenance, part, last_time, error)
    class(fields_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: base
    !> The continued run
    type(provenance_t), intent(in) :: provenance
    !> Modelled part of the plate: whole, quarter, half_x, half_y or point
    character(len=*), intent(in) :: part
    !> Time of the last fields to keep, that of the checkpoint
    real(wp), intent(in) :: last_time
    !> Raised if the file cannot be used
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: names(:)
    logical :: present

    if (allocated(error)) return
    present = communicator%any(communicator%is_root() .and. file_exists(base//'.h5'))
    if (.not. present) then
      call self%create(communicator, base, provenance, part, error)
      return
    end if
    call self%name_files(communicator, base, part)
    call self%open_file(error)
    if (allocated(error)) return
    call self%drop_times_after(last_time)
    call self%file%members('meshes', names)
    self%mesh = size(names)
    call self%file%members('restarts', names)
    call write_provenance(self%file, 'restarts/'//numbered(size(names) + 1), provenance)
    call self%close_file(error)
  end subroutine resume

  !> Writes the mesh of the following fields. Called at the start and after changes of the mesh.
  subroutine write_mesh(self, points, cells, coordinates, connectivity, names, values, error)
    class(fields_file_t), intent(inout) :: self
    !> The points that this rank owns, and its elements
    type(global_numbers_t), intent(in) :: points, cells
    !> Coordinates of these points (x, y, z by points)
    real(wp), intent(in) :: coordinates(:, :)
    !> Global numbers of the nine points of each element, in the order 1 + i + 3 j (9 by elements)
    integer, intent(in) :: connectivity(:, :)
    !> Names of constant fields of the elements, such as their layer; may be empty
    character(len=*), intent(in) :: names(:)
    !> Constant fields of the elements (names by elements)
    integer, intent(in) :: values(:, :)
    !> Raised if the mesh cannot be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: group
    integer :: i

    if (allocated(error)) return
    call self%open_file(error)
    if (allocated(error)) return
    self%points = points
    self%cells = cells
    self%mesh = self%mesh + 1
    group = 'meshes/'//numbered(self%mesh)
    call write_real_columns(self%file, group//'/coordinates', points%own, points%total, coordinates)
    call write_integer_columns(self%file, group//'/connectivity', cells%own, cells%total, &
                               connectivity(xdmf_order, :) - 1)
    do i = 1, size(names)
      call write_integer_columns(self%file, group//'/cells/'//trim(names(i)), cells%own, cells%total, values(i:i, :))
      call explain_dataset(self%file, self%rows, group//'/cells/'//trim(names(i)), error)
    end do
    call self%close_file(error, group)
  end subroutine write_mesh

  !> True if the last mesh has this number of points: layers are only added to a mesh.
  pure logical function is_on(self, points)
    class(fields_file_t), intent(in) :: self
    !> Number of points on all ranks
    integer, intent(in) :: points

    is_on = self%points%total == points
  end function is_on

  !> True: the file has no time yet.
  pure logical function is_empty(self)
    class(fields_file_t), intent(in) :: self

    is_empty = size(self%grids) == 0
  end function is_empty

  !> Starts a time.
  subroutine begin(self, time, step, error)
    class(fields_file_t), intent(inout) :: self
    real(wp), intent(in) :: time
    !> Number of the time step
    integer, intent(in) :: step
    !> Raised if the file cannot be opened
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(error)) return
    call self%open_file(error)
    if (allocated(error)) return
    self%time_group = 'times/'//numbered(size(self%grids) + 1)
    call write_reals(self%file, self%time_group//'/time', [time], [integer ::])
    call write_integers(self%file, self%time_group//'/step', [step], [integer ::])
    call write_integers(self%file, self%time_group//'/mesh', [self%mesh], [integer ::])
  end subroutine begin

  !> Writes a field over the points: a scalar, a vector of three components, or any other number of components, which
  !> then become scalars NAME_1, NAME_2, ... because readers of XDMF do not agree on anything else.
  subroutine write_point_field(self, name, values, error)
    class(fields_file_t), intent(inout) :: self
    !> Name of the field
    character(len=*), intent(in) :: name
    !> The field (components by points, those owned first)
    real(wp), intent(in) :: values(:, :)
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(error)) return
    call write_field(self%file, self%rows, self%time_group//'/points/'//name, self%points, values, error)
    call report(self, error)
  end subroutine write_point_field

  !> Writes a field over the elements, with components as over points.
  subroutine write_cell_field(self, name, values, error)
    class(fields_file_t), intent(inout) :: self
    !> Name of the field
    character(len=*), intent(in) :: name
    !> The field (components by elements)
    real(wp), intent(in) :: values(:, :)
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(error)) return
    call write_field(self%file, self%rows, self%time_group//'/cells/'//name, self%cells, values, error)
    call report(self, error)
  end subroutine write_cell_field

  !> Writes values known to every rank, in columns, such as one for each interface.
  subroutine write_figures(self, name, values, error)
    class(fields_file_t), intent(inout) :: self
    !> Their name
    character(len=*), intent(in) :: name
    !> The figures (rows by columns)
    real(wp), intent(in) :: values(:, :)
    !> Raised if they cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(error)) return
    call write_reals(self%file, self%time_group//'/interfaces/'//name, reshape(values, [size(values)]), shape(values))
    call report(self, error)
  end subroutine write_figures

  !> Completes the time, so that the files contain it.
  subroutine finish(self, error)
    class(fields_file_t), intent(inout) :: self
    !> Set if a field of this time could not be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: grid

    if (.not. self%file%is_open) return
    call grid_of_time(self%file, self%name, self%time_group, grid)
    call self%close_file(error, self%time_group)
    if (allocated(error)) return
    call append(self%grids, grid)
    if (self%communicator%is_root()) call write_xdmf(self%base//'.xdmf', self%part, self%grids, error)
    call self%communicator%agree(error)
  end subroutine finish

  !> Stores the names of the files.
  subroutine name_files(self, communicator, base, part)
    class(fields_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: base
    !> Modelled part of the plate
    character(len=*), intent(in) :: part

    self%communicator = communicator
    self%base = base
    self%name = base(index(base, '/', back=.true.) + 1:)//'.h5'
    self%part = part
    self%mesh = 0
    if (allocated(self%grids)) deallocate (self%grids)
    allocate (self%grids(0))
  end subroutine name_files

  !> Opens NAME.h5 to add to it.
  subroutine open_file(self, error)
    class(fields_file_t), intent(inout) :: self
    !> Raised if it cannot be opened
    type(error_t), allocatable, intent(inout) :: error

    call self%file%open(self%communicator, self%base//'.h5', writable=.true.)
    if (allocated(self%file%failure)) call self%close_file(error)
  end subroutine open_file

  !> Closes NAME.h5. If an added group cannot be written, as on a full disk, it is removed again, so that the previous
  !> content remains readable.
  subroutine close_file(self, error, added)
    class(fields_file_t), intent(inout) :: self
    !> Set if there was an error since it was opened
    type(error_t), allocatable, intent(inout) :: error
    !> Group that was added
    character(len=*), intent(in), optional :: added

    if (allocated(self%file%failure) .and. present(added)) call self%file%discard(added)
    call self%file%close()
    call report(self, error)
  end subroutine close_file

  !> Sets an error if there was a failure with NAME.h5.
  subroutine report(self, error)
    class(fields_file_t), intent(in) :: self
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(self%file%failure)) call fail(error, exit_files, &
      'Trouble with the field file '//self%base//'.h5: '//self%file%failure//'.')
  end subroutine report

  !> Removes the times after the last to keep and describes the others.
  subroutine drop_times_after(self, last_time)
    class(fields_file_t), intent(inout) :: self
    !> Time of the last fields to keep
    real(wp), intent(in) :: last_time
    type(line_t), allocatable :: names(:)
    character(len=:), allocatable :: grid
    real(wp), allocatable :: time(:)
    integer :: i

    call self%file%members('times', names)
    do i = 1, size(names)
      call read_reals(self%file, 'times/'//names(i)%text//'/time', time, [integer ::])
      if (time(1) > last_time) then
        call self%file%remove('times/'//names(i)%text)
      else
        call grid_of_time(self%file, self%name, 'times/'//names(i)%text, grid)
        call append(self%grids, grid)
      end if
    end do
  end subroutine drop_times_after
end module fields_file
