!> Lines required in the mesh, by rigs or by decks of later runs.
module deck_mesh_lines
  use cell_grids, only: cell_edges
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report
  use kinds, only: wp
  use mesh_deck, only: key_lines, mesh_group
  use rigs, only: window_lines
  use roundings, only: rounding
  use support_deck, only: key_window, support_group
  implicit none
  private
  public :: check_window_lines, lacks_window_lines

contains

  !> Reports windows and requested lines without a line in the mesh, because all are used by the patch or by other
  !> windows.
  subroutine check_window_lines(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: direction

    if (lacks_window_lines(deck)) then
      call report(deck%settings, problems, support_group, key_window, 'no line of the mesh can be moved to an edge '// &
                'of the window; give more elements, or keep the patch off the edge.')
      return
    end if
    do direction = 1, 2
      if (.not. deck%settings%is_given(mesh_group, key_lines(direction))) cycle
      if (misses(deck, deck%settings%reals_of(mesh_group, key_lines(direction)), direction)) &
        call report(deck%settings, problems, mesh_group, key_lines(direction), 'no line of the mesh can be moved '// &
                  'there; allowed: on the plate, off the patch, with more elements between lines.')
    end do
  end subroutine check_window_lines

  !> True if the edge of a rectangular window is no line of the mesh, which then has no nodes on it.
  pure logical function lacks_window_lines(deck) result(lacks)
    !> The deck
    type(deck_t), intent(in) :: deck

    lacks = misses(deck, window_lines(deck%supports, 1), 1) .or. misses(deck, window_lines(deck%supports, 2), 2)
  end function lacks_window_lines

  !> True if the mesh has no line at a coordinate.
  pure logical function misses(deck, lines, direction)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The coordinates
    real(wp), intent(in) :: lines(:)
    !> 1 for x, 2 for y
    integer, intent(in) :: direction
    integer :: line

    misses = .false.
    associate (edges => cell_edges(deck%plate, deck%mesh, direction))
      do line = 1, size(lines)
        misses = misses .or. lines(line) > edges(1) .and. &
                 minval(abs(edges - lines(line))) > rounding*deck%plate%length(direction)
      end do
    end associate
  end function misses
end module deck_mesh_lines
