!> A deck's setup on finer elements with shorter steps, for the change of its results.
module deck_refinements
  use case_deck, only: case_group, key_refine
  use deck_contents, only: deck_t
  use stepping_parameters, only: is_explicit
  use text, only: append, counted, lower_case, to_text
  implicit none
  private
  public :: refine, refined_text

  !> Suffix of the names of finer results, before the number of refinements.
  character(len=*), parameter, public :: finer_ending = '_finer'

contains

  !> Halves elements and steps `refine` times; under error control the permitted error is divided by eight instead of
  !> halving the step. The results have a name of their own.
  subroutine refine(deck)
    type(deck_t), intent(inout) :: deck
    integer :: parts

    if (deck%case%refine == 0) return
    parts = 2**deck%case%refine
    deck%case%name = deck%case%name//finer_ending//to_text(deck%case%refine)
    deck%setup%mesh%elements = parts*deck%setup%mesh%elements
    deck%setup%mesh%cell = deck%setup%mesh%cell/parts
    associate (time => deck%stepping%time)
      time%step = time%step/parts
      time%step_min = min(time%step_min, time%step)
      time%step_max = time%step_max/parts
    end associate
    deck%stepping%central%step_factor = deck%stepping%central%step_factor/parts
    deck%stepping%central%longest = deck%stepping%central%longest/parts
    deck%stepping%adapt%tolerance = deck%stepping%adapt%tolerance/parts**3
    deck%setup%loading%steps = parts*deck%setup%loading%steps
    call append(deck%reasons, 'Refined '//counted(to_text(deck%case%refine), 'time')//': '// &
                to_text(deck%setup%mesh%elements(1))//' x '//to_text(deck%setup%mesh%elements(2))//' elements'// &
                steps_of(deck)//'.')
  end subroutine refine

  !> Clause on the steps.
  function steps_of(deck) result(clause)
    type(deck_t), intent(in) :: deck
    !> Such as , steps of 2e-6
    character(len=:), allocatable :: clause

    if (is_explicit(deck%stepping)) then
      clause = ', '//to_text(deck%stepping%central%step_factor)//' of the stable step'
    else if (deck%setup%is_static()) then
      clause = ', '//counted(to_text(deck%setup%loading%steps), 'load step')
    else
      clause = ', steps of '//to_text(deck%stepping%time%step)
    end if
  end function steps_of

  !> The text of a deck with one refinement, from one without.
  pure function refined_text(text) result(finer)
    !> Text of the deck
    character(len=*), intent(in) :: text
    !> The same with one key more
    character(len=:), allocatable :: finer
    integer :: place

    place = end_of_case(text)
    if (place > 0) then
      finer = text(:place)//' '//key_refine//'=1'//text(place + 1:)
    else
      finer = text//new_line('a')//'&'//case_group//' '//key_refine//'=1 /'//new_line('a')
    end if
  end function refined_text

  !> Position of the last character of the name of the group &case at its first occurrence outside of texts and
  !> comments; 0: there is none.
  pure integer function end_of_case(text) result(place)
    !> Text of the deck
    character(len=*), intent(in) :: text
    character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz0123456789_'
    character(len=1) :: quote
    integer :: i

    place = 0
    quote = ' '
    i = 0
    do while (i < len(text) - len(case_group))
      i = i + 1
      if (quote /= ' ') then
        if (text(i:i) == quote) quote = ' '
      else if (scan(text(i:i), '''"') == 1) then
        quote = text(i:i)
      else if (text(i:i) == '!') then
        i = i + scan(text(i + 1:)//new_line('a'), new_line('a'))
      else if (lower_case(text(i:i + len(case_group))) == '&'//case_group) then
        place = i + len(case_group)
        if (verify(lower_case(text(place + 1:min(place + 1, len(text)))), letters) /= 0) return
        place = 0
      end if
    end do
  end function end_of_case
end module deck_refinements
