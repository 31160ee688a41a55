!> NAME_history.csv: a row per accepted step, in columns of fixed width, numbers exact to the last bit. Only the first
!> rank writes, but every routine is collective, so that all ranks agree on errors.
module history_file
  use communicators, only: communicator_t
  use errors, only: error_t, exit_files, exit_internal, fail
  use files, only: file_exists, rename_file
  use history_rows, only: header, row, widths_of
  use kinds, only: long, wp
  use output_streams, only: output_stream_t
  use text, only: to_text
  implicit none
  private
  public :: history_file_t

  !> Longest time in seconds before a row is written to the file: short for a reader, while writes that are this rare
  !> take no measurable time. It has no effect on results.
  real(wp), parameter :: longest_wait = 3
  !> Bytes read at a time.
  integer, parameter :: block_length = 65536

  !> An open history.
  type :: history_file_t
    !> Rows in the file
    integer :: rows = 0
    !> Values of the last of them; not allocated before the first
    real(wp), allocatable :: last_row(:)
    !> The ranks that agree on errors
    type(communicator_t), private :: communicator
    !> Path of the file
    character(len=:), allocatable, private :: path
    !> Integer columns
    logical, allocatable, private :: whole(:)
    !> Characters of each column
    integer, allocatable, private :: widths(:)
    !> The file, open on the first rank
    type(output_stream_t), private :: file
    !> Clock at the last flush
    integer(long), private :: flushed = 0
  contains
    procedure :: create
    procedure :: resume
    procedure :: write_row
    procedure :: flush
    procedure :: close
    procedure, private :: check
    procedure, private :: check_presence
  end type history_file_t

