!> Checks of the keys by which matrix strengths depend on the strain rate.
module deck_strain_rates
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, remark, report
  use material_deck, only: key_gain, key_rate, material_group
  implicit none
  private
  public :: check_strain_rates

contains

  !> Checks the keys of all materials of plies with fracture energies, or without.
  subroutine check_strain_rates(deck, softens, problems)
    type(deck_t), intent(in) :: deck
    !> True: plies soften by their fracture energies
    logical, intent(in) :: softens
    type(problems_t), intent(inout) :: problems
    integer :: place

    do place = 1, size(deck%setup%materials)
      associate (s => deck%settings, material => deck%setup%materials(place))
        if (.not. material%rate_gain > 0) cycle
        if (.not. softens) then
          call report(s, problems, material_group, key_gain, 'belongs to plies with fracture energies; give G_ft, '// &
                      'G_fc, G_mt and G_mc of every material, or leave it out.', place)
        else if (.not. material%reference_rate > 0) then
          if (are_clear(s, problems, material_group, key_rate, place)) &
            call report(s, problems, material_group, key_gain, 'needs '//key_rate//', the strain rate of the tests '// &
                        'that YT, YC and S12 are from; give it.', place)
        else if (problems%errors() == 0 .and. .not. deck%setup%counts_rates()) then
          call remark(s, problems, material_group, key_gain, 'has no effect in this run: the strain rates are '// &
                      'those of the test under an impactor with a mass or a pressure in time only.', place)
        end if
      end associate
    end do
  end subroutine check_strain_rates
end module deck_strain_rates
