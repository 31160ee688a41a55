!> The command line of the program.
module command_lines
  use applicable_options, only: refuse_inapplicable
  use errors, only: error_t, fail, exit_files, exit_usage
  use folder_listings, only: file_by_age
  use kinds, only: wp
  use rig_decks, only: rig_names, rigs
  use text, only: line_t, append, nearest_name, words_of
  use usage_texts, only: of_term, option_rows
  implicit none
  private
  public :: argument, command_t, read_command_line

  !> Commands of the program, numbered as in verb_words.
  integer, parameter, public :: verb_run = 1, verb_check = 2, verb_explain = 3, verb_restart = 4, &
                                verb_version = 5, verb_help = 6, verb_new = 7, verb_completion = 8, &
                                verb_man = 9, verb_queue = 10

  !> A parsed command line.
  type :: command_t
    !> One of the verbs
    integer :: verb = verb_run
    !> Deck, checkpoint or its folder, topic; empty: none
    character(len=:), allocatable :: target
    !> Folder that overrides the deck's; unallocated: the deck's
    character(len=:), allocatable :: output
    !> Wall-clock seconds that override the deck's; 0: the deck's
    real(wp) :: wall_limit = 0
    !> Rig whose deck is written; empty: none
    character(len=:), allocatable :: rig
    !> slurm or pbs
    character(len=:), allocatable :: queue
    !> Ranks of a job and its wall-clock seconds; 0: by the size of the deck, and a day
    integer :: ranks = 0, seconds = 0
    !> True: a chain of jobs
    logical :: chain = .false.
    !> True: verification by a second run on a finer mesh with shorter steps
    logical :: verify = .false.
    !> True: the log and the summary have a profile of time and memory
    logical :: profile = .false.
    !> Arguments for PETSc, in one string
    character(len=:), allocatable :: petsc_options
    !> True: explain as a Markdown table, for the manual
    logical :: markdown = .false.
    !> All options given, without values
    type(line_t), allocatable :: options(:)
  end type command_t

  !> The words of the verbs, in the order of their numbers.
  character(len=*), parameter :: verb_words(*) = [character(len=10) :: 'run', 'check', 'explain', 'restart', &
                                                  'version', 'help', 'new', 'completion', 'man', 'queue']

  !> Options that ask for help, and for the version.
  character(len=*), parameter :: informing(*) = [character(len=9) :: '-h', '--help', '-v', '-V', '--version']
  !> Options that take a value.
  character(len=*), parameter :: valued(*) = [character(len=12) :: '--rig', '--ranks', '--time', &
                                                                      '--output', '--wall-limit']

