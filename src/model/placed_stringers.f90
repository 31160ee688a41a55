!> Places the stringers of the deck on edges of this rank's elements.
module placed_stringers
  use edge_beams, only: edge_beam_t, new_edge_beam, simpson
  use element_batches, only: batch_of, lane_of
  use kinds, only: wp
  use line_loads, only: along_x, line_load_t
  use mesh_parameters, only: curvatures, initial_deflection
  use composite_plates, only: composite_plate_t
  use placed_lines, only: relative_stiffness
  use roundings, only: rounding
  use stringers, only: face_front, is_covered, stringer_t
  implicit none
  private
  public :: place_stringers, stiffness_on_line

contains

  !> Adds the beams to the elements. Both cells at an edge have a half of its stringer, so that a stringer on a line of
  !> symmetry counts half in the modelled part; at an edge of the plate its only cell has all of it.
  subroutine place_stringers(plate)
    !> The plate, with its elements; receives their beams
    type(composite_plate_t), intent(inout) :: plate
    type(edge_beam_t), allocatable :: beams(:), found(:)
    integer :: element, total, pass

    if (.not. allocated(plate%setup%stringers)) return
    if (size(plate%setup%stringers) == 0) return
    allocate (plate%elements%first_beam(plate%elements%batches + 1), source=1)
    do pass = 1, 2
      total = 0
      do element = 1, plate%elements%elements
        call find_beams(plate, element, found)
        if (pass == 2) beams(total + 1:total + size(found)) = found
        total = total + size(found)
        plate%elements%first_beam(batch_of(element) + 1) = total + 1
      end do
      if (pass == 1) allocate (beams(total))
    end do
    call move_alloc(beams, plate%elements%beams)
  end subroutine place_stringers

  !> Total stiffness that is added to the springs of a line with a prescribed motion where stringers cross it. All of a
  !> stringer's reaction acts on the springs of one node, whose fraction of the line is at least a sixth of the shortest
  !> cell: these are stiff against the stringer over the length of the plate.
  pure real(wp) function stiffness_on_line(plate, load) result(stiffness)
    type(composite_plate_t), intent(in) :: plate
    type(line_load_t), intent(in) :: load
    integer :: i, along

    stiffness = 0
    if (.not. (allocated(plate%setup%stringers) .and. load%prescribed)) return
    along = merge(1, 2, load%direction == along_x)
    associate (length => plate%setup%plate%length)
      do i = 1, size(plate%setup%stringers)
        associate (stringer => plate%setup%stringers(i))
          if (stringer%along == along) cycle
          if (load%at < stringer%ends(1) - rounding*maxval(length) .or. &
              load%at > stringer%ends(2) + rounding*maxval(length)) cycle
          stiffness = max(stiffness, relative_stiffness*stiffness_of(stringer)*length(along)/length(3 - along) &
                          /(minval(simpson)*minval(plate%mesh%along(along)%sides())))
        end associate
      end do
    end associate

  contains

    !> Stiffness of a section against the component of the line, of all its kinds the largest.
    pure real(wp) function stiffness_of(stringer)
      !> One that crosses the line
      type(stringer_t), intent(in) :: stringer

      associate (section => stringer%section)
        select case (load%component)
        case (1, 2)
          stiffness_of = section%axial
        case (3)
          stiffness_of = section%shear
        case default
          stiffness_of = max(section%bending + section%axial*(plate%layup%thickness/2 + section%eccentricity)**2, &
                             section%torsion)
        end select
      end associate
    end function stiffness_of
  end function stiffness_on_line

  !> Beams on the edges of an element, in the order of the deck.
  subroutine find_beams(plate, element, beams)
    type(composite_plate_t), intent(in) :: plate
    !> Position among this rank's elements
    integer, intent(in) :: element
    type(edge_beam_t), allocatable, intent(out) :: beams(:)
    integer :: place(2), number, cell, i, side, count
    real(wp) :: ends(2, 2)

    associate (mesh => plate%mesh, stringers => plate%setup%stringers)
      number = plate%distribution%elements(element)
      cell = mesh%element_cell(number)
      place = mesh%place_of(cell)
      ends(:, 1) = mesh%along(1)%ends(place(1))
      ends(:, 2) = mesh%along(2)%ends(place(2))
      allocate (beams(2*size(stringers)))
      count = 0
      do i = 1, size(stringers)
        associate (stringer => stringers(i), along => stringers(i)%along)
          if (stringer%face == face_front .and. .not. mesh%is_top(number)) cycle
          if (stringer%face /= face_front .and. number /= mesh%first_element(cell + 1) - 1) cycle
          do side = -1, 1, 2
            if (.not. is_covered(stringer, ends((side + 3)/2, 3 - along), ends(:, along), &
                                 rounding*maxval(plate%setup%plate%length))) cycle
            count = count + 1
            beams(count) = beam_of(plate, element, stringer, side, ends(2, :) - ends(1, :), &
                                   1.0_wp/cells_beside(plate, place(3 - along), 3 - along, side))
            beams(count)%lane = lane_of(element)
            beams(count)%stringer = i
            beams(count)%outwards = merge(-1, 1, stringer%face == face_front)
          end do
        end associate
      end do
      beams = beams(:count)
    end associate
  end subroutine find_beams

  !> A beam on one edge of an element.
  function beam_of(plate, element, stringer, side, sides, share) result(beam)
    type(composite_plate_t), intent(in) :: plate
    !> Position among this rank's elements
    integer, intent(in) :: element
    type(stringer_t), intent(in) :: stringer
    !> Side of the element, -1 or 1
    integer, intent(in) :: side
    !> Sides of the element along x and y, and share of the stringer
    real(wp), intent(in) :: sides(2), share
    type(edge_beam_t) :: beam
    real(wp) :: places(2, 9), deflection(9), slopes(9, 2), height
    integer :: a

    associate (partition => plate%distribution, panel => plate%setup%plate, &
               plies => plate%layup%stacks(plate%layup%stack(element))%plies)
      places = plate%mesh%node_coordinates(:, plate%mesh%point_node( &
                                           partition%points(partition%connectivity(:, element))))
      deflection = [(initial_deflection(panel, places(:, a)), a=1, 9)]
      slopes = 0
      if (any(abs(panel%curvature_radius) > 0)) slopes = transpose(spread(curvatures(panel), 2, 9)*places)
      if (stringer%face == face_front) then
        height = plies(1)%z_top - stringer%section%eccentricity
      else
        height = plies(size(plies))%z_bottom + stringer%section%eccentricity
      end if
    end associate
    beam = new_edge_beam(stringer%section, height, stringer%along, side, sides, deflection, slopes, share)
  end function beam_of

  !> Cells of the full plate beside an edge.
  pure integer function cells_beside(plate, cell, direction, side) result(cells)
    type(composite_plate_t), intent(in) :: plate
    !> Column or row of a cell, direction across the edge: 1 for x, 2 for y
    integer, intent(in) :: cell, direction
    !> Side of the cell on which the edge lies, -1 or 1
    integer, intent(in) :: side

    cells = 2
    if (side < 0 .and. cell == 1 .and. .not. plate%mesh%halved(direction)) cells = 1
    if (side > 0 .and. cell == plate%mesh%cells(direction)) cells = 1
  end function cells_beside
end module placed_stringers
