!> Operations of the file system that Fortran does not offer.
module files
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char, c_ptr, c_size_t, c_associated, c_loc
  use errors, only: error_t, fail, exit_files
  use system_reasons, only: last_reason
  use text, only: to_text
  implicit none
  private
  public :: file_exists, is_directory, is_pipe, is_readable, is_same_file, rename_file, remove_file, &
            make_directory, read_whole_file, read_obstacle, write_obstacle, ignore_size_signal

  !> Permissions of new folders before the user's mask: rwx for all (octal 777).
  integer(c_int), parameter :: all_permissions = 511_c_int
  !> Mode of `access` for reading
  integer(c_int), parameter :: may_read = 4_c_int

  interface
    !> C library: renames a file in one step.
    integer(c_int) function c_rename(from, to) bind(c, name='rename')
      import :: c_char, c_int
      !> Zero-terminated paths
      character(kind=c_char), intent(in) :: from(*), to(*)
    end function c_rename

    !> C library: removes a file.
    integer(c_int) function c_unlink(path) bind(c, name='unlink')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function c_unlink

    !> C library: creates a folder.
    integer(c_int) function c_mkdir(path, mode) bind(c, name='mkdir')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      !> Permissions
      integer(c_int), value :: mode
    end function c_mkdir

    !> C library: whether a file may be used in a certain way.
    integer(c_int) function c_access(path, mode) bind(c, name='access')
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
      !> The way
      integer(c_int), value :: mode
    end function c_access

    !> 1: the path is a pipe.
    integer(c_int) function implam_is_pipe(path) bind(c)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function implam_is_pipe

    !> 1: both paths lead to one file.
    integer(c_int) function implam_is_same_file(a, b) bind(c)
      import :: c_char, c_int
      !> Zero-terminated paths
      character(kind=c_char), intent(in) :: a(*), b(*)
    end function implam_is_same_file

    !> Number of the reason why a file cannot be extended; 0: it can be.
    integer(c_int) function implam_write_obstacle(path, trial, bytes) bind(c)
      import :: c_char, c_int
      !> Zero-terminated paths of the file and of one that is written instead
      character(kind=c_char), intent(in) :: path(*), trial(*)
      !> Number of bytes
      integer(c_int), value :: bytes
    end function implam_write_obstacle

    !> Writes beyond the limit of the size of files (`ulimit -f`) fail from now on; the Fortran library would end the
    !> program.
    subroutine ignore_size_signal() bind(c, name='implam_ignore_size_signal')
    end subroutine ignore_size_signal

    !> C library: opens a file.
    type(c_ptr) function c_fopen(path, mode) bind(c, name='fopen')
      import :: c_char, c_ptr
      !> Zero-terminated path and mode
      character(kind=c_char), intent(in) :: path(*), mode(*)
    end function c_fopen

    !> C library: reads bytes and returns how many there were.
    integer(c_size_t) function c_fread(buffer, item_size, items, stream) bind(c, name='fread')
      import :: c_ptr, c_size_t
      !> Receives the bytes
      type(c_ptr), value :: buffer
      !> Size and number of items wanted
      integer(c_size_t), value :: item_size, items
      !> Open file
      type(c_ptr), value :: stream
    end function c_fread

    !> C library: closes a file.
    integer(c_int) function c_fclose(stream) bind(c, name='fclose')
      import :: c_int, c_ptr
      !> Open file
      type(c_ptr), value :: stream
    end function c_fclose
  end interface

