!> NAME_history.csv: a row an accepted step, numbers exact to the last bit. Only the first rank writes,
!> yet every routine is collective, so that all ranks agree on errors.
module history_file
  use communicators, only: communicator_t
  use errors, only: error_t, exit_files, exit_internal, fail
  use files, only: file_exists, rename_file
  use kinds, only: long, wp
  implicit none
  private
  public :: history_file_t

  !> Longest time in seconds that a row may wait before it is in the file.
  real(wp), parameter :: longest_wait = 3

  !> An open history.
  type :: history_file_t
    !> Rows in the file
    integer :: rows = 0
    !> The ranks that agree on errors
    type(communicator_t), private :: communicator
    !> Path of the file
    character(len=:), allocatable, private :: path
    !> Columns that hold integers
    logical, allocatable, private :: whole(:)
    !> Unit of the file, on the first rank
    integer, private :: unit = 0
    !> The file is open, on the first rank
    logical, private :: is_open = .false.
    !> Clock at the last flush
    integer(long), private :: flushed = 0
  contains
    procedure :: create
    procedure :: resume
    procedure :: write_row
    procedure :: flush
    procedure :: close
    procedure, private :: open_unit
    procedure, private :: check
  end type history_file_t

contains

  !> Starts a history, replacing one of that name.
  subroutine create(self, communicator, path, columns, whole, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Path of the file
    character(len=*), intent(in) :: path
    !> Names of the columns
    character(len=*), intent(in) :: columns(:)
    !> Columns that hold integers
    logical, intent(in) :: whole(:)
    !> Raised if the file can't be written
    type(error_t), allocatable, intent(inout) :: error
    integer :: status

    self%communicator = communicator
    self%path = path
    self%whole = whole
    self%rows = 0
    if (communicator%is_root()) then
      call self%open_unit(path, 'rewind', error)
      if (.not. allocated(error)) then
        write (self%unit, '(a)', iostat=status) header(columns)
        call self%check(status, error)
      end if
    end if
    call self%flush(error)
  end subroutine create

  !> Goes on with a history: its first rows are kept, those after the checkpoint dropped. If there are fewer rows, or no
  !> file, it goes on with what there is: `rows` then tells.
  subroutine resume(self, communicator, path, columns, whole, rows_to_keep, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Path of the file
    character(len=*), intent(in) :: path
    !> Names of the columns
    character(len=*), intent(in) :: columns(:)
    !> Columns that hold integers
    logical, intent(in) :: whole(:)
    !> Rows written when the checkpoint was
    integer, intent(in) :: rows_to_keep
    !> Raised if the file can't be written or is the history of another kind of run
    type(error_t), allocatable, intent(inout) :: error
    logical :: present

    present = .false.
    if (communicator%is_root()) present = file_exists(path)
    call communicator%broadcast(present)
    if (.not. present) then
      call self%create(communicator, path, columns, whole, error)
      return
    end if
    self%communicator = communicator
    self%path = path
    self%whole = whole
    self%rows = 0
    ! The kept rows are written aside: a kill meanwhile leaves the old history whole.
    if (communicator%is_root()) then
      call keep_rows(path, path//'.tmp', header(columns), rows_to_keep, self%rows, error)
      if (.not. allocated(error)) call rename_file(path//'.tmp', path, error)
      if (.not. allocated(error)) call self%open_unit(path, 'append', error)
    end if
    call communicator%broadcast(self%rows)
    call self%flush(error)
  end subroutine resume

  !> Writes one row.
  subroutine write_row(self, values, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> One number a column; those of the first rank count
    real(wp), intent(in) :: values(:)
    !> Raised if the row can't be written
    type(error_t), allocatable, intent(inout) :: error
    integer(long) :: now, rate
    integer :: status

    if (size(values) /= size(self%whole)) then
      call fail(error, exit_internal, 'A row of the history has another number of values than there are columns.')
      return
    end if
    self%rows = self%rows + 1
    if (self%is_open) then
      write (self%unit, '(a)', iostat=status) row(values, self%whole)
      call system_clock(now, rate)
      if (status == 0 .and. now - self%flushed > longest_wait*rate) then
        flush (self%unit, iostat=status)
        self%flushed = now
      end if
      call self%check(status, error)
    end if
    call self%communicator%agree(error)
  end subroutine write_row

  !> Hands all rows to the operating system, as is due before a checkpoint.
  subroutine flush(self, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> Raised if they can't be written
    type(error_t), allocatable, intent(inout) :: error
    integer :: status

    if (self%is_open) then
      flush (self%unit, iostat=status)
      call self%check(status, error)
      call system_clock(self%flushed)
    end if
    call self%communicator%agree(error)
  end subroutine flush

  !> Ends the history.
  subroutine close (self, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> Raised if the last rows can't be written
    type(error_t), allocatable, intent(inout) :: error
    integer :: status

    if (self%is_open) then
      flush (self%unit, iostat=status)
      call self%check(status, error)
      close (self%unit, iostat=status)
      call self%check(status, error)
      self%is_open = .false.
    end if
    call self%communicator%agree(error)
  end subroutine close

  !> Opens the file for writing.
  subroutine open_unit(self, path, position, error)
    !> The history
    class(history_file_t), intent(inout) :: self
    !> Path of the file
    character(len=*), intent(in) :: path
    !> Fortran's position: rewind (the file is emptied) or append
    character(len=*), intent(in) :: position
    !> Raised if it can't be opened
    type(error_t), allocatable, intent(inout) :: error
    integer :: status

    if (position == 'rewind') then
      open (newunit=self%unit, file=path, action='write', status='replace', iostat=status)
    else
      open (newunit=self%unit, file=path, action='write', position=position, iostat=status)
    end if
    self%is_open = status == 0
    if (status /= 0) call fail(error, exit_files, "Can't open the history "//path//' for writing.')
  end subroutine open_unit

  !> Raises an error if a transfer failed.
  subroutine check(self, status, error)
    !> The history
    class(history_file_t), intent(in) :: self
    !> Status of the transfer
    integer, intent(in) :: status
    !> Raised unless the status is 0
    type(error_t), allocatable, intent(inout) :: error

    if (status /= 0) call fail(error, exit_files, "Can't write to the history "//self%path &
                               //': is the disk full, or the quota used up?')
  end subroutine check

  !> Copies the header and the first rows of a history.
  subroutine keep_rows(from, to, expected, wanted, kept, error)
    !> Path of the history
    character(len=*), intent(in) :: from
    !> Path of the copy
    character(len=*), intent(in) :: to
    !> Header the history must have
    character(len=*), intent(in) :: expected
    !> Rows to keep
    integer, intent(in) :: wanted
    !> Rows kept: fewer if there are not that many
    integer, intent(out) :: kept
    !> Raised on a failure
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: line
    logical :: complete
    integer :: source, copy, status, closed

    kept = 0
    open (newunit=source, file=from, action='read', status='old', iostat=status)
    if (status /= 0) then
      call fail(error, exit_files, "Can't read the history "//from//'.')
      return
    end if
    call read_line(source, line, complete)
    if (.not. complete .or. line /= expected) then
      call fail(error, exit_files, 'The history '//from//' has other columns than this run writes; move it away.')
      close (source)
      return
    end if
    open (newunit=copy, file=to, action='write', status='replace', iostat=status)
    if (status == 0) write (copy, '(a)', iostat=status) line
    do while (status == 0 .and. kept < wanted)
      call read_line(source, line, complete)
      if (.not. complete) exit
      write (copy, '(a)', iostat=status) line
      kept = kept + 1
    end do
    if (status == 0) flush (copy, iostat=status)
    if (status /= 0) call fail(error, exit_files, "Can't write "//to//'.')
    close (copy, iostat=closed)
    close (source, iostat=closed)
  end subroutine keep_rows

  !> Reads a line of any length.
  subroutine read_line(unit, line, complete)
    !> Unit of the file
    integer, intent(in) :: unit
    !> The line
    character(len=:), allocatable, intent(out) :: line
    !> There was a line, with its end
    logical, intent(out) :: complete
    character(len=512) :: part
    integer :: length, status

    line = ''
    do
      read (unit, '(a)', advance='no', iostat=status, size=length) part
      line = line//part(:length)
      if (status /= 0) exit
    end do
    complete = is_iostat_eor(status)
  end subroutine read_line

  !> First line of the file.
  pure function header(columns) result(line)
    !> Names of the columns
    character(len=*), intent(in) :: columns(:)
    !> The line
    character(len=:), allocatable :: line
    integer :: i

    line = ''
    do i = 1, size(columns)
      if (i > 1) line = line//','
      line = line//trim(columns(i))
    end do
  end function header

  !> One row as text.
  pure function row(values, whole) result(line)
    !> The numbers
    real(wp), intent(in) :: values(:)
    !> Columns that hold integers
    logical, intent(in) :: whole(:)
    !> The line
    character(len=:), allocatable :: line
    ! 17 significant digits give every double back exactly.
    character(len=25) :: number
    integer :: i

    line = ''
    do i = 1, size(values)
      if (whole(i)) then
        write (number, '(i0)') nint(values(i), long)
      else
        write (number, '(es25.16e3)') values(i)
      end if
      if (i > 1) line = line//','
      line = line//trim(adjustl(number))
    end do
  end function row
end module history_file
