!> The log on the terminal and in NAME.log. Any rank may call at any time, but only the rank opened with `writes`
!> prints. No routine is collective.
module logger
  use, intrinsic :: iso_c_binding, only: c_int
  use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
  use errors, only: error_t, exit_files, fail
  use file_locks, only: file_lock_t
  use kinds, only: long, wp
  use output_streams, only: output_stream_t
  implicit none
  private
  public :: log_t

  !> Longest time in seconds before a line is written to the file: short for a reader, while writes that are this rare
  !> take no measurable time. It has no effect on results.
  real(wp), parameter :: longest_wait = 2
  !> C's number of the standard output.
  integer(c_int), parameter :: standard_output = 1

  !> A log file together with the terminal.
  type :: log_t
    !> True: details are printed on the terminal, too
    logical :: verbose = .false.
    !> The output is a terminal, on which a line can be overwritten
    logical :: interactive = .false.
    !> Warnings so far
    integer :: warnings = 0
    !> This rank writes
    logical, private :: writes = .false.
    !> The file
    type(output_stream_t), private :: file
    !> Prevents other runs from writing the same log and results
    type(file_lock_t), private :: lock
    !> Length of the transient line on the terminal now
    integer, private :: transient = 0
    !> Clock at the last flush
    integer(long), private :: flushed = 0
  contains
    procedure :: open
    procedure :: error
    procedure :: warning
    procedure :: note
    procedure :: detail
    procedure :: status
    procedure :: close
    procedure, private :: to_terminal
    procedure, private :: to_file
    procedure, private :: clear_status
  end type log_t

  interface
    !> C library: whether a file descriptor is a terminal.
    integer(c_int) function c_isatty(descriptor) bind(c, name='isatty')
      import :: c_int
      !> The descriptor
      integer(c_int), value :: descriptor
    end function c_isatty
  end interface

contains

  !> Starts the log.
  subroutine open (self, path, writes, append, error)
    class(log_t), intent(inout) :: self
    !> Path of the file; empty: terminal only
    character(len=*), intent(in) :: path
    !> This rank is the one that writes
    logical, intent(in) :: writes
    !> Append to the existing file (restart)
    logical, intent(in) :: append
    !> Raised, on the rank that writes, if the file cannot be opened or another run writes it
    type(error_t), allocatable, intent(inout) :: error
    logical :: refused

    self%writes = writes
    if (.not. writes) return
    self%interactive = c_isatty(standard_output) == 1
    if (len_trim(path) == 0) return
    ! Opening may empty the file, so the lock is taken before.
    call self%lock%take(path, refused)
    if (refused) then
      call fail(error, exit_files, 'Another run is writing '//trim(path)//' and the results beside it; wait '// &
                'until it has ended, or give another folder (--output).')
      return
    end if
    call self%file%open(path, merge('a', 'w', append))
    if (self%file%failed) call fail(error, exit_files, "Cannot write the log "//trim(path)//': '//self%file%reason//'.')
    call system_clock(self%flushed)
  end subroutine open

  !> Records the error that ends the run; on the terminal the program prints it at the end.
  subroutine error(self, text)
    class(log_t), intent(inout) :: self
    !> One sentence
    character(len=*), intent(in) :: text

    call self%to_file('error: '//text, at_once=.true.)
  end subroutine error

  !> Prints a warning.
  subroutine warning(self, text)
    class(log_t), intent(inout) :: self
    !> One sentence
    character(len=*), intent(in) :: text

    self%warnings = self%warnings + 1
    call self%to_terminal(error_unit, 'implam: warning: '//text)
    call self%to_file('warning: '//text, at_once=.true.)
  end subroutine warning

  !> Shows the progress of the run.
  subroutine note(self, text)
    class(log_t), intent(inout) :: self
    !> One line
    character(len=*), intent(in) :: text

    call self%to_terminal(output_unit, text)
    call self%to_file(text, at_once=.true.)
  end subroutine note

  !> Writes a line to the file only.
  subroutine detail(self, text)
    class(log_t), intent(inout) :: self
    !> One line
    character(len=*), intent(in) :: text

    if (self%verbose) call self%to_terminal(output_unit, text)
    call self%to_file(text, at_once=.false.)
  end subroutine detail

  !> Shows a line that the next one overwrites; no effect if the output is not a terminal.
  subroutine status(self, text)
    class(log_t), intent(inout) :: self
    !> One line
    character(len=*), intent(in) :: text
    integer :: ignored

    if (.not. (self%writes .and. self%interactive)) return
    write (output_unit, '(3a)', advance='no', iostat=ignored) achar(13), text, &
      repeat(' ', max(0, self%transient - len(text)))
    flush (output_unit, iostat=ignored)
    self%transient = len(text)
  end subroutine status

  !> Ends the log.
  subroutine close (self)
    class(log_t), intent(inout) :: self

    call self%clear_status()
    call self%file%close()
    call self%lock%release()
  end subroutine close

  !> Writes a line to the terminal; the run continues if this fails.
  subroutine to_terminal(self, unit, line)
    class(log_t), intent(inout) :: self
    !> Unit of the terminal
    integer, intent(in) :: unit
    character(len=*), intent(in) :: line
    integer :: ignored

    if (.not. self%writes) return
    call self%clear_status()
    write (unit, '(a)', iostat=ignored) line
    flush (unit, iostat=ignored)
  end subroutine to_terminal

  !> Writes a line to the file. If this fails no more lines are written to the file, and the terminal is informed.
  subroutine to_file(self, line, at_once)
    class(log_t), intent(inout) :: self
    character(len=*), intent(in) :: line
    !> True: the line is written at once
    logical, intent(in) :: at_once
    integer(long) :: now, rate

    if (.not. self%file%is_open()) return
    call self%file%put_line(line)
    call system_clock(now, rate)
    if (at_once .or. now - self%flushed > longest_wait*rate) then
      call self%file%flush()
      self%flushed = now
    end if
    if (.not. self%file%failed) return
    call self%file%close()
    call self%to_terminal(error_unit, 'implam: warning: the log file cannot be written any more')
  end subroutine to_file

  !> Blanks the transient line.
  subroutine clear_status(self)
    class(log_t), intent(inout) :: self
    integer :: ignored

    if (self%transient == 0) return
    write (output_unit, '(3a)', advance='no', iostat=ignored) achar(13), repeat(' ', self%transient), achar(13)
    flush (output_unit, iostat=ignored)
    self%transient = 0
  end subroutine clear_status
end module logger
