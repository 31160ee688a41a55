!> Signals by which a queue announces that the time is up.
module queue_signals
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: catch_stop_signals, stop_signal

  interface
    !> From now on TERM, INT, USR1, USR2 and XCPU are remembered instead of ending the program, whatever libraries
    !> have made of them.
    subroutine catch_stop_signals() bind(c, name='implam_catch_stop_signals')
    end subroutine catch_stop_signals

    !> Number of the last such signal; 0: none came.
    integer(c_int) function stop_signal() bind(c, name='implam_stop_signal')
      import :: c_int
    end function stop_signal
  end interface
end module queue_signals
