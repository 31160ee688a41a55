!> Matrix strengths by the strain rate: checks of their keys, and the rate that an impact is expected to have.
module deck_strain_rates
  use deck_contents, only: deck_t
  use deck_fibre_strengths, only: belongs_to_softening
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, remark, report
  use kinds, only: wp
  use material_deck, only: key_gain, key_rate, material_group
  use mathematical_constants, only: pi
  use setup_scales, only: bending_section, free_span
  use stacking, only: section_t
  implicit none
  private
  public :: check_strain_rates, expected_rate

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
          call report(s, problems, material_group, key_gain, belongs_to_softening, place)
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

  !> Strain rate (M32) of the outer plies under the contact up to the largest force, by the elastic impact of the check;
  !> 0: no impact, or strengths do not depend on it. The strain follows a half sine from the impactor's velocity to its
  !> travel. Its amplitude is that of a plate under a force on a circle of the area of the contact (S. Timoshenko, S.
  !> Woinowsky-Krieger, Theory of Plates and Shells, 1959, section 35, the same curvature in all directions). Strengths
  !> depend on the logarithm of the rate: a factor of two changes them by less than a third of the gain per decade.
  pure real(wp) function expected_rate(deck) result(rate)
    type(deck_t), intent(in) :: deck
    type(section_t) :: section
    real(wp) :: bending, radius, strain

    rate = 0
    if (.not. (deck%setup%counts_rates() .and. deck%expected%of_impact .and. deck%expected%contact_side > 0)) return
    section = bending_section(deck%setup)
    bending = (section%stiffness(13) + section%stiffness(16))/2
    associate (o => deck%expected, nu => section%stiffness(14)/bending)
      radius = o%contact_side/sqrt(pi)
      strain = o%scales%thickness/2*o%force/(4*pi*bending) &
             *(log(max(1.0_wp, 2*minval(free_span(deck%setup))/(pi*radius))) + 1/(1 + nu))
      rate = strain*deck%setup%impactor%velocity/(2*(o%deflection + o%indentation))
    end associate
  end function expected_rate
end module deck_strain_rates
