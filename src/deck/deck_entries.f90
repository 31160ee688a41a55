!> Groups, keys and values as written in a deck.
module deck_entries
  use deck_problems, only: max_shown
  implicit none
  private
  public :: value_t, entry_t, block_t, append_entry, append_values, split_repeats, shown, shown_values, written_values

  !> Largest number of values and keys of a deck.
  integer, parameter, public :: max_values = 10000

  !> One value of a key.
  type :: value_t
    !> The word, or the text without its quotes
    character(len=:), allocatable :: text
    !> True: it was written in quotes
    logical :: quoted = .false.
  end type value_t

  !> One key with its values.
  type :: entry_t
    !> Index of its group
    integer :: block = 0
    !> Name as written
    character(len=:), allocatable :: key
    !> Line of the key
    integer :: line = 0
    !> False: a fault was already reported
    logical :: valid = .true.
    !> The values, repeated by their repeat counts
    type(value_t), allocatable :: values(:)
  end type entry_t

  !> One group.
  type :: block_t
    !> Name as written
    character(len=:), allocatable :: name
    !> Line of its &
    integer :: line = 0
  end type block_t

contains

  !> Adds an entry to the list, without copying the values of those before it.
  pure subroutine append_entry(entries, entry)
    !> The list
    type(entry_t), allocatable, intent(inout) :: entries(:)
    !> The new one
    type(entry_t), intent(in) :: entry
    type(entry_t), allocatable :: longer(:)
    integer :: i

    allocate (longer(size(entries) + 1))
    do i = 1, size(entries)
      longer(i)%block = entries(i)%block
      longer(i)%line = entries(i)%line
      longer(i)%valid = entries(i)%valid
      call move_alloc(entries(i)%key, longer(i)%key)
      call move_alloc(entries(i)%values, longer(i)%values)
    end do
    longer(size(longer)) = entry
    call move_alloc(longer, entries)
  end subroutine append_entry

  !> Adds a value to a key, as often as its repeat count says.
  pure subroutine append_values(values, repeats, value)
    !> The key's values
    type(value_t), allocatable, intent(inout) :: values(:)
    !> The repeat count
    integer, intent(in) :: repeats
    type(value_t), intent(in) :: value
    type(value_t), allocatable :: longer(:)
    integer :: i, old

    old = size(values)
    allocate (longer(old + repeats))
    do i = 1, old
      call move_alloc(values(i)%text, longer(i)%text)
      longer(i)%quoted = values(i)%quoted
    end do
    do i = old + 1, old + repeats
      longer(i) = value
    end do
    call move_alloc(longer, values)
  end subroutine append_values

  !> Separates a repeat count from a value.
  pure subroutine split_repeats(written, quoted, counted, repeats, word)
    !> The value as written in the deck, without quotes
    character(len=*), intent(in) :: written
    !> True: it was written in quotes
    logical, intent(in) :: quoted
    !> Digits of the count if they were written in front of quotes, otherwise empty
    character(len=*), intent(in) :: counted
    !> The count; 1 if there is none, 0 if it is not allowed
    integer, intent(out) :: repeats
    !> The value itself
    character(len=:), allocatable, intent(out) :: word
    character(len=:), allocatable :: digits
    integer :: star, status

    repeats = 1
    word = written
    digits = counted
    star = index(written, '*')
    if (.not. quoted .and. star > 0) then
      digits = written(:star - 1)
      word = written(star + 1:)
      if (star == 1) repeats = 0
    end if
    if (len(digits) == 0) return
    repeats = 0
    if (verify(digits, '0123456789') > 0 .or. len(digits) > 9) return
    read (digits, *, iostat=status) repeats
    if (status /= 0 .or. repeats > max_values) repeats = 0
  end subroutine split_repeats

  !> A name or word as shown in a message: truncated if it is long.
  pure function shown(word) result(short)
    !> Any text
    character(len=*), intent(in) :: word
    !> The text, truncated
    character(len=:), allocatable :: short

    short = word
    if (len(word) > max_shown) short = word(:max_shown - 3)//'...'
  end function shown

  !> Values as shown in a message, with a blank in front.
  pure function shown_values(values) result(short)
    type(value_t), intent(in) :: values(:)
    !> Separated by commas, truncated if long
    character(len=:), allocatable :: short

    short = ''
    if (size(values) > 0) short = ' '//shown(written_values(values(:min(size(values), max_shown))))
  end function shown_values

  !> Values as written in a deck.
  pure function written_values(values) result(words)
    type(value_t), intent(in) :: values(:)
    !> Separated by commas
    character(len=:), allocatable :: words
    integer :: i, j

    words = ''
    do i = 1, size(values)
      if (i > 1) words = words//', '
      if (.not. values(i)%quoted) then
        words = words//values(i)%text
        cycle
      end if
      words = words//''''
      do j = 1, len(values(i)%text)
        words = words//repeat(values(i)%text(j:j), merge(2, 1, values(i)%text(j:j) == ''''))
      end do
      words = words//''''
    end do
  end function written_values
end module deck_entries
