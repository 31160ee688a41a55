!> Conditions under which a key has an effect, the last cell of its row, as a deck would give them.
!>
!> A cell is a list of conditions separated by commas, all of which must hold. A condition is `&group`, `key`,
!> `key = value`, the last two also with the name of another group before the key; `not` before it reverses it, and
!> ` or ` separates alternatives. A key alone is one whose value, given or by default, is not zero; `not` before it
!> asks for one that the deck does not give, as defaults follow from other keys.
module key_conditions
  use deck_entries, only: value_t
  use deck_settings, only: settings_t
  use deck_values, only: logical_value, real_value
  use text, only: line_t, lower_case, words_of
  implicit none
  private
  public :: condition_t, missing_condition, conditions_in_words, split_condition

  !> One condition, its words separated.
  type :: condition_t
    !> True: it must not hold
    logical :: reversed = .false.
    !> Names of the group, empty for that of the key itself, and of a key, empty for a group alone; value of the key,
    !> empty: any
    character(len=:), allocatable :: group, key, value
  end type condition_t

contains

  !> Why a key has no effect, such as `without &thermal`; empty: it has one.
  pure function missing_condition(settings, conditions, group, place) result(reason)
    type(settings_t), intent(in) :: settings
    !> The cell
    character(len=*), intent(in) :: conditions
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    character(len=:), allocatable :: reason
    type(line_t), allocatable :: parts(:)
    integer :: i

    reason = ''
    parts = words_of(conditions, ',')
    do i = 1, size(parts)
      if (any_holds(settings, parts(i)%text, group, place)) cycle
      reason = reason_of(parts(i)%text)
      return
    end do
  end function missing_condition

  !> The cell as a clause, such as `used with law = 'cohesive', not with G_c`.
  pure function conditions_in_words(conditions, mark) result(words)
    !> The cell
    character(len=*), intent(in) :: conditions
    !> Written before and after each condition
    character(len=*), intent(in) :: mark
    character(len=:), allocatable :: words
    type(line_t), allocatable :: parts(:)
    type(condition_t) :: first
    integer :: i

    words = ''
    parts = words_of(conditions, ',')
    do i = 1, size(parts)
      call split_condition(leading(parts(i)%text), first)
      if (i > 1) words = words//', '
      if (first%reversed) words = words//'not '
      if (i == 1) words = words//'used '
      words = words//'with '//mark//alternatives(parts(i)%text, mark//' or '//mark)//mark
    end do
  end function conditions_in_words

  !> Why a condition that does not hold leaves a key without effect.
  pure function reason_of(condition) result(reason)
    !> Alternatives
    character(len=*), intent(in) :: condition
    character(len=:), allocatable :: reason
    type(condition_t) :: first

    call split_condition(leading(condition), first)
    if (.not. first%reversed) then
      reason = 'without '//alternatives(condition, ' or ')
    else if (first%key /= '' .and. first%value == '') then
      reason = 'as '//shown(first)//' is given'
    else
      reason = 'with '//shown(first)
    end if
  end function reason_of

  !> True if one of the alternatives holds.
  pure logical function any_holds(settings, alternatives, group, place)
    type(settings_t), intent(in) :: settings
    !> Conditions with ` or ` between them
    character(len=*), intent(in) :: alternatives
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    type(condition_t) :: condition
    character(len=:), allocatable :: left

    any_holds = .false.
    left = alternatives
    do while (left /= '')
      call split_condition(leading(left), condition)
      left = rest(left)
      any_holds = any_holds .or. (holds(settings, condition, group, place) .neqv. condition%reversed)
    end do
  end function any_holds

  !> True if a condition holds, its reversal apart. Values with errors have a message of their own: they count as fit.
  pure logical function holds(settings, condition, group, place)
    type(settings_t), intent(in) :: settings
    type(condition_t), intent(in) :: condition
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    integer :: i

    if (condition%key == '') then
      holds = settings%has_group(condition%group)
    else if (condition%group == '' .or. condition%group == group) then
      holds = has_value(settings, condition, group, place)
    else
      holds = .false.
      do i = 1, max(1, settings%groups_named(condition%group))
        holds = holds .or. has_value(settings, condition, condition%group, i)
      end do
    end if
  end function holds

  !> True if one of the values in effect is the wanted one, or any that is not zero.
  pure logical function has_value(settings, condition, group, place)
    type(settings_t), intent(in) :: settings
    type(condition_t), intent(in) :: condition
    !> Group of the key asked for
    character(len=*), intent(in) :: group
    integer, intent(in) :: place
    type(value_t), allocatable :: values(:)
    integer :: i, item

    has_value = .false.
    item = settings%find(group, condition%key, place)
    if (item == 0) return
    if (.not. settings%items(item)%valid) then
      has_value = .not. condition%reversed
      return
    end if
    if (condition%reversed .and. condition%value == '' .and. .not. settings%items(item)%given) return
    call settings%take_values(group, condition%key, values, place)
    do i = 1, size(values)
      if (index(condition%value, '.') == 1) then
        has_value = has_value .or. (logical_value(values(i)) .eqv. condition%value == '.true.')
      else if (condition%value /= '') then
        has_value = has_value .or. lower_case(values(i)%text) == condition%value
      else
        has_value = has_value .or. values(i)%quoted .or. abs(real_value(values(i))) > 0
      end if
    end do
  end function has_value

  !> Splits a condition into its words.
  pure subroutine split_condition(text, condition)
    !> One condition
    character(len=*), intent(in) :: text
    type(condition_t), intent(out) :: condition
    character(len=:), allocatable :: words
    integer :: mark

    words = trim(adjustl(text))
    condition%reversed = index(words, 'not ') == 1
    if (condition%reversed) words = trim(adjustl(words(5:)))
    condition%group = ''
    condition%value = ''
    mark = index(words, '=')
    if (mark > 0) then
      condition%value = trim(adjustl(words(mark + 1:)))
      words = trim(words(:mark - 1))
    end if
    if (index(words, '&') == 1) then
      mark = index(words//' ', ' ')
      condition%group = words(2:mark - 1)
      words = trim(adjustl(words(mark:)))
    end if
    condition%key = words
  end subroutine split_condition

  !> Alternatives as a deck has them.
  pure recursive function alternatives(text, between) result(words)
    !> One or more conditions
    character(len=*), intent(in) :: text
    !> What stands between two of them
    character(len=*), intent(in) :: between
    character(len=:), allocatable :: words
    type(condition_t) :: first

    call split_condition(leading(text), first)
    words = shown(first)
    if (rest(text) /= '') words = words//between//alternatives(rest(text), between)
  end function alternatives

  !> A condition as a deck has it.
  pure function shown(condition) result(words)
    type(condition_t), intent(in) :: condition
    character(len=:), allocatable :: words

    words = ''
    if (condition%group /= '') words = '&'//condition%group
    if (condition%group /= '' .and. condition%key /= '') words = words//' '
    words = words//condition%key
    if (condition%value == '') return
    if (index(condition%value, '.') == 1) then
      words = words//' = '//condition%value
    else
      words = words//' = '''//condition%value//''''
    end if
  end function shown

  !> The first of several alternatives.
  pure function leading(text) result(first)
    !> Conditions with ` or ` between them
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: first

    first = text
    if (index(text, ' or ') > 0) first = text(:index(text, ' or ') - 1)
  end function leading

  !> The alternatives after the first.
  pure function rest(text) result(others)
    !> Conditions with ` or ` between them
    character(len=*), intent(in) :: text
    character(len=:), allocatable :: others

    others = ''
    if (index(text, ' or ') > 0) others = text(index(text, ' or ') + 4:)
  end function rest
end module key_conditions
