!> Text files written through the C library, because Fortran's `flush` and `close` do not report when the disk is full.
module output_streams
  use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_null_ptr, c_ptr, c_size_t
  use system_reasons, only: last_reason
  implicit none
  private
  public :: output_stream_t

  !> A file being written. After a failure it remains failed: `failed` is checked at the end.
  type :: output_stream_t
    !> True: an operation has failed
    logical :: failed = .false.
    !> Why the first one has failed, as the end of a sentence
    character(len=:), allocatable :: reason
    !> C's handle
    type(c_ptr), private :: stream = c_null_ptr
  contains
    procedure :: open
    procedure :: is_open
    procedure :: put
    procedure :: put_line
    procedure :: flush
    procedure :: synchronise
    procedure :: close
    procedure, private :: note
  end type output_stream_t

  interface
    !> C library: opens a file.
    type(c_ptr) function c_fopen(path, mode) bind(c, name='fopen')
      import :: c_char, c_ptr
      !> Zero-terminated path and mode
      character(kind=c_char), intent(in) :: path(*), mode(*)
    end function c_fopen

    !> C library: writes items and returns how many it could.
    integer(c_size_t) function c_fwrite(items, item_length, count, stream) bind(c, name='fwrite')
      import :: c_char, c_ptr, c_size_t
      !> The items
      character(kind=c_char), intent(in) :: items(*)
      !> Bytes an item, and number of items
      integer(c_size_t), value :: item_length, count
      !> The open file
      type(c_ptr), value :: stream
    end function c_fwrite

    !> C library: flushes a stream to the operating system.
    integer(c_int) function c_fflush(stream) bind(c, name='fflush')
      import :: c_int, c_ptr
      !> The open file
      type(c_ptr), value :: stream
    end function c_fflush

    !> C library: descriptor of an open file.
    integer(c_int) function c_fileno(stream) bind(c, name='fileno')
      import :: c_int, c_ptr
      !> The open file
      type(c_ptr), value :: stream
    end function c_fileno

    !> C library: waits until a file is on the disk.
    integer(c_int) function c_fsync(descriptor) bind(c, name='fsync')
      import :: c_int
      !> Descriptor of the file
      integer(c_int), value :: descriptor
    end function c_fsync

    !> C library: closes a file.
    integer(c_int) function c_fclose(stream) bind(c, name='fclose')
      import :: c_int, c_ptr
      !> The open file
      type(c_ptr), value :: stream
    end function c_fclose
  end interface

contains

  !> Opens a file.
  subroutine open (self, path, mode)
    class(output_stream_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    !> As in C: 'w' a new file, 'a' at the end of the file, 'r+' over its beginning, 'r' nothing to write
    character(len=*), intent(in) :: mode

    self%stream = c_fopen(path//c_null_char, mode//c_null_char)
    self%failed = .false.
    call self%note(.not. c_associated(self%stream))
  end subroutine open

  !> Whether the file is open.
  logical function is_open(self)
    class(output_stream_t), intent(in) :: self

    is_open = c_associated(self%stream)
  end function is_open

  !> Writes text as it is.
  subroutine put(self, text)
    class(output_stream_t), intent(inout) :: self
    character(len=*), intent(in) :: text
    integer(c_size_t) :: written

    if (self%failed .or. len(text) == 0) return
    written = c_fwrite(text, 1_c_size_t, len(text, c_size_t), self%stream)
    call self%note(written /= len(text))
  end subroutine put

  !> Writes a line.
  subroutine put_line(self, line)
    class(output_stream_t), intent(inout) :: self
    !> The line, without its end
    character(len=*), intent(in) :: line

    call self%put(line//new_line('a'))
  end subroutine put_line

  !> Flushes to the operating system.
  subroutine flush(self)
    class(output_stream_t), intent(inout) :: self

    if (.not. self%failed) call self%note(c_fflush(self%stream) /= 0)
  end subroutine flush

  !> Waits until the file is on the disk.
  subroutine synchronise(self)
    class(output_stream_t), intent(inout) :: self

    call self%flush()
    if (.not. self%failed) call self%note(c_fsync(c_fileno(self%stream)) /= 0)
  end subroutine synchronise

  !> Closes the file.
  subroutine close (self)
    class(output_stream_t), intent(inout) :: self
    integer(c_int) :: status

    if (.not. self%is_open()) return
    status = c_fclose(self%stream)
    self%stream = c_null_ptr
    call self%note(status /= 0)
  end subroutine close

  !> Stores a failure of the last operation with its reason; that of the first one is kept.
  subroutine note(self, has_failed)
    class(output_stream_t), intent(inout) :: self
    !> True: it has failed
    logical, intent(in) :: has_failed

    if (self%failed .or. .not. has_failed) return
    self%failed = .true.
    self%reason = last_reason()
  end subroutine note
end module output_streams
