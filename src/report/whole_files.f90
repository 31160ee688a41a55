!> Files written as a whole: to a draft on the disk, which then gets their name.
module whole_files
  use errors, only: error_t, fail, exit_files
  use files, only: remove_file, rename_file
  use output_streams, only: output_stream_t
  implicit none
  private
  public :: write_whole_file

contains

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
