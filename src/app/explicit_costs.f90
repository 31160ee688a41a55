!> What a run by central differences costs, for `implam check`: its steps and the time that one processor takes.
module explicit_costs
  use deck_contents, only: deck_t
  use kinds, only: wp
  use model_sizes, only: model_size_t
  use step_intervals, only: seconds_per_element
  use stepping_parameters, only: is_explicit
  use text, only: line_t, append, rounded_text, to_text
  implicit none
  private
  public :: cost_lines

contains

  !> One sentence; none for a deck whose steps are implicit, whose costs go by how they converge.
  function cost_lines(deck, model_size) result(lines)
    !> The deck, checked
    type(deck_t), intent(in) :: deck
    !> Size of its model
    type(model_size_t), intent(in) :: model_size
    !> The sentence
    type(line_t), allocatable :: lines(:)
    real(wp) :: steps
    character(len=:), allocatable :: bound

    allocate (lines(0))
    if (.not. is_explicit(deck%stepping) .or. deck%has_static .or. .not. deck%stepping%time%step > 0) return
    steps = deck%stepping%time%end/deck%stepping%time%step
    bound = ''
    if (any(deck%delaminations%follows)) bound = 'at most '
    call append(lines, 'About '//rounded_text(steps)//' steps of '//rounded_text(deck%stepping%time%step)//' for '// &
                bound//rounded_text(model_size%elements)//' elements of all layers: '// &
                spoken(seconds_per_element*steps*model_size%elements)//' of one processor.')
  end function cost_lines

  !> A time as people say it.
  pure function spoken(seconds) result(words)
    !> The time in seconds
    real(wp), intent(in) :: seconds
    !> In seconds, minutes or hours
    character(len=:), allocatable :: words

    if (seconds < 100) then
      words = rounded_text(max(1.0_wp, seconds))//' s'
    else if (seconds < 6000) then
      words = to_text(nint(seconds/60))//' min'
    else
      words = to_text(nint(min(seconds/3600, 1.0e9_wp)))//' h'
    end if
  end function spoken
end module explicit_costs
