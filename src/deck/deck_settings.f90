!> Every key in effect, from the deck or by default: the source of the parameters and of the echo.
module deck_settings
  use deck_entries, only: value_t
  use deck_values, only: real_value, integer_value, logical_value
  use kinds, only: wp
  use text, only: line_t, append, lower_case, to_text
  implicit none
  private
  public :: settings_t, setting_t, present_group_t

  !> One key in effect.
  type :: setting_t
    !> Names of the group and of the key as the manual writes it
    character(len=:), allocatable :: group, key
    !> Index among the groups of this name, from 1
    integer :: place = 1
    !> Line of the key, or of its group if it is not given
    integer :: line = 0
    !> True: from the deck
    logical :: given = .false.
    !> True: the values can be used
    logical :: valid = .true.
    !> True: chosen for the accuracy of the deck
    logical :: chosen = .false.
    !> Table from which the value is taken, as the deck refers to it; unallocated: none
    character(len=:), allocatable :: origin
    !> True: without effect on this deck, so that the echo omits it
    logical :: idle = .false.
    !> The values; none if the key has no default
    type(value_t), allocatable :: values(:)
  end type setting_t

  !> One group of the deck.
  type :: present_group_t
    !> Name
    character(len=:), allocatable :: name
    !> Its line
    integer :: line = 0
  end type present_group_t

  !> All keys in effect. Names are given in any case; `place` is 1 where it is left out.
  type :: settings_t
    !> The groups that the deck has
    type(present_group_t), allocatable :: groups(:)
    !> The keys in the order of the manual
    type(setting_t), allocatable :: items(:)
  contains
    procedure :: groups_named
    procedure :: has_group
    procedure :: line_of_group
    procedure :: find
    procedure :: is_given
    procedure :: is_known
    procedure :: line_of
    procedure :: take_values
    procedure :: text_of
    procedure :: texts_of
    procedure :: real_of
    procedure :: reals_of
    procedure :: integers_of
    procedure :: integer_of
    procedure :: logical_of
    procedure :: adopt
    procedure :: derive
    procedure :: derive_numbers
    procedure :: choose
    procedure :: set_aside
  end type settings_t

