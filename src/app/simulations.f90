!> A run: initialise, step until the end, finalise.
module simulations
  use kinds, only: wp
  use errors, only: error_t, fail, exit_stopped
  use text, only: to_text, line_t
  use files, only: make_directory
  use logger, only: log_t
  use timers, only: timer_set_t
  use communicators, only: communicator_t
  use models, only: model_t
  use model_building, only: create_model
  use time_stepping, only: time_stepper_t
  use deck_contents, only: deck_t
  use deck_echo, only: echo
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use deck_extents, only: extent_lines
  use indentation_deck, only: echo_without_group
  use build_information, only: this_build
  use run_provenance, only: provenance_t, this_run
  use run_progress, only: progress_t
  use history_file, only: history_file_t
  use fields_file, only: fields_file_t
  use checkpoints, only: checkpoint_archive_t
  use queue_signals, only: stop_signal
  use output_clocks, only: clock_t
  use energy_watches, only: energy_watch_t
  use result_rows, only: row_of, column_names, column_whole
  use field_results, only: write_mesh, write_fields
  implicit none
  private
  public :: simulation_t

  !> A run with all that it has open.
  type :: simulation_t
    !> The deck
    type(deck_t) :: deck
    !> The ranks
    type(communicator_t) :: communicator
    !> What does not change
    type(model_t) :: model
    !> What evolves
    type(time_stepper_t) :: stepper
    !> Log, progress and result files
    type(log_t) :: log
    !> Time spent in set-up, steps and results
    type(timer_set_t) :: timers
    !> Bar or lines of progress
    type(progress_t) :: progress
    !> Version, deck and machine, for every result
    type(provenance_t) :: provenance
    !> Force history
    type(history_file_t) :: history
    !> Fields
    type(fields_file_t) :: fields
    !> Clocks of history, fields and checkpoints
    type(clock_t) :: history_clock, fields_clock, checkpoint_clock
    !> The warning of a border reached was given
    logical, private :: warned_of_border = .false.
    !> Looks after the energy that integrators create
    type(energy_watch_t), private :: energy_watch
    !> Folder and name that all results share
    character(len=:), allocatable :: base
  contains
    !> Sets a run up from the start.
    procedure :: initialize
    !> Sets a run up from a checkpoint.
    procedure :: resume
    !> Steps until the end.
    procedure :: run
    !> Writes what is left and closes the files.
    procedure :: finalize
  end type simulation_t

