!> Energy release rates along the fronts of a state.
module front_releases
  use kinds, only: wp
  use element_batches, only: lanes
  use strain_recovery, only: nodal_strains
  use delamination_parameters, only: release_two_state
  use delamination_fronts, only: front_segment_t, find_front
  use energy_release, only: two_state_release, segment_mean, vcct_release, over_outside_cells
  use fracture_criteria, only: release_ratio
  use plate_integrators, only: motion_t
  use separations, only: separation_t
  use models, only: model_t
  implicit none
  private
  public :: front_release_t, release_along_front

  !> The front of one zone and what it would release, the same on every rank.
  type :: front_release_t
    !> The segments
    type(front_segment_t), allocatable :: segments(:)
    !> G_I, G_II, G_III of each segment; Eq. 11 gives no modes and stands in the second row, (3, segments)
    real(wp), allocatable :: modes(:, :)
    !> G over its critical value, of each segment
    real(wp), allocatable :: ratio(:)
  end type front_release_t

contains

  !> Energy release rates along the front of a zone.
  function release_along_front(model, separation, motion, zone, method) result(front)
    !> The model
    type(model_t), intent(in) :: model
    !> Delaminated cells
    type(separation_t), intent(in) :: separation
    !> Motion with its forces
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> release_two_state or release_vcct
    integer, intent(in) :: method
    !> The front
    type(front_release_t) :: front
    integer :: s

    front%segments = find_front(separation%regions(zone), model%mesh)
    if (method == release_two_state) then
      front%modes = two_state_rates(model, motion, zone, front%segments)
    else
      front%modes = vcct_rates(model, motion, zone, front%segments)
    end if
    front%ratio = [(release_ratio(model%scene%delaminations(zone), front%modes(:, s)), s=1, size(front%segments))]
  end function release_along_front

  !> Rates by virtual crack closure, those of the edges into the same cell put together.
  function vcct_rates(model, motion, zone, segments) result(modes)
    !> The model
    type(model_t), intent(in) :: model
    !> Motion with its forces
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> G_I, G_II, G_III, (3, segments)
    real(wp), allocatable :: modes(:, :)
    real(wp), allocatable :: values(:)
    real(wp) :: forces(3, 2, 3), jumps(3, 2, 3)
    integer :: s, line, k

    allocate (modes(3, size(segments)), values(36*size(segments)))
    values = 0
    do s = 1, size(segments)
      do line = 1, 3
        do k = 1, 2
          forces(:, k, line) = tie_force(model, motion, zone, &
                                         merge(segments(s)%edge(line), segments(s)%ahead(1, line), k == 1))
          jumps(:, k, line) = jump(model, motion, zone, segments(s)%behind(k, line))
        end do
      end do
      values(36*s - 35:36*s) = [reshape(forces, [18]), reshape(jumps, [18])]
    end do
    call model%communicator%sum(values)
    do s = 1, size(segments)
      modes(:, s) = vcct_release(segments(s), reshape(values(36*s - 35:36*s - 18), [3, 2, 3]), &
                                 reshape(values(36*s - 17:36*s), [3, 2, 3]))
    end do
    modes = over_outside_cells(segments, modes)
  end function vcct_rates

  !> Force that holds the jump at a node, on the rank that owns it: external less internal and inertia forces.
  pure function tie_force(model, motion, zone, node) result(force)
    !> The model
    type(model_t), intent(in) :: model
    !> Motion with its forces
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> Node
    integer, intent(in) :: node
    !> Force, x, y, z; zero on other ranks and where there is no jump
    real(wp) :: force(3)
    integer :: i

    force = 0
    i = owned_lower_point(model, zone, node)
    if (i > 0) force = -motion%internal(1:3, i) - motion%inertia(1:3, i)
  end function tie_force

  !> Jump at a node, on the rank that owns it.
  pure function jump(model, motion, zone, node)
    !> The model
    type(model_t), intent(in) :: model
    !> Motion
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> Node
    integer, intent(in) :: node
    !> Jump, x, y, z; zero on other ranks and where there is none
    real(wp) :: jump(3)
    integer :: i

    jump = 0
    i = owned_lower_point(model, zone, node)
    if (i > 0) jump = motion%displacement(1:3, i)
  end function jump

  !> Position of a node's point below an interface on the rank that owns it; 0: elsewhere or none.
  pure integer function owned_lower_point(model, zone, node) result(i)
    !> The model
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> Node
    integer, intent(in) :: node

    i = model%mesh%lower_point(node, zone)
    if (i > 0) i = model%distribution%local(i)
    if (i > model%distribution%owned) i = 0
  end function owned_lower_point

  !> Rates by Eq. 11 with its sign put right: node by node, the nodes shared by neighbouring segments
  !> averaged along the front, never across it; then the mean of each segment's three nodes.
  function two_state_rates(model, motion, zone, segments) result(modes)
    !> The model
    type(model_t), intent(in) :: model
    !> Motion
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> Zero, G, zero, (3, segments)
    real(wp), allocatable :: modes(:, :)
    real(wp) :: rates(3, size(segments))
    real(wp), allocatable :: strains(:), stiffness(:)
    integer :: s, line

    allocate (modes(3, size(segments)), source=0.0_wp)
    allocate (strains(96*size(segments)), stiffness(42*size(segments)), source=0.0_wp)
    call front_states(model, model%motion_of(motion%displacement), segments, front_elements(model, zone, segments), &
                      strains, stiffness)
    call model%communicator%sum(strains)
    call model%communicator%sum(stiffness)
    do s = 1, size(segments)
      associate (e => reshape(strains(96*s - 95:96*s), [8, 3, 2, 2]), c => reshape(stiffness(42*s - 41:42*s), [21, 2]))
        do line = 1, 3
          rates(line, s) = two_state_release(c, e(:, line, :, 1), e(:, line, :, 2))
        end do
      end associate
    end do
    call average_shared(segments, rates)
    do s = 1, size(segments)
      modes(2, s) = segment_mean(rates(:, s))
    end do
  end function two_state_rates

  !> Elements above and below the interface on the delaminated and the intact side of every segment, as this rank
  !> numbers them; 0: another rank has it.
  pure function front_elements(model, zone, segments) result(elements)
    !> The model
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> Elements, (2 layers, 2 sides, segments)
    integer :: elements(2, 2, size(segments))
    integer :: s, side, layer, cells(2)

    do s = 1, size(segments)
      cells = [model%mesh%cell_at(segments(s)%inside(1), segments(s)%inside(2)), &
               model%mesh%cell_at(segments(s)%outside(1), segments(s)%outside(2))]
      do side = 1, 2
        do layer = 1, 2
          elements(layer, side, s) = model%distribution%local_element( &
                                     model%mesh%element_at(cells(side), model%mesh%zones(zone)%below_ply + layer - 1))
        end do
      end do
    end do
  end function front_elements

  !> Strains of the elements along a front at the three nodes of their segments, and the stiffness of the layers on
  !> its intact side, or behind it where the zone ends and one layer follows; zero where another rank has the
  !> element. Every batch is computed once.
  subroutine front_states(model, field, segments, elements, strains, stiffness)
    !> The model
    type(model_t), intent(in) :: model
    !> Motion of every layer, (5, points)
    real(wp), intent(in) :: field(:, :)
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> Elements of this rank, layer by layer, side by side, segment by segment; 0: none
    integer, intent(in) :: elements(4*size(segments))
    !> Strains, zero on entry, (8 components, 3 nodes, elements)
    real(wp), intent(inout) :: strains(8, 3, size(elements))
    !> Stiffness, zero on entry, (21, 2 layers, segments)
    real(wp), intent(inout) :: stiffness(21, 2, size(segments))
    real(wp) :: at_nodes(lanes, 9, 8)
    integer :: batches(size(elements)), e, same, s, lane, line, nodes(9), layer, side

    batches = merge(1 + (elements - 1)/lanes, 0, elements > 0)
    do e = 1, size(elements)
      if (batches(e) == 0 .or. any(batches(:e - 1) == batches(e))) cycle
      call nodal_strains(model%elements, batches(e), model%scene%kinematics, field, at_nodes)
      do same = e, size(elements)
        if (batches(same) /= batches(e)) cycle
        s = 1 + (same - 1)/4
        lane = 1 + modulo(elements(same) - 1, lanes)
        nodes = model%mesh%cell_nodes(model%mesh%element_cell(model%distribution%elements(elements(same))))
        do line = 1, 3
          strains(:, line, same) = at_nodes(lane, findloc(nodes, segments(s)%edge(line), dim=1), :)
        end do
        layer = 1 + modulo(same - 1, 2)
        side = 1 + modulo(same - 1, 4)/2
        if (side == merge(1, 2, segments(s)%at_border)) stiffness(:, layer, s) = &
          model%elements%stiffness(lane, :, batches(e))
      end do
    end do
  end subroutine front_states

  !> Replaces the rates at nodes that segments share by their mean.
  pure subroutine average_shared(segments, rates)
    !> The front
    type(front_segment_t), intent(in) :: segments(:)
    !> Rate at each segment's three nodes, (3, segments)
    real(wp), intent(inout) :: rates(:, :)
    real(wp) :: smooth(3, size(segments)), total
    integer :: s, t, line, found, k

    smooth = rates
    do s = 1, size(segments)
      do line = 1, 3, 2
        total = 0
        found = 0
        do t = 1, size(segments)
          do k = 1, 3, 2
            if (segments(t)%edge(k) /= segments(s)%edge(line)) cycle
            total = total + rates(k, t)
            found = found + 1
          end do
        end do
        smooth(line, s) = total/found
      end do
    end do
    rates = smooth
  end subroutine average_shared
end module front_releases
