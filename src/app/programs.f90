!> The commands of the program.
module programs
  use, intrinsic :: iso_fortran_env, only: error_unit
  use errors, only: error_t, exit_done, exit_files
  use text, only: line_t
  use communicators, only: communicator_t, start_mpi, finish_mpi
  use launchers, only: launched
  use deck_symmetries, only: symmetry_sentence
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use ply_zone_tables, only: ply_zone_lines
  use scale_tables, only: scale_lines
  use strength_tables, only: strength_lines
  use zone_tables, only: zone_lines
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use deck_explain, only: explain, explain_table
  use files, only: ignore_size_signal
  use hdf5_file, only: files_left_open
  use initial_states, only: fit_initial_state
  use build_information, only: version, commit, compiler, petsc_version
  use run_provenance, only: citation_of
  use command_lines, only: argument, command_t, read_command_line, verb_run, verb_check, verb_explain, verb_restart, &
                           verb_version, verb_help, verb_new, verb_completion, verb_man, verb_queue
  use computations, only: compute, read_deck_everywhere
  use root_output, only: print_lines
  use queue_signals, only: release_stop_signals
  use growth_explain, only: explain_growth_errors, growth_topic_sentence, is_growth_topic
  use material_explain, only: explain_materials, is_material_topic, material_topic_sentence
  use result_explain, only: explain_column, explain_results, is_result_topic, result_topics_sentence
  use run_costs, only: cost_lines
  use model_sizes, only: model_size_t, size_of_model
  use stepping_parameters, only: is_explicit
  use queue_scripts, only: queue_job_t, write_queue_script
  use shell_pages, only: completion, manual_page
  use starter_decks, only: starter_name, write_starter
  use usage_texts, only: command_help, usage_lines
  implicit none
  private
  public :: run_program

