!> Change of the results on a finer mesh with shorter steps, from the summaries of both runs.
module verifications
  use checkpoints, only: checkpoint_archive_t, checkpoint_ending
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use errors, only: error_t
  use files, only: file_exists, read_whole_file
  use json_text, only: json_t
  use kinds, only: wp
  use root_output, only: print_lines
  use summary_file, only: summary_ending
  use summary_rows, only: label_of_result, unit_of_result
  use text, only: line_t, append, rounded_text
  use usual_units, only: in_usual_unit
  use whole_files, only: write_whole_file
  implicit none
  private
  public :: stage_of, print_changes

  !> Stage of a run of an earlier command.
  integer, parameter, public :: stage_none = 0, stage_stopped = 1, stage_done = 2
  !> Ending of the file's name.
  character(len=*), parameter :: verification_ending = '_verification.json'
  !> Largest summary read.
  integer, parameter :: max_bytes = 10000000
  !> Compared results.
  character(len=*), parameter :: figures(10) = [character(len=20) :: &
    'peak_force', 'peak_force_at', 'contact_duration', 'impactor_velocity', 'largest_deflection', 'energy_absorbed', &
    'delaminated_area', 'projected_area', 'energy_delamination', 'energy_ply_damage']

contains

  !> Stage of a run of the same deck by the same program in an earlier command. Collective.
  integer function stage_of(base, deck, commit, communicator) result(stage)
    character(len=*), intent(in) :: base
    character(len=*), intent(in) :: deck
    !> Of the program
    character(len=*), intent(in) :: commit
    type(communicator_t), intent(in) :: communicator
    type(checkpoint_archive_t) :: archive
    type(error_t), allocatable :: error
    character(len=:), allocatable :: summary
    logical :: ended, stopped

    stage = stage_none
    if (communicator%is_root()) then
      call read_summary(base, summary)
      ended = index(summary, '"kind": "done"') > 0
      if (ended .and. holds(summary, 'deck', deck) .and. holds(summary, 'commit', commit)) stage = stage_done
      stopped = file_exists(base//checkpoint_ending) .and. .not. ended
    end if
    call communicator%broadcast(stage)
    call communicator%broadcast(stopped)
    if (.not. stopped) return
    call archive%open_for_loading(communicator, base//checkpoint_ending, error)
    if (allocated(error)) return
    if (archive%provenance%deck == deck) stage = stage_stopped
    call archive%close(error)
  end function stage_of

  !> A summary; empty if there is none.
  subroutine read_summary(base, summary)
    character(len=*), intent(in) :: base
    !> Its text
    character(len=:), allocatable, intent(out) :: summary
    type(error_t), allocatable :: error

    call read_whole_file(base//summary_ending, max_bytes, summary, error)
  end subroutine read_summary

  !> True: a summary has a member of this name and text.
  logical function holds(summary, name, content)
    character(len=*), intent(in) :: summary
    !> Name and text of the member
    character(len=*), intent(in) :: name, content
    type(json_t) :: json
    character(len=:), allocatable :: member

    call json%begin()
    call json%put(name, content)
    call json%finished(member)
    ! The line between the brackets.
    member = member(index(member, '"'):index(member, '"', back=.true.))
    holds = index(summary, member) > 0
  end function holds

  !> Prints the changes of the results, and writes them to NAME_verification.json. Collective.
  subroutine print_changes(deck, finer, communicator, error)
    !> The deck, and the same refined
    type(deck_t), intent(in) :: deck, finer
    type(communicator_t), intent(in) :: communicator
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: lines(:)
    character(len=:), allocatable :: content

    if (communicator%is_root()) then
      call compare_summaries(deck, finer, lines, content)
      call print_lines(communicator, lines)
      call write_whole_file(deck%output%directory//'/'//deck%case%name//verification_ending, content, error)
    end if
    call communicator%agree(error)
  end subroutine print_changes

  !> The changes as a table and as JSON.
  subroutine compare_summaries(deck, finer, lines, content)
    !> The deck, and the same refined
    type(deck_t), intent(in) :: deck, finer
    type(line_t), allocatable, intent(out) :: lines(:)
    !> The JSON
    character(len=:), allocatable, intent(out) :: content
    character(len=:), allocatable :: summary, finer_summary
    type(json_t) :: json
    real(wp) :: values(2)
    logical :: found(2)
    character(len=22) :: label
    integer :: i

    call read_summary(deck%output%directory//'/'//deck%case%name, summary)
    call read_summary(finer%output%directory//'/'//finer%case%name, finer_summary)
    call json%begin()
    call json%put('as_it_is', deck%case%name)
    call json%put('finer', finer%case%name)
    call json%open_object('figures')
    allocate (lines(0))
    call append(lines, 'Verification with elements and time steps half as long:')
    call append(lines, '  figure                  as it is      finer         change')
    do i = 1, size(figures)
      call find_number(summary, trim(figures(i)), values(1), found(1))
      call find_number(finer_summary, trim(figures(i)), values(2), found(2))
      if (.not. all(found) .or. all(abs(values) <= 0)) cycle
      label = label_of_result(trim(figures(i)))
      call append(lines, '  '//label//'  '//wide(shown(values(1)))//wide(shown(values(2)))//change(values))
      call json%open_object(trim(figures(i)))
      call json%put('as_it_is', values(1))
      call json%put('finer', values(2))
      call json%close()
    end do
    call json%finished(content)

  contains

    !> A value with its unit.
    pure function shown(value) result(words)
      real(wp), intent(in) :: value
      !> Such as 2.468 kN
      character(len=:), allocatable :: words

      words = in_usual_unit(value, unit_of_result(trim(figures(i))), deck%case%units)
    end function shown
  end subroutine compare_summaries

  !> Number of a member of the outermost object; the member has a line of its own.
  pure subroutine find_number(summary, name, value, found)
    character(len=*), intent(in) :: summary
    !> The member
    character(len=*), intent(in) :: name
    !> Its number
    real(wp), intent(out) :: value
    !> False: there is none, or it is not known
    logical, intent(out) :: found
    character(len=:), allocatable :: opening
    integer :: first, status

    value = 0
    opening = new_line('a')//'  "'//name//'": '
    first = index(summary, opening)
    found = first > 0
    if (.not. found) return
    first = first + len(opening)
    read (summary(first:first + scan(summary(first:), ','//new_line('a')) - 2), *, iostat=status) value
    found = status == 0
  end subroutine find_number

  !> A word padded with blanks.
  pure function wide(word)
    character(len=*), intent(in) :: word
    !> The same in 14 columns or more
    character(len=max(14, len(word) + 1)) :: wide

    wide = word
  end function wide

  !> Relative change of a figure.
  pure function change(values) result(word)
    !> Original and finer value
    real(wp), intent(in) :: values(2)
    !> Such as -0.27 %; empty if the first value is 0
    character(len=:), allocatable :: word

    word = '-'
    if (abs(values(1)) > 0) word = rounded_text(100*(values(2)/values(1) - 1), 2)//' %'
  end function change
end module verifications
