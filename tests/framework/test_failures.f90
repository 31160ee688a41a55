!> What failed so far in the test that runs on this process, and where.
module test_failures
  implicit none
  private
  public :: SourceLocation, anyExceptions, add_failure, take_failures

  !> Place of an assert in a test file
  type :: SourceLocation
    !> Path of the test file
    character(len=512) :: file = '?'
    !> Line in that file
    integer :: line = 0
  end type SourceLocation

  !> One line a failed assert; the asserts of a test have no other way to reach the run that it belongs to
  character(len=:), allocatable, save :: failures

contains

  !> Has an assert failed in the current test on this process?
  logical function anyExceptions()
    anyExceptions = allocated(failures)
  end function anyExceptions

  !> Notes that an assert failed.
  subroutine add_failure(reason, message, location)
    !> What was expected and what was found
    character(len=*), intent(in) :: reason
    !> What the author of the test wishes to say about it
    character(len=*), intent(in), optional :: message
    !> Where the assert stands
    type(SourceLocation), intent(in), optional :: location
    type(SourceLocation) :: place
    character(len=12) :: line

    if (present(location)) place = location
    write (line, '(i0)') place%line
    if (.not. allocated(failures)) failures = ''
    failures = failures//'  '//trim(place%file)//':'//trim(line)//': '//reason
    if (present(message)) then
      if (len_trim(message) > 0) failures = failures//' ['//trim(message)//']'
    end if
    failures = failures//new_line('a')
  end subroutine add_failure

  !> Returns the failures of the test that ended, and resets them.
  subroutine take_failures(text)
    !> One line a failure; empty if there was none
    character(len=:), allocatable, intent(out) :: text

    if (allocated(failures)) then
      call move_alloc(failures, text)
    else
      text = ''
    end if
  end subroutine take_failures
end module test_failures
