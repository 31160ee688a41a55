!> Strain gauges of the deck: rows of its table, filling and checks.
module gauge_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use gauges, only: face_back, face_front, gauge_t
  use kinds, only: wp
  use text, only: to_text
  implicit none
  private
  public :: fill_gauges, check_gauges

  !> Names that checks across groups use.
  character(len=*), parameter, public :: gauge_group = 'gauge', key_gauge_at = 'at'
  character(len=*), parameter :: group = gauge_group
  character(len=group_row_length), parameter, public :: gauge_group_row = &
    'gauge | several | A strain gauge on a surface of the plate, written as a column of the history.'
  character(len=key_row_length), parameter, public :: gauge_rows(*) = [character(len=key_row_length) :: &
    'gauge | at | real | 2 | length | required | any | &
      &Point from the plate''s centre, x and y.', &
    'gauge | face | choice | 1 | - | ''front'' | front back | &
      &Surface of the gauge: the struck one (front) or the opposite one (back).', &
    'gauge | angle | real | 1 | degree | 0 | >= -360, <= 360 | &
      &Direction of the strain from x.']

contains

  !> All gauges, in the order of the deck.
  subroutine fill_gauges(settings, all)
    type(settings_t), intent(in) :: settings
    type(gauge_t), allocatable, intent(out) :: all(:)
    integer :: place

    allocate (all(settings%groups_named(group)))
    do place = 1, size(all)
      if (settings%is_known(group, 'at', place)) all(place)%at = settings%reals_of(group, 'at', place)
      all(place)%face = code_of(settings%text_of(group, 'face', place), 'front back', [face_front, face_back])
      all(place)%angle = settings%real_of(group, 'angle', place)
    end do
  end subroutine fill_gauges

  !> Checks that gauges lie on the plate.
  subroutine check_gauges(settings, length, all, problems)
    type(settings_t), intent(in) :: settings
    real(wp), intent(in) :: length(2)
    type(gauge_t), intent(in) :: all(:)
    type(problems_t), intent(inout) :: problems
    integer :: place

    do place = 1, size(all)
      if (.not. are_clear(settings, problems, group, 'at', place)) cycle
      if (any(abs(all(place)%at) > length/2)) &
        call report(settings, problems, group, 'at', 'the gauge lies off the plate; allowed: up to '// &
                  to_text(length(1)/2)//', '//to_text(length(2)/2)//' in both directions from its centre.', place)
    end do
  end subroutine check_gauges
end module gauge_deck
