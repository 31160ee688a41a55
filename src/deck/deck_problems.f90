!> The faults of a deck: collected, so that all are reported at once, and each in one line.
module deck_problems
  use errors, only: exit_done, exit_deck, exit_files
  use grouped_messages, only: merged, skeleton
  use text, only: line_t, append, to_text, lower_case
  implicit none
  private
  public :: problems_t

  !> Largest number of faults reported.
  integer, parameter :: max_problems = 100
  !> Characters of a name or value shown in a message.
  integer, parameter, public :: max_shown = 60

  !> Represents any key of a group, when a fault may have hidden some.
  character(len=*), parameter, public :: any_key = '*'

  !> One fault.
  type :: problem_t
    !> Line of the deck; 0: the deck as a whole
    integer :: line = 0
    !> Index of its group among those of this name; 0: any
    integer :: place = 0
    !> True: a warning, with which the deck can run
    logical :: is_warning = .false.
    !> Group and key it belongs to, in lower case; empty if none
    character(len=:), allocatable :: group, key
    !> Text after `file:line:`
    character(len=:), allocatable :: message
  end type problem_t

  !> Faults of one deck.
  type :: problems_t
    private
    !> Path or name of the deck
    character(len=:), allocatable :: source
    !> The faults in the order they were found
    type(problem_t), allocatable :: list(:)
    !> True: the deck's file could not be read at all
    logical :: unreadable = .false.
  contains
    procedure :: begin
    procedure :: cannot_read
    procedure :: error => add_error
    procedure :: warning => add_warning
    procedure :: errors => number_of_errors
    procedure :: concern
    procedure :: is_full
    procedure :: exit_code
    procedure :: lines
    procedure :: remarks
    procedure, private :: add
    procedure, private :: line_of
    procedure, private :: grouped
  end type problems_t

