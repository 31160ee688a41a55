!> Lines required in the mesh, by rigs or by decks of later runs: those that nearly coincide are merged, those that the
!> mesh cannot have are reported.
module deck_mesh_lines
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use coincident_lines, only: merged_lines, merging_distance
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark, report
  use kinds, only: wp
  use mesh_deck, only: key_core, key_lines, mesh_group
  use mesh_parameters, only: add_lines
  use ply_zone_parameters, only: ply_zone_t
  use rigs, only: window_lines
  use roundings, only: rounding
  use short_numbers, only: short_text
  use stringer_deck, only: key_ends, key_stringer_at, stringer_group
  use stringers, only: lines_of_stringers, move_line
  use support_deck, only: key_window, support_group
  use support_parameters, only: window_rectangle
  use text, only: to_text
  use zone_deck, only: doubler_group, key_zone_at, key_zone_size, ply_drop_group
  implicit none
  private
  public :: place_mesh_lines, check_window_lines, lacks_window_lines

contains

  !> Collects the lines required in the mesh. Lines that nearly coincide with each other, the patch or the border are
  !> merged: the edges of windows are moved.
  subroutine place_mesh_lines(deck, problems)
    !> The deck, its patch, core and windows known; receives the lines
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: lines(:)
    integer :: direction

    call shorten_core(deck, problems)
    do direction = 1, 2
      call merge_along(deck, direction, lines, problems)
      if (direction == 1) call move_alloc(lines, deck%setup%mesh%x_lines)
      if (direction == 2) call move_alloc(lines, deck%setup%mesh%y_lines)
      call remark_core(deck, direction, problems)
    end do
  end subroutine place_mesh_lines

  !> Warns of a border of the core that is moved to a line.
  subroutine remark_core(deck, direction, problems)
    !> The deck with its lines
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: direction
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: distances(:)
    integer :: side, nearest

    if (.not. deck%setup%mesh%cell > 0) return
    associate (mesh => deck%setup%mesh, lines => lines_along(deck, direction))
      if (size(lines) == 0) return
      do side = 1, -1, -2
        distances = abs(lines - mesh%struck(direction) - side*mesh%core(direction)/2)
        nearest = minloc(distances, dim=1)
        if (distances(nearest) >= mesh%cell/2 .or. distances(nearest) <= rounding*deck%setup%plate%length(direction)) &
          cycle
        call remark(deck%settings, problems, mesh_group, key_core, 'its border is less than half a cell from a '// &
                    'line of the mesh at '//merge('x', 'y', direction == 1)//' = '//to_text(lines(nearest))// &
                    ' and is moved there, to avoid cells of '//short_text(distances(nearest))//' between them.')
        exit
      end do
    end associate
  end subroutine remark_core

  !> A core whose border is less than half a cell from that of the plate ends a cell before it.
  subroutine shorten_core(deck, problems)
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: most
    integer :: direction

    associate (mesh => deck%setup%mesh)
      if (.not. mesh%cell > 0) return
      do direction = 1, 2
        most = deck%setup%plate%length(direction) - 2*abs(mesh%struck(direction))
        if (mesh%core(direction) >= most*(1 - rounding) .or. mesh%core(direction) <= most - mesh%cell) cycle
        if (.not. most > 2*mesh%cell) cycle
        mesh%core(direction) = most - 2*mesh%cell
        call remark(deck%settings, problems, mesh_group, key_core, 'ends less than half a cell before the border '// &
                    'of the plate; along '//merge('x', 'y', direction == 1)//' it is '// &
                    short_text(mesh%core(direction))//', a cell before it.')
      end do
    end associate
  end subroutine shorten_core

  !> Merges the lines required along one direction.
  subroutine merge_along(deck, direction, lines, problems)
    !> The deck; its windows are moved
    type(deck_t), intent(inout) :: deck
    integer, intent(in) :: direction
    real(wp), allocatable, intent(out) :: lines(:)
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: given(:), places(:), stiffened(:)
    integer :: i, windows

    allocate (given(0), lines(0))
    if (deck%settings%is_known(mesh_group, key_lines(direction))) &
      given = abs(deck%settings%reals_of(mesh_group, key_lines(direction)))
    windows = size(deck%setup%supports)
    stiffened = lines_of_stringers(deck%setup%stringers, deck%setup%plate%length(direction), direction)
    associate (mesh => deck%setup%mesh, half => deck%setup%plate%length(direction)/2)
      places = [merge(deck%setup%supports%window(direction)/2, 0.0_wp, deck%setup%supports%shape == window_rectangle), &
                given, abs(stiffened)]
      places = merged_lines(places, [abs(mesh%struck(direction) + [-mesh%patch, 0.0_wp, mesh%patch]/2), half], &
                            merging_distance*2*half)
      do i = 1, windows
        if (deck%setup%supports(i)%shape /= window_rectangle) cycle
        call remark_moved(deck%setup%supports(i)%window(direction)/2, places(i), support_group, key_window, i)
        deck%setup%supports(i)%window(direction) = 2*places(i)
      end do
      do i = 1, size(given)
        call remark_moved(given(i), places(windows + i), mesh_group, key_lines(direction))
      end do
      do i = 1, size(stiffened)
        associate (place => sign(places(windows + size(given) + i), stiffened(i)))
          call remark_moved(abs(stiffened(i)), abs(place), stringer_group, '')
          call move_line(deck%setup%stringers, direction, stiffened(i), place)
          stiffened(i) = place
        end associate
      end do
    end associate
    given = places(windows + 1:windows + size(given))
    call add_lines(lines, stiffened)
    call add_lines(lines, [-given, given])
    call add_lines(lines, window_lines(deck%setup%supports, direction))
    call take_zone_lines(deck, direction, lines, problems)

  contains

    !> Warns of a line that is moved.
    subroutine remark_moved(from, to, group, key, place)
      !> Distances from the centre
      real(wp), intent(in) :: from, to
      !> Group and key that require the line
      character(len=*), intent(in) :: group, key
      integer, intent(in), optional :: place

      if (abs(to - from) <= rounding*from) return
      call remark(deck%settings, problems, group, key, 'the line at '//merge('x', 'y', direction == 1)//' = '// &
                  to_text(from)//' nearly coincides with another one at '//to_text(to)//' and is moved there, to '// &
                  'avoid cells of '//short_text(abs(to - from))//' between them.', place)
    end subroutine remark_moved
  end subroutine merge_along

  !> Adds the edges of doublers and ply drops to the lines required along one direction. An edge that nearly coincides
  !> with another line, the patch or the border is moved there.
  subroutine take_zone_lines(deck, direction, lines, problems)
    !> The deck; its zones are moved
    type(deck_t), intent(inout) :: deck
    integer, intent(in) :: direction
    real(wp), allocatable, intent(inout) :: lines(:)
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (allocated(deck%setup%zones%doublers)) then
      do i = 1, size(deck%setup%zones%doublers)
        call take(deck%setup%zones%doublers(i), doubler_group)
      end do
    end if
    if (allocated(deck%setup%zones%drops)) then
      do i = 1, size(deck%setup%zones%drops)
        call take(deck%setup%zones%drops(i), ply_drop_group)
      end do
    end if

  contains

    !> Adds the edges of one zone.
    subroutine take(zone, group)
      class(ply_zone_t), intent(inout) :: zone
      character(len=*), intent(in) :: group
      real(wp), allocatable :: others(:)
      real(wp) :: edges(2), moved(2)
      integer :: k

      associate (mesh => deck%setup%mesh, half => deck%setup%plate%length(direction)/2)
        edges = zone%edges(direction)
        others = [mesh%struck(direction) + [-mesh%patch, 0.0_wp, mesh%patch]/2, -half, half, lines]
        do k = 1, 2
          moved(k) = others(minloc(abs(others - edges(k)), dim=1))
          if (abs(moved(k) - edges(k)) > merging_distance*2*half) moved(k) = edges(k)
          if (abs(moved(k) - edges(k)) > rounding*half) &
            call remark(deck%settings, problems, group, key_zone_size, 'the edge at '// &
                        merge('x', 'y', direction == 1)//' = '//to_text(edges(k))//' nearly coincides with another '// &
                        'line of the mesh at '//to_text(moved(k))//' and is moved there, to avoid cells of '// &
                        short_text(abs(moved(k) - edges(k)))//' between them.', i)
        end do
      end associate
      zone%at(direction) = sum(moved)/2
      zone%size(direction) = moved(2) - moved(1)
      associate (least => merging_distance*deck%setup%plate%length(direction))
        if (zone%size(direction) < least*(1 - rounding)) &
          call report(deck%settings, problems, group, key_zone_size, 'both edges along '// &
                      merge('x', 'y', direction == 1)//' lie on one line of the mesh, as lines have a distance of '// &
                      'at least '//short_text(least)//'; give a larger size, or other edges if these are moved.', i)
      end associate
      call add_lines(lines, moved)
    end subroutine take
  end subroutine take_zone_lines

  !> Reports windows and requested lines without a line in the mesh, because all are used by the patch or by other
  !> windows.
  subroutine check_window_lines(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: direction

    if (lacks_window_lines(deck)) then
      call report(deck%settings, problems, support_group, key_window, 'no line of the mesh can be moved to an edge '// &
                'of the window; give more elements, or keep the patch off the edge.')
      return
    end if
    call check_stringer_lines(deck, problems)
    do direction = 1, 2
      call check_zone_lines(deck, direction, problems)
      if (.not. deck%settings%is_given(mesh_group, key_lines(direction))) cycle
      if (misses(deck, lines_along(deck, direction), direction)) &
        call report(deck%settings, problems, mesh_group, key_lines(direction), 'no line of the mesh can be moved '// &
                  'there; allowed: on the plate, off the patch, with more elements between lines.')
    end do
  end subroutine check_window_lines

  !> Reports doublers and ply drops without a line of the mesh on an edge.
  subroutine check_zone_lines(deck, direction, problems)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: direction
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (allocated(deck%setup%zones%doublers)) then
      do i = 1, size(deck%setup%zones%doublers)
        call check(deck%setup%zones%doublers(i), doubler_group)
      end do
    end if
    if (allocated(deck%setup%zones%drops)) then
      do i = 1, size(deck%setup%zones%drops)
        call check(deck%setup%zones%drops(i), ply_drop_group)
      end do
    end if

  contains

    !> Reports one of them.
    subroutine check(zone, group)
      class(ply_zone_t), intent(in) :: zone
      character(len=*), intent(in) :: group

      if (problems%concern(group, place=i)) return
      if (misses(deck, zone%edges(direction), direction)) &
        call report(deck%settings, problems, group, key_zone_at, 'no line of the mesh can be moved to its edges at '// &
                    merge('x', 'y', direction == 1)//' = '//to_text(zone%at(direction) - zone%size(direction)/2)// &
                    ' and '//to_text(zone%at(direction) + zone%size(direction)/2)//'; give more elements, or keep '// &
                    'the patch off the edge.', i)
    end subroutine check
  end subroutine check_zone_lines

  !> Reports stringers without a line in the mesh.
  subroutine check_stringer_lines(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (problems%concern(stringer_group)) return
    do i = 1, size(deck%setup%stringers)
      associate (stringer => deck%setup%stringers(i), across => 3 - deck%setup%stringers(i)%along)
        if (misses(deck, [stringer%at], across)) then
          call report(deck%settings, problems, stringer_group, key_stringer_at, 'no line of the mesh can be moved '// &
                      'to the stringer; give more elements, or keep it off the patch.', i)
        else if (misses(deck, stringer%ends, stringer%along)) then
          call report(deck%settings, problems, stringer_group, trim(key_ends(1)), &
                      'no line of the mesh can be moved to an end of the stringer; give more elements, or keep it '// &
                      'off the patch.', i)
        end if
      end associate
    end do
  end subroutine check_stringer_lines

  !> Lines required along a direction.
  pure function lines_along(deck, direction) result(lines)
    type(deck_t), intent(in) :: deck
    integer, intent(in) :: direction
    real(wp), allocatable :: lines(:)

    allocate (lines(0))
    if (direction == 1 .and. allocated(deck%setup%mesh%x_lines)) lines = deck%setup%mesh%x_lines
    if (direction == 2 .and. allocated(deck%setup%mesh%y_lines)) lines = deck%setup%mesh%y_lines
  end function lines_along

  !> True if the edge of a rectangular window is no line of the mesh, which then has no nodes on it.
  pure logical function lacks_window_lines(deck) result(lacks)
    type(deck_t), intent(in) :: deck

    lacks = misses(deck, window_lines(deck%setup%supports, 1), 1) .or. &
            misses(deck, window_lines(deck%setup%supports, 2), 2)
  end function lacks_window_lines

  !> True if the mesh has no line at a coordinate.
  pure logical function misses(deck, lines, direction)
    type(deck_t), intent(in) :: deck
    real(wp), intent(in) :: lines(:)
    integer, intent(in) :: direction
    type(cell_line_t) :: cells
    integer :: line

    misses = .false.
    cells = cells_along(deck%setup%plate, deck%setup%mesh, direction)
    do line = 1, size(lines)
      misses = misses .or. cells%distance_of(lines(line)) > rounding*deck%setup%plate%length(direction)
    end do
  end function misses
end module deck_mesh_lines
