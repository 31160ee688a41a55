!> Usage of the program: one table of commands, options and exit codes, for --help, the manual page and the completions
!> of shells.
module usage_texts
  use text, only: line_t, append, joined, words_of
  implicit none
  private
  public :: usage_lines, command_help, explained_options

  !> Characters of a term and of an explanation; columns of explanations and of the page.
  integer, parameter, public :: text_length = 400
  integer, parameter :: indent = 31, width = 96

  !> Commands and their meaning.
  character(len=text_length), parameter, public :: command_rows(2, 11) = reshape([character(len=text_length) :: &
    '[run] DECK.nml', 'run a deck', &
    'check DECK.nml', 'list all errors and doubtful values of a deck, and what to expect: force, contact, errors of &
      &mesh and steps, memory and time; nothing is run', &
    'new [NAME.nml]', 'write a commented deck that is ready to run, with --rig that of a test rig; &
      &no file is overwritten', &
    'explain [GROUP [KEY]]', 'groups and keys of a deck: units, defaults, meaning; GROUP.KEY and GROUP%KEY are &
      &accepted too', &
    'explain TABLE', 'names, units and meaning of results; TABLE is history, fields or summary', &
    'explain materials [NAME]', 'published materials for decks, with the source of each value', &
    'restart [FILE]', 'resume from a checkpoint (NAME_restart.h5), or from the newest one of a folder: that named, &
      &that of --output, or the current one; the deck is that of the checkpoint, and its file is not read again', &
    'queue slurm|pbs [DECK.nml]', 'write a job script with ranks and memory estimated from the deck; with --chain '// &
    'the job is submitted again until the run is complete; array.txt of a sweep makes a job array', &
    'completion bash|zsh', 'print a script for the completion of commands, groups and keys in the shell', &
    'man', 'print this page and all keys as a manual page of Unix: implam man | man -l -', &
    'help [COMMAND|GROUP [KEY]]', 'this page, its part on a command, or the same as explain'], [2, 11])
  !> Options: term, commands that take it (empty: all), explanation. The last row is of PETSc.
  integer, parameter, public :: of_term = 1, of_commands = 2, of_meaning = 3
  character(len=*), parameter :: runs = 'run restart'
  character(len=text_length), parameter, public :: option_rows(3, 12) = reshape([character(len=text_length) :: &
    '--rig NAME', 'new', 'the deck of a test: d7136, a drop-weight test after ASTM D7136; d7137, the compression &
    &of its panel after the impact; stiffened and stiffened_compression, the same of a curved panel with blades', &
    '--output DIR', runs//' queue', 'folder of the results, instead of the deck''s; for restart the folder of the &
      &checkpoint', &
    '--wall-limit SECONDS', runs, 'end with a checkpoint before this wall-clock time has passed', &
    '--verify', 'run', 'run the deck, then again with elements and time steps half as long, and report the changes of &
      &the figures; the same command resumes where it was stopped', &
    '--profile', runs, 'print in log and summary the time and memory of each part of the run', &
    '--ranks N', 'queue', 'ranks of the job; default: by the number of unknowns', &
    '--time H:MM:SS', 'queue', 'wall-clock limit of the job; default: one day', &
    '--chain', 'queue', 'submit the job again, from its checkpoint, until the run is complete', &
    '--markdown', 'explain help', 'print a Markdown table', &
    '-v, --version', '', 'version, commit, compiler and PETSc, and how to cite', &
    '-h, --help', '', 'this page', &
    '-mat_..., -ksp_..., -log_view', runs, 'these and other options with one dash are passed to PETSc'], [3, 12])
  !> Exit codes.
  character(len=text_length), parameter, public :: code_rows(2, 7) = reshape([character(len=text_length) :: &
    '0', 'completed', '1', 'wrong use of the command line', '2', 'error in the deck', &
    '3', 'no convergence at the smallest step, an unstable motion, or with strict of &case a limit of the model &
      &exceeded', '4', 'a file that cannot be read or written', '5', 'internal error', &
    '75', 'stopped by a signal or the wall-clock limit, with a checkpoint: resume with restart'], [2, 7])
  !> Paragraphs on ranks and signals.
  character(len=text_length), parameter, public :: notes(2) = [character(len=text_length) :: &
    'Under mpirun all of this applies except the signals.', &
    'TERM, INT, USR1, USR2 and XCPU end the run after the current step, with a checkpoint; a line says '// &
    'that it was received. Under mpirun send USR1 '// &
    'to mpirun, or any of them to every rank: mpirun itself takes TERM and INT, kills the ranks a second later and '// &
    'ends with code 1.']

