!> Checks of sizes of plate, laminate and interfaces. Zones and starters consist of entire cells, so that their
!> sizes may differ from those of the deck.
module deck_extents
  use cell_grids, only: cells_along, cells_from_struck
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_line_conflicts, only: check_line_conflicts
  use deck_mesh_lines, only: check_window_lines
  use deck_patches, only: check_core, check_patch
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark, are_clear
  use delamination_deck, only: key_smoothing, key_starter, key_zone
  use doubler_bonds, only: names_of_doublers
  use interface_places, only: delamination_group
  use delamination_parameters, only: delamination_t, law_front, release_vcct, default_smoothing, min_smoothed_cells
  use kinds, only: wp
  use line_deck, only: line_group, line_key_at => key_at
  use line_loads, only: along_x
  use laminate_deck, only: laminate_group, key_thicknesses
  use mesh_parameters, only: is_mirrored
  use plate_deck, only: plate_group, key_length, key_symmetry
  use roundings, only: rounding
  use short_numbers, only: short_text
  use text, only: line_t, to_text
  implicit none
  private
  public :: check_sizes, check_extents, extent_lines

  !> Length over thickness beyond which round-off dominates the result, and below which plate theory is inaccurate.
  !> Stiffnesses of shear and bending differ by the square of the first, 1e10, so that six of sixteen digits remain. At
  !> four thicknesses the deflection of a cross-ply is 12 % too small (N. J. Pagano, S. J. Hatfield, AIAA J. 10 (1972)
  !> 931-933).
  real(wp), parameter :: max_slenderness = 1.0e5_wp, min_slenderness = 5
  !> Smallest ratio of the sides of starter and loaded patch; below it growth may never start: under the same force a
  !> starter as large as the patch had an eighth of the energy release rate of one twice as wide. It affects a warning
  !> only.
  real(wp), parameter :: min_starter = 1.5_wp
  !> Relative difference from the requested size above which a warning is given: 5 %, as much as the error of the
  !> force with accuracy='draft'.
  real(wp), parameter :: size_tolerance = 0.05_wp
  !> Distance of a line from its coordinate, relative to the plate's length, above which it is reported as moved: .1 mm
  !> in 100 mm, below the accuracy of a rig. It affects a warning only.
  real(wp), parameter :: moved_line = 1.0e-3_wp

