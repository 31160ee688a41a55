!> An HDF5 file shared by all ranks, on one rank without MPI. Every routine is collective. Errors are stored and agreed
!> on by all ranks; after an error the routines do nothing, and the owner of the file checks at the end.
module hdf5_file
  use communicators, only: communicator_t
  use hdf5, only: h5eset_auto_f, h5f_acc_rdonly_f, h5f_acc_rdwr_f, h5f_acc_trunc_f, h5f_obj_all_f, h5f_obj_file_f, &
    h5fclose_f, h5fcreate_f, h5fd_mpio_collective_f, h5fopen_f, h5gclose_f, h5gcreate_f, &
    h5gget_obj_info_idx_f, h5gn_members_f, h5iis_valid_f, h5ldelete_f, h5lexists_f, h5open_f, &
    h5p_dataset_create_f, h5p_dataset_xfer_f, h5p_file_access_f, h5p_file_create_f, h5p_link_create_f, &
    h5pclose_f, h5pcreate_f, h5pset_create_inter_group_f, h5pset_dxpl_mpio_f, h5pset_fapl_mpio_f, &
    h5pset_obj_track_times_f, h5pset_userblock_f, h5t_native_integer, hid_t, hsize_t
  use files, only: write_obstacle
  use mpi, only: mpi_info_null
  use output_streams, only: output_stream_t
  use text, only: line_t
  implicit none
  private
  public :: hdf5_file_t, files_left_open

  !> Bytes reserved on the disk while data are written, and freed for the metadata of HDF5 before the file is closed:
  !> HDF5 crashes or hangs if it cannot write these.
  integer, parameter :: reserved_bytes = 1048576

  !> An open file.
  type :: hdf5_file_t
    !> The error; unallocated if there is none
    character(len=:), allocatable :: failure
    !> The ranks that share the file
    type(communicator_t) :: communicator
    !> Handle of the file
    integer(hid_t) :: id = -1
    !> Property list: all ranks transfer together; negative between closing and opening
    integer(hid_t) :: together = -1
    !> Property list: missing groups of a path are created
    integer(hid_t) :: with_groups = -1
    !> Property list: datasets carry no dates, so equal runs give equal files
    integer(hid_t) :: undated = -1
    !> The file is open
    logical :: is_open = .false.
    !> Path of the reserve file, on the first rank; not allocated if there is none
    character(len=:), allocatable, private :: reserve
    !> Path of the file, on the first rank; not allocated if it is read only
    character(len=:), allocatable, private :: path
  contains
    procedure :: create
    procedure :: open
    procedure, private :: write_reserve
    procedure, private :: remove_reserve
    procedure :: close
    procedure :: check_status
    procedure :: succeeded
    procedure :: exists
    procedure :: make_group
    procedure :: remove
    procedure :: discard
    procedure :: members
  end type hdf5_file_t