contains

  !> Parses the arguments of the program.
  subroutine read_command_line(command, error)
    type(command_t), intent(out) :: command
    !> Set (usage) if an argument is not understood
    type(error_t), allocatable, intent(out) :: error
    character(len=:), allocatable :: word
    integer :: i
    logical :: verb_given

    command%target = ''
    command%rig = ''
    command%petsc_options = ''
    allocate (command%options(0))
    verb_given = .false.
    i = 1
    do while (i <= command_argument_count())
      word = argument(i)
      if (index(word, '--') == 1 .or. any(word == ['-h', '-v', '-V'])) then
        call read_option(command, word, i, error)
      else if (index(word, '-') == 1) then
        command%petsc_options = command%petsc_options//' '//word
        call append(command%options, word)
        if (takes_value(i + 1)) then
          i = i + 1
          command%petsc_options = command%petsc_options//' '//argument(i)
        end if
      else if (.not. verb_given .and. verb_of(word) > 0) then
        verb_given = .true.
        command%verb = verb_of(word)
      else if (command%verb == verb_queue .and. .not. allocated(command%queue)) then
        command%queue = word
      else if (command%target == '') then
        command%target = word
      else if (any(command%verb == [verb_explain, verb_help]) .and. scan(command%target, '%. ') == 0) then
        command%target = command%target//'%'//word
      else if (.not. verb_given .and. meant_verb(command%target) /= '') then
        call fail(error, exit_usage, 'Unknown command "'//command%target//'"; did you mean '// &
                  meant_verb(command%target)//'?')
      else
        call fail(error, exit_usage, 'Unexpected argument "'//word//'": one deck, checkpoint or topic at a time.')
      end if
      if (allocated(error)) return
      i = i + 1
    end do
    if (any([(any(command%options(i)%text == informing), i=1, size(command%options))])) then
      ! Help or version, whatever else is given: the first option of these decides.
      if (verb_given .and. all(command%verb /= [verb_help, verb_explain])) command%target = ''
      do i = size(command%options), 1, -1
        if (any(command%options(i)%text == informing(:2))) command%verb = verb_help
        if (any(command%options(i)%text == informing(3:))) command%verb = verb_version
      end do
      return
    end if
    if (.not. verb_given) call refuse_misspelt_verb(command%target, error)
    if (.not. allocated(error)) call require_target(command, error)
    if (.not. allocated(error)) call refuse_inapplicable(trim(verb_words(command%verb)), command%options, error)
  end subroutine read_command_line

  !> Reads an option that begins with two dashes.
  subroutine read_option(command, word, i, error)
    type(command_t), intent(inout) :: command
    !> The option
    character(len=*), intent(in) :: word
    !> Its position; increased if the option takes a value
    integer, intent(inout) :: i
    !> Set (usage) if the option is unknown or lacks its value
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: value
    integer :: equals

    equals = index(word, '=')
    value = word(merge(equals, len(word), equals > 0) + 1:)
    call append(command%options, word(:merge(equals - 1, len(word), equals > 0)))
    if (equals > 0) then
      call read_value(command, word(:equals - 1), value, error)
    else if (any(word == valued)) then
      i = i + 1
      if (i <= command_argument_count()) value = argument(i)
      call read_value(command, word, value, error)
    else
      call read_switch(command, word, error)
    end if
  end subroutine read_option

  !> Reads an option without a value.
  subroutine read_switch(command, word, error)
    type(command_t), intent(inout) :: command
    !> The option
    character(len=*), intent(in) :: word
    !> Set (usage) if the option is unknown
    type(error_t), allocatable, intent(inout) :: error

    select case (word)
    case ('--version', '-v', '-V', '--help', '-h')
      continue
    case ('--markdown')
      command%markdown = .true.
    case ('--verify')
      command%verify = .true.
    case ('--profile')
      command%profile = .true.
    case ('--chain')
      command%chain = .true.
    case default
      call refuse_option(word, error)
    end select
  end subroutine read_switch

  !> Reads an option with its value, the next word or the text after an equals sign.
  subroutine read_value(command, word, value, error)
    type(command_t), intent(inout) :: command
    !> The option
    character(len=*), intent(in) :: word
    !> Its value; empty: there is none
    character(len=*), intent(in) :: value
    !> Set (usage) if the option is unknown or lacks its value
    type(error_t), allocatable, intent(inout) :: error

    select case (word)
    case ('--rig')
      command%rig = value
      if (all(rigs /= value)) call fail(error, exit_usage, '--rig needs the name of a rig: '//rig_names//'.')
    case ('--ranks')
      command%ranks = whole_number(value)
      if (command%ranks < 1) call fail(error, exit_usage, '--ranks needs a whole number above 0.')
    case ('--time')
      command%seconds = clock_seconds(value)
      if (command%seconds < 60) call fail(error, exit_usage, '--time needs hours:minutes:seconds, a minute at least.')
    case ('--output')
      command%output = value
      if (command%output == '') call fail(error, exit_usage, '--output needs a folder.')
    case ('--wall-limit')
      command%wall_limit = seconds_of(value)
      if (.not. command%wall_limit > 0) call fail(error, exit_usage, '--wall-limit needs a number of seconds above 0.')
    case default
      call refuse_option(word, error)
    end select
  end subroutine read_value

  !> Reports an unknown option, or one that takes no value, with the most similar option.
  subroutine refuse_option(word, error)
    !> The option
    character(len=*), intent(in) :: word
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: known(:), terms(:)
    character(len=:), allocatable :: nearest, verb
    integer :: i, j

    verb = ''
    if (index(word, '--') == 1) verb = meant_verb(word(3:))
    allocate (known(0))
    do i = 1, size(option_rows, 2)
      terms = words_of(trim(option_rows(of_term, i)), ' ')
      do j = 1, size(terms)
        if (index(terms(j)%text, '--') == 1) call append(known, terms(j)%text)
      end do
    end do
    nearest = nearest_name(word, known)
    if (nearest == word) then
      call fail(error, exit_usage, word//' takes no value.')
    else if (nearest /= '') then
      call fail(error, exit_usage, 'Unknown option "'//word//'"; did you mean '//nearest//'?')
    else if (verb /= '') then
      call fail(error, exit_usage, 'Unknown option "'//word//'"; did you mean implam '//verb//'?')
    else
      call fail(error, exit_usage, 'Unknown option "'//word//'"; see implam help.')
    end if
  end subroutine refuse_option

  !> Command most similar to a word; empty: none is similar, or the word may be the name of a file.
  pure function meant_verb(word) result(verb)
    character(len=*), intent(in) :: word
    character(len=:), allocatable :: verb
    type(line_t), allocatable :: known(:)
    integer :: i

    verb = ''
    if (scan(word, './') > 0) return
    allocate (known(0))
    do i = 1, size(verb_words)
      call append(known, trim(verb_words(i)))
    end do
    verb = nearest_name(word, known)
  end function meant_verb

  !> Refuses a word that is no file and similar to a command, instead of reading it as a deck.
  subroutine refuse_misspelt_verb(word, error)
    !> The word; empty: there is none
    character(len=*), intent(in) :: word
    !> Set (usage) if it is one
    type(error_t), allocatable, intent(inout) :: error
    logical :: is_there

    if (word == '') return
    inquire (file=word, exist=is_there)
    if (.not. is_there .and. meant_verb(word) /= '') &
      call fail(error, exit_usage, 'Unknown command "'//word//'"; did you mean '//meant_verb(word)//'?')
  end subroutine refuse_misspelt_verb

  !> Value of a word; 0 if it is no whole number.
  pure integer function whole_number(word) result(number)
    character(len=*), intent(in) :: word
    integer :: status

    number = 0
    if (len(word) == 0 .or. len(word) > 6 .or. verify(word, '0123456789') > 0) return
    read (word, *, iostat=status) number
    if (status /= 0) number = 0
  end function whole_number

  !> Seconds of hours:minutes:seconds or hours:minutes; 0 if the word is neither.
  pure integer function clock_seconds(word) result(seconds)
    character(len=*), intent(in) :: word
    type(line_t), allocatable :: parts(:)
    integer :: i

    seconds = 0
    parts = words_of(word, ':')
    if (size(parts) < 2 .or. size(parts) > 3) return
    if (any([(len(parts(i)%text) == 0 .or. len(parts(i)%text) > 4 .or. verify(parts(i)%text, '0123456789') > 0, &
              i=1, size(parts))])) return
    do i = 1, size(parts)
      seconds = seconds + whole_number(parts(i)%text)*60**(3 - i)
    end do
  end function clock_seconds

  !> Value of a word in seconds; 0 if it is no number.
  pure real(wp) function seconds_of(word) result(seconds)
    character(len=*), intent(in) :: word
    integer :: status

    seconds = 0
    if (verify(word, '0123456789.eE+-') > 0) return
    read (word, *, iostat=status) seconds
    if (status /= 0 .or. .not. seconds <= huge(seconds)) seconds = 0
  end function seconds_of

  !> Checks that the verbs that need a file have one.
  subroutine require_target(command, error)
    type(command_t), intent(inout) :: command
    !> Set (usage) if no file is given, (files) if restart is given a deck
    type(error_t), allocatable, intent(inout) :: error

    if (command%verb == verb_restart .and. index(command%target, '.nml', back=.true.) > 0 .and. &
        index(command%target, '.nml', back=.true.) == len(command%target) - 3) &
      call fail(error, exit_files, 'restart takes a checkpoint or its folder and not the deck '//command%target// &
                ', as the checkpoint holds the deck: implam restart FOLDER/NAME_restart.h5, or implam restart FOLDER.')
    if (any(command%verb == [verb_version, verb_man]) .and. command%target /= '') &
      call fail(error, exit_usage, 'Unexpected argument "'//command%target//'": implam '// &
                trim(verb_words(command%verb))//' takes none.')
    if (command%target /= '') return
    select case (command%verb)
    case (verb_run, verb_check)
      call fail(error, exit_usage, &
                'No deck given; `implam new` writes one to start from, `implam help` lists the commands.')
    case (verb_queue)
      ! The deck of this folder, if there is exactly one.
      command%target = file_by_age('.', '.nml', 0)
      if (file_by_age('.', '.nml', 1) /= '') command%target = ''
      if (.not. allocated(command%queue) .or. command%target == '') &
        call fail(error, exit_usage, 'implam queue needs slurm or pbs, and a deck or the array.txt of a sweep.')
    case (verb_completion)
      call fail(error, exit_usage, 'implam completion needs the name of a shell, bash or zsh.')
    end select
  end subroutine require_target

  !> Verb of a word; 0: the word is not a verb.
  pure integer function verb_of(word) result(verb)
    character(len=*), intent(in) :: word

    verb = findloc(verb_words == word, .true., dim=1)
  end function verb_of

  !> True if an argument is the value of a PETSc option before it: a number or a plain word that is not a file.
  logical function takes_value(i)
    !> Position of the argument
    integer, intent(in) :: i
    character(len=:), allocatable :: word

    takes_value = .false.
    if (i > command_argument_count()) return
    word = argument(i)
    takes_value = index(word, '-') /= 1 .and. index(word, '.nml') == 0 .and. index(word, '.h5') == 0 &
                  .and. verb_of(word) == 0
    if (len(word) > 1) takes_value = takes_value .or. &
                                     scan(word(1:1), '-') == 1 .and. scan(word(2:2), '0123456789.') == 1
  end function takes_value

  !> One argument of the command line.
  function argument(i) result(word)
    !> Position
    integer, intent(in) :: i
    character(len=:), allocatable :: word
    integer :: length

    call get_command_argument(i, length=length)
    allocate (character(len=length) :: word)
    call get_command_argument(i, word)
  end function argument
end module command_lines
