!> New files of the user, written only if they do not exist.
module new_files
  use errors, only: error_t, fail, exit_files
  use files, only: file_exists
  use text, only: line_t
  implicit none
  private
  public :: write_new_file

contains

  !> Writes lines to a new file.
  subroutine write_new_file(path, lines, error)
    !> Its path
    character(len=*), intent(in) :: path
    !> Its lines
    type(line_t), intent(in) :: lines(:)
    !> Set if the file exists or cannot be written
    type(error_t), allocatable, intent(inout) :: error
    integer :: unit, status, i

    if (file_exists(path)) then
      call fail(error, exit_files, path//' exists and is not overwritten; give another name or remove it.')
      return
    end if
    open (newunit=unit, file=path, status='new', action='write', iostat=status)
    do i = 1, size(lines)
      if (status == 0) write (unit, '(a)', iostat=status) lines(i)%text
    end do
    if (status == 0) close (unit, iostat=status)
    if (status /= 0) call fail(error, exit_files, 'Cannot write '//path//'.')
  end subroutine write_new_file
end module new_files
