!> Warns of a low-pass filter of the contact force whose corner the rows of the history cannot resolve, or whose period
!> is longer than the run.
module deck_force_filters
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use kinds, only: wp
  use output_deck, only: output_group, key_force_filter
  use short_numbers, only: short_text, text_at_most
  implicit none
  private
  public :: check_force_filter

contains

  !> Compares the corner frequency with the Nyquist frequency of the rows. Rows without an interval of time are assumed
  !> to be as far apart as the first ones.
  subroutine check_force_filter(deck, problems)
    !> The deck, filled and checked, its step known
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: apart

    if (problems%errors() > 0 .or. .not. (deck%has_time .and. deck%setup%impactor%is_present)) return
    apart = deck%output%history_every
    if (.not. apart > 0) apart = deck%stepping%time%step*deck%output%steps_between_rows
    if (deck%output%force_filter > 0 .and. deck%output%force_filter*deck%stepping%time%end < 1) then
      call remark(deck%settings, problems, output_group, key_force_filter, 'has a period longer than the run, so '// &
                  'that the filter removes the contact force itself; give at least '// &
                  short_text(1/deck%stepping%time%end)//trim(merge('.                       ', &
                                                                   '; it is probably in kHz.', &
                                                                   deck%case%units == 'mm-kg-ms')))
    end if
    if (2*apart*deck%output%force_filter <= 1) return
    call remark(deck%settings, problems, output_group, key_force_filter, 'is above the Nyquist frequency of the '// &
                'rows, which are '//short_text(apart)//' apart; give at most '//text_at_most(0.5_wp/apart)// &
                ', or rows at shorter intervals.')
  end subroutine check_force_filter
end module deck_force_filters
