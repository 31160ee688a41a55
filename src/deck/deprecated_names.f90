!> Deprecated keys and values of the deck: they are still read for one minor version, with a warning.
module deprecated_names
  use deck_entries, only: entry_t, shown, shown_values
  use deck_problems, only: problems_t
  use deck_scanner, only: scan_t
  use text, only: line_t, lower_case, to_text, words_of
  implicit none
  private
  public :: deprecation_t, deprecation_of, replace_deprecated, first_version_without

  !> Characters of a row.
  integer, parameter, public :: deprecation_row_length = 120
  !> Entry of a row for no value and for no replacement.
  character(len=*), parameter :: none = '-'

  !> A deprecated key, or a deprecated value.
  type :: deprecation_t
    !> Group and key in lower case
    character(len=:), allocatable :: group, key
    !> The value in lower case; empty: the key itself is deprecated
    character(len=:), allocatable :: value
    !> Key or value to write instead; empty: nothing
    character(len=:), allocatable :: replacement
    !> First version that warns
    character(len=:), allocatable :: since
  end type deprecation_t

contains

  !> A row as data.
  pure function deprecation_of(row) result(deprecation)
    !> Group, key, value or -, replacement or -, first version that warns, separated by bars
    character(len=*), intent(in) :: row
    !> The row as data
    type(deprecation_t) :: deprecation
    type(line_t), allocatable :: column(:)

    column = words_of(trim(row), '|')
    deprecation%group = lower_case(column(1)%text)
    deprecation%key = lower_case(column(2)%text)
    deprecation%value = lower_case(column(3)%text)
    deprecation%replacement = column(4)%text
    deprecation%since = column(5)%text
    if (deprecation%value == none) deprecation%value = ''
    if (deprecation%replacement == none) deprecation%replacement = ''
  end function deprecation_of

  !> Replaces deprecated keys and values of a scanned deck and warns of each.
  subroutine replace_deprecated(rows, scan, problems)
    !> Rows of deprecated names
    character(len=*), intent(in) :: rows(:)
    !> The deck; its keys and values are replaced
    type(scan_t), intent(inout) :: scan
    !> Warnings are added
    type(problems_t), intent(inout) :: problems
    type(deprecation_t) :: deprecation
    integer :: i, row

    do row = 1, size(rows)
      deprecation = deprecation_of(rows(row))
      do i = 1, size(scan%entries)
        if (lower_case(scan%blocks(scan%entries(i)%block)%name) /= deprecation%group) cycle
        if (lower_case(scan%entries(i)%key) /= deprecation%key) cycle
        call replace_entry(deprecation, scan%entries(i), problems)
      end do
    end do
  end subroutine replace_deprecated

  !> Replaces the key or value of an entry of the deck if it is deprecated.
  subroutine replace_entry(deprecation, entry, problems)
    !> The deprecation
    type(deprecation_t), intent(in) :: deprecation
    !> A key with its values
    type(entry_t), intent(inout) :: entry
    !> A warning is added
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: head
    integer :: i
    logical :: found

    head = '&'//deprecation%group//' '//shown(entry%key)//' ='//shown_values(entry%values)//': '
    if (deprecation%value == '') then
      ! Without a replacement the key is empty, and ignored.
      entry%key = deprecation%replacement
      found = .true.
    else
      found = .false.
      do i = 1, size(entry%values)
        if (lower_case(entry%values(i)%text) /= deprecation%value) cycle
        entry%values(i)%text = deprecation%replacement
        found = .true.
      end do
    end if
    if (found) call problems%warning(entry%line, deprecation%group, entry%key, head//sentence(deprecation))
  end subroutine replace_entry

  !> Sentence of a warning.
  pure function sentence(deprecation) result(words)
    !> The deprecation
    type(deprecation_t), intent(in) :: deprecation
    !> The sentence
    character(len=:), allocatable :: words

    words = 'deprecated since version '//deprecation%since//' and refused from '// &
               first_version_without(deprecation%since)//' on; '
    if (deprecation%replacement == '') then
      words = words//'it has no effect, leave it out.'
    else if (deprecation%value == '') then
      words = words//'write '//deprecation%replacement//'.'
    else
      words = words//'write '''//deprecation%replacement//'''.'
    end if
  end function sentence

  !> The minor version after the first one that warns.
  pure function first_version_without(since) result(version)
    !> MAJOR.MINOR.PATCH
    character(len=*), intent(in) :: since
    !> The next minor version
    character(len=:), allocatable :: version
    type(line_t), allocatable :: number(:)
    integer :: minor

    number = words_of(since, '.')
    read (number(2)%text, *) minor
    version = number(1)%text//'.'//to_text(minor + 1)//'.0'
  end function first_version_without
end module deprecated_names