contains

  !> Sets a run up from the start.
  subroutine initialize(self, deck, communicator, error)
    !> The run
    class(simulation_t), intent(out) :: self
    !> The deck, checked
    type(deck_t), intent(in) :: deck
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Set if files cannot be written or the model cannot be set up
    type(error_t), allocatable, intent(out) :: error

    call prepare(self, deck, communicator, append=.false., error=error)
    if (allocated(error)) return
    call self%history%create(communicator, self%base//'_history.csv', column_names, column_whole, error)
    if (allocated(error)) return
    call self%fields%create(communicator, self%base, self%provenance, part_of(self), error)
    if (allocated(error)) return
    call write_mesh(self%model, self%fields, error)
  end subroutine initialize

  !> What initialise and resume have in common: log, model, state at rest.
  subroutine prepare(self, deck, communicator, append, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> True: go on with the log that is there
    logical, intent(in) :: append
    !> Set if something cannot be set up
    type(error_t), allocatable, intent(out) :: error

    call self%timers%start('set-up')
    self%deck = deck
    self%communicator = communicator
    self%base = deck%output%directory//'/'//deck%name
    self%history_clock%interval = deck%output%history_every
    self%fields_clock%interval = deck%output%fields_every
    self%checkpoint_clock%interval = deck%output%checkpoint_every
    if (communicator%is_root()) call make_directory(deck%output%directory, error)
    if (.not. allocated(error)) call self%log%open(self%base//'.log', communicator%is_root(), append, error)
    call communicator%agree(error)
    if (allocated(error)) return
    self%provenance = this_run(this_build(), deck%text, communicator%size)
    call self%provenance%report(self%log)
    call log_echo(self)
    call create_model(deck%scene_t, communicator, self%model, error)
    if (allocated(error)) return
    call self%stepper%start(self%model, deck%stepping, deck%linear_solver, error)
    if (allocated(error)) return
    call self%log%note('Model: '//to_text(self%model%mesh%elements())//' elements, '// &
                       to_text(self%stepper%operator%numbering%total)//' unknowns, '// &
                       to_text(communicator%size)//' rank(s).')
    call self%progress%start(0.0_wp)
  end subroutine prepare

  !> Lists every key in effect in the log, and zones and starters as they are.
  subroutine log_echo(self)
    !> The run
    class(simulation_t), intent(inout) :: self
    type(vocabulary_t) :: vocabulary
    type(line_t), allocatable :: lines(:)
    integer :: i

    call load_deck_table(vocabulary)
    call echo(vocabulary, self%deck%settings, lines)
    if (self%deck%has_impactor .and. .not. self%deck%has_indentation) &
      call echo_without_group(self%deck%indentation, lines)
    lines = [lines, extent_lines(self%deck)]
    do i = 1, size(lines)
      call self%log%detail(lines(i)%text)
    end do
  end subroutine log_echo

  !> Part of the plate that the files hold.
  pure function part_of(self) result(part)
    !> The run
    class(simulation_t), intent(in) :: self
    !> 'whole' or 'quarter'
    character(len=:), allocatable :: part

    part = 'whole'
    if (self%model%mesh%multiplicity == 4) part = 'quarter'
  end function part_of

  !> Sets a run up from a checkpoint that has been opened for loading.
  subroutine resume(self, deck, communicator, path, error)
    !> The run
    class(simulation_t), intent(out) :: self
    !> The deck that the checkpoint holds
    type(deck_t), intent(in) :: deck
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The checkpoint
    character(len=*), intent(in) :: path
    !> Set if the checkpoint cannot be used
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    integer :: rows

    call prepare(self, deck, communicator, append=.true., error=error)
    if (allocated(error)) return
    call archive%open_for_loading(communicator, path, error)
    if (allocated(error)) return
    call visit(self, archive, rows, error)
    if (allocated(error)) return
    call archive%close(error)
    if (allocated(error)) return
    self%warned_of_border = self%stepper%now%interfaces%border_reached
    call self%history%resume(communicator, self%base//'_history.csv', column_names, column_whole, rows, error)
    if (allocated(error)) return
    if (self%history%rows /= rows) &
      call self%log%warning('The history before the checkpoint is not there; it goes on from here.')
    call self%fields%resume(communicator, self%base, self%provenance, part_of(self), self%stepper%now%time, error)
    if (allocated(error)) return
    call write_mesh(self%model, self%fields, error)
    call self%progress%start(self%stepper%now%time/end_of(self))
  end subroutine resume

  !> Saves or loads all that evolves.
  subroutine visit(self, archive, rows, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> Where to or where from
    type(checkpoint_archive_t), intent(inout) :: archive
    !> Rows of the history
    integer, intent(inout) :: rows
    !> Set if the factored operator cannot be made again
    type(error_t), allocatable, intent(out) :: error

    call self%stepper%visit(archive, self%model, error)
    call self%history_clock%visit(archive, 'history')
    call self%fields_clock%visit(archive, 'fields')
    call self%checkpoint_clock%visit(archive, 'checkpoint')
    call archive%item('history/rows', rows)
  end subroutine visit

  !> Time, or load factor, at which the run ends.
  pure real(wp) function end_of(self)
    !> The run
    class(simulation_t), intent(in) :: self

    end_of = 1
    if (.not. self%deck%has_static) end_of = self%deck%stepping%time%end
  end function end_of

  !> Steps until the end, or until a queue's signal.
  subroutine run(self, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> Set if no step converges, a file cannot be written, or a signal came
    type(error_t), allocatable, intent(out) :: error
    real(wp) :: event

    call self%timers%stop('set-up')
    do while (self%stepper%now%time < end_of(self))
      event = min(end_of(self), self%history_clock%next(), self%fields_clock%next(), self%checkpoint_clock%next())
      call self%timers%start('steps')
      call self%stepper%advance(self%model, event, error)
      call self%timers%stop('steps')
      if (allocated(error)) return
      call self%timers%start('results')
      call write_results(self, error)
      call self%timers%stop('results')
      if (allocated(error)) return
      call self%progress%update(self%log, self%stepper%now%time/end_of(self), 'step '// &
                                to_text(self%stepper%now%step)//', time '//to_text(self%stepper%now%time))
      if (.not. self%communicator%any(stop_signal() /= 0)) cycle
      call save_checkpoint(self, error)
      call fail(error, exit_stopped, 'Stopped by a signal at time '//to_text(self%stepper%now%time)// &
                '; go on with: implam restart '//self%base//'_restart.h5')
      return
    end do
  end subroutine run

  !> Writes what is due after an accepted step. The clocks move before the checkpoint is saved, so that
  !> a run that goes on from it does not write twice.
  subroutine write_results(self, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> Set if a file cannot be written
    type(error_t), allocatable, intent(out) :: error
    logical :: row_due

    call warn(self)
    row_due = self%history_clock%interval <= 0 .or. self%stepper%now%time >= end_of(self)
    if (self%history_clock%strikes_at(self%stepper%now%time)) row_due = .true.
    if (row_due) call self%history%write_row(row_of(self%model, self%stepper), error)
    if (allocated(error)) return
    if (self%fields_clock%strikes_at(self%stepper%now%time)) &
      call write_fields(self%model, self%stepper, self%deck%output, self%fields, error)
    if (allocated(error)) return
    if (self%checkpoint_clock%strikes_at(self%stepper%now%time)) call save_checkpoint(self, error)
  end subroutine write_results

  !> Warns, once each, of what a user must not overlook.
  subroutine warn(self)
    !> The run
    class(simulation_t), intent(inout) :: self
    real(wp) :: amplitude

    associate (now => self%stepper%now)
      if (now%interfaces%border_reached .and. .not. self%warned_of_border) then
        call self%log%warning('A delamination has reached the border of its zone at time '//to_text(now%time)// &
                              ' and cannot grow on there: if it would, make the zone larger.')
        self%warned_of_border = .true.
      end if
      if (self%deck%has_static) return
      amplitude = 1
      if (.not. self%deck%has_impactor) amplitude = self%deck%pressure%amplitude(now%time)
      if (self%energy_watch%alarms(now%ledger, sum(now%interfaces%ties%debt()), amplitude)) &
        call self%log%warning('The time integrators have created more than 1 % of the energy by time '// &
                              to_text(now%time)//': take smaller steps, or more damping (rho_inf) with delamination.')
    end associate
  end subroutine warn

  !> Saves a checkpoint.
  subroutine save_checkpoint(self, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> Set if it cannot be written
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    integer :: rows

    call self%history%flush(error)
    if (allocated(error)) return
    rows = self%history%rows
    call archive%open_for_saving(self%communicator, self%base//'_restart.h5', self%provenance, error)
    if (allocated(error)) return
    call visit(self, archive, rows, error)
    if (allocated(error)) return
    call archive%close(error)
  end subroutine save_checkpoint

  !> Writes the last fields, closes the files and says what the run took.
  subroutine finalize(self, error)
    !> The run
    class(simulation_t), intent(inout) :: self
    !> Set if a file cannot be written
    type(error_t), allocatable, intent(out) :: error

    if (self%deck%output%fields_every <= 0) &
      call write_fields(self%model, self%stepper, self%deck%output, self%fields, error)
    if (allocated(error)) return
    call self%history%close(error)
    call self%progress%finish(self%log, summary(self))
    call log_costs(self)
    call self%log%note('Results: '//self%base//'_history.csv, '//self%base//'.xdmf, '//self%base//'.log')
    call self%stepper%operator%solver%release()
  end subroutine finalize

  !> Lists in the log where time and memory went; the second part of the list is contained in the steps.
  subroutine log_costs(self)
    !> The run
    class(simulation_t), intent(inout) :: self
    real(wp) :: factor_entries, megabytes
    integer :: matrix_entries, i

    associate (operator => self%stepper%operator)
      call operator%solver%statistics(factor_entries, megabytes)
      matrix_entries = operator%numbering%row_start(operator%numbering%rows + 1) - 1
      call self%log%detail('Factor: '//to_text(factor_entries)//' numbers, '//to_text(megabytes)//' MB; matrix: '// &
                           to_text(matrix_entries)//' numbers on this rank.')
      associate (lines => [self%timers%lines(), operator%timers%lines()])
        call self%log%detail(repeat(' ', 37)//'times    on the wall      processor')
        do i = 1, size(lines)
          call self%log%detail(lines(i))
        end do
      end associate
    end associate
  end subroutine log_costs

  !> What a run took, in one line.
  function summary(self) result(line)
    !> The run
    class(simulation_t), intent(in) :: self
    !> The line
    character(len=:), allocatable :: line

    associate (now => self%stepper%now, operator => self%stepper%operator)
      line = to_text(now%step)//' steps ('//to_text(self%stepper%rejected)//' rejected), '// &
             to_text(now%all_iterations)//' iterations of equilibrium, '//to_text(now%all_force_iterations)// &
             ' of the force, '//to_text(operator%factorizations)//' factorizations, '// &
             to_text(operator%solves)//' solves.'
    end associate
  end function summary
end module simulations