contains

  !> Number of groups of this name in the deck.
  pure integer function groups_named(self, group) result(number)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group
    integer :: i

    number = count([(self%groups(i)%name == lower_case(group), i=1, size(self%groups))])
  end function groups_named

  !> True: the deck has the group.
  pure logical function has_group(self, group)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group

    has_group = self%groups_named(group) > 0
  end function has_group

  !> Line of a group, 0 if the deck does not have it.
  pure integer function line_of_group(self, group, place) result(line)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group
    integer, intent(in), optional :: place
    integer :: i, left

    left = 1
    if (present(place)) left = place
    line = 0
    do i = 1, size(self%groups)
      if (self%groups(i)%name /= lower_case(group)) cycle
      left = left - 1
      if (left == 0) line = self%groups(i)%line
    end do
  end function line_of_group

  !> Index of a key in the list; 0: the key is not in it.
  pure integer function find(self, group, key, place) result(index)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer :: wanted

    wanted = 1
    if (present(place)) wanted = place
    do index = size(self%items), 1, -1
      if (self%items(index)%place /= wanted) cycle
      if (self%items(index)%group /= lower_case(group)) cycle
      if (lower_case(self%items(index)%key) == lower_case(key)) return
    end do
  end function find

  !> True: the deck gives the key.
  pure logical function is_given(self, group, key, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer :: i

    i = self%find(group, key, place)
    is_given = .false.
    if (i > 0) is_given = self%items(i)%given
  end function is_given

  !> True: the key has values, given or by default, that can be used.
  pure logical function is_known(self, group, key, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer :: i

    i = self%find(group, key, place)
    is_known = .false.
    if (i > 0) is_known = self%items(i)%valid .and. size(self%items(i)%values) > 0
  end function is_known

  !> Line to be named when a key has an error: its own, or that of its group.
  pure integer function line_of(self, group, key, place) result(line)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer :: i

    i = self%find(group, key, place)
    line = 0
    if (i > 0) line = self%items(i)%line
  end function line_of

  !> Takes the values of a key; none if no values can be used. Not a function, because gfortran 12 leaks the memory of
  !> texts in a list that a function returns.
  pure subroutine take_values(self, group, key, values, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    type(value_t), allocatable, intent(out) :: values(:)
    integer, intent(in), optional :: place
    integer :: i

    i = self%find(group, key, place)
    if (i > 0) then
      if (self%items(i)%valid) values = self%items(i)%values
    end if
    if (.not. allocated(values)) allocate (values(0))
  end subroutine take_values

  !> Text of a key with one value; empty if there is none.
  pure function text_of(self, group, key, place) result(word)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    character(len=:), allocatable :: word
    type(value_t), allocatable :: values(:)

    call self%take_values(group, key, values, place)
    word = ''
    if (size(values) > 0) word = values(1)%text
  end function text_of

  !> Texts of a key.
  pure function texts_of(self, group, key, place) result(words)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    type(line_t), allocatable :: words(:)
    type(value_t), allocatable :: values(:)
    integer :: i

    call self%take_values(group, key, values, place)
    allocate (words(0))
    do i = 1, size(values)
      call append(words, values(i)%text)
    end do
  end function texts_of

  !> Number of a key with one value; 0 if there is none.
  pure real(wp) function real_of(self, group, key, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    type(value_t), allocatable :: values(:)

    call self%take_values(group, key, values, place)
    real_of = 0
    if (size(values) > 0) real_of = real_value(values(1))
  end function real_of

  !> Numbers of a key.
  pure function reals_of(self, group, key, place) result(numbers)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    real(wp), allocatable :: numbers(:)
    type(value_t), allocatable :: values(:)
    integer :: i

    call self%take_values(group, key, values, place)
    numbers = [(real_value(values(i)), i=1, size(values))]
  end function reals_of

  !> Whole numbers of a key.
  pure function integers_of(self, group, key, place) result(numbers)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer, allocatable :: numbers(:)
    type(value_t), allocatable :: values(:)
    integer :: i

    call self%take_values(group, key, values, place)
    numbers = [(integer_value(values(i)), i=1, size(values))]
  end function integers_of

  !> Whole number of a key with one value; 0 if there is none.
  pure integer function integer_of(self, group, key, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    integer, allocatable :: numbers(:)

    numbers = self%integers_of(group, key, place)
    integer_of = 0
    if (size(numbers) > 0) integer_of = numbers(1)
  end function integer_of

  !> Truth value of a key; false if there is none.
  pure logical function logical_of(self, group, key, place)
    class(settings_t), intent(in) :: self
    character(len=*), intent(in) :: group, key
    integer, intent(in), optional :: place
    type(value_t), allocatable :: values(:)

    call self%take_values(group, key, values, place)
    logical_of = .false.
    if (size(values) > 0) logical_of = logical_value(values(1))
  end function logical_of

  !> Sets a key that the deck does not give to the value of a table to which the deck refers. The key then counts as
  !> given.
  pure subroutine adopt(self, group, key, word, origin, place)
    class(settings_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    !> The value as written in a deck
    character(len=*), intent(in) :: word
    !> Name of the table, for the echo
    character(len=*), intent(in) :: origin
    integer, intent(in), optional :: place
    integer :: i

    i = self%find(group, key, place)
    if (i == 0) return
    if (self%items(i)%given) return
    call self%derive(group, key, word, .false., place)
    self%items(i)%given = .true.
    self%items(i)%origin = origin
  end subroutine adopt

  !> Sets the value of a key that the deck does not give and that follows from other keys.
  pure subroutine derive(self, group, key, word, quoted, place)
    class(settings_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    !> The value as written in a deck, without quotes
    character(len=*), intent(in) :: word
    !> True: it is a text
    logical, intent(in) :: quoted
    integer, intent(in), optional :: place
    type(value_t), allocatable :: values(:)
    integer :: i

    i = self%find(group, key, place)
    if (i == 0) return
    allocate (values(1))
    values(1)%text = word
    values(1)%quoted = quoted
    call move_alloc(values, self%items(i)%values)
  end subroutine derive

  !> Sets the numbers of a key that the deck does not give and that follow from other keys.
  pure subroutine derive_numbers(self, group, key, numbers)
    class(settings_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    !> The numbers
    real(wp), intent(in) :: numbers(:)
    type(value_t), allocatable :: values(:)
    integer :: i, item

    item = self%find(group, key)
    if (item == 0) return
    allocate (values(size(numbers)))
    do i = 1, size(numbers)
      values(i)%text = to_text(numbers(i))
    end do
    call move_alloc(values, self%items(item)%values)
  end subroutine derive_numbers

  !> Sets the values of a key that are chosen for the accuracy.
  pure subroutine choose(self, group, key, words, quoted)
    class(settings_t), intent(inout) :: self
    character(len=*), intent(in) :: group, key
    !> The values as written in a deck, without quotes
    type(line_t), intent(in) :: words(:)
    !> True: they are texts
    logical, intent(in), optional :: quoted
    type(value_t), allocatable :: values(:)
    integer :: i, place

    place = self%find(group, key)
    if (place == 0) return
    allocate (values(size(words)))
    do i = 1, size(words)
      values(i)%text = words(i)%text
      values(i)%quoted = .false.
      if (present(quoted)) values(i)%quoted = quoted
    end do
    call move_alloc(values, self%items(place)%values)
    self%items(place)%chosen = .true.
  end subroutine choose

  !> Omits a group that the deck does not have from the echo.
  pure subroutine set_aside(self, group)
    class(settings_t), intent(inout) :: self
    character(len=*), intent(in) :: group
    integer :: i

    if (self%has_group(group)) return
    do i = 1, size(self%items)
      if (self%items(i)%group == lower_case(group)) self%items(i)%idle = .true.
    end do
  end subroutine set_aside
end module deck_settings
