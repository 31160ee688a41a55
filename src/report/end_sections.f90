!> Axial stiffness of the plate's section at the ends that lines displace: laminate, doublers and ply drops, stringers.
module end_sections
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use packed_matrices, only: inverse, unpacked
  use roundings, only: rounding
  use setups, only: setup_t
  use stacking, only: section_of, section_t, stacked_plies
  use stiffened_sections, only: edges_across
  implicit none
  private
  public :: skin_share

contains

  !> Share of the laminate in the axial stiffness of the section, the mean of both ends: strains are those of plane
  !> sections, lateral forces are zero. With E1c the moduli are those of tension.
  pure real(wp) function skin_share(setup, along) result(share)
    type(setup_t), intent(in) :: setup
    !> Direction of the load, 1 for x, 2 for y
    integer, intent(in) :: along
    real(wp) :: skin, total
    integer :: i

    associate (length => setup%plate%length)
      skin = length(3 - along)*modulus_of(setup, setup%laminate, along)
      total = (end_stiffness(setup, along, -1) + end_stiffness(setup, along, 1))/2
      if (allocated(setup%stringers)) then
        do i = 1, size(setup%stringers)
          associate (s => setup%stringers(i))
            if (s%along == along) total = total + s%section%axial* &
              count(abs(s%ends) >= length(along)/2*(1 - rounding))/2.0_wp
          end associate
        end do
      end if
    end associate
    share = skin/total
  end function skin_share

  !> Axial stiffness of the plies at one end.
  pure real(wp) function end_stiffness(setup, along, side) result(stiffness)
    type(setup_t), intent(in) :: setup
    !> Direction of the load, and -1 or 1 for the end
    integer, intent(in) :: along, side
    real(wp), allocatable :: lines(:)
    real(wp) :: point(2)
    integer :: i

    stiffness = 0
    lines = edges_across(setup%zones, setup%plate%length(3 - along), 3 - along)
    ! A point within the plate belongs to the zones that end at its edge.
    point(along) = side*setup%plate%length(along)/2*(1 - rounding)
    do i = 1, size(lines) - 1
      point(3 - along) = (lines(i) + lines(i + 1))/2
      stiffness = stiffness + (lines(i + 1) - lines(i))* &
                  modulus_of(setup, setup%zones%laminate_of(setup%laminate, setup%zones%at(point)), along)
    end do
  end function end_stiffness

  !> Axial stiffness per width of a laminate without lateral force, the inverse of the first or fourth compliance.
  pure real(wp) function modulus_of(setup, laminate, along) result(modulus)
    type(setup_t), intent(in) :: setup
    type(laminate_t), intent(in) :: laminate
    integer, intent(in) :: along
    type(section_t) :: section
    real(wp) :: compliance(3, 3)

    section = section_of(stacked_plies(laminate, setup%materials), laminate%shear_correction)
    compliance = inverse(unpacked(section%stiffness(1:6)))
    modulus = 1/compliance(along, along)
  end function modulus_of
end module end_sections
