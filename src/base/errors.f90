!> Errors are returned as values: a procedure that can fail returns one, only `main` ends the program.
module errors
  implicit none
  private
  public :: error_t, fail

  !> Exit codes of the program, which are also the kinds of errors.
  integer, parameter, public :: exit_done = 0
  integer, parameter, public :: exit_usage = 1
  integer, parameter, public :: exit_deck = 2
  integer, parameter, public :: exit_convergence = 3
  integer, parameter, public :: exit_files = 4
  integer, parameter, public :: exit_internal = 5
  integer, parameter, public :: exit_stopped = 75

  !> Description of the error; unallocated: success.
  type :: error_t
    !> Exit code of the program if no caller handles the error.
    integer :: code = exit_internal
    !> One sentence for the user.
    character(len=:), allocatable :: message
  end type error_t

contains

  !> Raises an error. The first error of a chain is kept: a second call changes nothing.
  subroutine fail(error, code, message)
    type(error_t), allocatable, intent(inout) :: error
    !> One of the exit codes of this module
    integer, intent(in) :: code
    !> One sentence for the user
    character(len=*), intent(in) :: message

    if (allocated(error)) return
    allocate (error)
    error%code = code
    error%message = message
  end subroutine fail
end module errors
