!> Initial zones of adaptive layers: the loaded patch or the starter, and some cells around it.
module deck_first_zones
  use cell_grids, only: cells_from_struck
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use delamination_deck, only: key_strip, key_zone
  use delamination_parameters, only: law_front
  use interface_places, only: delamination_group
  use kinds, only: wp
  use laminate_parameters, only: shear_energy
  use line_deck, only: line_group, line_key_at => key_at
  use layer_extents, only: cells_at_once, largest_extents, thicknesses_ahead
  use text, only: append
  implicit none
  private
  public :: check_left_out_zones, set_first_zones

contains

  !> Reports missing zones: only zones of a cohesive law are adaptive. A front has no damage ahead of it, a strip
  !> crosses the full width of a zone, and lines act on the initial layers.
  subroutine check_left_out_zones(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    logical :: beside_layers(size(deck%setup%lines))
    integer :: i, place

    ! Lines that displace an edge of the plate in its plane do not act on layers.
    beside_layers = [(deck%setup%initial%is_inherited .and. deck%setup%lines(i)%is_end(deck%setup%plate%length), &
                      i=1, size(deck%setup%lines))]
    do i = 1, size(deck%setup%delaminations)
      place = deck%setup%delaminations(i)%group
      if (deck%settings%is_given(delamination_group, key_zone, place)) cycle
      if (deck%setup%delaminations(i)%bonds_doublers()) cycle
      if (deck%setup%delaminations(i)%law == law_front) then
        call require('a front requires a zone; zones are adaptive with law = ''cohesive'' only')
      else if (deck%settings%is_given(delamination_group, key_strip, place)) then
        call require(key_strip//' runs across the full width of the zone')
      else if (.not. all(beside_layers) .and. .not. problems%concern(line_group, line_key_at)) then
        call require('a &line acts on layers that exist from the start')
      end if
    end do

  contains

    !> Reports a zone that is missing.
    subroutine require(reason)
      !> Reason why it is required
      character(len=*), intent(in) :: reason

      if (are_clear(deck%settings, problems, delamination_group, key_zone, place)) &
        call report(deck%settings, problems, delamination_group, key_zone, 'is missing; '//reason//'.', place)
    end subroutine require
  end subroutine check_left_out_zones

  !> Sets the initial extents of adaptive zones.
  subroutine set_first_zones(deck, problems)
    !> The deck, filled; its interfaces receive the zones
    type(deck_t), intent(inout) :: deck
    !> Errors so far; if there are any, nothing is done
    type(problems_t), intent(in) :: problems
    type(cell_line_t) :: line
    real(wp) :: least, thickness
    integer :: i, direction

    if (problems%errors() > 0) return
    if (deck%setup%laminate%shear_correction == shear_energy) call set_permanent_zones(deck)
    thickness = thicknesses_ahead*sum(deck%setup%laminate%thickness)
    do direction = 1, 2
      line = cells_from_struck(deck%setup%plate, deck%setup%mesh, direction)
      least = deck%setup%mesh%patch
      do i = 1, size(deck%setup%delaminations)
        associate (d => deck%setup%delaminations(i))
          if (d%is_adaptive) least = max(least, d%starter + 2*abs(d%starter_at(direction)))
        end associate
      end do
      do i = 1, size(deck%setup%delaminations)
        if (deck%setup%delaminations(i)%is_adaptive) &
          deck%setup%delaminations(i)%zone(direction) = line%widened(least, cells_at_once, thickness)
      end do
    end do
  end subroutine set_first_zones

  !> Sets adaptive zones to their largest extents. With the energy-consistent shear stiffness the plate is more
  !> compliant than its layers, a sandwich many times, so that the strain energy would be discontinuous when layers are
  !> inserted.
  subroutine set_permanent_zones(deck)
    !> The deck; its interfaces receive the zones
    type(deck_t), intent(inout) :: deck
    integer :: i

    if (.not. any(deck%setup%delaminations%is_adaptive)) return
    do i = 1, size(deck%setup%delaminations)
      associate (d => deck%setup%delaminations(i))
        if (.not. d%is_adaptive) cycle
        d%is_adaptive = .false.
        d%zone = largest_extents(d%zone, deck%setup%mesh%core, deck%setup%mesh%cell, deck%setup%plate%length)
      end associate
    end do
    call append(deck%reasons, 'The plate has layers from the start, '//trim(merge('in the core', 'everywhere ', &
                deck%setup%mesh%cell > 0))// &
                  ', as with shear_correction = ''energy'' its shear stiffness is below that '// 'of its layers.')
  end subroutine set_permanent_zones
end module deck_first_zones