contains

  !> Executes a command. Without a launcher MPI is started only for computations: commands that read or explain decks
  !> also work where MPI must not be started.
  subroutine run_program(code, close_failed)
    integer, intent(out) :: code
    !> True: a file could not be closed, so that the finalization of the libraries, MPI included, would crash and has to
    !> be omitted
    logical, intent(out) :: close_failed
    type(command_t) :: command
    type(communicator_t) :: communicator
    type(error_t), allocatable :: error

    code = exit_done
    call ignore_size_signal()
    if (launched()) call start_mpi(communicator)
    if (command_argument_count() == 0) call print_lines(communicator, usage_lines())
    call read_command_line(command, error)
    if (.not. allocated(error)) then
      if (all(command%verb /= [verb_run, verb_restart])) call release_stop_signals()
      select case (command%verb)
      case (verb_version)
        call print_lines(communicator, &
                         [line_t('Implam '//version//' ('//commit//'), '//compiler//', PETSc '//petsc_version), &
                          line_t('To cite: '//citation_of(version))])
      case (verb_help)
        if (command%target == '') then
          call print_lines(communicator, usage_lines())
        else if (size(command_help(command%target)) > 0) then
          call print_lines(communicator, command_help(command%target))
        else
          call explain_topic(command, communicator, error)
        end if
      case (verb_explain)
        call explain_topic(command, communicator, error)
      case (verb_completion, verb_man)
        call print_page(command, communicator, error)
      case (verb_new)
        call start_deck(command, communicator, error)
      case (verb_queue)
        call queue_deck(command, communicator, error)
      case (verb_check)
        call check(command, communicator, code, error)
      case (verb_run, verb_restart)
        call compute(command, communicator, code, error)
      end select
    end if
    call communicator%agree(error)
    if (allocated(error)) then
      code = error%code
      if (communicator%is_root()) write (error_unit, '(2a)') 'implam: ', error%message
    end if
    close_failed = .false.
    if (code == exit_files) close_failed = communicator%any(files_left_open())
    if (.not. close_failed) call finish_mpi()
  end subroutine run_program

  !> Prints the manual page or the completions of a shell.
  subroutine print_page(command, communicator, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    !> Set (usage) if the shell is not known
    type(error_t), allocatable, intent(inout) :: error
    type(vocabulary_t) :: vocabulary
    type(line_t), allocatable :: lines(:)

    call load_deck_table(vocabulary)
    if (command%verb == verb_man) then
      call manual_page(vocabulary, version, lines)
    else
      call completion(command%target, vocabulary, lines, error)
    end if
    if (.not. allocated(error)) call print_lines(communicator, lines)
  end subroutine print_page

  !> Writes a deck to start from.
  subroutine start_deck(command, communicator, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    !> Set (files) if it cannot be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: path

    path = command%target
    if (path == '') path = starter_name
    if (command%target == '' .and. command%rig /= '') path = command%rig//'.nml'
    if (.not. communicator%is_root()) return
    call write_starter(path, command%rig, error)
    if (.not. allocated(error)) call print_lines(communicator, [line_t('Wrote '//path//'. To run it: implam '//path)])
  end subroutine start_deck

  !> Writes the script of a job.
  subroutine queue_deck(command, communicator, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    !> Set if the deck has faults or the script exists
    type(error_t), allocatable, intent(inout) :: error
    type(queue_job_t) :: job
    type(line_t), allocatable :: lines(:)

    if (.not. communicator%is_root()) return
    job%queue = command%queue
    job%target = command%target
    job%program = argument(0)
    job%ranks = command%ranks
    job%seconds = command%seconds
    job%chain = command%chain
    if (allocated(command%output)) job%output = command%output
    call write_queue_script(job, lines, error)
    call print_lines(communicator, lines)
  end subroutine queue_deck

  !> Explains a group or key of the deck, or the tables of results.
  subroutine explain_topic(command, communicator, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    !> Set (usage) if there is no such group or key
    type(error_t), allocatable, intent(out) :: error
    type(vocabulary_t) :: vocabulary
    type(line_t), allocatable :: lines(:), columns(:)

    call load_deck_table(vocabulary)
    call explain_column(command%target, columns, error)
    if (allocated(error)) return
    if (size(columns) > 0 .and. vocabulary%group_index(command%target) == 0 .and. &
        size(vocabulary%groups_with(command%target)) == 0) then
      call print_lines(communicator, columns)
      return
    end if
    if (is_growth_topic(command%target)) then
      call explain_growth_errors(command%markdown, lines)
      call print_lines(communicator, lines)
      return
    end if
    if (is_result_topic(command%target) .or. is_material_topic(command%target)) then
      if (is_material_topic(command%target)) then
        call explain_materials(command%target, command%markdown, lines, error)
        if (allocated(error)) return
      else
        call explain_results(command%target, command%markdown, lines)
      end if
      call print_lines(communicator, lines)
      if (command%markdown .or. size(vocabulary%groups_with(command%target)) == 0) return
      call print_lines(communicator, [line_t('The deck has keys of this name too:')])
    end if
    if (command%markdown) then
      call explain_table(vocabulary, command%target, lines, error)
    else
      call explain(vocabulary, command%target, lines, error)
    end if
    if (allocated(error)) return
    call print_lines(communicator, lines)
    if (size(columns) > 0 .and. .not. command%markdown) &
      call print_lines(communicator, [line_t('Results have this name too:'), columns])
    if (command%target == '') call print_lines(communicator, &
      [line_t(result_topics_sentence), line_t(material_topic_sentence), &
       line_t(growth_topic_sentence)])
  end subroutine explain_topic

  !> Reads and checks a deck, and lists its errors.
  subroutine check(command, communicator, code, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    integer, intent(out) :: code
    !> Set if the initial state cannot be read or is of another plate
    type(error_t), allocatable, intent(inout) :: error
    type(deck_t) :: deck
    type(problems_t) :: problems
    type(model_size_t) :: model_size
    logical :: lacks

    call read_deck_everywhere(command%target, communicator, deck, problems)
    code = problems%exit_code()
    call print_lines(communicator, problems%lines())
    if (code /= exit_done) return
    call fit_initial_state(deck, communicator, error, lacks)
    if (allocated(error)) return
    if (lacks) call print_lines(communicator, [line_t('The initial state '//deck%setup%initial%from// &
      ' does not exist yet, so the deck is not compared with it; the run needs it.')])
    call print_lines(communicator, [line_t(command%target//': no errors.')])
    if (symmetry_sentence(deck) /= '') call print_lines(communicator, [line_t(symmetry_sentence(deck))])
    call print_lines(communicator, [scale_lines(deck), ply_zone_lines(deck), zone_lines(deck), strength_lines(deck)])
    model_size = size_of_model(deck%setup, is_explicit(deck%stepping))
    call print_lines(communicator, [line_t(model_size%sentence()), cost_lines(deck, model_size)])
  end subroutine check
end module programs
