!> Strengths of all interfaces between plies.
module interface_strengths
  use delamination_parameters, only: delamination_t
  use kinds, only: wp
  use material_parameters, only: material_t
  use plies, only: ply_t
  use ply_blocks, only: are_alike
  implicit none
  private
  public :: interlaminar_strengths

contains

  !> Strengths of the interface below each ply: those of its cohesive law, otherwise S12 and YT of the weaker adjacent
  !> ply; none between plies of equal material and angle.
  pure function interlaminar_strengths(plies, number, materials, delaminations) result(strengths)
    type(ply_t), intent(in) :: plies(:)
    !> Their numbers among those of the plate
    integer, intent(in) :: number(:)
    type(material_t), intent(in) :: materials(:)
    !> Interfaces that may delaminate; not allocated: none
    type(delamination_t), allocatable, intent(in) :: delaminations(:)
    !> In shear and opening; 0: not known, or equal plies, (2, plies - 1)
    real(wp) :: strengths(2, size(plies) - 1)
    integer :: i, place

    strengths = 0
    do i = 1, size(strengths, 2)
      if (are_alike(plies(i), plies(i + 1))) cycle
      ! 0: strength not known.
      associate (beside => materials(plies(i:i + 1)%material))
        strengths(:, i) = [minval(beside%s12), minval(beside%yt)]
      end associate
    end do
    if (.not. allocated(delaminations)) return
    do i = 1, size(delaminations)
      associate (interface => delaminations(i))
        ! A deck that is not yet checked may name a ply that does not exist.
        place = findloc(number, interface%below_ply, dim=1)
        if (interface%is_on_front()) place = findloc(number, 1, dim=1) - 1
        if (place < 1 .or. place > size(strengths, 2)) cycle
        if (interface%bonds_doublers()) then
          if (.not. any(interface%beside == number(merge(place, place + 1, interface%is_on_front())))) cycle
        end if
        if (interface%strength_shear > 0) strengths(1, place) = interface%strength_shear
        if (interface%strength_opening > 0) strengths(2, place) = interface%strength_opening
      end associate
    end do
  end function interlaminar_strengths
end module interface_strengths
