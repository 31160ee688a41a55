!> Reports of a run in its log: keys in effect at the start, costs at the end.
module run_reports
  use text, only: line_t, to_text
  use logger, only: log_t
  use models, only: model_t
  use profiles, only: part_length, profile_row_t
  use timers, only: timer_set_t
  use deck_contents, only: deck_t
  use deck_echo, only: echo
  use deck_extents, only: extent_lines
  use ply_zone_tables, only: ply_zone_lines
  use scale_tables, only: scale_lines
  use strength_tables, only: strength_lines
  use zone_tables, only: zone_lines
  use deck_table, only: load_deck_table
  use deck_vocabulary, only: vocabulary_t
  use explicit_costs, only: untaken_step
  use indentation_deck, only: echo_without_group
  use kinds, only: wp
  use tangent_operators, only: tangent_operator_t
  use steppers, only: stepper_t
  implicit none
  private
  public :: log_echo, log_model, log_costs

contains

  !> Lists all keys in effect in the log, and zones and starters on the mesh.
  subroutine log_echo(deck, log)
    type(deck_t), intent(in) :: deck
    type(log_t), intent(inout) :: log
    type(vocabulary_t) :: vocabulary
    type(line_t), allocatable :: lines(:)
    integer :: i

    call load_deck_table(vocabulary)
    call echo(vocabulary, deck%settings, lines)
    if (deck%setup%impactor%is_present .and. .not. deck%setup%impactor%indentation%is_given) &
      call echo_without_group(deck%setup%impactor%indentation, lines)
    lines = [lines, extent_lines(deck), scale_lines(deck), ply_zone_lines(deck), zone_lines(deck), &
             strength_lines(deck)]
    if (allocated(deck%reasons)) lines = [lines, deck%reasons]
    do i = 1, size(lines)
      call log%detail(lines(i)%text)
    end do
  end subroutine log_echo

  !> Reports the size of the model and its steps, and whether the deck's step is longer. Collective.
  subroutine log_model(deck, model, stepper, log)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    type(log_t), intent(inout) :: log
    character(len=:), allocatable :: untaken
    type(line_t), allocatable :: lines(:)
    integer :: i

    lines = stepper%model_sentences(model)
    do i = 1, size(lines)
      call log%note(lines(i)%text)
    end do
    untaken = untaken_step(deck, stepper%longest_step())
    if (untaken /= '') call log%note(untaken)
  end subroutine log_model

  !> Lists the profile in the log, the longest parts first.
  subroutine log_profile(rows, log)
    !> The parts; none without a profile
    type(profile_row_t), intent(in) :: rows(:)
    type(log_t), intent(inout) :: log
    character(len=part_length + 48) :: line
    logical :: left(size(rows))
    integer :: i, k

    if (size(rows) == 0) return
    call log%detail('Profile: each part without those inside it     calls    wall clock     memory')
    left = .true.
    do k = 1, size(rows)
      i = maxloc(rows%seconds, 1, left)
      left(i) = .false.
      write (line, '(a,i20,f13.4," s",f7.1," MB")') rows(i)%name, rows(i)%calls, rows(i)%seconds, rows(i)%megabytes
      call log%detail(trim(line))
    end do
    write (line, '(a,f13.4," s",f7.1," MB")') 'all of this rank'//repeat(' ', part_length + 4), sum(rows%seconds), &
      sum(rows%megabytes)
    call log%detail(trim(line))
  end subroutine log_profile

  !> Lists time and memory in the log; the second part of the list is contained in the steps.
  subroutine log_costs(timers, operator, log)
    !> Time of set-up, steps and output
    type(timer_set_t), intent(in) :: timers
    type(tangent_operator_t), intent(inout) :: operator
    type(log_t), intent(inout) :: log
    real(wp) :: factor_entries, megabytes
    integer :: matrix_entries, i

    factor_entries = 0
    ! Central differences free the factor of the equilibrium before the first step.
    if (allocated(operator%solver)) call operator%solver%statistics(factor_entries, megabytes)
    if (factor_entries > 0) then
      matrix_entries = operator%numbering%row_start(operator%numbering%rows + 1) - 1
      call log%detail('Factor: '//to_text(factor_entries)//' numbers, '//to_text(megabytes)//' MB; matrix: '// &
                      to_text(matrix_entries)//' numbers on this rank.')
    end if
    associate (lines => [timers%lines(), operator%timers%lines()])
      call log%detail(repeat(' ', 37)//'times    wall clock       processor')
      do i = 1, size(lines)
        call log%detail(lines(i))
      end do
    end associate
    call log_profile(timers%profile%rows(), log)
  end subroutine log_costs
end module run_reports
