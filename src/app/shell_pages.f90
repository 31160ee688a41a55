!> The manual page of Unix and the completions of shells, generated from the tables of the program.
module shell_pages
  use allowed_values, only: allowed_sentence
  use deck_vocabulary, only: vocabulary_t, key_entry_t
  use errors, only: error_t, fail, exit_usage
  use growth_explain, only: growth_topic
  use key_conditions, only: conditions_in_words
  use material_explain, only: material_topic
  use result_explain, only: result_topics
  use text, only: line_t, append
  use usage_texts, only: command_rows, explained_options, of_term, option_rows, code_rows, notes
  use usual_ranges, only: range_in_words
  implicit none
  private
  public :: manual_page, completion

contains

  !> The manual page in the macros of man(7).
  subroutine manual_page(vocabulary, version, lines)
    type(vocabulary_t), intent(in) :: vocabulary
    !> Version of the program
    character(len=*), intent(in) :: version
    type(line_t), allocatable, intent(out) :: lines(:)
    integer :: i, j

    allocate (lines(0))
    call append(lines, '.TH IMPLAM 1 "" "Implam '//version//'"')
    call append(lines, '.SH NAME')
    call append(lines, 'implam \- low-velocity impact on composite laminates and the damage it causes')
    call append_terms('SYNOPSIS', '.B implam ', command_rows)
    call append_terms('OPTIONS', '.B ', explained_options())
    call append_terms('EXIT STATUS', '.B ', code_rows)
    call append(lines, '.SH RANKS AND SIGNALS')
    do i = 1, size(notes)
      call append(lines, escaped(trim(notes(i))))
      call append(lines, '.PP')
    end do
    call append(lines, '.SH DECK')
    call append(lines, 'A file of Fortran namelists: groups &name key = values ... / and comments behind !. '// &
                       'Units are any consistent ones.')
    do i = 1, size(vocabulary%groups)
      call append(lines, '.SS &'//vocabulary%groups(i)%name)
      call append(lines, escaped(vocabulary%groups(i)%meaning))
      do j = 1, size(vocabulary%keys)
        if (vocabulary%keys(j)%group == vocabulary%groups(i)%name) call append_key(vocabulary%keys(j), lines)
      end do
    end do
    call append(lines, '.SH FILES')
    call append(lines, 'Decks to start from and the manual lie in share/implam and share/doc/implam beside bin.')

  contains

    !> A section of terms and explanations.
    subroutine append_terms(heading, markup, rows)
      !> Name of the section
      character(len=*), intent(in) :: heading
      !> Beginning of each term
      character(len=*), intent(in) :: markup
      !> Terms and explanations, (2, rows)
      character(len=*), intent(in) :: rows(:, :)
      integer :: row

      call append(lines, '.SH '//heading)
      do row = 1, size(rows, 2)
        call append(lines, '.TP')
        call append(lines, markup//escaped(trim(rows(1, row))))
        call append(lines, escaped(trim(rows(2, row))))
      end do
    end subroutine append_terms
  end subroutine manual_page

  !> A key in the manual page.
  subroutine append_key(key, lines)
    type(key_entry_t), intent(in) :: key
    type(line_t), allocatable, intent(inout) :: lines(:)
    character(len=:), allocatable :: unit, conditions

    unit = ''
    if (key%unit /= '-') unit = '; unit: '//key%unit
    conditions = ''
    if (key%used_with /= '') conditions = '; '//conditions_in_words(key%used_with, '')
    if (key%usual /= '') conditions = conditions//'; '//range_in_words(key%usual)
    call append(lines, '.TP')
    call append(lines, '.B '//key%name)
    call append(lines, escaped(key%meaning//' ('//allowed_sentence(key)//unit//'; default: '//key%default// &
                               conditions//')'))
  end subroutine append_key

  !> A line with dashes, backslashes and initial dots escaped.
  pure function escaped(line) result(safe)
    character(len=*), intent(in) :: line
    !> With the escapes of roff
    character(len=:), allocatable :: safe
    integer :: i

    safe = ''
    if (scan(line(:min(1, len(line))), '.''') == 1) safe = '\&'
    do i = 1, len(line)
      select case (line(i:i))
      case ('-')
        safe = safe//'\-'
      case ('\')
        safe = safe//'\e'
      case default
        safe = safe//line(i:i)
      end select
    end do
  end function escaped

  !> A script that a shell reads to complete commands, options, groups and keys.
  subroutine completion(shell, vocabulary, lines, error)
    !> bash or zsh
    character(len=*), intent(in) :: shell
    type(vocabulary_t), intent(in) :: vocabulary
    !> The script
    type(line_t), allocatable, intent(out) :: lines(:)
    !> Raised (usage) for another shell
    type(error_t), allocatable, intent(inout) :: error
    character(len=:), allocatable :: topics
    integer :: i

    allocate (lines(0))
    topics = result_topics//' '//material_topic//' '//growth_topic
    do i = 1, size(vocabulary%groups)
      topics = topics//' '//vocabulary%groups(i)%name
    end do
    do i = 1, size(vocabulary%keys)
      topics = topics//' '//vocabulary%keys(i)%group//'.'//vocabulary%keys(i)%name
    end do
    select case (shell)
    case ('bash')
      call append(lines, '# Completion of implam for bash, written by `implam completion bash`.')
      call append_words(lines, topics)
    case ('zsh')
      call append(lines, '#compdef implam')
      call append(lines, '# Completion of implam for zsh, written by `implam completion zsh`.')
      call append(lines, 'autoload -U +X bashcompinit && bashcompinit')
      call append_words(lines, topics)
      ! The file is read at the first completion: zsh then waits for a response.
      call append(lines, 'if [[ ${zsh_eval_context[-1]} == loadautofunc ]]; then _bash_complete -F _implam; fi')
    case default
      call fail(error, exit_usage, 'implam completion knows bash and zsh.')
    end select
  end subroutine completion

  !> The function that both shells run.
  subroutine append_words(lines, topics)
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> Topics of explain
    character(len=*), intent(in) :: topics
    character(len=:), allocatable :: verbs, options
    integer :: i

    verbs = 'run'
    do i = 2, size(command_rows, 2)
      if (index(' '//verbs//' ', ' '//first_word(command_rows(1, i))//' ') == 0) &
        verbs = verbs//' '//first_word(command_rows(1, i))
    end do
    options = '-h --help'
    do i = 1, size(option_rows, 2)
      if (index(option_rows(of_term, i), '--') == 1) options = options//' '//first_word(option_rows(of_term, i))
    end do
    call append(lines, '_implam() {')
    call append(lines, '  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=')
    call append(lines, '  case $before in')
    call append(lines, '    explain|help) words='''//topics//''' ;;')
    call append(lines, '    completion) words=''bash zsh'' ;;')
    call append(lines, '    --wall-limit) return ;;')
    call append(lines, '    --output) COMPREPLY=($(compgen -d -- "$word")); return ;;')
    call append(lines, '    implam|*/implam) words='''//verbs//' '//options//''' ;;')
    call append(lines, '    *) [[ $word == -* ]] && words='''//options//''' ;;')
    call append(lines, '  esac')
    call append(lines, '  COMPREPLY=($(compgen -W "$words" -- "$word"))')
    call append(lines, '  [[ '' explain help completion '' == *" $before "* ]] && return')
    call append(lines, '  COMPREPLY+=($(compgen -f -X ''!*.nml'' -- "$word")')
    call append(lines, '    $(compgen -f -X ''!*_restart.h5'' -- "$word")')
    call append(lines, '    $(compgen -d -- "$word"))')
    call append(lines, '}')
    call append(lines, 'complete -F _implam implam')
  end subroutine append_words

  !> First word of a term.
  pure function first_word(term) result(word)
    !> The term
    character(len=*), intent(in) :: term
    !> Up to its first blank
    character(len=:), allocatable :: word

    word = term(:index(term//' ', ' ') - 1)
  end function first_word
end module shell_pages
