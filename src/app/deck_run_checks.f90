!> Checks of how a run is carried out: the times of its output, and what PETSc is told.
module deck_run_checks
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: tell, remark
  use kinds, only: wp
  use text, only: line_t, to_text, words_of
  implicit none
  private
  public :: check_intervals, check_petsc_options

  !> Most events of a run: more pass the range of default integers.
  real(wp), parameter :: most_events = 1.0e8_wp
  !> Part of a step below which an interval of output is remarked on.
  real(wp), parameter :: short = 0.5_wp
  !> What options for PETSc begin with in a deck.
  character(len=*), parameter :: beginnings(*) = [character(len=5) :: '-ksp_', '-pc_', '-mat_']

contains

  !> Intervals of output far below the step, which cut every step.
  subroutine check_intervals(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: keys(*) = [character(len=16) :: 'history_every', 'fields_every', 'checkpoint_every']
    real(wp) :: every, step, end
    integer :: i

    if (deck%has_static) then
      step = 1.0_wp/max(deck%stepping%static_steps, 1)
      end = 1
    else
      if (.not. deck%has_time .or. problems%concern('time')) return
      step = deck%stepping%time%step
      end = deck%stepping%time%end
    end if
    do i = 1, size(keys)
      every = deck%settings%real_of('output', trim(keys(i)))
      if (.not. every > 0) cycle
      if (end > most_events*every) then
        call tell(deck%settings, problems, 'output', trim(keys(i)), 'makes more than '//to_text(most_events)// &
                  ' steps; allowed: from '//to_text(end/most_events)//'.')
      else if (every < short*step) then
        call remark(deck%settings, problems, 'output', trim(keys(i)), 'every step becomes that short, '// &
                    to_text(nint(step/every))//' times as many as with steps of '//to_text(step)//'.')
      end if
    end do
  end subroutine check_intervals

  !> Options for PETSc: those of the solver, none that could write files. A deck may come from anywhere.
  subroutine check_petsc_options(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: words(:)
    integer :: i

    words = words_of(deck%settings%text_of('solver', 'petsc_options'), ' ')
    do i = 1, size(words)
      if (is_allowed(words(i)%text)) cycle
      call tell(deck%settings, problems, 'solver', 'petsc_options', words(i)%text//' might write files or more; '// &
                'allowed: -log_view and options that begin with -ksp_, -pc_ or -mat_, and words without : and /; '// &
                'give others on the command line.')
      return
    end do
  end subroutine check_petsc_options

  !> Whether a word is one of the options for a deck, or a value that names no file.
  pure logical function is_allowed(word)
    !> The word
    character(len=*), intent(in) :: word
    integer :: i

    ! A tab would part what is one word here into two for PETSc.
    is_allowed = scan(word, ':/'//achar(9)) == 0
    if (.not. is_allowed .or. word == '-log_view' .or. index(word, '-') /= 1) return
    if (len(word) > 1) is_allowed = scan(word(2:2), '0123456789.') == 1
    do i = 1, size(beginnings)
      if (index(word, trim(beginnings(i))) == 1) is_allowed = .true.
    end do
  end function is_allowed
end module deck_run_checks
