!> Runs of decks from the command line: from the start, from a checkpoint, and twice for verification.
module computations
  use build_information, only: commit
  use case_deck, only: case_group, key_name
  use checkpoints, only: checkpoint_archive_t, checkpoint_ending, newest_checkpoint
  use command_lines, only: command_t, verb_restart
  use communicators, only: communicator_t, start_mpi
  use deck_contents, only: deck_t
  use deck_echo, only: adopted_values
  use deck_problems, only: problems_t
  use deck_reader, only: read_deck, read_deck_text
  use deck_refinements, only: refined_text
  use errors, only: error_t, exit_done, exit_files, exit_stopped, exit_usage, fail
  use files, only: is_directory
  use initial_states, only: fit_initial_state
  use adaptive_zones, only: visit_zones
  use petsc_session, only: start_petsc, finish_petsc
  use queue_signals, only: announce_stop_signals
  use root_output, only: print_lines
  use simulations, only: simulation_t
  use text, only: line_t
  use profiles, only: new_profile, profile_t
  use verifications, only: stage_done, stage_stopped, stage_of, print_changes
  implicit none
  private
  public :: compute, read_deck_everywhere

contains

  !> Runs a deck, or continues from a checkpoint.
  subroutine compute(command, communicator, code, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(inout) :: communicator
    integer, intent(inout) :: code
    !> Set if the run fails
    type(error_t), allocatable, intent(out) :: error
    type(deck_t) :: deck
    character(len=:), allocatable :: checkpoint
    type(profile_t) :: profile

    profile = new_profile(command%profile)
    call profile%enter('deck')
    call take_deck(command, communicator, deck, checkpoint, code, error)
    call profile%leave()
    if (code /= exit_done .or. allocated(error)) return
    call profile%enter('MPI and PETSc')
    call start_mpi(communicator)
    call start_petsc(communicator, deck%linear_solver%petsc_options//command%petsc_options, error)
    call profile%leave()
    if (allocated(error)) return
    if (communicator%is_root()) call announce_stop_signals()
    if (command%verify) then
      call verify(command, communicator, deck, profile, code, error)
    else
      call simulate(deck, communicator, profile, checkpoint, error)
    end if
    call finish_petsc()
    call profile%release()
  end subroutine compute

  !> Reads the deck from its file or a checkpoint, and its initial state.
  subroutine take_deck(command, communicator, deck, checkpoint, code, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    type(deck_t), intent(out) :: deck
    !> Path of the checkpoint from which the run continues; empty: it begins
    character(len=:), allocatable, intent(out) :: checkpoint
    integer, intent(inout) :: code
    !> Set if a checkpoint cannot be read or the deck cannot be verified
    type(error_t), allocatable, intent(out) :: error
    type(problems_t) :: problems

    checkpoint = ''
    if (command%verb == verb_restart) then
      call find_checkpoint(command, communicator, checkpoint, error)
      if (allocated(error)) return
      call read_checkpoint_deck(checkpoint, communicator, deck, problems, error)
      if (allocated(error)) return
      call print_lines(communicator, [line_t('The deck is the one stored in '//checkpoint// &
                                             '; a deck file changed since then is not read.')])
    else
      call read_deck_everywhere(command%target, communicator, deck, problems)
    end if
    call accept_deck(command, communicator, deck, problems, code)
    if (code /= exit_done) return
    if (checkpoint == '') call fit_initial_state(deck, communicator, error)
    if (allocated(error) .or. .not. command%verify) return
    if (deck%case%refine > 0) then
      call fail(error, exit_usage, '--verify refines the setup itself; take refine out of &case.')
    else if (deck%setup%initial%is_inherited) then
      call fail(error, exit_usage, '--verify refines the mesh, which a deck with &initial_state has from another run.')
    end if
  end subroutine take_deck

  !> Reports the errors of a deck, and applies the options of the command line.
  subroutine accept_deck(command, communicator, deck, problems, code)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    type(deck_t), intent(inout) :: deck
    !> Errors and warnings so far
    type(problems_t), intent(inout) :: problems
    integer, intent(inout) :: code

    code = problems%exit_code()
    call print_lines(communicator, problems%lines())
    if (allocated(command%output)) deck%output%directory = command%output
    if (command%wall_limit > 0) deck%stepping%time%wall_limit = command%wall_limit
  end subroutine accept_deck

  !> Runs the deck's setup to its end.
  subroutine simulate(deck, communicator, profile, checkpoint, error)
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    type(profile_t), intent(in) :: profile
    !> Checkpoint to continue from; empty: from the start
    character(len=*), intent(in) :: checkpoint
    !> Set if the run fails
    type(error_t), allocatable, intent(out) :: error
    type(simulation_t), allocatable :: simulation

    allocate (simulation)
    if (checkpoint /= '') then
      call simulation%resume(deck, communicator, profile, checkpoint, error)
    else
      call simulation%initialize(deck, communicator, profile, error)
    end if
    if (.not. allocated(error)) call simulation%run(error)
    if (.not. allocated(error)) call simulation%finalize(error)
    call simulation%conclude(error)
    if (allocated(error)) call simulation%log%error(error%message)
    call simulation%log%close()
  end subroutine simulate

  !> Runs a setup twice, the second time on finer elements with shorter steps, and reports the change of the results.
  !> Results of an earlier command are reused.
  subroutine verify(command, communicator, deck, profile, code, error)
    type(command_t), intent(in) :: command
    type(communicator_t), intent(in) :: communicator
    !> The deck of the first run
    type(deck_t), intent(in) :: deck
    type(profile_t), intent(in) :: profile
    integer, intent(inout) :: code
    !> Set if a run fails
    type(error_t), allocatable, intent(out) :: error
    type(deck_t) :: finer
    type(problems_t) :: problems

    call read_deck_text(refined_text(deck%text), command%target, finer, problems)
    call accept_deck(command, communicator, finer, problems, code)
    if (code /= exit_done) return
    call continue_run(deck, communicator, profile, error)
    if (.not. allocated(error)) call continue_run(finer, communicator, profile, error)
    if (allocated(error)) then
      if (error%code == exit_stopped) &
        error%message = error%message//', or complete both runs with the same command.'
      return
    end if
    call print_changes(deck, finer, communicator, error)
  end subroutine verify

  !> Continues a run of an earlier command.
  subroutine continue_run(deck, communicator, profile, error)
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    type(profile_t), intent(in) :: profile
    !> Set if the run fails
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: base
    type(checkpoint_archive_t) :: archive
    type(deck_t) :: left

    base = deck%output%directory//'/'//deck%case%name
    select case (stage_of(base, deck%text, commit, communicator))
    case (stage_done)
      call print_lines(communicator, [line_t(deck%case%name//' has been run before; its results are kept.')])
    case (stage_stopped)
      left = deck
      call archive%open_for_loading(communicator, base//checkpoint_ending, error)
      if (allocated(error)) return
      call visit_zones(left%setup%delaminations, archive)
      call archive%close(error)
      if (.not. allocated(error)) call simulate(left, communicator, profile, base//checkpoint_ending, error)
    case default
      call simulate(deck, communicator, profile, '', error)
    end select
  end subroutine continue_run

  !> Reads a deck on the root rank and gives its text to all.
  subroutine read_deck_everywhere(path, communicator, deck, problems)
    !> Path of the deck
    character(len=*), intent(in) :: path
    type(communicator_t), intent(in) :: communicator
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    character(len=:), allocatable :: text
    logical :: lacks

    lacks = .false.
    if (communicator%is_root()) then
      call read_deck(path, deck, problems)
      text = deck%text
      lacks = problems%exit_code() == exit_files
    end if
    call communicator%broadcast_text(text)
    call communicator%broadcast(lacks)
    if (.not. communicator%is_root()) call read_deck_text(text, path, deck, problems)
    if (lacks .and. .not. communicator%is_root()) call problems%cannot_read('')
  end subroutine read_deck_everywhere

  !> The checkpoint to continue from: the given file, or else the newest valid one of a folder.
  subroutine find_checkpoint(command, communicator, path, error)
    type(command_t), intent(in) :: command
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
    if (.not. allocated(error)) call print_lines(communicator, [line_t('Continuing from '//path//'.')])
  end subroutine find_checkpoint

  !> Reads the deck of a checkpoint. Results continue in the folder of the checkpoint.
  subroutine read_checkpoint_deck(path, communicator, deck, problems, error)
    !> The checkpoint
    character(len=*), intent(in) :: path
    type(communicator_t), intent(in) :: communicator
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    !> Set if the file is no checkpoint or damaged
    type(error_t), allocatable, intent(out) :: error
    type(checkpoint_archive_t) :: archive
    integer :: slash

    call archive%open_for_loading(communicator, path, error)
    if (allocated(error)) return
    call read_deck_text(archive%provenance%deck, path, deck, problems)
    ! The default name of a deck is that of its file, not that of the checkpoint.
    deck%case%name = archive%provenance%case_name
    call deck%settings%derive(case_group, key_name, deck%case%name, .true.)
    if (problems%errors() == 0 .and. adopted_values(deck%settings) /= archive%provenance%library) &
      call fail(error, exit_files, path//' was written by version '//archive%provenance%version// &
                ', whose library of materials has other values; continue with that version, or start a new run.')
    if (problems%errors() == 0) call visit_zones(deck%setup%delaminations, archive)
    call archive%close(error)
    deck%output%directory = '.'
    slash = index(path, '/', back=.true.)
    if (slash > 0) deck%output%directory = path(:max(slash - 1, 1))
  end subroutine read_checkpoint_deck
end module computations
