!> Progress of a run: in steps if all have one length, else in time or load.
module run_advances
  use deck_contents, only: deck_t
  use kinds, only: wp
  use logger, only: log_t
  use run_moments, only: moment
  use run_progress, only: progress_t
  use text, only: to_text
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: start_progress, show_progress

contains

  !> Starts the clock of a run or restart.
  subroutine start_progress(progress, stepper, end)
    type(progress_t), intent(inout) :: progress
    type(time_stepper_t), intent(in) :: stepper
    !> End of the run
    real(wp), intent(in) :: end

    call progress%start(stepper%now%time/end, done(stepper))
  end subroutine start_progress

  !> Prints the progress of a run, if it is due.
  subroutine show_progress(progress, deck, stepper, end, log)
    type(progress_t), intent(inout) :: progress
    type(deck_t), intent(in) :: deck
    type(time_stepper_t), intent(in) :: stepper
    !> End of the run
    real(wp), intent(in) :: end
    type(log_t), intent(inout) :: log
    character(len=:), allocatable :: of

    associate (now => stepper%now)
      if (.not. progress%is_due(log, now%time/end)) return
      of = ''
      if (allocated(stepper%explicit)) of = ' of about '//to_text(nint(done(stepper) + left(stepper, end)))
      call progress%update(log, now%time/end, done(stepper), left(stepper, end), 'step '//to_text(now%step)//of// &
                           ', '//moment(deck, now%time))
    end associate
  end subroutine show_progress

  !> The completed part.
  pure real(wp) function done(stepper)
    type(time_stepper_t), intent(in) :: stepper

    done = stepper%now%time
    if (allocated(stepper%explicit)) done = stepper%now%step
  end function done

  !> The remainder, in the same unit. The length of steps by central differences is assumed to be constant.
  pure real(wp) function left(stepper, end)
    type(time_stepper_t), intent(in) :: stepper
    !> End of the run
    real(wp), intent(in) :: end

    left = max(0.0_wp, end - stepper%now%time)
    if (allocated(stepper%explicit)) left = left/max(stepper%explicit%steps%now, tiny(left))
  end function left
end module run_advances