contains

  !> True: there is a file or folder of that name.
  logical function file_exists(path) result(exists)
    character(len=*), intent(in) :: path

    exists = c_access(path//c_null_char, 0_c_int) == 0
  end function file_exists

  !> True: the path is a folder.
  logical function is_directory(path)
    character(len=*), intent(in) :: path

    is_directory = c_access(path//'/.'//c_null_char, 0_c_int) == 0
  end function is_directory

  !> True: the path is a pipe. Opening it would wait for another program.
  logical function is_pipe(path)
    character(len=*), intent(in) :: path

    is_pipe = implam_is_pipe(path//c_null_char) == 1
  end function is_pipe

  !> True: the path is a file, not a folder, that this process may read.
  logical function is_readable(path)
    character(len=*), intent(in) :: path

    is_readable = .false.
    if (.not. is_directory(path)) is_readable = c_access(path//c_null_char, may_read) == 0
  end function is_readable

  !> True: both paths lead to one existing file, after all links are resolved.
  logical function is_same_file(a, b)
    !> The paths
    character(len=*), intent(in) :: a, b

    is_same_file = implam_is_same_file(a//c_null_char, b//c_null_char) == 1
  end function is_same_file

  !> Why a file cannot be extended, as the end of a sentence; empty if it can be, or if the system gives another reason.
  !> It is called after a failure, since libraries do not return the reason.
  function write_obstacle(path, bytes) result(reason)
    !> Path of the file, which may not exist
    character(len=*), intent(in) :: path
    !> Number of bytes
    integer, intent(in) :: bytes
    character(len=:), allocatable :: reason

    select case (implam_write_obstacle(path//c_null_char, path//'.trial'//c_null_char, bytes))
    case (1)
      reason = 'no space is left on the disk'
    case (2)
      reason = 'the quota of this user on the disk is used up'
    case (3)
      reason = 'the limit of the size of files (ulimit -f) is reached'
    case default
      reason = ''
    end select
  end function write_obstacle

  !> Renames a file atomically: other processes find either the old file of that name or the new one.
  subroutine rename_file(from, to, error)
    !> Paths; a file `to` is replaced
    character(len=*), intent(in) :: from, to
    !> Raised if it cannot be done
    type(error_t), allocatable, intent(inout) :: error

    if (c_rename(from//c_null_char, to//c_null_char) == 0) return
    call fail(error, exit_files, "Cannot rename "//from//' to '//to//': '//last_reason()//'.')
  end subroutine rename_file

  !> Removes a file if it exists. A failure is reported when the file is written again.
  subroutine remove_file(path)
    character(len=*), intent(in) :: path
    integer(c_int) :: ignored

    ignored = c_unlink(path//c_null_char)
  end subroutine remove_file

  !> Creates a folder and its parents, if they do not exist.
  subroutine make_directory(path, error)
    character(len=*), intent(in) :: path
    !> Raised if the folder does not exist afterwards
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: reason
    integer :: i, status

    do i = 2, len(path)
      if (path(i:i) == '/') status = c_mkdir(path(:i - 1)//c_null_char, all_permissions)
    end do
    status = c_mkdir(path//c_null_char, all_permissions)
    if (status /= 0) reason = last_reason()
    ! Another process may have created the folder, so only the result matters.
    if (is_directory(path)) return
    if (file_exists(path)) reason = 'a file has this name'
    if (.not. allocated(reason)) reason = 'it has disappeared'
    call fail(error, exit_files, "Cannot make the folder "//path//': '//reason//'.')
  end subroutine make_directory

  !> Reads an entire file, byte by byte.
  subroutine read_whole_file(path, max_bytes, content, error)
    character(len=*), intent(in) :: path
    !> Largest size accepted
    integer, intent(in) :: max_bytes
    !> The bytes; empty if there was an error
    character(len=:), allocatable, intent(out) :: content
    !> Raised if the file is missing, a folder, unreadable or too large
    type(error_t), allocatable, intent(inout) :: error
    character(kind=c_char), allocatable, target :: buffer(:)
    type(c_ptr) :: stream
    integer :: bytes, i

    content = ''
    if (read_obstacle(path) /= '') then
      call fail(error, exit_files, path//': '//read_obstacle(path)//'.')
      return
    end if
    stream = c_fopen(path//c_null_char, 'rb'//c_null_char)
    if (.not. c_associated(stream)) then
      call fail(error, exit_files, path//': cannot be read: '//last_reason()//'.')
      return
    end if
    allocate (buffer(max_bytes + 1))
    bytes = int(c_fread(c_loc(buffer), 1_c_size_t, int(max_bytes + 1, c_size_t), stream))
    i = c_fclose(stream)
    if (bytes > max_bytes) then
      call fail(error, exit_files, path//': has more than '//to_text(max_bytes)//' bytes.')
      return
    end if
    deallocate (content)
    allocate (character(len=bytes) :: content)
    do i = 1, bytes
      content(i:i) = buffer(i)
    end do
  end subroutine read_whole_file

  !> Why a path cannot be read, as the end of a sentence; empty if it can be.
  function read_obstacle(path) result(reason)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: reason

    reason = ''
    if (is_directory(path)) then
      reason = 'it is a folder, not a file'
    else if (.not. file_exists(path)) then
      reason = 'there is no such file'
    else if (.not. is_readable(path)) then
      reason = 'this user may not read it'
    end if
  end function read_obstacle
end module files
