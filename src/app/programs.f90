!> What the program does for each verb of the command line.
module programs
  use, intrinsic :: iso_fortran_env, only: output_unit, error_unit
  use errors, only: error_t, exit_done, exit_files
  use text, only: line_t
  use communicators, only: communicator_t, start_mpi, finish_mpi
  use kinds, only: wp
  use timers, only: wall_time
  use launchers, only: launched
  use petsc_session, only: start_petsc, finish_petsc
  use linear_solver_deck, only: check_ranks
  use case_deck, only: case_group, key_name
  use deck_symmetries, only: symmetry_sentence
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck, read_deck_text
  use deck_scales, only: scale_lines
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use deck_explain, only: explain, explain_table
  use hdf5_file, only: files_left_open
  use checkpoints, only: checkpoint_archive_t, newest_checkpoint
  use files, only: is_directory
  use build_information, only: version, commit, compiler, petsc_version
  use command_lines, only: command_t, read_command_line, verb_run, verb_check, verb_explain, verb_restart, &
                           verb_version, verb_help, verb_new, verb_completion, verb_man, verb_queue
  use queue_signals, only: release_stop_signals
  use result_explain, only: explain_results, is_result_topic, result_topics_sentence
  use model_sizes, only: model_size_t, size_of_model
  use queue_scripts, only: queue_job_t, write_queue_script
  use shell_pages, only: completion, manual_page
  use simulations, only: simulation_t
  use starter_decks, only: starter_name, write_starter
  use usage_texts, only: usage_lines
  implicit none
  private
  public :: run_program