contains

  !> Starts an empty list.
  subroutine begin(self, source)
    class(problems_t), intent(inout) :: self
    !> Path or name of the deck
    character(len=*), intent(in) :: source

    self%source = source
    self%unreadable = .false.
    if (allocated(self%list)) deallocate (self%list)
    allocate (self%list(0))
  end subroutine begin

  !> The file cannot be read.
  subroutine cannot_read(self, message)
    class(problems_t), intent(inout) :: self
    !> Path and reason
    character(len=*), intent(in) :: message

    self%unreadable = .true.
    call self%add(.false., 0, '', '', message)
  end subroutine cannot_read

  !> Adds a fault that forbids a run.
  subroutine add_error(self, line, group, key, message, place)
    class(problems_t), intent(inout) :: self
    !> Line of the deck; 0: the deck as a whole
    integer, intent(in) :: line
    !> Group and key it belongs to; empty if none
    character(len=*), intent(in) :: group, key
    !> Text after `file:line:`
    character(len=*), intent(in) :: message
    !> Index of its group among those of this name; absent: any
    integer, intent(in), optional :: place

    call self%add(.false., line, group, key, message, place)
  end subroutine add_error

  !> Adds a remark on a deck that can run, with line, group and key as in `add_error`.
  subroutine add_warning(self, line, group, key, message)
    class(problems_t), intent(inout) :: self
    integer, intent(in) :: line
    character(len=*), intent(in) :: group, key
    !> Text after `file:line: warning:`
    character(len=*), intent(in) :: message

    call self%add(.true., line, group, key, message)
  end subroutine add_warning

  !> Adds a fault or remark, with arguments as in `add_error`.
  subroutine add(self, is_warning, line, group, key, message, place)
    class(problems_t), intent(inout) :: self
    !> True: a remark
    logical, intent(in) :: is_warning
    integer, intent(in) :: line
    character(len=*), intent(in) :: group, key
    character(len=*), intent(in) :: message
    integer, intent(in), optional :: place
    type(problem_t) :: problem

    if (.not. is_warning .and. self%is_full()) return
    problem%is_warning = is_warning
    problem%line = line
    if (present(place)) problem%place = place
    problem%group = lower_case(group)
    problem%key = lower_case(key)
    problem%message = message
    if (.not. is_warning .and. self%errors() == max_problems) &
      problem%message = 'there are more faults; correct those above first.'
    self%list = [self%list, problem]
  end subroutine add

  !> True: the largest number of faults is reached.
  pure logical function is_full(self)
    class(problems_t), intent(in) :: self

    is_full = self%errors() > max_problems
  end function is_full

  !> True: an error belongs to this group, or to this key of it, so that checks that depend on it would be misleading.
  pure logical function concern(self, group, key, place)
    class(problems_t), intent(in) :: self
    character(len=*), intent(in) :: group
    !> Name of the key; absent: any
    character(len=*), intent(in), optional :: key
    !> Index among the groups of this name; absent: any
    integer, intent(in), optional :: place
    integer :: i

    concern = .false.
    do i = 1, size(self%list)
      if (self%list(i)%is_warning .or. self%list(i)%group /= lower_case(group)) cycle
      if (present(key)) then
        if (self%list(i)%key /= lower_case(key) .and. self%list(i)%key /= any_key) cycle
      end if
      if (present(place)) then
        if (self%list(i)%place > 0 .and. self%list(i)%place /= place) cycle
      end if
      concern = .true.
    end do
  end function concern

  !> Number of faults that forbid a run.
  pure integer function number_of_errors(self) result(number)
    class(problems_t), intent(in) :: self

    number = count(.not. self%list%is_warning)
  end function number_of_errors

  !> Exit code of a check.
  pure integer function exit_code(self)
    class(problems_t), intent(in) :: self

    exit_code = exit_done
    if (self%errors() > 0) exit_code = exit_deck
    if (self%unreadable) exit_code = exit_files
  end function exit_code

  !> The errors, then the warnings, each in order of the deck's lines.
  function lines(self) result(list)
    class(problems_t), intent(in) :: self
    !> Lines such as `deck.nml:7: &plate edges = 'soft': is not a choice; allowed: ...`
    type(line_t), allocatable :: list(:)
    type(problem_t), allocatable :: problems(:)
    logical, allocatable :: reported(:)
    integer :: next(1), i, pass

    allocate (list(0))
    problems = self%grouped()
    allocate (reported(size(problems)), source=.false.)
    do pass = 1, 2
      do i = 1, count(problems%is_warning .eqv. pass == 2)
        next = minloc(problems%line, mask=.not. reported .and. (problems%is_warning .eqv. pass == 2))
        reported(next(1)) = .true.
        call append(list, self%line_of(problems(next(1))))
      end do
    end do
  end function lines

  !> The warnings in the order they were found, without the deck's name, which a restart does not have.
  function remarks(self) result(list)
    class(problems_t), intent(in) :: self
    !> Lines such as `line 7: &time step = 1e-6: ...`
    type(line_t), allocatable :: list(:)
    type(problem_t), allocatable :: problems(:)
    integer :: i

    allocate (list(0))
    problems = self%grouped()
    do i = 1, size(problems)
      associate (problem => problems(i))
        if (.not. problem%is_warning) cycle
        if (problem%line > 0) then
          call append(list, 'line '//to_text(problem%line)//': '//problem%message)
        else
          call append(list, problem%message)
        end if
      end associate
    end do
  end function remarks

  !> The faults in the order they were found; warnings of one line of the deck that differ only in numbers are merged
  !> into one.
  function grouped(self) result(list)
    class(problems_t), intent(in) :: self
    type(problem_t), allocatable :: list(:)
    type(line_t), allocatable :: alike(:)
    logical :: reported(size(self%list))
    integer :: i, k

    allocate (list(0))
    reported = .false.
    do i = 1, size(self%list)
      if (reported(i)) cycle
      list = [list, self%list(i)]
      if (.not. self%list(i)%is_warning) cycle
      if (allocated(alike)) deallocate (alike)
      do k = i, size(self%list)
        if (.not. self%list(k)%is_warning .or. self%list(k)%line /= self%list(i)%line) cycle
        if (skeleton(self%list(k)%message) /= skeleton(self%list(i)%message)) cycle
        call append(alike, self%list(k)%message)
        reported(k) = .true.
      end do
      list(size(list))%message = merged(alike)
    end do
  end function grouped

  !> One fault as printed.
  function line_of(self, problem) result(line)
    class(problems_t), intent(in) :: self
    !> The fault
    type(problem_t), intent(in) :: problem
    !> With the place in front
    character(len=:), allocatable :: line

    line = problem%message
    if (problem%is_warning) line = 'warning: '//line
    if (problem%line > 0) then
      line = self%source//':'//to_text(problem%line)//': '//line
    else if (.not. self%unreadable) then
      line = self%source//': '//line
    end if
  end function line_of
end module deck_problems
