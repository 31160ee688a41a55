!> A run: initialise, step until the end, finalise.
module simulations
  use kinds, only: wp
  use errors, only: error_t, fail, exit_stopped
  use files, only: make_directory, remove_file
  use logger, only: log_t
  use profiles, only: profile_t, wall_time
  use timers, only: timer_set_t
  use communicators, only: communicator_t
  use launchers, only: launched
  use models, only: model_t
  use model_building, only: create_model
  use stepper_choice, only: choose_stepper
  use steppers, only: stepper_t
  use deck_contents, only: deck_t
  use build_information, only: this_build
  use deck_echo, only: adopted_values
  use result_paths, only: refuse_pipes
  use run_provenance, only: provenance_t, this_run
  use run_advances, only: show_progress
  use run_moments, only: moment
  use run_progress, only: progress_t
  use run_records, only: run_record_t, new_run_record
  use run_reports, only: log_echo, log_model, log_costs
  use run_steps, only: advance_to_output, row_is_due
  use run_warnings, only: report_last_warnings, report_warnings
  use stepping_parameters, only: end_of_run
  use run_summaries, only: summarise
  use summary_file, only: summary_ending
  use history_file, only: history_file_t
  use fields_file, only: fields_file_t
  use checkpoints, only: checkpoint_archive_t, checkpoint_ending, retire_checkpoint
  use wall_limits, only: wall_limit_t
  use queue_signals, only: announce_stop, stop_signal
  use output_clocks, only: clock_t, next_event, shown_time
  use energy_checks, only: energy_check_t
  use initial_states, only: take_initial_state, visit_incomplete_start
  use adaptive_zones, only: visit_zones
  use result_rows, only: list_columns, row_of
  use result_tables, only: result_name_length
  use field_results, only: field_rows, part_of, write_fields, write_mesh
  implicit none
  private
  public :: simulation_t

  !> A run with its open files. It has many components because it owns files, clocks and timers.
  type :: simulation_t
    type(deck_t) :: deck
    !> The ranks
    type(communicator_t) :: communicator
    type(model_t) :: model
    !> The time stepper, with the state
    class(stepper_t), allocatable :: stepper
    !> Log, progress and result files
    type(log_t) :: log
    !> Time of set-up, steps and output
    type(timer_set_t) :: timers
    !> Bar or lines of progress
    type(progress_t) :: progress
    !> Version, deck and machine, for every result
    type(provenance_t) :: provenance
    !> Force history
    type(history_file_t) :: history
    type(fields_file_t) :: fields
    !> Clocks of history, fields and checkpoints
    type(clock_t) :: history_clock, fields_clock, checkpoint_clock
    !> Wall-clock limit
    type(wall_limit_t), private :: wall_limit
    !> Record for the summary
    type(run_record_t), private :: record
    !> True: set up, so that a summary can be written
    logical, private :: is_ready = .false.
    !> The check of energies
    type(energy_check_t), private :: energy_check
    !> Folder and name that all results share
    character(len=:), allocatable :: base
  contains
    procedure :: initialize
    procedure :: resume
    procedure :: run
    procedure :: finalize
    procedure :: conclude
  end type simulation_t

