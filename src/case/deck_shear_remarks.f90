!> Remarks on a transverse shear stiffness that does not suit the plies.
module deck_shear_remarks
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delamination_deck, only: key_zone
  use interface_places, only: delamination_group
  use kinds, only: wp
  use laminate_deck, only: laminate_group, key_correction
  use laminate_parameters, only: shear_five_sixths, shear_energy
  use plies, only: ply_t
  use shear_corrections, only: natural_correction, shear_contrast, shear_excess
  use short_numbers, only: short_text
  use stacking, only: stacked_plies, section_stiffness
  implicit none
  private
  public :: check_correction

contains

  !> Warns of a transverse shear stiffness that does not suit the plies: the factor 5/6 far from equilibrium, or layers
  !> that appear in the run and are stiffer than the plate was.
  subroutine check_correction(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    !> Warnings are added
    type(problems_t), intent(inout) :: problems
    type(ply_t), allocatable :: plies(:)
    integer :: place

    if (problems%errors() > 0) return
    plies = stacked_plies(deck%laminate, deck%materials)
    if (natural_correction(plies) == shear_five_sixths) return
    if (deck%laminate%shear_correction == shear_five_sixths) then
      call remark(deck%settings, problems, laminate_group, key_correction, 'the transverse shear stiffness is '// &
                  short_text(shear_excess(plies))//' times that of equilibrium through the thickness, as shear '// &
                  'moduli of the plies differ by a factor of '//short_text(shear_contrast(plies))// &
                  '; write ''energy'', or leave the key out.')
      return
    end if
    do place = 1, size(deck%delaminations)
      if (deck%delaminations(place)%follows) call remark(deck%settings, problems, delamination_group, key_zone, &
        'left out, the plate is parted into layers in the run, whose transverse shear stiffness is '// &
        short_text(parted_excess(plies, deck%delaminations(place)%below_ply))//' times its own; the strain energy '// &
        'jumps there (energy_layers), so give the zone.', deck%delaminations(place)%group)
    end do
  end subroutine check_correction

  !> Transverse shear stiffness along x of two layers together over that of the plate.
  pure real(wp) function parted_excess(plies, below) result(excess)
    !> All plies
    type(ply_t), intent(in) :: plies(:)
    !> Ply above the interface
    integer, intent(in) :: below
    real(wp), dimension(21) :: upper, lower, plate

    upper = section_stiffness(plies(:below), plies(:below)%elasticity, shear_energy)
    lower = section_stiffness(plies(below + 1:), plies(below + 1:)%elasticity, shear_energy)
    plate = section_stiffness(plies, plies%elasticity, shear_energy)
    excess = (upper(19) + lower(19))/plate(19)
  end function parted_excess
end module deck_shear_remarks
