!> Why the last operation of the C library has failed.
module system_reasons
  use, intrinsic :: iso_c_binding, only: c_char, c_int
  implicit none
  private
  public :: last_reason

  !> Characters of a reason.
  integer, parameter :: max_length = 200

  interface
    !> Copies the reason without a zero; returns its length.
    integer(c_int) function implam_last_reason(text, size) bind(c)
      import :: c_char, c_int
      !> Receives the reason
      character(kind=c_char), intent(out) :: text(*)
      !> Characters of it
      integer(c_int), value :: size
    end function implam_last_reason
  end interface

contains

  !> The reason as the end of a sentence; to be called at once after the failure.
  function last_reason() result(reason)
    !> Such as `permission denied`
    character(len=:), allocatable :: reason
    character(kind=c_char) :: text(max_length)
    integer :: length, i

    length = implam_last_reason(text, int(max_length, c_int))
    allocate (character(len=length) :: reason)
    do i = 1, length
      reason(i:i) = text(i)
    end do
  end function last_reason
end module system_reasons
