!> Signals by which a queue announces that the time is up: TERM, INT, USR1, USR2 and XCPU. The program holds them back
!> from its start on (held_signals.c), so that they wait until they are asked for.
module queue_signals
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: announce_stop_signals, release_stop_signals, stop_signal

  interface
    !> From now on they end the program, as they do others; for what computes nothing.
    subroutine release_stop_signals() bind(c, name='implam_release_stop_signals')
    end subroutine release_stop_signals

    !> From now on a line on standard error says at once that such a signal has come: the run ends with the step at
    !> hand, which may take minutes.
    subroutine announce_stop_signals() bind(c, name='implam_announce_stop_signals')
    end subroutine announce_stop_signals

    !> Number of such a signal that has come; 0: none.
    integer(c_int) function stop_signal() bind(c, name='implam_stop_signal')
      import :: c_int
    end function stop_signal
  end interface
end module queue_signals
