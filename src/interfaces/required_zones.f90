!> Required extents of adaptive layers: some cells ahead of damage, all cells adjacent to these with an onset index of
!> at least a half, and any cell with an index of 1.
module required_zones
  use cell_lines, only: cell_line_t
  use interface_fields, only: delaminated_above
  use interface_states, only: interface_state_t
  use joined_stacks, only: joined_stacks_of
  use kinds, only: wp
  use layer_extents, only: cells_ahead, cells_at_once, onset_of_layers, thicknesses_ahead
  use composite_plates, only: composite_plate_t
  use onset_index, only: onset_of_joined_cells
  use roundings, only: rounding
  implicit none
  private
  public :: required_extents

contains

  !> Required extents of the zones. All adaptive zones have the same extents, since intact layers beside a damaged
  !> interface are more compliant than one layer. Extents that grow get additional cells. Collective; the same on every
  !> rank.
  function required_extents(plate, stiffness, interfaces, displacement) result(extents)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(interface_state_t), intent(in) :: interfaces
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Full extents along x and y, (2, zones)
    real(wp) :: extents(2, size(plate%mesh%zones))
    real(wp) :: needed(2, size(extents, 2))
    integer :: zone

    do zone = 1, size(extents, 2)
      extents(:, zone) = plate%setup%delaminations(zone)%zone
    end do
    associate (is_adaptive => spread(plate%setup%delaminations%is_adaptive, 1, 2))
      if (.not. any(is_adaptive)) return
      needed = max(around_onset(plate, stiffness, interfaces, displacement), &
                   with_margin(plate, around_damage(plate, interfaces), cells_ahead, &
                               thicknesses_ahead*plate%layup%thickness))
      needed = spread(maxval(merge(needed, 0.0_wp, is_adaptive), 2), 2, size(needed, 2))
      if (.not. any(is_adaptive .and. needed > extents*(1 + rounding))) return
      where (is_adaptive .and. needed > extents*(1 + rounding)) &
        extents = with_margin(plate, needed, cells_at_once, 0.0_wp)
    end associate
  end function required_extents

  !> Extents over the cells without layers that the onset index requires.
  function around_onset(plate, stiffness, interfaces, displacement) result(extents)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(interface_state_t), intent(in) :: interfaces
    !> Displacement, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Full extents along x and y, (2, zones)
    real(wp) :: extents(2, size(plate%mesh%zones))
    real(wp), allocatable :: onset(:, :)
    integer :: zone

    onset = onset_of_joined_cells(plate, joined_stacks_of(plate, stiffness, delaminated_above(plate, interfaces), &
                                                          displacement))
    do zone = 1, size(extents, 2)
      extents(:, zone) = plate%setup%delaminations(zone)%zone
      call extend(plate, centre_of(plate, zone), onset(:, zone), extents(:, zone))
    end do
  end function around_onset

  !> Extends a rectangle by adjacent cells whose index requires it. Distant cells with an index between a half and 1, as
  !> at a clamped edge, are not included.
  pure subroutine extend(plate, centre, onset, extents)
    type(composite_plate_t), intent(in) :: plate
    !> Centre of the rectangle
    real(wp), intent(in) :: centre(2)
    !> Onset index of the cells without layers, (cells)
    real(wp), intent(in) :: onset(:)
    !> Full extents along x and y
    real(wp), intent(inout) :: extents(2)
    type(cell_line_t) :: columns, rows
    real(wp) :: before(2), near(2)
    integer :: cell, place(2)

    columns = plate%mesh%along(1)%from(centre(1))
    rows = plate%mesh%along(2)%from(centre(2))
    do
      before = extents
      near = [columns%widened(extents(1), 1), rows%widened(extents(2), 1)]*(1 + rounding)
      do cell = 1, size(onset)
        if (onset(cell) < onset_of_layers) cycle
        place = plate%mesh%place_of(cell)
        associate (reach => 2*[maxval(abs(columns%ends(place(1)))), maxval(abs(rows%ends(place(2))))])
          if (onset(cell) >= 1 .or. all(reach <= near)) extents = max(extents, reach)
        end associate
      end do
      if (.not. any(extents > before)) return
    end do
  end subroutine extend

  !> Centre of a layered rectangle.
  pure function centre_of(plate, zone) result(centre)
    type(composite_plate_t), intent(in) :: plate
    !> Its index
    integer, intent(in) :: zone
    real(wp) :: centre(2)

    centre = plate%mesh%struck + plate%setup%delaminations(zone)%zone_at
  end function centre_of

  !> Extents of the damaged points. Collective.
  function around_damage(plate, interfaces) result(extents)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> Full extents along x and y, (2, zones)
    real(wp) :: extents(2, size(plate%mesh%zones))
    real(wp) :: list(size(extents)), damage(size(plate%zone))
    integer :: i

    extents = 0
    damage = interfaces%cohesive%damage(plate)
    do i = 1, plate%distribution%owned
      if (.not. damage(i) > 0) cycle
      associate (place => plate%place_of(i))
        extents(:, plate%zone(i)) = max(extents(:, plate%zone(i)), 2*abs(place - centre_of(plate, plate%zone(i))))
      end associate
    end do
    list = reshape(extents, [size(extents)])
    call plate%communicator%maximum(list)
    extents = reshape(list, shape(extents))
  end function around_damage

  !> Extents with additional cells on each side; zero remains zero.
  pure function with_margin(plate, extents, cells, least) result(wider)
    type(composite_plate_t), intent(in) :: plate
    !> Full extents along x and y, (2, zones)
    real(wp), intent(in) :: extents(:, :)
    !> Cells
    integer, intent(in) :: cells
    !> Smallest length of these cells
    real(wp), intent(in) :: least
    !> (2, zones)
    real(wp) :: wider(2, size(extents, 2))
    type(cell_line_t) :: columns, rows
    real(wp) :: centre(2)
    integer :: zone

    wider = 0
    do zone = 1, size(extents, 2)
      if (.not. any(extents(:, zone) > 0)) cycle
      centre = centre_of(plate, zone)
      columns = plate%mesh%along(1)%from(centre(1))
      rows = plate%mesh%along(2)%from(centre(2))
      wider(:, zone) = [columns%widened(extents(1, zone), cells, least), rows%widened(extents(2, zone), cells, least)]
    end do
  end function with_margin
end module required_zones
