!> Energy release rates along a front by Eq. 11 of the paper with its sign corrected, theory (D10), from the states on
!> both sides of the front.
!>
!> The steps are those of section 3.3.3 of the paper: strains are extrapolated to the nodes of the front from the cells
!> on either side and smoothed along the front, not across it; the smooth states give G at the nodes, and the mean of
!> three nodes is G of a segment. Smoothing G instead of the states would count differences between adjacent segments as
!> released energy, as where a front turns around an intact cell: on discs that grow cell by cell the rates would sum to
!> 1.32 of the energy released, against 1.18 with smooth states.
!>
!> If plies have cracked on one side only, strains across the front are discontinuous without any delamination. The
!> states are then compared with the stiffness of the stiffer side, to which they are converted by equal forces across
!> the front. With the softer stiffness the energy of a force that the crack has not yet released would be
!> overestimated, by up to 18 times G_c for one or two steps after each crack.
module two_state_energy_release
  use kinds, only: wp
  use element_batches, only: lanes, batch_of, lane_of
  use strain_recovery, only: nodal_strains
  use delamination_fronts, only: front_segment_t
  use virtual_crack_closure, only: two_state_release, converted_strains, segment_mean
  use motions, only: motion_t
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: two_state_rates

contains

  !> Rates of the segments of a front.
  function two_state_rates(plate, section_stiffness, motion, zone, segments) result(modes)
    type(composite_plate_t), intent(in) :: plate
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), intent(in) :: section_stiffness(:, :, :)
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: zone
    type(front_segment_t), intent(in) :: segments(:)
    !> Zero, G, zero, (3, segments)
    real(wp), allocatable :: modes(:, :)
    real(wp), allocatable :: values(:)
    integer :: n

    n = size(segments)
    allocate (modes(3, n), source=0.0_wp)
    allocate (values(180*n), source=0.0_wp)
    call front_states(plate, section_stiffness, plate%motion_of(motion%displacement), segments, &
                      front_elements(plate, zone, segments), values(:96*n), values(96*n + 1:))
    call plate%communicator%sum(values)
    modes(2, :) = rates_of_states(plate, segments, reshape(values(:96*n), [8, 3, 2, 2, n]), &
                                  reshape(values(96*n + 1:), [21, 2, 2, n]))
  end function two_state_rates

  !> Energy release rates of the segments from the states at their nodes.
  function rates_of_states(plate, segments, found, stiffness) result(rates)
    type(composite_plate_t), intent(in) :: plate
    type(front_segment_t), intent(in) :: segments(:)
    !> Extrapolated strains, (8, 3 nodes, 2 layers, 2 sides, segments)
    real(wp), intent(in) :: found(:, :, :, :, :)
    !> Stiffness, (21, 2 layers, 2 sides, segments)
    real(wp), intent(in) :: stiffness(:, :, :, :)
    !> G of each segment
    real(wp) :: rates(size(segments))
    real(wp) :: states(8, 3, 2, 2, size(segments)), common(21, 2, size(segments)), smooth(8, 2, 2), &
                nodal(3), known(21)
    integer :: s, line, layer, side

    do s = 1, size(segments)
      do layer = 1, 2
        common(:, layer, s) = common_stiffness(segments(s), stiffness(:, layer, :, s))
        do side = 1, 2
          ! Beyond the border of the zone there is a single layer, with another stiffness than these two.
          known = stiffness(:, layer, merge(1, side, segments(s)%at_border), s)
          do line = 1, 3
            states(:, line, layer, side, s) = &
              converted_strains(symmetric(plate, segments(s)%edge(line), found(:, line, layer, side, s)), known, &
                           common(:, layer, s), segments(s)%direction)
          end do
        end do
      end do
    end do
    do s = 1, size(segments)
      do line = 1, 3
        smooth = smooth_state(segments, states, common, s, line)
        nodal(line) = two_state_release(common(:, :, s), smooth(:, :, 1), smooth(:, :, 2))
      end do
      rates(s) = segment_mean(nodal)
    end do
  end function rates_of_states

  !> Stiffness for the comparison of the states of a layer on both sides of a segment: that of the stiffer side.
  pure function common_stiffness(segment, stiffness) result(common)
    type(front_segment_t), intent(in) :: segment
    !> Stiffness of the layer, (21, 2 sides)
    real(wp), intent(in) :: stiffness(:, :)
    !> The stiffer of them
    real(wp) :: common(21)
    !> Positions of the diagonal of the membrane stiffness
    integer, parameter :: diagonal(3) = [1, 4, 6]

    common = stiffness(:, 1)
    if (segment%at_border) return
    if (sum(stiffness(diagonal, 2)) > sum(common(diagonal))) common = stiffness(:, 2)
  end function common_stiffness

  !> Strains without the components that vanish on a line of symmetry, as their mean from both sides does on the full
  !> plate.
  pure function symmetric(plate, node, strains)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: node
    !> Strains at the node
    real(wp), intent(in) :: strains(8)
    !> The same, symmetric where the node is on a line of symmetry
    real(wp) :: symmetric(8)
    integer :: direction

    symmetric = strains
    do direction = 1, 2
      if (.not. plate%mesh%mirrored(direction)) cycle
      if (abs(plate%mesh%node_coordinates(direction, node)) > 0) cycle
      symmetric([3, 6, 6 + direction]) = 0
    end do
  end function symmetric

  !> State at a node of a segment: mean over the segments that share the node and border on cells of the same stiffness.
  !> Between cells of different stiffness strains are discontinuous.
  pure function smooth_state(segments, states, common, s, line) result(smooth)
    type(front_segment_t), intent(in) :: segments(:)
    !> Strains, (8, 3 nodes, 2 layers, 2 sides, segments)
    real(wp), intent(in) :: states(:, :, :, :, :)
    !> Stiffness of the strains, (21, 2 layers, segments)
    real(wp), intent(in) :: common(:, :, :)
    !> The segment, and the number of its node
    integer, intent(in) :: s, line
    !> Strains, (8, 2 layers, 2 sides)
    real(wp) :: smooth(8, 2, 2)
    integer :: t, k, found

    smooth = 0
    found = 0
    do t = 1, size(segments)
      k = findloc(segments(t)%edge, segments(s)%edge(line), dim=1)
      if (k == 0) cycle
      if (any(abs(common(:, :, t) - common(:, :, s)) > 0)) cycle
      smooth = smooth + states(:, k, :, :, t)
      found = found + 1
    end do
    smooth = smooth/found
  end function smooth_state

  !> Elements above and below the interface on the delaminated and the intact side of every segment, as numbered on this
  !> rank; 0: on another rank.
  pure function front_elements(plate, zone, segments) result(elements)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: zone
    type(front_segment_t), intent(in) :: segments(:)
    !> Elements, (2 layers, 2 sides, segments)
    integer :: elements(2, 2, size(segments))
    integer :: s, side, layer, cells(2)

    do s = 1, size(segments)
      cells = [plate%mesh%cell_at(segments(s)%inside(1), segments(s)%inside(2)), &
               plate%mesh%cell_at(segments(s)%outside(1), segments(s)%outside(2))]
      do side = 1, 2
        do layer = 1, 2
          elements(layer, side, s) = plate%distribution%local_element( &
                                     plate%mesh%element_at(cells(side), plate%mesh%zones(zone)%below_ply + layer - 1))
        end do
      end do
    end do
  end function front_elements

  !> Strains of the elements along a front at the three nodes of their segments, and their stiffness; zero for elements
  !> of other ranks. Every batch is computed once.
  subroutine front_states(plate, section_stiffness, field, segments, elements, strains, stiffness)
    type(composite_plate_t), intent(in) :: plate
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), intent(in) :: section_stiffness(:, :, :)
    !> Motion of every layer, (5, points)
    real(wp), intent(in) :: field(:, :)
    type(front_segment_t), intent(in) :: segments(:)
    !> Elements of this rank, layer by layer, side by side, segment by segment; 0: none
    integer, intent(in) :: elements(4*size(segments))
    !> Strains, zero on entry, (8 components, 3 nodes, elements)
    real(wp), intent(inout) :: strains(8, 3, size(elements))
    !> Stiffness, zero on entry, (21, elements)
    real(wp), intent(inout) :: stiffness(21, size(elements))
    real(wp) :: at_nodes(lanes, 9, 8)
    integer :: batches(size(elements)), e, same, s, lane, line, nodes(9)

    batches = merge(batch_of(elements), 0, elements > 0)
    do e = 1, size(elements)
      if (batches(e) == 0 .or. any(batches(:e - 1) == batches(e))) cycle
      call nodal_strains(plate%elements, batches(e), plate%setup%mesh%kinematics, field, at_nodes)
      do same = e, size(elements)
        if (batches(same) /= batches(e)) cycle
        s = 1 + (same - 1)/4
        lane = lane_of(elements(same))
        nodes = plate%mesh%cell_nodes(plate%mesh%element_cell(plate%distribution%elements(elements(same))))
        do line = 1, 3
          strains(:, line, same) = at_nodes(lane, findloc(nodes, segments(s)%edge(line), dim=1), :)
        end do
        stiffness(:, same) = section_stiffness(lane, :, batches(e))
      end do
    end do
  end subroutine front_states
end module two_state_energy_release
