!> Summary of a run, printed in the log and written to NAME_summary.json.
module run_summaries
  use case_deck, only: needs_coarse_run
  use coarse_runs, only: coarse_run_t, run_coarse_model
  use deck_contents, only: deck_t
  use errors, only: error_t
  use kinds, only: wp
  use logger, only: log_t
  use models, only: model_t
  use run_errors, only: run_errors_t, errors_by_coarse_run, errors_by_elastic_impact
  use run_figures, only: run_figures_t, ending_of, find_figures
  use run_provenance, only: provenance_t
  use run_records, only: run_record_t
  use run_results, only: results_t
  use run_warnings, only: reported_warnings
  use summary_file, only: summary_text
  use summary_lines, only: lines_of_summary
  use summary_results, only: results_of
  use text, only: line_t
  use steppers, only: stepper_t
  use whole_files, only: write_whole_file
  implicit none
  private
  public :: summarise

  !> Reasons why errors are not known, or not as requested.
  character(len=*), parameter :: &
    unasked = 'not known; a coarser run, about an eighth of the work, gives them with &case error_estimate=.true.', &
    cut = 'not known; the coarser run that gives them is not complete', &
    elastic_only = 'those of the preliminary elastic impact; the coarser run for more accurate ones is not complete'

contains

  !> Prints and writes the summary, also of a run that was stopped or has failed. A coarse run precedes it if the deck
  !> requests one, or an accuracy without another error estimate; the run's factor has been released. Collective.
  subroutine summarise(deck, model, stepper, record, provenance, seconds, path, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(in) :: record
    type(provenance_t), intent(in) :: provenance
    !> Wall-clock time since the start of this process
    real(wp), intent(in) :: seconds
    character(len=*), intent(in) :: path
    type(log_t), intent(inout) :: log
    !> Reason of a premature end; otherwise set if the summary cannot be written
    type(error_t), allocatable, intent(inout) :: error
    type(run_figures_t) :: figures
    type(results_t) :: results
    type(run_errors_t) :: errors
    type(coarse_run_t) :: coarse_run
    type(error_t), allocatable :: fault
    type(line_t), allocatable :: lines(:), given(:)
    character(len=:), allocatable :: unknown_because
    logical :: ended, needed
    integer :: i

    call find_figures(model, stepper%now, figures)
    results = results_of(deck, stepper%now, record, figures)
    if (.not. allocated(error)) errors = errors_by_elastic_impact(deck, record, stepper%now%has_failures())
    ended = .not. (allocated(error) .or. deck%setup%is_static() .or. deck%setup%initial%is_inherited)
    needed = ended .and. needs_coarse_run(deck%settings, errors%source /= 'none')
    if (needed) call run_coarse_model(deck, model%plate%communicator, coarse_run)
    if (coarse_run%done) errors = errors_by_coarse_run(deck, record, stepper%now%impact%impactor%velocity, &
                                                     sum(figures%interfaces%area), coarse_run)
    unknown_because = ''
    if (needed .and. .not. coarse_run%done) then
      unknown_because = cut
      if (errors%source == 'elastic') unknown_because = elastic_only
    else if (ended .and. errors%source == 'none') then
      unknown_because = unasked
    end if
    given = reported_warnings(record, deck, stepper)
    lines = lines_of_summary(deck, results, record, figures, errors, unknown_because, given)
    do i = 1, size(lines)
      call log%note(lines(i)%text)
    end do
    if (model%plate%communicator%is_root()) &
      call write_whole_file(path, summary_text(deck, stepper, record, results, figures, errors, given, &
                                               ending_of(error), provenance, model%plate%profile, seconds), fault)
    call model%plate%communicator%agree(fault)
    if (allocated(fault) .and. .not. allocated(error)) error = fault
  end subroutine summarise
end module run_summaries
