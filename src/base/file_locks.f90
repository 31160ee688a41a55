!> A lock that shows other runs that a file is being written. It ends with the process, however that ends.
module file_locks
  use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
  implicit none
  private
  public :: file_lock_t

  !> Return code of the C side if another process holds the lock.
  integer(c_int), parameter :: taken_by_another = -2

  !> A lock on one file.
  type :: file_lock_t
    private
    !> The descriptor that holds it; negative: none
    integer(c_int) :: descriptor = -1
  contains
    procedure :: take
    procedure :: release
  end type file_lock_t

  interface
    !> Locks a file, which is created if it does not exist: a descriptor, or a negative number.
    integer(c_int) function implam_lock_file(path) bind(c)
      import :: c_char, c_int
      character(kind=c_char), intent(in) :: path(*)
    end function implam_lock_file

    !> Ends a lock.
    subroutine implam_unlock_file(descriptor) bind(c)
      import :: c_int
      !> Return code of implam_lock_file
      integer(c_int), value :: descriptor
    end subroutine implam_unlock_file
  end interface

contains

  !> Takes the lock without waiting; without effect on file systems without locks.
  subroutine take(self, path, refused)
    class(file_lock_t), intent(inout) :: self
    character(len=*), intent(in) :: path
    !> True: another run holds it
    logical, intent(out) :: refused

    call self%release()
    self%descriptor = implam_lock_file(path//c_null_char)
    refused = self%descriptor == taken_by_another
  end subroutine take

  !> Releases the lock.
  subroutine release(self)
    class(file_lock_t), intent(inout) :: self

    if (self%descriptor >= 0) call implam_unlock_file(self%descriptor)
    self%descriptor = -1
  end subroutine release
end module file_locks
