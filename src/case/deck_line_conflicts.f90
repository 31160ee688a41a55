!> Checks that each motion of a node is prescribed by one line only, and that lines act on motions that the edges do not
!> constrain.
module deck_line_conflicts
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report
  use line_deck, only: line_group, key_at, key_layer
  use line_loads, only: line_load_t, along_x, all_layers
  use mesh_parameters, only: is_halved
  use supports, only: fixed_by_edge
  use text, only: to_text
  implicit none
  private
  public :: check_line_conflicts

contains

  !> Checks every line by itself and against the lines before it.
  subroutine check_line_conflicts(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: line, earlier

    do line = 1, size(deck%setup%lines)
      if (deck%setup%lines(line)%layer > size(deck%setup%delaminations) + 1) &
        call report(deck%settings, problems, line_group, key_layer, 'there are fewer layers; allowed: 1 to '// &
                    to_text(size(deck%setup%delaminations) + 1)//'.', line)
      if (acts_on_held_edge(deck, deck%setup%lines(line))) &
        call report(deck%settings, problems, line_group, key_at, 'the edge of the plate holds this component, so '// &
                    'that the line has no effect; free the edge, for u and v by in_plane = ''free'', or move the '// &
                    'line.', line)
      do earlier = 1, line - 1
        if (.not. meet(deck%setup%lines(line), deck%setup%lines(earlier))) cycle
        if (deck%setup%lines(line)%direction /= deck%setup%lines(earlier)%direction) then
          ! Lines with the same motion may both hold the node where they cross.
          associate (one => deck%setup%lines(line), other => deck%setup%lines(earlier))
            if (max(abs(one%value - other%value), abs(one%rise - other%rise)) <= 0 .and. &
                (one%history == other%history .or. .not. abs(one%value) > 0)) cycle
          end associate
        else if (node_of(deck, deck%setup%lines(line)) /= node_of(deck, deck%setup%lines(earlier))) then
          cycle
        end if
        call report(deck%settings, problems, line_group, '', '&line number '//to_text(earlier)//' of the deck '// &
                    'prescribes the same component of the same nodes; leave one of the two out.', line)
      end do
    end do
  end subroutine check_line_conflicts

  !> True: a line moves or loads an edge in a component that the edge constrains. A line that only supports such an edge
  !> has no effect and is accepted.
  pure logical function acts_on_held_edge(deck, line) result(acts)
    type(deck_t), intent(in) :: deck
    type(line_load_t), intent(in) :: line
    type(cell_line_t) :: cells
    logical :: held(5), halved(2)
    integer :: normal, node

    normal = merge(2, 1, line%direction == along_x)
    cells = cells_along(deck%setup%plate, deck%setup%mesh, normal)
    node = node_of(deck, line)
    halved = is_halved(deck%setup%plate%symmetry)
    held = .false.
    if (node == 0 .and. .not. halved(normal)) then
      held = fixed_by_edge(deck%setup%plate%edges(2*normal - 1), normal, deck%setup%plate)
    else if (node == 2*cells%cells()) then
      held = fixed_by_edge(deck%setup%plate%edges(2*normal), normal, deck%setup%plate)
    end if
    acts = held(line%component) .and. abs(line%value) > 0
  end function acts_on_held_edge

  !> Index of the line of nodes that a line acts on, from 0.
  pure integer function node_of(deck, line) result(node)
    type(deck_t), intent(in) :: deck
    type(line_load_t), intent(in) :: line
    type(cell_line_t) :: cells

    cells = cells_along(deck%setup%plate, deck%setup%mesh, merge(2, 1, line%direction == along_x))
    node = cells%nearest_node(line%at)
  end function node_of

  !> True: two lines prescribe the same component of a layer.
  pure logical function meet(one, other)
    !> The lines
    type(line_load_t), intent(in) :: one, other

    meet = one%prescribed .and. other%prescribed .and. one%component == other%component .and. &
           (one%layer == other%layer .or. one%layer == all_layers .or. other%layer == all_layers)
  end function meet
end module deck_line_conflicts