contains

  !> Does what the command line asks. Without a launcher MPI starts only when there is something to compute: what
  !> reads or explains decks then answers at once, also on machines where MPI must not start.
  subroutine run_program(code, broken)
    !> Exit code
    integer, intent(out) :: code
    !> True: a file could not be closed and the libraries' own ends, MPI's too, would crash on it; leave without them
    logical, intent(out) :: broken
    type(command_t) :: command
    type(communicator_t) :: communicator
    type(error_t), allocatable :: error

    code = exit_done
    if (launched()) call start_mpi(communicator)
    if (command_argument_count() == 0) call tell_usage(communicator)
    call read_command_line(command, error)
    if (.not. allocated(error)) then
      if (all(command%verb /= [verb_run, verb_restart])) call release_stop_signals()
      select case (command%verb)
      case (verb_version)
        call print_lines(communicator, &
                         [line_t('Implam '//version//' ('//commit//'), '//compiler//', PETSc '//petsc_version)])
      case (verb_help)
        if (command%target == '') then
          call tell_usage(communicator)
        else
          call explain_topic(command, communicator, error)
        end if
      case (verb_explain)
        call explain_topic(command, communicator, error)
      case (verb_completion, verb_man)
        call tell_page(command, communicator, error)
      case (verb_new)
        call start_deck(command, communicator, error)
      case (verb_queue)
        call queue_deck(command, communicator, error)
      case (verb_check)
        call check(command, communicator, code)
      case (verb_run, verb_restart)
        call compute(command, communicator, code, error)
      end select
    end if
    call communicator%agree(error)
    if (allocated(error)) then
      code = error%code
      if (communicator%is_root()) write (error_unit, '(2a)') 'implam: ', error%message
    end if
    broken = .false.
    if (code == exit_files) broken = communicator%any(files_left_open())
    if (.not. broken) call finish_mpi()
  end subroutine run_program

  !> Prints lines on the root rank.
  subroutine print_lines(communicator, lines)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The lines
    type(line_t), intent(in) :: lines(:)
    integer :: i

    if (.not. communicator%is_root()) return
    do i = 1, size(lines)
      write (output_unit, '(a)') lines(i)%text
    end do
  end subroutine print_lines

  !> Prints how the program is used.
  subroutine tell_usage(communicator)
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    type(line_t), allocatable :: lines(:)

    call usage_lines(lines)
    call print_lines(communicator, lines)
  end subroutine tell_usage

  !> Prints the manual page, or what a shell completes.
  subroutine tell_page(command, communicator, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
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
  end subroutine tell_page

  !> Writes a deck to start from.
  subroutine start_deck(command, communicator, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Set (files) if it can't be written
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: path

    path = command%target
    if (path == '') path = starter_name
    if (.not. communicator%is_root()) return
    call write_starter(path, error)
    if (.not. allocated(error)) call print_lines(communicator, [line_t('Wrote '//path//'. To run it: implam '//path)])
  end subroutine start_deck

  !> Writes the script of a job.
  subroutine queue_deck(command, communicator, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Set if the deck has faults or the script is there already
    type(error_t), allocatable, intent(inout) :: error
    type(queue_job_t) :: job
    type(line_t), allocatable :: lines(:)
    integer :: length

    if (.not. communicator%is_root()) return
    job%queue = command%queue
    job%target = command%target
    call get_command_argument(0, length=length)
    allocate (character(len=length) :: job%program)
    call get_command_argument(0, job%program)
    job%ranks = command%ranks
    job%seconds = command%seconds
    job%chain = command%chain
    call write_queue_script(job, lines, error)
    call print_lines(communicator, lines)
  end subroutine queue_deck

  !> Explains a group or key of the deck, or what results hold.
  subroutine explain_topic(command, communicator, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Set (usage) if there is no such group or key
    type(error_t), allocatable, intent(out) :: error
    type(vocabulary_t) :: vocabulary
    type(line_t), allocatable :: lines(:)

    call load_deck_table(vocabulary)
    if (is_result_topic(command%target)) then
      call explain_results(command%target, command%markdown, lines)
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
    if (command%target == '') call print_lines(communicator, [line_t(result_topics_sentence)])
  end subroutine explain_topic

  !> Reads and checks a deck, lists what is wrong with it.
  subroutine check(command, communicator, code)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Exit code
    integer, intent(out) :: code
    type(deck_t) :: deck
    type(problems_t) :: problems
    type(model_size_t) :: model_size

    call read_deck_everywhere(command%target, communicator, deck, problems)
    code = problems%exit_code()
    call print_lines(communicator, problems%lines())
    if (code /= exit_done) return
    call print_lines(communicator, [line_t(command%target//': no errors.')])
    if (symmetry_sentence(deck) /= '') call print_lines(communicator, [line_t(symmetry_sentence(deck))])
    call print_lines(communicator, scale_lines(deck))
    model_size = size_of_model(deck%scene_t)
    call print_lines(communicator, [line_t(model_size%sentence())])
  end subroutine check

  !> Reads a deck on the root rank and gives its text to all.
  subroutine read_deck_everywhere(path, communicator, deck, problems)
    !> Path of the deck
    character(len=*), intent(in) :: path
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The deck
    type(deck_t), intent(out) :: deck
    !> What is wrong with it
    type(problems_t), intent(out) :: problems
    character(len=:), allocatable :: text

    if (communicator%is_root()) then
      call read_deck(path, deck, problems)
      text = deck%text
    end if
    call communicator%broadcast_text(text)
    if (.not. communicator%is_root()) call read_deck_text(text, path, deck, problems)
  end subroutine read_deck_everywhere

  !> Runs a deck, or goes on from a checkpoint.
  subroutine compute(command, communicator, code, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks; MPI is started here if it was not before
    type(communicator_t), intent(inout) :: communicator
    !> Exit code
    integer, intent(inout) :: code
    !> Set if the run fails
    type(error_t), allocatable, intent(out) :: error
    type(deck_t) :: deck
    type(problems_t) :: problems
    type(simulation_t), allocatable :: simulation
    character(len=:), allocatable :: checkpoint
    real(wp) :: begun

    begun = wall_time()
    ! A checkpoint is read through MPI.
    if (command%verb == verb_restart) then
      call start_mpi(communicator)
      call find_checkpoint(command, communicator, checkpoint, error)
      if (allocated(error)) return
      call read_checkpoint_deck(checkpoint, communicator, deck, problems, error)
      if (allocated(error)) return
    else
      call read_deck_everywhere(command%target, communicator, deck, problems)
    end if
    call check_ranks(deck%settings, deck%linear_solver, communicator%size, problems)
    code = problems%exit_code()
    call print_lines(communicator, problems%lines())
    if (code /= exit_done) return
    if (allocated(command%output)) deck%output%directory = command%output
    if (command%wall_limit > 0) deck%stepping%time%wall_limit = command%wall_limit
    call start_mpi(communicator)
    call start_petsc(communicator, deck%linear_solver%petsc_options//command%petsc_options, error)
    if (allocated(error)) return
    allocate (simulation)
    if (command%verb == verb_restart) then
      call simulation%resume(deck, communicator, begun, checkpoint, error)
    else
      call simulation%initialize(deck, communicator, begun, error)
    end if
    if (.not. allocated(error)) call simulation%run(error)
    if (.not. allocated(error)) call simulation%finalize(error)
    call simulation%conclude(error)
    if (allocated(error)) call simulation%log%error(error%message)
    call simulation%log%close()
    call finish_petsc()
  end subroutine compute

  !> The checkpoint to go on from: the file named, or else the newest whole one of a folder.
  subroutine find_checkpoint(command, communicator, path, error)
    !> What is asked
    type(command_t), intent(in) :: command
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Path of the checkpoint
    character(len=:), allocatable, intent(out) :: path
    !> Set if there is none in the folder
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: folder
    logical :: is_file

    path = command%target
    is_file = path /= ''
    if (is_file .and. communicator%is_root()) is_file = .not. is_directory(path)
    call communicator%broadcast(is_file)
    if (is_file) return
    folder = '.'
    if (allocated(command%output)) folder = command%output
    if (path /= '') folder = path
    call newest_checkpoint(communicator, folder, path, error)
    if (.not. allocated(error)) call print_lines(communicator, [line_t('Going on from '//path//'.')])
  end subroutine find_checkpoint

  !> Reads the deck that a checkpoint holds. Results go on in the folder of the checkpoint.
  subroutine read_checkpoint_deck(path, communicator, deck, problems, error)
    !> The checkpoint
    character(len=*), intent(in) :: path
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> The deck
    type(deck_t), intent(out) :: deck
    !> What is wrong with it
    type(problems_t), intent(out) :: problems
    !> Set if the file is no checkpoint or damaged
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    integer :: slash

    call archive%open_for_loading(communicator, path, error)
    if (allocated(error)) return
    call read_deck_text(archive%provenance%deck, path, deck, problems)
    ! A deck without a name has that of its file, which isn't the checkpoint's.
    deck%name = archive%provenance%case_name
    call deck%settings%derive(case_group, key_name, deck%name, .true.)
    call archive%close(error)
    deck%output%directory = '.'
    slash = index(path, '/', back=.true.)
    if (slash > 0) deck%output%directory = path(:max(slash - 1, 1))
  end subroutine read_checkpoint_deck
end module programs
