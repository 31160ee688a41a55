!> New files of the user, written only if they do not exist.
module new_files
  use errors, only: error_t, fail, exit_files
  use files, only: file_exists
  use text, only: joined, line_t
  use whole_files, only: write_whole_file
  implicit none
  private
  public :: write_new_file

contains

  !> Writes lines to a new file.
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
end module new_files
