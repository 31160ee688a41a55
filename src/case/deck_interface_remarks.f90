!> Remarks on interfaces that may be unintended: plies of one angle on both sides, and a zone beyond the fine core of
!> the mesh.
module deck_interface_remarks
  use cell_grids, only: cells_from_struck
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delamination_deck, only: key_zone
  use interface_places, only: delamination_group, key_below_ply
  use kinds, only: wp
  use material_parameters, only: first_alike
  use short_numbers, only: short_text
  use text, only: to_text
  implicit none
  private
  public :: check_interfaces

  !> Difference of angles in degrees below which they are equal: decks have at most three decimals, and round-off is
  !> about 1e-13.
  real(wp), parameter :: same = 1.0e-6_wp

contains

  !> Adds the remarks.
  subroutine check_interfaces(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    logical :: beyond(size(deck%setup%delaminations))
    integer :: i

    if (problems%errors() > 0) return
    do i = 1, size(deck%setup%delaminations)
      associate (d => deck%setup%delaminations(i), groups => deck%setup%delaminations%group)
        ! Messages that differ only in the ply are merged.
        if (.not. d%bonds_doublers() .and. lies_within_a_block(deck, d%below_ply)) &
          call remark(deck%settings, problems, delamination_group, key_below_ply, 'the plies on both sides of the '// &
                      'interface below ply '//to_text(d%below_ply)//' are of one material and angle, and act as '// &
                      'one thick ply; impacts delaminate plies of different angles.', d%group)
        beyond(i) = deck%setup%mesh%cell > 0 .and. .not. d%is_adaptive .and. &
                    any(d%zone/2 >= deck%setup%mesh%core/2 + deck%setup%mesh%cell)
        ! All interfaces of a group have one zone.
        if (beyond(i) .and. .not. any(beyond(:i - 1) .and. groups(:i - 1) == d%group)) &
          call remark(deck%settings, problems, delamination_group, key_zone, 'reaches beyond the core of the mesh, '// &
                      'where cells are up to '//short_text(longest_cell(deck, d%zone))// &
                      ' long; make the core as large as the zone.', d%group)
      end associate
    end do
  end subroutine check_interfaces

  !> True if an interface lies between plies of one orthotropic material and angle, in a laminate that also has other
  !> interfaces.
  pure logical function lies_within_a_block(deck, ply) result(within)
    type(deck_t), intent(in) :: deck
    !> Ply above the interface
    integer, intent(in) :: ply

    associate (laminate => deck%setup%laminate)
      within = first_alike(deck%setup%materials, laminate%material(ply)) == &
               first_alike(deck%setup%materials, laminate%material(ply + 1))
      if (within) within = is_parallel(laminate%angle(ply) - laminate%angle(ply + 1)) .and. &
                           abs(deck%setup%materials(laminate%material(ply))%e1 - &
                               deck%setup%materials(laminate%material(ply))%e2) > 0 .and. &
                           .not. all(is_parallel(laminate%angle - laminate%angle(ply)))
    end associate
  end function lies_within_a_block

  !> True for a difference of two angles whose fibres are parallel.
  elemental logical function is_parallel(difference)
    !> The difference in degrees
    real(wp), intent(in) :: difference

    is_parallel = abs(difference - 180*anint(difference/180)) < same
  end function is_parallel

  !> Longest side of the cells of a zone.
  pure real(wp) function longest_cell(deck, zone) result(longest)
    type(deck_t), intent(in) :: deck
    !> Full extents of the zone
    real(wp), intent(in) :: zone(2)
    type(cell_line_t) :: line
    integer :: direction

    longest = 0
    do direction = 1, 2
      line = cells_from_struck(deck%setup%plate, deck%setup%mesh, direction)
      longest = max(longest, line%longest_within(zone(direction)))
    end do
  end function longest_cell
end module deck_interface_remarks
