!> Signals by which a queue announces the time limit: TERM, INT, USR1, USR2 and XCPU. They are blocked from the start of
!> the program (held_signals.c) and remain pending until they are queried.
module queue_signals
  use, intrinsic :: iso_c_binding, only: c_int
  implicit none
  private
  public :: announce_stop, announce_stop_signals, release_stop_signals, stop_signal

  interface
    !> Restores their default action, for commands that compute nothing.
    subroutine release_stop_signals() bind(c, name='implam_release_stop_signals')
    end subroutine release_stop_signals

    !> Reports such a signal at once on standard error: the run ends after the current step, which may take minutes.
    subroutine announce_stop_signals() bind(c, name='implam_announce_stop_signals')
    end subroutine announce_stop_signals

    !> Reports a signal that the run has received, unless it has been reported.
    subroutine announce_stop() bind(c, name='implam_announce_stop')
    end subroutine announce_stop

    !> Number of a received signal; 0: none.
    integer(c_int) function stop_signal() bind(c, name='implam_stop_signal')
      import :: c_int
    end function stop_signal
  end interface
end module queue_signals
