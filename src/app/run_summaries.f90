!> The end of a run in words and figures: found once, printed in the log and written to NAME_summary.json.
module run_summaries
  use case_deck, only: needs_companion
  use companion_runs, only: companion_t, run_companion
  use deck_contents, only: deck_t
  use errors, only: error_t
  use kinds, only: wp
  use logger, only: log_t
  use models, only: model_t
  use run_errors, only: run_errors_t, errors_by_companion, errors_by_pilot
  use run_figures, only: run_figures_t, ending_of, find_figures
  use run_provenance, only: provenance_t
  use run_records, only: run_record_t
  use summary_file, only: summary_text, write_summary
  use summary_lines, only: lines_of_summary
  use text, only: line_t
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: summarise

  !> Why errors are not known, or not as was asked.
  character(len=*), parameter :: &
    unasked = 'not known; a coarser run, about an eighth of the work, gives them with &case error_estimate=.true.', &
    cut = 'not known; the coarser run that gives them has not come to its end', &
    pilots = 'those of the pilot; the coarser run that gives more accurate ones has not come to its end'

contains

  !> Says what a run has come to, also one that has been stopped or has failed. A companion runs first if the deck asks
  !> for one, or for an accuracy that nothing else gives; the run's own factor has been released by then. Collective.
  subroutine summarise(deck, model, stepper, record, provenance, seconds, path, log, error)
    !> The deck
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    !> What the run has stepped with
    type(time_stepper_t), intent(in) :: stepper
    !> What it remembers
    type(run_record_t), intent(in) :: record
    !> Version, deck and machine
    type(provenance_t), intent(in) :: provenance
    !> Wall-clock time since this process began
    real(wp), intent(in) :: seconds
    !> Path of the file
    character(len=*), intent(in) :: path
    !> The log
    type(log_t), intent(inout) :: log
    !> What ended the run before its time; set, if nothing did, if the summary cannot be written
    type(error_t), allocatable, intent(inout) :: error
    type(run_figures_t) :: figures
    type(run_errors_t) :: errors
    type(companion_t) :: companion
    type(error_t), allocatable :: fault
    type(line_t), allocatable :: lines(:)
    character(len=:), allocatable :: unknown_because
    logical :: ended, wanted
    integer :: i

    call find_figures(model, stepper%now, figures)
    if (.not. allocated(error)) errors = errors_by_pilot(deck, record)
    ended = .not. (allocated(error) .or. deck%has_static .or. deck%inherits)
    wanted = ended .and. needs_companion(deck%settings, errors%source /= 'none')
    if (wanted) call run_companion(deck, model%communicator, companion)
    if (companion%done) errors = errors_by_companion(deck, record, stepper%now%impactor%velocity, &
                                                     sum(figures%interfaces%area), companion)
    unknown_because = ''
    if (wanted .and. .not. companion%done) then
      unknown_because = cut
      if (errors%source == 'pilot') unknown_because = pilots
    else if (ended .and. errors%source == 'none') then
      unknown_because = unasked
    end if
    lines = lines_of_summary(deck, stepper%now, record, figures, errors, unknown_because)
    do i = 1, size(lines)
      call log%note(lines(i)%text)
    end do
    if (model%communicator%is_root()) &
      call write_summary(path, summary_text(deck, stepper, record, figures, errors, ending_of(error), provenance, &
                                            seconds), fault)
    call model%communicator%agree(fault)
    if (allocated(fault) .and. .not. allocated(error)) error = fault
  end subroutine summarise
end module run_summaries
