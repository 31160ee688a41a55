!> Files written as a whole: to a draft on the disk, which then gets their name.
module whole_files
  use errors, only: error_t, fail, exit_files
  use files, only: file_exists, remove_file, rename_file
  use output_streams, only: output_stream_t
  use text, only: joined, line_t
  implicit none
  private
  public :: write_new_file, write_whole_file

contains

  !> Writes lines to a new file of the user; a file that exists is not replaced.
  subroutine write_new_file(path, lines, error)
    character(len=*), intent(in) :: path
    !> Its lines
    type(line_t), intent(in) :: lines(:)
    !> Set if the file exists or cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (file_exists(path)) then
      call fail(error, exit_files, path//' exists and is not overwritten; give another name or remove it.')
    else
      call write_whole_file(path, joined(lines, new_line('a'))//new_line('a'), error)
    end if
  end subroutine write_new_file

  !> Writes a file or replaces it; without success, as on a full disk, there is no new file.
  subroutine write_whole_file(path, content, error)
    character(len=*), intent(in) :: path
    !> Its text
    character(len=*), intent(in) :: content
    type(error_t), allocatable, intent(inout) :: error
    type(output_stream_t) :: file

    call file%open(path//'.tmp', 'w')
    call file%put(content)
    if (file%is_open()) call file%synchronise()
    call file%close()
    if (file%failed) then
      call remove_file(path//'.tmp')
      call fail(error, exit_files, 'Cannot write '//path//': '//file%reason//'.')
    else
      call rename_file(path//'.tmp', path, error)
    end if
  end subroutine write_whole_file
end module whole_files
