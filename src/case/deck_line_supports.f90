!> Checks that supports and lines constrain rigid-body motions and carry the forces along them, and that prescribed
!> lines do not act on supports.
module deck_line_supports
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark
  use kinds, only: wp
  use line_deck, only: line_group, key_displacement, key_force
  use line_loads, only: line_load_t, along_x, along_y
  use material_parameters, only: largest_strain
  use mesh_parameters, only: is_mirrored, symmetry_point, edge_clamped, edge_elastic, edge_free
  use plate_constraints, only: unrestrained
  use packed_matrices, only: inverse, unpacked
  use roundings, only: rounding
  use stacking, only: section_of, section_t, stacked_plies
  use support_parameters, only: support_t, bearing_face, window_none, window_circle, window_rectangle
  use text, only: rounded_text
  implicit none
  private
  public :: check_line_supports, check_in_plane_balance, check_moved_lines, check_line_strains

contains

  !> Checks that lines and edges constrain the rigid-body deflection and rotations about x and y.
  subroutine check_line_supports(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(line_load_t), allocatable :: supporting(:)
    logical, allocatable :: across(:)
    logical :: tilts(2), edges(4)
    integer :: along, n

    if (any(deck%setup%plate%edges == edge_clamped)) return
    supporting = pack(deck%setup%lines, deck%setup%lines%prescribed)
    edges = deck%setup%plate%edges /= edge_free
    do along = 1, 2
      ! The rotation is constrained by two lines or edges across this direction, or one along it.
      across = supporting%component == 3 .and. supporting%direction == merge(along_y, along_x, along == 1)
      n = count(edges(2*along - 1:2*along))
      if (any(across)) n = n + merge(2, 1, minval(supporting%at, mask=across) < maxval(supporting%at, mask=across))
      tilts(along) = n > 1 .or. any(edges(5 - 2*along:6 - 2*along)) .or. any(supporting%component == 3 + along) .or. &
                     any(supporting%component == 3 .and. .not. across)
    end do
    ! A rotation about an in-plane axis changes its sign if the plate is turned by 180 degrees about z.
    tilts = tilts .or. is_mirrored(deck%setup%plate%symmetry) .or. deck%setup%plate%symmetry == symmetry_point
    if (all(tilts) .and. (any(supporting%component == 3) .or. any(edges))) return
    call report(deck%settings, problems, line_group, '', 'lines and edges leave the plate free to move or to tilt '// &
              'in a static analysis; support another line.', 1)
  end subroutine check_line_supports

  !> Checks that in-plane forces balance where nothing restrains the plate against them: the struck point, which is
  !> fixed against rigid-body motions, would carry the remainder.
  subroutine check_in_plane_balance(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    logical :: mirrored(2), free(3)
    real(wp) :: net(3), total
    integer :: line

    mirrored = is_mirrored(deck%setup%plate%symmetry)
    free = unrestrained(deck%setup) .and. .not. [mirrored, any(mirrored)]
    if (deck%setup%plate%symmetry == symmetry_point) free(1:2) = .false.
    net = 0
    total = 0
    do line = 1, size(deck%setup%lines)
      associate (l => deck%setup%lines(line), normal => merge(1, 2, deck%setup%lines(line)%direction == along_y))
        if (l%prescribed .or. l%component > 2) cycle
        ! A line off the cut represents its mirror image, too.
        net(l%component) = net(l%component) + merge(2, 1, mirrored(normal) .and. abs(l%at) > 0)*l%value
        if (l%component /= normal) &
          net(3) = net(3) + merge(1, -1, normal == 1)*l%at*l%value/maxval(deck%setup%plate%length)
        total = total + abs(l%value)
      end associate
    end do
    if (.not. any(free .and. abs(net) > rounding*total)) return
    call report(deck%settings, problems, line_group, '', 'in-plane forces of lines do not balance, and nothing '// &
                'holds the plate against them in a static analysis; give a line with a displacement u or v, or an '// &
                'edge with in_plane = ''fixed''.', 1)
  end subroutine check_in_plane_balance

  !> Reports prescribed deflections of lines where supports constrain the plate, and strains that are not small.
  subroutine check_moved_lines(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: line, along, i

    do line = 1, size(deck%setup%lines)
      associate (l => deck%setup%lines(line), plate => deck%setup%plate)
        if (l%prescribed .and. l%component <= 2) then
          if (abs(l%value) > largest_strain*plate%length(l%component)) &
            call remark(deck%settings, problems, line_group, key_displacement, 'is '// &
                        rounded_text(100*abs(l%value)/plate%length(l%component))//' % of the plate''s length, and '// &
                        'the model assumes small strains.', line)
        end if
        if (.not. (l%prescribed .and. l%component == 3 .and. abs(l%value) > 0)) cycle
        along = merge(1, 2, l%direction == along_x)
        if (any([(resists(deck%setup%supports(i), l, along, plate%length), i=1, size(deck%setup%supports))])) then
          call report(deck%settings, problems, line_group, key_displacement, 'the line runs from edge to edge of '// &
                    'the plate, over the frame of &support, which holds the deflection there; load by '// &
                    '&impactor travel or by a force.', line)
        else if (any(holds(plate%edges(2*along - 1:2*along), plate%edge_stiffness(1))) .or. &
                 any([(holds_ends(deck%setup%supports(i), l, along, plate%length), &
                       i=1, size(deck%setup%supports))])) then
          call remark(deck%settings, problems, line_group, key_displacement, 'the line runs to edges that hold the '// &
                    'deflection; its force depends on the size of the cells there.', line)
        end if
      end associate
    end do
  end subroutine check_moved_lines

  !> Reports in-plane forces of lines under which the laminate, free to deform, has strains that are not small.
  subroutine check_line_strains(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(section_t) :: section
    real(wp) :: compliance(3, 3), strain
    integer :: line

    if (problems%errors() > 0) return
    section = section_of(stacked_plies(deck%setup%laminate, deck%setup%materials), deck%setup%laminate%shear_correction)
    compliance = inverse(unpacked(section%stiffness(1:6)))
    do line = 1, size(deck%setup%lines)
      associate (l => deck%setup%lines(line), normal => merge(1, 2, deck%setup%lines(line)%direction == along_y))
        if (l%prescribed .or. l%component > 2) cycle
        strain = abs(l%value)/deck%setup%plate%length(3 - normal)*merge(compliance(normal, normal), compliance(3, 3), &
                                                                  l%component == normal)
        if (strain > largest_strain) call remark(deck%settings, problems, line_group, key_force, 'strains the '// &
          'laminate by '//rounded_text(100*strain)//' %, and the model assumes small strains.', line)
      end associate
    end do
  end subroutine check_line_strains

  !> True: an edge constrains the deflection.
  elemental logical function holds(edge, stiffness)
    !> Kind of the edge
    integer, intent(in) :: edge
    !> Stiffness of elastic edges against deflection; 0: rigid
    real(wp), intent(in) :: stiffness

    holds = edge /= edge_free .and. .not. (edge == edge_elastic .and. stiffness > 0)
  end function holds

  !> True: the frame of a rig resists the motion of a line. The plate may lift off a unilateral frame.
  pure logical function resists(support, line, along, lengths)
    type(support_t), intent(in) :: support
    type(line_load_t), intent(in) :: line
    !> Direction that it runs along, 1 for x, 2 for y
    integer, intent(in) :: along
    !> Lengths of the plate
    real(wp), intent(in) :: lengths(2)
    real(wp) :: half(2)
    integer :: bearing

    resists = .false.
    if (support%shape == window_none .or. (support%unilateral .and. line%value < 0)) return
    half = support%window/2
    if (support%shape == window_circle) half = [support%radius, support%radius]
    if (abs(line%at) > half(3 - along)) then
      bearing = merge(support%bearing, support%sides, along == 2 .or. support%shape == window_circle)
      resists = bearing == bearing_face
      return
    end if
    if (support%shape == window_circle) half(along) = sqrt(support%radius**2 - line%at**2)
    resists = half(along) < lengths(along)/2*(1 - rounding) .or. &
              support%shape == window_rectangle .and. abs(line%at) >= half(3 - along)*(1 - rounding)
  end function resists

  !> True: a window that reaches the edges of the plate holds it at the ends of a line.
  pure logical function holds_ends(support, line, along, lengths)
    type(support_t), intent(in) :: support
    !> The line, which the rig does not resist
    type(line_load_t), intent(in) :: line
    !> Direction that it runs along, 1 for x, 2 for y
    integer, intent(in) :: along
    !> Lengths of the plate
    real(wp), intent(in) :: lengths(2)

    holds_ends = support%shape == window_rectangle .and. .not. (support%unilateral .and. line%value < 0) .and. &
                 support%window(along) >= lengths(along)*(1 - rounding) .and. &
                 abs(line%at) < support%window(3 - along)/2
  end function holds_ends
end module deck_line_supports