contains

  !> Starts a history, replacing one of that name.
  subroutine create(self, communicator, path, columns, whole, error)
    class(history_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    character(len=*), intent(in) :: columns(:)
    logical, intent(in) :: whole(:)
    !> Raised if the file cannot be written
    type(error_t), allocatable, intent(inout) :: error

    self%communicator = communicator
    self%path = path
    self%whole = whole
    self%widths = widths_of(columns, whole)
    self%rows = 0
    if (allocated(self%last_row)) deallocate (self%last_row)
    if (communicator%is_root()) then
      call self%file%open(path, 'w')
      call self%file%put_line(header(columns))
    end if
    call self%flush(error)
  end subroutine create

  !> Continues a history: rows up to the checkpoint are kept, later ones removed. If there are fewer rows, or no file,
  !> the history continues after these; `rows` is their number. If the row at the checkpoint differs from that of the
  !> run, the history is not changed.
  subroutine resume(self, communicator, path, columns, whole, rows_to_keep, last_row, error)
    class(history_file_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    character(len=*), intent(in) :: path
    character(len=*), intent(in) :: columns(:)
    logical, intent(in) :: whole(:)
    !> Rows written when the checkpoint was
    integer, intent(in) :: rows_to_keep
    !> Values of the last of them, of the first rank; empty without rows
    real(wp), intent(in) :: last_row(:)
    !> Raised if the file cannot be written or is the history of another run
    type(error_t), allocatable, intent(inout) :: error
    logical :: present

    present = communicator%any(communicator%is_root() .and. file_exists(path))
    if (.not. present) then
      call self%create(communicator, path, columns, whole, error)
      return
    end if
    self%communicator = communicator
    self%path = path
    self%whole = whole
    self%widths = widths_of(columns, whole)
    self%rows = 0
    ! The kept rows are written to another file, so that the old history remains valid if the run is killed.
    if (communicator%is_root()) then
      call keep_rows(path, path//'.tmp', header(columns), rows_to_keep, &
                     row(last_row, whole, self%widths), self%rows, error)
      if (.not. allocated(error)) call rename_file(path//'.tmp', path, error)
      if (.not. allocated(error)) call self%file%open(path, 'a')
    end if
    call communicator%broadcast(self%rows)
    if (allocated(self%last_row)) deallocate (self%last_row)
    if (self%rows == rows_to_keep) self%last_row = last_row
    call self%flush(error)
  end subroutine resume

  !> Writes one row.
  subroutine write_row(self, values, error)
    class(history_file_t), intent(inout) :: self
    !> One number per column, of the first rank
    real(wp), intent(in) :: values(:)
    !> Raised if the row cannot be written
    type(error_t), allocatable, intent(inout) :: error
    integer(long) :: now, rate

    if (size(values) /= size(self%whole)) then
      call fail(error, exit_internal, 'A row of the history has another number of values than there are columns.')
      return
    end if
    self%rows = self%rows + 1
    self%last_row = values
    if (self%file%is_open()) then
      call self%file%put_line(row(values, self%whole, self%widths))
      call system_clock(now, rate)
      if (now - self%flushed > longest_wait*rate) then
        call self%file%flush()
        self%flushed = now
      end if
    end if
    call self%check(error)
  end subroutine write_row

  !> Flushes all rows, as required before a checkpoint.
  subroutine flush(self, error)
    class(history_file_t), intent(inout) :: self
    !> Raised if they cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (self%file%is_open()) call self%file%flush()
    call system_clock(self%flushed)
    call self%check(error)
    call self%check_presence(error)
  end subroutine flush

  !> Ends the history.
  subroutine close (self, error)
    class(history_file_t), intent(inout) :: self
    !> Raised if the last rows cannot be written
    type(error_t), allocatable, intent(inout) :: error

    call self%file%close()
    call self%check(error)
    call self%check_presence(error)
  end subroutine close

  !> Raises an error on all ranks if the file has been removed; rows written to a removed file would be lost without an
  !> error.
  subroutine check_presence(self, error)
    class(history_file_t), intent(in) :: self
    type(error_t), allocatable, intent(inout) :: error

    if (self%communicator%is_root() .and. .not. self%file%failed) then
      if (.not. file_exists(self%path)) &
        call fail(error, exit_files, 'The history '//self%path//' has been removed since this run began to write it.')
    end if
    call self%communicator%agree(error)
  end subroutine check_presence

  !> Raises an error on all ranks if the first one could not write.
  subroutine check(self, error)
    class(history_file_t), intent(in) :: self
    type(error_t), allocatable, intent(inout) :: error

    if (self%file%failed) call fail(error, exit_files, "Cannot write the history "//self%path//': '// &
                                    self%file%reason//'.')
    call self%communicator%agree(error)
  end subroutine check

  !> Copies the header and the first rows of a history.
  subroutine keep_rows(from, to, expected, rows_to_keep, last, kept, error)
    !> Path of the history
    character(len=*), intent(in) :: from
    !> Path of the copy
    character(len=*), intent(in) :: to
    !> Header the history must have
    character(len=*), intent(in) :: expected
    !> Rows to keep
    integer, intent(in) :: rows_to_keep
    !> The last of them; empty: none
    character(len=*), intent(in) :: last
    !> Rows kept: fewer if there are not that many
    integer, intent(out) :: kept
    type(error_t), allocatable, intent(inout) :: error
    character(len=len(expected) + 1) :: found
    type(output_stream_t) :: copy
    integer(long) :: bytes
    integer :: unit, status
    logical :: same

    kept = 0
    open (newunit=unit, file=from, access='stream', form='unformatted', action='read', status='old', iostat=status)
    if (status /= 0) then
      call fail(error, exit_files, "Cannot read the history "//from//'.')
      return
    end if
    read (unit, iostat=status) found
    if (status /= 0 .or. found /= expected//new_line('a')) then
      call fail(error, exit_files, 'The history '//from//' has other columns than this run writes; move it away.')
    else
      call measure_rows(unit, len(found, long), rows_to_keep, bytes, kept, status)
      same = kept < rows_to_keep
      if (.not. same) same = ends_with(unit, bytes, last)
      if (status /= 0) then
        call fail(error, exit_files, "Cannot read the history "//from//'.')
      else if (.not. same) then
        call fail(error, exit_files, 'The history '//from//' belongs to another run than the checkpoint: row '// &
                  to_text(rows_to_keep)//' differs; move the history away, or use the checkpoint of its run.')
      else
        call copy%open(to, 'w')
        call copy_bytes(unit, bytes, copy, status)
        call copy%close()
        if (copy%failed) call fail(error, exit_files, "Cannot write "//to//': '//copy%reason//'.')
        if (status /= 0) call fail(error, exit_files, "Cannot read the history "//from//'.')
      end if
    end if
    close (unit, iostat=status)
  end subroutine keep_rows

  !> True if the first part of a file ends with a given line.
  logical function ends_with(unit, bytes, line)
    !> Unit of the file
    integer, intent(in) :: unit
    !> Length of the first part
    integer(long), intent(in) :: bytes
    !> The line, without its end; empty: any
    character(len=*), intent(in) :: line
    character(len=len(line) + 2) :: found
    integer :: status

    ends_with = len(line) == 0
    if (ends_with .or. bytes < len(found)) return
    read (unit, pos=bytes - len(found) + 1, iostat=status) found
    ends_with = status == 0 .and. found == new_line('a')//line//new_line('a')
  end function ends_with

  !> Finds the end of the last row to keep. A row without line end was truncated by a kill and is ignored.
  subroutine measure_rows(unit, header_bytes, rows_to_keep, bytes, kept, status)
    !> Unit of the history
    integer, intent(in) :: unit
    !> Length of the header
    integer(long), intent(in) :: header_bytes
    !> Rows to keep
    integer, intent(in) :: rows_to_keep
    !> Length of the header and the rows to keep
    integer(long), intent(out) :: bytes
    !> Number of these rows
    integer, intent(out) :: kept
    !> 0 unless the file cannot be read
    integer, intent(out) :: status
    character(len=block_length) :: block
    integer(long) :: place, length
    integer :: i

    status = 0
    kept = 0
    bytes = header_bytes
    place = header_bytes
    inquire (unit, size=length)
    do while (place < length .and. kept < rows_to_keep .and. status == 0)
      block = ''
      read (unit, pos=place + 1, iostat=status) block(:min(length - place, len(block, long)))
      do i = 1, block_length
        if (block(i:i) /= new_line('a')) cycle
        kept = kept + 1
        bytes = place + i
        if (kept == rows_to_keep) exit
      end do
      place = place + block_length
    end do
  end subroutine measure_rows

  !> Copies the first part of a file.
  subroutine copy_bytes(unit, bytes, copy, status)
    !> Unit of the file
    integer, intent(in) :: unit
    !> Length to copy
    integer(long), intent(in) :: bytes
    !> Where to
    type(output_stream_t), intent(inout) :: copy
    !> 0 unless the file cannot be read
    integer, intent(out) :: status
    character(len=block_length) :: block
    integer(long) :: place
    integer :: length

    status = 0
    place = 0
    do while (place < bytes .and. status == 0)
      length = int(min(bytes - place, len(block, long)))
      read (unit, pos=place + 1, iostat=status) block(:length)
      call copy%put(block(:length))
      place = place + length
    end do
  end subroutine copy_bytes
end module history_file