contains

  !> Checks sizes given in the deck.
  subroutine check_sizes(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (are_clear(deck%settings, problems, plate_group, key_length)) then
      call check_thickness(deck, problems)
      call check_patch(deck, problems)
      call check_core(deck, problems)
    end if
    call check_zones(deck, problems)
    if (are_clear(deck%settings, problems, plate_group, key_length//' '//key_symmetry)) &
      call check_line_places(deck, problems)
  end subroutine check_sizes

  !> Checks that lines are on the modelled part of the plate.
  subroutine check_line_places(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: half
    integer :: place, direction
    logical :: mirrored(2)

    mirrored = is_mirrored(deck%setup%plate%symmetry)
    do place = 1, size(deck%setup%lines)
      if (.not. are_clear(deck%settings, problems, line_group, line_key_at, place)) cycle
      associate (line => deck%setup%lines(place))
        direction = merge(2, 1, line%direction == along_x)
        half = deck%setup%plate%length(direction)/2
        if (abs(line%at) > half*(1 + rounding)) then
          call report(deck%settings, problems, line_group, line_key_at, &
                      'the line is not on the plate; allowed: '// &
                    to_text(-half)//' to '//to_text(half)//'.', place)
        else if (mirrored(direction) .and. line%at < 0) then
          call report(deck%settings, problems, line_group, line_key_at, 'only one side is modelled, and a line '// &
                    'includes its image on the other side; allowed: 0 or more.', place)
        end if
      end associate
    end do
  end subroutine check_line_places

  !> Warns of lines that are moved to lines of nodes.
  subroutine check_line_nodes(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(cell_line_t) :: cells
    real(wp) :: taken
    integer :: place, direction

    do place = 1, size(deck%setup%lines)
      direction = merge(2, 1, deck%setup%lines(place)%direction == along_x)
      cells = cells_along(deck%setup%plate, deck%setup%mesh, direction)
      associate (at => deck%setup%lines(place)%at)
        taken = cells%place_of_node(cells%nearest_node(at))
        if (abs(taken - at) > moved_line*deck%setup%plate%length(direction)) &
          call remark(deck%settings, problems, line_group, line_key_at, 'lines lie on nodes; on this mesh the line '// &
                      'is at '//to_text(rounded(taken))//'.', place)
      end associate
    end do
  end subroutine check_line_nodes

  !> Thickness of the laminate against the plate.
  subroutine check_thickness(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: thickness, shorter, longer

    if (.not. allocated(deck%setup%laminate%thickness)) return
    thickness = sum(deck%setup%laminate%thickness)
    shorter = minval(deck%setup%plate%length)
    longer = maxval(deck%setup%plate%length)
    if (thickness > shorter) then
      call report(deck%settings, problems, laminate_group, key_thicknesses, 'the laminate is '// &
                  short_text(thickness)//' thick, more than the plate''s width; plate theory does not apply.')
    else if (longer > max_slenderness*thickness*(1 + rounding)) then
      call report(deck%settings, problems, laminate_group, key_thicknesses, 'the laminate is '// &
                  short_text(thickness)//' thick, less than '//to_text(1/max_slenderness)// &
                  ' of the plate''s length, where round-off dominates.')
    else if (thickness*min_slenderness > shorter) then
      call remark(deck%settings, problems, laminate_group, key_thicknesses, 'the plate is less than '// &
                  to_text(min_slenderness)//' thicknesses wide; plate theory is inaccurate there.')
    end if
  end subroutine check_thickness

  !> Zones against the plate, and starters against the loaded patch.
  subroutine check_zones(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    do i = 1, size(deck%setup%delaminations)
      if (repeats(deck, i)) cycle
      associate (s => deck%settings, d => deck%setup%delaminations(i), place => deck%setup%delaminations(i)%group)
        if (any(d%zone > deck%setup%plate%length) .and. are_clear(s, problems, plate_group, key_length) .and. &
            are_clear(s, problems, delamination_group, key_zone, place)) &
          call report(s, problems, delamination_group, key_zone, 'the zone must not be larger than the plate.', place)
        if (d%is_adaptive .and. any(d%starter + 2*abs(d%starter_at) >= deck%setup%plate%length) .and. &
            are_clear(s, problems, plate_group, key_length) .and. &
            are_clear(s, problems, delamination_group, key_starter, place)) &
          call report(s, problems, delamination_group, key_starter, 'must lie within the plate.', place)
        if (deck%setup%impactor%is_present .and. d%law == law_front .and. &
            d%starter < min_starter*deck%setup%mesh%patch .and. &
            are_clear(s, problems, delamination_group, key_starter, place)) &
          call remark(s, problems, delamination_group, key_starter, 'the starter is hardly larger than the loaded '// &
                      'patch: most of the shear force then acts within the starter, and growth may never start.', place)
      end associate
    end do
  end subroutine check_zones

  !> True for an interface of the same group and law as one before it, whose sizes are the same.
  pure logical function repeats(deck, i)
    type(deck_t), intent(in) :: deck
    !> The interface
    integer, intent(in) :: i

    repeats = any(deck%setup%delaminations(:i - 1)%group == deck%setup%delaminations(i)%group .and. &
                  deck%setup%delaminations(:i - 1)%law == deck%setup%delaminations(i)%law)
  end function repeats

  !> Warns of lines, zones and starters whose size on the mesh differs from the deck's.
  subroutine check_extents(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(cell_line_t) :: columns, rows
    real(wp) :: zone(2), starter(2)
    integer :: i

    if (problems%errors() > 0) return
    call check_window_lines(deck, problems)
    call check_line_nodes(deck, problems)
    call check_line_conflicts(deck, problems)
    if (size(deck%setup%delaminations) == 0) return
    columns = cells_from_struck(deck%setup%plate, deck%setup%mesh, 1)
    rows = cells_from_struck(deck%setup%plate, deck%setup%mesh, 2)
    do i = 1, size(deck%setup%delaminations)
      if (repeats(deck, i)) cycle
      associate (d => deck%setup%delaminations(i), place => deck%setup%delaminations(i)%group)
        call extents_of(columns, rows, d, zone, starter)
        if (differs(zone, d%zone) .and. .not. (d%is_adaptive .or. d%bonds_doublers())) &
          call remark(deck%settings, problems, delamination_group, key_zone, 'zones consist of entire cells; '// &
                      'on this mesh the zone is '//shown(zone)//'.', place)
        if (deck%settings%is_given(delamination_group, key_starter, place) .and. &
            differs(starter, [d%starter, d%starter])) &
          call remark(deck%settings, problems, delamination_group, key_starter, &
                      'starters consist of entire cells; on this mesh the starter is '//shown(starter)//'.', place)
        call check_smoothing(deck, d, mean_cell(columns, rows, d%zone), minval(starter)/2, problems)
      end associate
    end do
  end subroutine check_extents

  !> Warns of a front that is smoothed over more than its radius: a rate proportional to the cosine of twice the angle
  !> around a disc then loses 29 % of its amplitude, 8 % at half the radius.
  subroutine check_smoothing(deck, delamination, cell, radius, problems)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination
    !> Length of the mean cell of its zone, and half of its starter
    real(wp), intent(in) :: cell, radius
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: advice
    real(wp) :: distance

    associate (d => delamination)
      if (d%law /= law_front .or. d%energy_release /= release_vcct .or. .not. d%starter > 0) return
      ! A round front in isotropic plies has one rate all around.
      if (d%starter_round .and. all(abs(deck%setup%materials%e1 &
                                        - deck%setup%materials%e2) <= size_tolerance*deck%setup%materials%e1)) return
      distance = d%smoothing
      advice = 'give a shorter one'
      if (.not. distance > 0) then
        distance = default_smoothing(sum(deck%setup%laminate%thickness), cell)
        advice = 'use cells of at most '//to_text(rounded(radius/min_smoothed_cells))
        if (.not. min_smoothed_cells*cell > sum(deck%setup%laminate%thickness)) return
      end if
      if (distance > radius*(1 + size_tolerance)) &
        call remark(deck%settings, problems, delamination_group, key_smoothing, 'rates are averaged over '// &
                    to_text(rounded(distance))//' along the front, more than half of the starter, which reduces '// &
                    'their variation along it; '//advice//'.', d%group)
    end associate
  end subroutine check_smoothing

  !> Length of the mean cell of a zone: the root of its mean area.
  pure real(wp) function mean_cell(columns, rows, zone) result(length)
    !> Cells along x and y, from the struck point
    type(cell_line_t), intent(in) :: columns, rows
    !> Extents of the zone
    real(wp), intent(in) :: zone(2)
    real(wp) :: x(2), y(2)
    integer :: across(2), along(2)

    across = columns%within(zone(1))
    along = rows%within(zone(2))
    x = columns%span(across)
    y = rows%span(along)
    length = sqrt((x(2) - x(1))*(y(2) - y(1))/product([across(2) - across(1), along(2) - along(1)] + 1))
  end function mean_cell

  !> Zone and starter of each interface on the mesh, for the log.
  pure function extent_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    !> One line per interface
    type(line_t), allocatable :: lines(:)
    type(cell_line_t) :: columns, rows
    real(wp) :: zone(2), starter(2)
    character(len=:), allocatable :: text
    integer :: place

    allocate (lines(size(deck%setup%delaminations)))
    columns = cells_from_struck(deck%setup%plate, deck%setup%mesh, 1)
    rows = cells_from_struck(deck%setup%plate, deck%setup%mesh, 2)
    do place = 1, size(lines)
      call extents_of(columns, rows, deck%setup%delaminations(place), zone, starter)
      text = 'Interface below ply '//to_text(deck%setup%delaminations(place)%below_ply)// &
             ': the mesh makes the zone '// shown(zone)
      if (deck%setup%delaminations(place)%bonds_doublers()) &
        text = 'Interface below ply '//to_text(deck%setup%delaminations(place)%below_ply)//': the bond of '// &
               names_of_doublers(deck%setup%zones, deck%setup%delaminations(place))
      if (deck%setup%delaminations(place)%starter > 0) text = text//' and the starter '//shown(starter)
      if (deck%setup%delaminations(place)%is_adaptive) text = text//'. The zone grows with the damage'
      lines(place)%text = text//'.'
    end do
  end function extent_lines

  !> Sizes of zone and starter on the mesh.
  pure subroutine extents_of(columns, rows, delamination, zone, starter)
    !> Cells along x and y, from the struck point
    type(cell_line_t), intent(in) :: columns, rows
    !> The interface as the deck gives it
    type(delamination_t), intent(in) :: delamination
    !> Extents along x and y on the full plate
    real(wp), intent(out) :: zone(2), starter(2)
    type(cell_line_t) :: x, y

    zone = [columns%extent_of(delamination%zone(1)), rows%extent_of(delamination%zone(2))]
    x = columns%from(delamination%starter_at(1))
    y = rows%from(delamination%starter_at(2))
    starter = [x%extent_of(delamination%starter), y%extent_of(delamination%starter)]
    if (.not. delamination%bonds_doublers()) starter = min(starter, zone)
  end subroutine extents_of

  !> True if a size differs from the requested one by more than `size_tolerance`.
  pure logical function differs(given, asked)
    !> Extents on the mesh and in the deck
    real(wp), intent(in) :: given(2), asked(2)

    differs = any(abs(given - asked) > size_tolerance*asked)
  end function differs

  !> Two extents to four digits.
  pure function shown(extents) result(text)
    !> Along x and y
    real(wp), intent(in) :: extents(2)
    !> Such as `0.012 by 0.0125`
    character(len=:), allocatable :: text

    text = to_text(rounded(extents(1)))//' by '//to_text(rounded(extents(2)))
  end function shown

  !> A number to four digits.
  pure real(wp) function rounded(value)
    real(wp), intent(in) :: value
    character(len=12) :: digits

    write (digits, '(es12.3e3)') value
    read (digits, *) rounded
  end function rounded
end module deck_extents
