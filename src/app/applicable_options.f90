!> Which options apply to which commands, by the table of options.
module applicable_options
  use errors, only: error_t, fail, exit_usage
  use text, only: line_t, append, joined, words_of
  use usage_texts, only: of_commands, of_term, option_rows
  implicit none
  private
  public :: refuse_inapplicable

contains

  !> Refuses all options that do not apply to a command, in one sentence.
  subroutine refuse_inapplicable(verb, given, error)
    !> The command
    character(len=*), intent(in) :: verb
    !> Options of the command line, without values
    type(line_t), intent(in) :: given(:)
    !> Set (usage) if there are any
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: wrong(:)
    character(len=:), allocatable :: commands
    integer :: i

    allocate (wrong(0))
    do i = 1, size(given)
      commands = commands_with(given(i)%text)
      if (commands == '' .or. index(' '//commands//' ', ' '//verb//' ') > 0) cycle
      call append(wrong, given(i)%text//' (an option of '//joined(words_of(commands, ' '), ', ')//')')
    end do
    if (size(wrong) == 0) return
    call fail(error, exit_usage, 'implam '//verb//' does not take '//joined(wrong, ', ')//'.')
  end subroutine refuse_inapplicable

  !> Commands to which an option applies; empty: all. Options that are not in the table are of PETSc, its last row.
  pure function commands_with(option) result(commands)
    character(len=*), intent(in) :: option
    character(len=:), allocatable :: commands
    type(line_t), allocatable :: terms(:)
    integer :: i, j

    do i = 1, size(option_rows, 2)
      commands = trim(option_rows(of_commands, i))
      terms = words_of(trim(option_rows(of_term, i)), ' ')
      do j = 1, size(terms)
        if (terms(j)%text == option .or. terms(j)%text == option//',') return
      end do
    end do
  end function commands_with
end module applicable_options
