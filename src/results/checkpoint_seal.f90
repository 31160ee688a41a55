!> The seal in the header of a checkpoint: format, length, and checksum of the remainder. It is written last, so that a
!> file with a valid seal is complete, and any later change is detected.
module checkpoint_seal
  use, intrinsic :: iso_fortran_env, only: int32, int8
  use errors, only: error_t, exit_files, fail
  use files, only: is_pipe, read_obstacle
  use kinds, only: long
  use output_streams, only: output_stream_t
  implicit none
  private
  public :: seal, verify_seal, synchronise_folder, crc32

  !> Bytes of the header of the file, which HDF5 reserves for the user.
  integer, parameter, public :: head_length = 512
  !> First line of the header.
  character(len=*), parameter :: title = 'IMPLAM CHECKPOINT'
  !> Second line of the header; its number changes when older files cannot be read.
  character(len=*), parameter :: format_line = 'format 5'
  !> End of a line.
  character(len=*), parameter :: end_of_line = new_line('a')
  !> Bytes read at a time.
  integer, parameter :: block_length = 1048576
  !> CRC of an empty file.
  integer(int32), parameter :: empty_crc = 0
  !> Polynomial of CRC-32 (IEEE 802.3), bits reversed: hexadecimal EDB88320.
  integer(int32), parameter :: polynomial = -306674912_int32

contains

  !> Writes the seal into the header of a file, and waits until the file is on the disk.
  subroutine seal(path, error)
    character(len=*), intent(in) :: path
    !> Set if the file cannot be read or written
    type(error_t), allocatable, intent(inout) :: error
    type(output_stream_t) :: file
    integer(long) :: bytes
    integer(int32) :: crc
    integer :: status

    call read_body(path, bytes, crc, status)
    call file%open(path, 'r+')
    call file%put(head(bytes, crc))
    call file%synchronise()
    call file%close()
    if (file%failed) then
      call fail(error, exit_files, 'Cannot complete the checkpoint '//path//': '//file%reason//'.')
    else if (status /= 0) then
      call fail(error, exit_files, 'Cannot complete the checkpoint '//path//', which cannot be read.')
    end if
  end subroutine seal

  !> Checks that a file is a valid checkpoint.
  subroutine verify_seal(path, error)
    character(len=*), intent(in) :: path
    !> Raised with the reason if it is not
    type(error_t), allocatable, intent(inout) :: error
    character(len=head_length) :: found
    integer(long) :: bytes
    integer(int32) :: crc
    integer :: status

    found = ''
    status = merge(1, 0, is_pipe(path))
    if (status == 0) call read_head(path, found, status)
    if (status == 0) call read_body(path, bytes, crc, status)
    if (read_obstacle(path) /= '') then
      call fail(error, exit_files, 'Cannot read the checkpoint '//path//': '//read_obstacle(path)//'.')
    else if (status /= 0) then
      call fail(error, exit_files, "Cannot read the checkpoint "//path//'.')
    else if (found(:len(title)) /= title) then
      call fail(error, exit_files, path//' is not a checkpoint of Implam.')
    else if (index(found, end_of_line//'format ') > 0 .and. &
             index(found, end_of_line//format_line//end_of_line) == 0) then
      call fail(error, exit_files, 'The checkpoint '//path//' was written by another version of Implam; ' &
                //'this one reads '//format_line//' only.')
    else if (found /= head(bytes, crc)) then
      call fail(error, exit_files, 'The checkpoint '//path//' is damaged: it was cut short or altered.')
    end if
  end subroutine verify_seal

  !> Waits until the names of the files in a folder are on the disk.
  subroutine synchronise_folder(path, error)
    !> Path of the folder
    character(len=*), intent(in) :: path
    type(error_t), allocatable, intent(inout) :: error
    type(output_stream_t) :: entries

    call entries%open(path, 'r')
    call entries%synchronise()
    call entries%close()
    if (entries%failed) call fail(error, exit_files, 'Cannot write the folder '//path//' to the disk: '// &
                                  entries%reason//'.')
  end subroutine synchronise_folder

  !> The header of a file with a given body.
  pure function head(bytes, crc)
    !> Length of the body
    integer(long), intent(in) :: bytes
    !> Checksum of the body
    integer(int32), intent(in) :: crc
    !> The header: lines of text, blanks and a last line end
    character(len=head_length) :: head

    write (head, '(4a,a,i0,2a,z8.8,a)') title, end_of_line, format_line, end_of_line, &
      'bytes ', bytes, end_of_line, 'crc32 ', crc, end_of_line
    head(head_length:) = end_of_line
  end function head

  !> Reads the header of a file; blank where the file is shorter.
  subroutine read_head(path, found, status)
    character(len=*), intent(in) :: path
    !> The head
    character(len=head_length), intent(out) :: found
    !> 0 unless the file cannot be read
    integer, intent(out) :: status
    integer(long) :: bytes
    integer :: unit, closed

    found = ''
    open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
    if (status /= 0) return
    inquire (unit, size=bytes)
    if (bytes > 0) read (unit, pos=1, iostat=status) found(:min(bytes, int(head_length, long)))
    close (unit, iostat=closed)
  end subroutine read_head

  !> Length and checksum of the body of a file.
  subroutine read_body(path, bytes, crc, status)
    character(len=*), intent(in) :: path
    !> Length
    integer(long), intent(out) :: bytes
    !> Checksum
    integer(int32), intent(out) :: crc
    !> 0 unless the file cannot be read
    integer, intent(out) :: status
    integer(int8), allocatable :: block(:)
    integer(long) :: done
    integer :: unit, length, closed

    crc = empty_crc
    bytes = 0
    open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
    if (status /= 0) return
    inquire (unit, size=bytes)
    bytes = max(bytes - head_length, 0_long)
    allocate (block(block_length))
    done = 0
    do while (done < bytes .and. status == 0)
      length = int(min(bytes - done, int(block_length, long)))
      read (unit, pos=head_length + done + 1, iostat=status) block(:length)
      crc = crc32(block(:length), crc)
      done = done + length
    end do
    close (unit, iostat=closed)
  end subroutine read_body

  !> Checksum CRC-32 (IEEE 802.3, as in zip and gzip): finds every change of up to four neighbouring bytes.
  pure function crc32(bytes, before) result(crc)
    !> The bytes
    integer(int8), intent(in) :: bytes(:)
    !> Checksum of the bytes before these; 0 if there are none
    integer(int32), intent(in) :: before
    !> Checksum of all
    integer(int32) :: crc
    integer(int32) :: table(0:255)
    integer :: i, bit

    do i = 0, 255
      table(i) = i
      do bit = 1, 8
        table(i) = ieor(ishft(table(i), -1), merge(polynomial, 0_int32, btest(table(i), 0)))
      end do
    end do
    crc = not(before)
    do i = 1, size(bytes)
      crc = ieor(ishft(crc, -8), table(iand(ieor(crc, int(bytes(i), int32)), 255_int32)))
    end do
    crc = not(crc)
  end function crc32
end module checkpoint_seal
