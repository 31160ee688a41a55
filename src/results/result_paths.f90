!> The files of a run, by the suffix of their names.
module result_paths
  use errors, only: error_t, exit_files, fail
  use files, only: is_pipe
  implicit none
  private
  public :: refuse_pipes

  !> Suffixes of all files that a run opens, including temporary ones.
  character(len=*), parameter :: endings(*) = [character(len=24) :: '.log', '_history.csv', '_history.csv.tmp', '.h5', &
    '.h5.reserve', '.xdmf', '.xdmf.tmp', '_summary.json', '_summary.json.tmp', '_restart.h5', '_restart.h5.tmp', &
    '_restart.h5.tmp.reserve']

contains

  !> Checks that none of the files is a pipe: opening one would wait until another program reads it.
  subroutine refuse_pipes(base, error)
    character(len=*), intent(in) :: base
    type(error_t), allocatable, intent(inout) :: error
    integer :: i

    do i = 1, size(endings)
      if (is_pipe(base//trim(endings(i)))) call fail(error, exit_files, base//trim(endings(i))//' is a pipe, not a '// &
        'file; remove it, or give another folder (--output).')
    end do
  end subroutine refuse_pipes
end module result_paths
