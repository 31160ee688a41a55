!> Failures so far in the current test on this process, with their positions.
module test_failures
  implicit none
  private
  public :: SourceLocation, anyExceptions, add_failure, take_failures

  !> Position of an assert in a test file
  type :: SourceLocation
    !> Path of the test file
    character(len=512) :: file = '?'
    !> Line in that file
    integer :: line = 0
  end type SourceLocation

  !> One line per failed assert; asserts have no other access to the run of their test
  character(len=:), allocatable, save :: failures

contains

  !> Whether an assert has failed in the current test on this process.
  logical function anyExceptions()
    anyExceptions = allocated(failures)
  end function anyExceptions

  !> Adds a failed assert.
  subroutine add_failure(reason, message, location)
    !> Expected and found values
    character(len=*), intent(in) :: reason
    !> Message of the test's author
    character(len=*), intent(in), optional :: message
    !> Position of the assert
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

  !> Returns the failures of the completed test, and resets them.
  subroutine take_failures(text)
    !> One line per failure; empty if there was none
    character(len=:), allocatable, intent(out) :: text

    if (allocated(failures)) then
      call move_alloc(failures, text)
    else
      text = ''
    end if
  end subroutine take_failures
end module test_failures
