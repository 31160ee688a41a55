!> Comparison of the figures of the examples with their tolerances.
module example_checks
  use kinds, only: wp
  implicit none
  private
  public :: require

contains

  !> Prints a figure and ends the program with code 1 if its error exceeds the tolerance.
  subroutine require(what, found, expected, tolerance)
    !> What the figure is
    character(len=*), intent(in) :: what
    !> The figure, and its expected value
    real(wp), intent(in) :: found, expected
    !> Largest difference allowed
    real(wp), intent(in) :: tolerance

    print '(2a,es23.15,a,es23.15,a,es9.2)', what, ':', found, ' for', expected, ', off by', found - expected
    if (abs(found - expected) <= tolerance) return
    print '(a,es9.2)', 'more than', tolerance
    stop 1
  end subroutine require
end module example_checks
