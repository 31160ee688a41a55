!> Remarks on the transverse shear of unlike plies.
module deck_shear_remarks
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delamination_deck, only: key_zone
  use interface_places, only: delamination_group
  use kinds, only: wp
  use laminate_deck, only: laminate_group, key_correction
  use laminate_parameters, only: shear_five_sixths
  use plies, only: ply_t
  use shear_corrections, only: natural_correction, shear_contrast, shear_excess
  use short_numbers, only: short_text
  use stacking, only: stacked_plies
  implicit none
  private
  public :: check_correction

  !> Relative round-off of lengths: below the digits of a deck.
  real(wp), parameter :: rounding = 1.0e-6_wp

contains

  !> Warns of a transverse shear stiffness that does not suit the plies: the factor 5/6 far from equilibrium, and layers
  !> of such plies that end within the plate.
  subroutine check_correction(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(ply_t), allocatable :: plies(:)
    integer :: i

    if (problems%errors() > 0) return
    plies = stacked_plies(deck%setup%laminate, deck%setup%materials)
    if (natural_correction(plies) == shear_five_sixths) return
    if (deck%setup%laminate%shear_correction == shear_five_sixths) then
      call remark(deck%settings, problems, laminate_group, key_correction, 'the transverse shear stiffness is '// &
                  short_text(shear_excess(plies))//' times that of equilibrium through the thickness, as shear '// &
                  'moduli of the plies differ by a factor of '//short_text(shear_contrast(plies))// &
                  '; write ''energy'', or leave the key out.')
    end if
    do i = 1, size(deck%setup%delaminations)
      if (deck%setup%delaminations(i)%bonds_doublers()) cycle
      if (all(deck%setup%delaminations(i)%zone >= (1 - rounding)*deck%setup%plate%length)) cycle
      call remark(deck%settings, problems, delamination_group, key_zone, &
                  'at the border of the zone all layers have '// &
                  'one rotation, though the shear strains of the plies differ: the plate is up to a few per cent '// &
                  'too stiff; give a zone as large as the plate.', deck%setup%delaminations(i)%group)
      exit
    end do
  end subroutine check_correction
end module deck_shear_remarks