contains

  !> Sets a run up from the start.
  subroutine initialize(self, deck, communicator, profile, error)
    class(simulation_t), intent(out) :: self
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    type(profile_t), intent(in) :: profile
    !> Set if files cannot be written or the model cannot be set up
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: retired
    character(len=result_name_length), allocatable :: names(:)
    logical, allocatable :: whole(:)

    call prepare(self, deck, communicator, profile, append=.false., error=error)
    if (.not. allocated(error) .and. deck%setup%initial%is_inherited) &
      call take_initial_state(deck, self%model, self%stepper, self%record, self%log, error)
    if (.not. allocated(error)) call retire_checkpoint(communicator, self%base//checkpoint_ending, retired, error)
    if (allocated(error)) return
    if (retired /= '') call self%log%note('The checkpoint of an earlier run is now '//retired//'.')
    ! From here on the results of an earlier run are replaced, whose summary must not be taken for that of this run.
    if (communicator%is_root()) call remove_file(self%base//summary_ending)
    call list_columns(deck, names, whole)
    call self%history%create(communicator, self%base//'_history.csv', names, whole, error)
    if (allocated(error)) return
    call self%fields%create(communicator, self%base, self%provenance, part_of(self%deck), error)
    if (allocated(error)) return
    call write_mesh(self%model%plate, self%fields, error)
    self%is_ready = .not. allocated(error)
  end subroutine initialize

  !> Common part of initialise and resume: log, model, state at rest.
  subroutine prepare(self, deck, communicator, profile, append, error)
    class(simulation_t), intent(inout) :: self
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    type(profile_t), intent(in) :: profile
    !> True: append to the existing log
    logical, intent(in) :: append
    !> Set if something cannot be set up
    type(error_t), allocatable, intent(out) :: error

    self%timers%profile = profile
    call self%timers%start('set-up')
    self%deck = deck
    self%communicator = communicator
    self%base = deck%output%directory//'/'//deck%case%name
    self%wall_limit = wall_limit_t(deck%stepping%time%wall_limit, profile%begun)
    self%history_clock%interval = deck%output%history_every
    self%fields_clock%interval = deck%output%fields_every
    self%checkpoint_clock%interval = deck%output%checkpoint_every
    call self%fields%describe(field_rows)
    if (communicator%is_root()) call make_directory(deck%output%directory, error)
    if (communicator%is_root()) call refuse_pipes(self%base, error)
    if (.not. allocated(error)) call self%log%open(self%base//'.log', communicator%is_root(), append, error)
    call communicator%agree(error)
    if (allocated(error)) return
    ! A launcher gives its ranks a terminal of its own, whose output may be redirected to a file.
    if (launched()) self%log%interactive = .false.
    self%provenance = this_run(this_build(), deck%text, communicator%size)
    self%provenance%units = deck%case%units
    self%provenance%case_name = deck%case%name
    self%provenance%library = adopted_values(deck%settings)
    call self%provenance%report(self%log)
    call log_echo(deck, self%log)
    call self%timers%start('model')
    call create_model(deck%setup, communicator, self%model, error)
    call self%timers%stop('model')
    self%model%plate%profile = profile
    if (allocated(error)) return
    call choose_stepper(deck%stepping, self%stepper)
    call self%stepper%start(self%model, deck%stepping, deck%linear_solver, &
                            append .or. deck%setup%initial%is_inherited, error)
    if (allocated(error)) return
    self%record = new_run_record(self%model%plate)
    self%record%filter%frequency = deck%output%force_filter
    call log_model(self%deck, self%model, self%stepper, self%log)
    call self%progress%start(self%stepper%now%time/end_of(self), self%stepper%done())
  end subroutine prepare

  !> Sets a run up from a checkpoint that has been opened for loading.
  subroutine resume(self, deck, communicator, profile, path, error)
    class(simulation_t), intent(out) :: self
    !> The deck of the checkpoint
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    type(profile_t), intent(in) :: profile
    !> The checkpoint
    character(len=*), intent(in) :: path
    !> Set if the checkpoint cannot be used
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    real(wp), allocatable :: last_row(:)
    character(len=result_name_length), allocatable :: names(:)
    logical, allocatable :: whole(:)
    integer :: rows

    call prepare(self, deck, communicator, profile, append=.true., error=error)
    if (allocated(error)) return
    call archive%open_for_loading(communicator, path, error)
    if (allocated(error)) return
    call visit(self, archive, rows, error)
    if (allocated(error)) return
    call archive%close(error)
    if (allocated(error)) return
    call self%fields%check_deck(communicator, self%base, deck%text, error)
    if (allocated(error)) return
    last_row = self%history%last_row
    call list_columns(deck, names, whole)
    call self%history%resume(communicator, self%base//'_history.csv', names, whole, rows, last_row, error)
    if (allocated(error)) return
    if (self%history%rows /= rows) &
      call self%log%warning('The history before the checkpoint is missing; it continues from here.')
    ! Without an interval the only fields are those of the end, which are written again.
    call self%fields%resume(communicator, self%base, self%provenance, part_of(self%deck), &
                            merge(shown_time(self%stepper%now%time), -1.0_wp, self%fields_clock%interval > 0), error)
    if (allocated(error)) return
    call write_mesh(self%model%plate, self%fields, error)
    call self%progress%start(self%stepper%now%time/end_of(self), self%stepper%done())
    if (allocated(error)) return
    if (communicator%is_root()) call remove_file(self%base//summary_ending)
    self%is_ready = .true.
  end subroutine resume

  !> Saves or loads the evolving state.
  subroutine visit(self, archive, rows, error)
    class(simulation_t), intent(inout) :: self
    type(checkpoint_archive_t), intent(inout) :: archive
    !> Rows of the history
    integer, intent(inout) :: rows
    !> Set if the operator cannot be factorized again
    type(error_t), allocatable, intent(out) :: error

    call visit_zones(self%model%plate%setup%delaminations, archive)
    call self%stepper%visit(archive, self%model, error)
    call self%history_clock%visit(archive, 'history')
    call self%fields_clock%visit(archive, 'fields')
    call self%checkpoint_clock%visit(archive, 'checkpoint')
    call self%record%visit(archive)
    call self%energy_check%visit(archive)
    call visit_incomplete_start(self%deck, archive)
    call archive%item('history/rows', rows)
    call archive%item('history/last_row', self%history%last_row)
  end subroutine visit

  !> Time, or load factor, at which the run ends.
  pure real(wp) function end_of(self)
    class(simulation_t), intent(in) :: self

    end_of = 1
    if (.not. self%deck%setup%is_static()) end_of = end_of_run(self%deck%stepping, self%record%contact_end)
    if (has_ended_by_failure(self)) end_of = self%stepper%now%time
  end function end_of

  !> True: the plate has failed, and the run need not show more. The record is in the checkpoint, so that a restart ends
  !> at the same step.
  pure logical function has_ended_by_failure(self) result(ended)
    class(simulation_t), intent(in) :: self

    ended = self%deck%stepping%time%ends_at_failure .and. self%record%compression%failed
  end function has_ended_by_failure

  !> Steps until the end, or until a signal or the wall-clock limit.
  subroutine run(self, error)
    class(simulation_t), intent(inout) :: self
    !> Set if no step converges, a file cannot be written, or the run has to stop
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: event, closest, begun

    call self%timers%stop('set-up')
    closest = self%stepper%smallest_step
    do while (self%stepper%now%time < end_of(self))
      event = next_event([self%history_clock, self%fields_clock, self%checkpoint_clock], end_of(self), closest)
      begun = wall_time()
      call self%timers%start('steps')
      call advance_to_output(self%deck, self%model, self%stepper, self%record, event, self%log, error)
      call self%timers%stop('steps')
      if (allocated(error)) return
      call self%timers%start('results')
      call write_results(self, self%stepper%now%time >= event, error)
      call self%timers%stop('results')
      if (allocated(error)) return
      call show_progress(self%progress, self%deck, self%stepper, end_of(self), self%log)
      call self%wall_limit%note_step(wall_time() - begun)
      call stop_if_due(self, error)
      if (allocated(error)) return
    end do
  end subroutine run

  !> Ends the run with a checkpoint after a signal, or if another step might exceed the wall-clock limit.
  subroutine stop_if_due(self, error)
    class(simulation_t), intent(inout) :: self
    !> Set if the run ends
    type(error_t), allocatable, intent(out) :: error
    character(len=*), parameter :: causes(*) = [character(len=29) :: 'as the wall-clock time is up', 'by a signal']
    logical :: signalled, late

    signalled = self%communicator%any(stop_signal() /= 0)
    late = self%communicator%any(self%wall_limit%is_up(wall_time())) .and. self%stepper%now%time < end_of(self)
    if (.not. (signalled .or. late)) return
    if (signalled .and. self%communicator%is_root()) call announce_stop()
    call save_checkpoint(self, error)
    call fail(error, exit_stopped, 'Stopped '//trim(causes(merge(2, 1, signalled)))//' at '// &
              moment(self%deck, self%stepper%now%time)//'; continue with: implam restart '//self%base// &
              checkpoint_ending)
  end subroutine stop_if_due

  !> Writes the output that is due after a step. The clocks advance before the checkpoint is saved, so that a restart
  !> does not write it twice.
  subroutine write_results(self, at_event, error)
    class(simulation_t), intent(inout) :: self
    !> True if the step has reached an output time or the end
    logical, intent(in) :: at_event
    type(error_t), allocatable, intent(out) :: error
    type(error_t), allocatable :: row_error
    real(wp) :: closest
    logical :: row_due, fields_due, checkpoint_due

    call self%stepper%complete_state(self%model, error)
    if (allocated(error)) return
    call self%record%observe_reactions(self%model, self%stepper%now)
    call report_warnings(self%deck, self%model, self%stepper, self%record, self%energy_check, self%log, error)
    row_due = row_is_due(self%deck%output, self%stepper%now%step) .or. self%stepper%now%time >= end_of(self)
    fields_due = .false.
    checkpoint_due = .false.
    if (at_event .or. has_ended_by_failure(self)) then
      closest = self%stepper%smallest_step
      if (self%history_clock%strikes_at(self%stepper%now%time, closest)) row_due = .true.
      fields_due = self%fields_clock%strikes_at(self%stepper%now%time, closest)
      ! The last fields are those of the state of the summary.
      if (self%fields_clock%interval > 0 .and. self%stepper%now%time >= end_of(self)) fields_due = .true.
      checkpoint_due = self%checkpoint_clock%strikes_at(self%stepper%now%time, closest) .or. &
                       self%deck%output%checkpoint_at_end .and. self%stepper%now%time >= end_of(self)
    end if
    if (allocated(error)) then
      ! The row beyond the limit is the last of the history.
      call self%history%write_row(row_of(self%model, self%stepper, self%record), row_error)
      if (.not. allocated(row_error)) call self%history%flush(row_error)
      return
    end if
    if (row_due) call self%history%write_row(row_of(self%model, self%stepper, self%record), error)
    if (allocated(error)) return
    if (fields_due) call write_fields(self%model%plate, self%stepper, self%deck%output, self%fields, error)
    if (allocated(error)) return
    if (checkpoint_due) call save_checkpoint(self, error)
  end subroutine write_results

  !> Saves a checkpoint.
  subroutine save_checkpoint(self, error)
    class(simulation_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    integer :: rows

    call self%history%flush(error)
    if (allocated(error)) return
    call self%timers%start('checkpoint')
    rows = self%history%rows
    call archive%open_for_saving(self%communicator, self%base//checkpoint_ending, self%provenance, error)
    if (allocated(error)) return
    call visit(self, archive, rows, error)
    if (allocated(error)) return
    call archive%close(error)
    call self%timers%stop('checkpoint')
  end subroutine save_checkpoint

  !> Writes the last fields, closes the files and reports the cost of the run.
  subroutine finalize(self, error)
    class(simulation_t), intent(inout) :: self
    type(error_t), allocatable, intent(out) :: error

    ! In a complete run that is continued in another folder, no step writes the last fields.
    if (self%deck%output%fields_every <= 0 .or. self%fields%is_empty()) &
      call write_fields(self%model%plate, self%stepper, self%deck%output, self%fields, error)
    if (allocated(error)) return
    if (has_ended_by_failure(self)) call self%log%note('The plate has failed, which ends the run at '// &
                                                       moment(self%deck, self%stepper%now%time)//'.')
    call self%history%close(error)
    call self%progress%finish(self%log, self%stepper%cost())
    call log_costs(self%timers, self%stepper%operator, self%log)
    call self%log%note('Results: '//self%base//'_history.csv, '//self%base//'.xdmf, '//self%base//summary_ending// &
                       ', '//self%base//'.log')
    call self%stepper%operator%release()
  end subroutine finalize

  !> Writes the summary, also of a run that was stopped or has failed: to NAME_summary.json, and rounded to the log.
  !> Collective.
  subroutine conclude(self, error)
    class(simulation_t), intent(inout) :: self
    !> Reason of a premature end; otherwise set if the summary cannot be written
    type(error_t), allocatable, intent(inout) :: error

    if (.not. self%is_ready) return
    call report_last_warnings(self%deck, self%model, self%stepper, self%record, self%energy_check, self%log, error)
    call summarise(self%deck, self%model, self%stepper, self%record, self%provenance, &
                   wall_time() - self%timers%profile%begun, self%base//summary_ending, self%log, error)
  end subroutine conclude
end module simulations
