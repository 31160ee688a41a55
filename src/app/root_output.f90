!> Lines on the terminal, from the root rank alone.
module root_output
  use, intrinsic :: iso_fortran_env, only: output_unit
  use communicators, only: communicator_t
  use text, only: line_t
  implicit none
  private
  public :: print_lines

contains

  !> Prints lines on the root rank.
  subroutine print_lines(communicator, lines)
    type(communicator_t), intent(in) :: communicator
    type(line_t), intent(in) :: lines(:)
    integer :: i

    if (.not. communicator%is_root()) return
    do i = 1, size(lines)
      write (output_unit, '(a)') lines(i)%text
    end do
  end subroutine print_lines
end module root_output
