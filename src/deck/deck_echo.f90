!> Lists every key in effect and whether it is from the deck, by default or chosen, for the log.
module deck_echo
  use deck_entries, only: written_values
  use deck_settings, only: settings_t
  use deck_vocabulary, only: vocabulary_t
  use text, only: line_t, append, to_text
  implicit none
  private
  public :: echo, adopted_values

contains

  !> Lines such as `&plate edges = 'clamped' [deck]`.
  subroutine echo(vocabulary, settings, lines)
    type(vocabulary_t), intent(in) :: vocabulary
    !> Keys in effect of a deck without errors
    type(settings_t), intent(in) :: settings
    !> One line per key
    type(line_t), allocatable, intent(out) :: lines(:)
    character(len=:), allocatable :: words, origin
    integer :: i

    allocate (lines(0))
    do i = 1, size(settings%items)
      associate (item => settings%items(i))
        words = written_values(item%values)
        if (size(item%values) == 0) then
          ! The meaning of its absence.
          words = vocabulary%keys(vocabulary%key_index(item%group, item%key))%default
          if (words == 'none') words = ''
          if (index(words, '=') == 1) words = words(3:)
        end if
        if (words == '' .or. item%idle) cycle
        origin = ' [default]'
        if (item%chosen) origin = ' [accuracy]'
        if (item%given) origin = ' [deck]'
        if (allocated(item%origin)) origin = ' ['//item%origin//']'
        call append(lines, '&'//item%group//' '//item%key//' = '//words//origin)
      end associate
    end do
  end subroutine echo

  !> Values from the table of published materials, one per line; empty: none.
  pure function adopted_values(settings) result(words)
    type(settings_t), intent(in) :: settings
    !> Lines such as `&material 1 E1 = 130e9 [library t700_m21, source a]`
    character(len=:), allocatable :: words
    integer :: i

    words = ''
    do i = 1, size(settings%items)
      associate (item => settings%items(i))
        if (.not. allocated(item%origin)) cycle
        if (words /= '') words = words//new_line('a')
        words = words//'&'//item%group//' '//to_text(item%place)//' '//item%key//' = '//written_values(item%values)// &
                ' ['//item%origin//']'
      end associate
    end do
  end function adopted_values
end module deck_echo
