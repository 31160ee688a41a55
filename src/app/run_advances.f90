!> Progress of a run: in steps if all have one length, else in time or load.
module run_advances
  use deck_contents, only: deck_t
  use kinds, only: wp
  use logger, only: log_t
  use run_moments, only: moment
  use run_progress, only: progress_t
  use text, only: to_text
  use steppers, only: stepper_t
  implicit none
  private
  public :: show_progress

contains

  !> Prints the progress of a run, if it is due.
  subroutine show_progress(progress, deck, stepper, end, log)
    type(progress_t), intent(inout) :: progress
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    real(wp), intent(in) :: end
    type(log_t), intent(inout) :: log
    character(len=:), allocatable :: of

    associate (now => stepper%now)
      if (.not. progress%is_due(log, now%time/end)) return
      of = ''
      if (stepper%expected_steps(end) > 0) of = ' of about '//to_text(stepper%expected_steps(end))
      call progress%update(log, now%time/end, stepper%done(), stepper%left(end), 'step '//to_text(now%step)//of// &
                           ', '//moment(deck, now%time))
    end associate
  end subroutine show_progress
end module run_advances
