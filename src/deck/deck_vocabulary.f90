!> The table of the deck as data: groups, keys, and the values of a key.
module deck_vocabulary
  use text, only: line_t, append, lower_case, words_of
  implicit none
  private
  public :: group_entry_t, key_entry_t, vocabulary_t, load_vocabulary

  !> Characters of a row of a group and of a key, sufficient for the longest.
  integer, parameter, public :: group_row_length = 220, key_row_length = 300

  !> A group of the deck.
  type :: group_entry_t
    !> Name without &
    character(len=:), allocatable :: name
    !> required; repeatable: required, may be given several times; settings: in effect even if left out; optional:
    !> physics that is modelled only if the group is given; several: optional, may be given several times; hidden:
    !> optional, for studies, and in no list of groups
    character(len=:), allocatable :: presence
    !> One sentence
    character(len=:), allocatable :: meaning
  end type group_entry_t

  !> A key of a group.
  type :: key_entry_t
    !> Names of the group and of the key as the manual writes it
    character(len=:), allocatable :: group, name
    !> real, integer, logical, text, name or choice
    character(len=:), allocatable :: kind
    !> Number of values: 1, 2, 1 or 4, plies, 1 or plies, 1 or more
    character(len=:), allocatable :: values
    !> Physical dimension, - if none
    character(len=:), allocatable :: unit
    !> required; none: the key may be left out; = and the origin of its value; or the value as written in a deck
    character(len=:), allocatable :: default
    !> Choices separated by blanks, or conditions separated by commas and after them words as `or 'all'`
    character(len=:), allocatable :: allowed
    !> One sentence
    character(len=:), allocatable :: meaning
    !> Conditions under which it has an effect (key_conditions); empty: always
    character(len=:), allocatable :: used_with
    !> Quantity whose usual range (usual_ranges) its values have; empty: any values
    character(len=:), allocatable :: usual
  contains
    procedure :: has_literal_default
  end type key_entry_t

  !> All groups and keys.
  type :: vocabulary_t
    !> Groups in the order of the manual
    type(group_entry_t), allocatable :: groups(:)
    !> Keys, those of a group together
    type(key_entry_t), allocatable :: keys(:)
  contains
    procedure :: group_index
    procedure :: key_index
    procedure :: group_names
    procedure :: key_names
    procedure :: groups_with
  end type vocabulary_t

contains

  !> Parses the table.
  pure subroutine load_vocabulary(group_rows, key_rows, vocabulary)
    !> Rows of groups: name, presence and meaning, separated by bars
    character(len=*), intent(in) :: group_rows(:)
    !> Rows of keys: group, key, type, number of values, unit, default, allowed, meaning and, if there are any, the
    !> conditions under which it has an effect and the quantity of a usual range, separated by bars
    character(len=*), intent(in) :: key_rows(:)
    !> The table as data
    type(vocabulary_t), intent(out) :: vocabulary
    type(line_t), allocatable :: column(:)
    integer :: i

    allocate (vocabulary%groups(size(group_rows)), vocabulary%keys(size(key_rows)))
    do i = 1, size(group_rows)
      column = words_of(trim(group_rows(i)), '|')
      vocabulary%groups(i)%name = column(1)%text
      vocabulary%groups(i)%presence = column(2)%text
      vocabulary%groups(i)%meaning = column(3)%text
    end do
    do i = 1, size(key_rows)
      column = words_of(trim(key_rows(i)), '|')
      call set_key(column, vocabulary%keys(i))
    end do
  end subroutine load_vocabulary

  !> Sets a key from the columns of its row, one by one: gfortran 12 corrupts memory if a constructor does it.
  pure subroutine set_key(column, key)
    !> Columns of the row
    type(line_t), intent(in) :: column(:)
    type(key_entry_t), intent(out) :: key

    key%group = column(1)%text
    key%name = column(2)%text
    key%kind = column(3)%text
    key%values = column(4)%text
    key%unit = column(5)%text
    key%default = column(6)%text
    key%allowed = column(7)%text
    key%meaning = column(8)%text
    key%used_with = ''
    if (size(column) > 8) key%used_with = column(9)%text
    key%usual = ''
    if (size(column) > 9) key%usual = column(10)%text
  end subroutine set_key

  !> True: the default is a value that may be written in the deck.
  pure logical function has_literal_default(self)
    class(key_entry_t), intent(in) :: self

    has_literal_default = self%default /= 'required' .and. self%default /= 'none' .and. self%default(1:1) /= '='
  end function has_literal_default

  !> Place of a group in the table, 0 if there is none of that name.
  pure integer function group_index(self, name) result(place)
    class(vocabulary_t), intent(in) :: self
    !> Name in any case
    character(len=*), intent(in) :: name

    do place = size(self%groups), 1, -1
      if (self%groups(place)%name == lower_case(name)) return
    end do
  end function group_index

  !> Place of a key in the table, 0 if the group has none of that name.
  pure integer function key_index(self, group, name) result(place)
    class(vocabulary_t), intent(in) :: self
    !> Names in any case
    character(len=*), intent(in) :: group, name

    do place = size(self%keys), 1, -1
      if (self%keys(place)%group /= lower_case(group)) cycle
      if (lower_case(self%keys(place)%name) == lower_case(name)) return
    end do
  end function key_index

  !> Names of all groups.
  pure function group_names(self) result(names)
    class(vocabulary_t), intent(in) :: self
    !> In the order of the manual
    type(line_t), allocatable :: names(:)
    integer :: i

    allocate (names(0))
    do i = 1, size(self%groups)
      if (self%groups(i)%presence /= 'hidden') call append(names, self%groups(i)%name)
    end do
  end function group_names

  !> Names of a group's keys.
  pure function key_names(self, group) result(names)
    class(vocabulary_t), intent(in) :: self
    character(len=*), intent(in) :: group
    !> In the order of the manual
    type(line_t), allocatable :: names(:)
    integer :: i

    allocate (names(0))
    do i = 1, size(self%keys)
      if (self%keys(i)%group == lower_case(group)) call append(names, self%keys(i)%name)
    end do
  end function key_names

  !> Names of the groups that have a key of this name.
  pure function groups_with(self, key) result(names)
    class(vocabulary_t), intent(in) :: self
    !> Name of the key in any case
    character(len=*), intent(in) :: key
    !> Names of groups
    type(line_t), allocatable :: names(:)
    integer :: i

    allocate (names(0))
    do i = 1, size(self%keys)
      if (lower_case(self%keys(i)%name) == lower_case(key)) call append(names, self%keys(i)%group)
    end do
  end function groups_with
end module deck_vocabulary