contains

  !> The help of the program.
  pure function usage_lines() result(lines)
    !> Lines for the terminal
    type(line_t), allocatable :: lines(:)
    integer :: i

    call append_rows(lines, 'Usage:', 'implam ', command_rows)
    call append_rows(lines, 'Options:', '', explained_options())
    call append_rows(lines, 'Exit codes:', '', code_rows)
    call append(lines, 'Ranks and signals:')
    do i = 1, size(notes)
      call append_wrapped(lines, '', trim(notes(i)), 2)
    end do
  end function usage_lines

  !> The part of the help on one command.
  pure function command_help(command) result(lines)
    !> Its first word
    character(len=*), intent(in) :: command
    !> Lines for the terminal; none: there is no such command
    type(line_t), allocatable :: lines(:)
    character(len=text_length) :: options(2, size(option_rows, 2))
    logical :: on_it(size(command_rows, 2)), with_it(size(option_rows, 2))
    integer :: i

    allocate (lines(0))
    do i = 1, size(on_it)
      on_it(i) = index(command_rows(1, i)//' ', command//' ') == 1 .or. &
                 index(command_rows(1, i), '['//command//']') == 1
    end do
    if (.not. any(on_it)) return
    do i = 1, size(with_it)
      with_it(i) = index(' '//trim(option_rows(of_commands, i))//' ', ' '//command//' ') > 0
    end do
    call append_rows(lines, 'Usage:', 'implam ', command_rows(:, pack([(i, i=1, size(on_it))], on_it)))
    options(1, :) = option_rows(of_term, :)
    options(2, :) = option_rows(of_meaning, :)
    if (any(with_it)) call append_rows(lines, 'Options:', '', options(:, pack([(i, i=1, size(with_it))], with_it)))
    call append(lines, 'implam help lists all commands, options and exit codes.')
  end function command_help

  !> Options and their explanations, which begin with the commands that take them.
  pure function explained_options() result(rows)
    !> (2, options)
    character(len=text_length) :: rows(2, size(option_rows, 2))
    integer :: i

    rows(1, :) = option_rows(of_term, :)
    rows(2, :) = option_rows(of_meaning, :)
    do i = 1, size(rows, 2)
      if (option_rows(of_commands, i) /= '') &
        rows(2, i) = 'with '//joined(words_of(trim(option_rows(of_commands, i)), ' '), ', ')//': '//rows(2, i)
    end do
  end function explained_options

  !> A heading and its rows.
  pure subroutine append_rows(lines, heading, prefix, rows)
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> Line above
    character(len=*), intent(in) :: heading
    !> Beginning of each term
    character(len=*), intent(in) :: prefix
    !> Terms and explanations, (2, rows)
    character(len=*), intent(in) :: rows(:, :)
    integer :: i

    call append(lines, heading)
    do i = 1, size(rows, 2)
      call append_wrapped(lines, prefix//trim(rows(1, i)), trim(rows(2, i)), indent)
    end do
  end subroutine append_rows

  !> A term with its explanation beside it.
  pure subroutine append_wrapped(lines, term, words, column)
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The term; empty: none
    character(len=*), intent(in) :: term
    !> The explanation
    character(len=*), intent(in) :: words
    !> Column of the explanation
    integer, intent(in) :: column
    type(line_t), allocatable :: word(:)
    character(len=:), allocatable :: line
    integer :: i

    line = '  '//term
    line = line//repeat(' ', max(2, column - len(line)))
    if (term == '') line = repeat(' ', column)
    word = words_of(words, ' ')
    do i = 1, size(word)
      if (len(line) + len(word(i)%text) > width) then
        call append(lines, trim(line))
        line = repeat(' ', column)
      end if
      line = line//word(i)%text//' '
    end do
    call append(lines, trim(line))
  end subroutine append_wrapped
end module usage_texts
