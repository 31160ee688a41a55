!> What becomes of memory that is freed. SuperLU_DIST, which comes with PETSc, makes the C library keep all of it as
!> soon as the program is loaded. That is quick where the same blocks are asked for again and again, as in the steps,
!> but the lists that build the pattern and the ordering of the matrix would add to the peak.
module freed_memory
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: return_freed_memory, keep_freed

  !> Settings of glibc: what is left at the end of the heap when it is trimmed, the size from which a block is a
  !> mapping of its own, which goes back to the system when freed, and how many such mappings there may be.
  integer(c_int), parameter :: trim_threshold = -1, mapping_threshold = -3, max_mappings = -4
  !> Sizes for the first two, bytes
  integer(c_int), parameter :: left_at_end = 2**20, large = 2**18
  !> Mappings that glibc allows by default
  integer(c_int), parameter :: usual_mappings = 65536

  interface
    !> C library: changes a setting.
    integer(c_int) function mallopt(option, value) bind(c)
      import :: c_int
      !> Which
      integer(c_int), value :: option
      !> Its value
      integer(c_int), value :: value
    end function mallopt
  end interface

contains

  !> Lets large blocks go back to the system when they are freed.
  subroutine return_freed_memory()
    call set([trim_threshold, mapping_threshold, max_mappings], [left_at_end, large, usual_mappings])
  end subroutine return_freed_memory

  !> Keeps freed memory for the next request.
  subroutine keep_freed()
    call set([trim_threshold, max_mappings], [-1_c_int, 0_c_int])
  end subroutine keep_freed

  !> Changes settings.
  subroutine set(options, values)
    !> Which
    integer(c_int), intent(in) :: options(:)
    !> Their values
    integer(c_int), intent(in) :: values(:)
    integer(c_int) :: done
    integer :: i

    do i = 1, size(options)
      done = mallopt(options(i), values(i))
    end do
  end subroutine set
end module freed_memory