contains

  !> Creates a file, replacing one of that name.
  subroutine create(self, communicator, path, head)
    class(hdf5_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    !> Bytes kept free at the start of the file: 0, or a power of two of at least 512
    integer, intent(in) :: head
    integer(hid_t) :: access_list, creation_list
    integer :: status, closed

    call start_over(self, communicator)
    call self%write_reserve(path)
    if (allocated(self%failure)) return
    call prepare(self, access_list)
    call h5pcreate_f(h5p_file_create_f, creation_list, status)
    call h5pset_userblock_f(creation_list, int(head, hsize_t), status)
    call h5fcreate_f(path, h5f_acc_trunc_f, self%id, status, creation_list, access_list)
    self%is_open = status == 0
    call h5pclose_f(creation_list, closed)
    call h5pclose_f(access_list, closed)
    call self%check_status(status, 'the file could not be created')
  end subroutine create

  !> Opens a file that is there.
  subroutine open (self, communicator, path, writable)
    class(hdf5_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    !> The file is to be written to as well
    logical, intent(in) :: writable
    integer(hid_t) :: access_list
    integer :: status, closed

    call start_over(self, communicator)
    if (writable) call self%write_reserve(path)
    if (allocated(self%failure)) return
    call prepare(self, access_list)
    call h5fopen_f(path, merge(h5f_acc_rdwr_f, h5f_acc_rdonly_f, writable), self%id, status, access_list)
    self%is_open = status == 0
    call h5pclose_f(access_list, closed)
    call self%check_status(status, 'the file could not be opened')
  end subroutine open

  !> Resets the error and the file.
  subroutine start_over(self, communicator)
    class(hdf5_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator

    if (allocated(self%failure)) deallocate (self%failure)
    if (allocated(self%path)) deallocate (self%path)
    self%communicator = communicator
  end subroutine start_over

  !> Writes the reserve file; without space for it the error is set before HDF5 opens the file.
  subroutine write_reserve(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    type(output_stream_t) :: stream

    if (self%communicator%is_root()) then
      self%path = path
      self%reserve = path//'.reserve'
      call stream%open(self%reserve, 'w')
      call stream%put(repeat('.', reserved_bytes))
      call stream%close()
    end if
    call self%check_status(merge(-1, 0, stream%failed), 'the folder cannot be written to or the disk is full')
    if (allocated(self%failure)) call self%remove_reserve()
  end subroutine write_reserve

  !> Removes the reserve.
  subroutine remove_reserve(self)
    class(hdf5_file_t), intent(inout) :: self
    integer :: unit, status

    if (allocated(self%reserve)) then
      open (newunit=unit, file=self%reserve, status='old', iostat=status)
      if (status == 0) close (unit, status='delete', iostat=status)
      deallocate (self%reserve)
    end if
    call self%communicator%barrier()
  end subroutine remove_reserve

  !> Starts the library if necessary, silences its own messages and creates the property lists.
  subroutine prepare(self, access_list)
    class(hdf5_file_t), intent(inout) :: self
    !> Property list for opening the file
    integer(hid_t), intent(out) :: access_list
    integer :: status
    logical :: started

    ! h5open_f creates the type constants of the library again at each call.
    call h5iis_valid_f(h5t_native_integer, started, status)
    if (.not. started) call h5open_f(status)
    call h5eset_auto_f(0, status)
    call h5pcreate_f(h5p_file_access_f, access_list, status)
    call h5pcreate_f(h5p_dataset_xfer_f, self%together, status)
    if (self%communicator%size > 1) then
      call h5pset_fapl_mpio_f(access_list, self%communicator%handle(), mpi_info_null, status)
      call h5pset_dxpl_mpio_f(self%together, h5fd_mpio_collective_f, status)
    else
      call leave_unlocked(access_list)
    end if
    call h5pcreate_f(h5p_link_create_f, self%with_groups, status)
    call h5pset_create_inter_group_f(self%with_groups, 1, status)
    call h5pcreate_f(h5p_dataset_create_f, self%undated, status)
    call h5pset_obj_track_times_f(self%undated, .false., status)
  end subroutine prepare

  !> Disables locking of the file, as on several ranks: otherwise a program that reads results while they are written
  !> would end the run.
  subroutine leave_unlocked(access_list)
    use, intrinsic :: iso_c_binding, only: c_bool, c_int, c_int64_t
    !> Property list for opening the file
    integer(hid_t), intent(in) :: access_list
    interface
      !> HDF5 in C.
      integer(c_int) function set_locking(list, use_locks, ignore_when_disabled) bind(c, name='H5Pset_file_locking')
        import :: c_bool, c_int, c_int64_t
        !> Property list for opening the file
        integer(c_int64_t), value :: list
        !> True: files are locked; true: file systems without locking are accepted
        logical(c_bool), value :: use_locks, ignore_when_disabled
      end function set_locking
    end interface
    integer(c_int) :: ignored

    ignored = set_locking(int(access_list, c_int64_t), .false._c_bool, .true._c_bool)
  end subroutine leave_unlocked

  !> Closes the file, also after a failure to open it. On several ranks HDF5 waits forever if one of them cannot write
  !> the metadata: if not even half of the reserve can be written, the file is not closed.
  subroutine close (self)
    class(hdf5_file_t), intent(inout) :: self
    integer :: status, closed
    character(len=:), allocatable :: obstacle

    if (self%together < 0) return
    call self%remove_reserve()
    obstacle = ''
    if (self%communicator%size > 1) obstacle = obstacle_of(self, reserved_bytes/2)
    if (obstacle /= '' .and. .not. allocated(self%failure)) self%failure = obstacle
    status = 0
    if (self%is_open .and. obstacle == '') call h5fclose_f(self%id, status)
    self%is_open = .false.
    call h5pclose_f(self%together, closed)
    call h5pclose_f(self%with_groups, closed)
    call h5pclose_f(self%undated, closed)
    self%together = -1
    call self%check_status(status, 'the file could not be closed')
  end subroutine close

  !> True if the library has failed to close a file on this rank; it would crash in a second attempt during the
  !> finalization of MPI.
  logical function files_left_open()
    use, intrinsic :: iso_c_binding, only: c_int, c_int64_t, c_size_t
    interface
      !> HDF5 in C; the Fortran interface subtracts the initial objects of the library, of any kind.
      integer(c_size_t) function count_objects(file, kinds) bind(c, name='H5Fget_obj_count')
        import :: c_int, c_int64_t, c_size_t
        !> A file, or all
        integer(c_int64_t), value :: file
        !> Kinds of objects to count
        integer(c_int), value :: kinds
      end function count_objects
    end interface
    integer :: status

    call h5iis_valid_f(h5t_native_integer, files_left_open, status)
    if (files_left_open) files_left_open = count_objects(int(h5f_obj_all_f, c_int64_t), int(h5f_obj_file_f, c_int)) > 0
  end function files_left_open

  !> Agrees on whether the last step failed on any rank.
  subroutine check_status(self, status, failure)
    class(hdf5_file_t), intent(inout) :: self
    !> Status the library returned on this rank; negative means failed
    integer, intent(in) :: status
    !> The error, if any; equal on all ranks
    character(len=*), intent(in) :: failure

    if (allocated(self%failure)) return
    if (.not. self%communicator%any(status < 0)) return
    ! The reserve exists while data are written: less space than its size remained for the data.
    self%failure = obstacle_of(self, reserved_bytes)
    if (self%failure == '') self%failure = failure
  end subroutine check_status

  !> Why the system refuses further writes, such as on a full disk; empty if it does not. Collective.
  function obstacle_of(self, bytes) result(obstacle)
    type(hdf5_file_t), intent(in) :: self
    !> Number of bytes to be written
    integer, intent(in) :: bytes
    !> The end of a sentence, equal on all ranks
    character(len=:), allocatable :: obstacle

    obstacle = ''
    if (allocated(self%path)) obstacle = write_obstacle(self%path, bytes)
    call self%communicator%broadcast_text(obstacle)
  end function obstacle_of

  !> True if there was no error so far.
  pure logical function succeeded(self)
    class(hdf5_file_t), intent(in) :: self

    succeeded = self%is_open .and. .not. allocated(self%failure)
  end function succeeded

  !> True if there is a group or dataset of that path.
  logical function exists(self, path)
    class(hdf5_file_t), intent(in) :: self
    character(len=*), intent(in) :: path
    integer :: status

    exists = .false.
    if (.not. self%succeeded()) return
    call h5lexists_f(self%id, path, exists, status)
    exists = exists .and. status == 0
  end function exists

  !> Creates a group, and the missing groups above it.
  subroutine make_group(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer(hid_t) :: group
    integer :: status

    if (.not. self%succeeded()) return
    call h5gcreate_f(self%id, path, group, status, lcpl_id=self%with_groups)
    if (status == 0) call h5gclose_f(group, status)
    call self%check_status(status, 'group '//path//' could not be made')
  end subroutine make_group

  !> Removes a group with its content, or a dataset.
  subroutine remove(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer :: status

    if (.not. self%succeeded()) return
    call h5ldelete_f(self%id, path, status)
    call self%check_status(status, path//' could not be removed')
  end subroutine remove

  !> Removes a group after an error, so that the file can be closed.
  subroutine discard(self, path)
    class(hdf5_file_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    integer :: status

    call self%remove_reserve()
    if (self%is_open) call h5ldelete_f(self%id, path, status)
  end subroutine discard

  !> Names of the members of a group, in alphabetical order; none if there is no such group.
  subroutine members(self, path, names)
    class(hdf5_file_t), intent(inout) :: self
    !> Path of the group
    character(len=*), intent(in) :: path
    !> Names of its members
    type(line_t), allocatable, intent(out) :: names(:)
    character(len=256) :: name
    integer :: count, i, kind, status

    count = 0
    if (self%exists(path)) then
      call h5gn_members_f(self%id, path, count, status)
      if (status < 0) count = 0
      call self%check_status(status, 'group '//path//' could not be listed')
    end if
    allocate (names(count))
    do i = 1, count
      call h5gget_obj_info_idx_f(self%id, path, i - 1, name, kind, status)
      names(i)%text = trim(name)
      call self%check_status(status, 'group '//path//' could not be listed')
    end do
  end subroutine members
end module hdf5_file
