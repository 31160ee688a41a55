!> Time or load of an event in words.
module run_moments
  use deck_contents, only: deck_t
  use kinds, only: wp
  use text, only: rounded_text
  use usual_units, only: in_usual_unit, time_kind
  implicit none
  private
  public :: moment

contains

  !> Time with its unit; without a known system of units, and in load steps, with its name; or the fraction of a static
  !> analysis with a variable load factor.
  pure function moment(deck, time) result(words)
    type(deck_t), intent(in) :: deck
    !> Time at the end of a step; in a static analysis the progress from 0 to 1
    real(wp), intent(in) :: time
    !> Such as 1.878 ms, time 0.001878, load factor 0.5, or 0.5 of the run
    character(len=:), allocatable :: words

    words = deck%setup%progress_name()//' '//rounded_text(time)
    if (deck%case%units /= '' .and. .not. deck%setup%is_static()) &
      words = in_usual_unit(time, time_kind, deck%case%units)
    if (deck%setup%is_static() .and. deck%setup%loading%dissipation > 0) words = rounded_text(time)//' of the run'
  end function moment
end module run_moments
