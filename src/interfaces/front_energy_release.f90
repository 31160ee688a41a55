!> Energy release rates along the fronts of a state.
module front_energy_release
  use kinds, only: wp
  use delamination_parameters, only: release_two_state
  use delamination_fronts, only: front_segment_t, find_front
  use virtual_crack_closure, only: vcct_release, over_outside_cells
  use front_smoothing, only: smoothed_along_front
  use benzeggagh_kenane, only: release_ratio
  use motions, only: motion_t
  use contact_and_ties, only: contact_and_ties_t
  use models, only: model_t
  use two_state_energy_release, only: two_state_rates
  implicit none
  private
  public :: front_energy_release_t, release_along_front

  !> The front of one zone and what it would release, the same on every rank.
  type :: front_energy_release_t
    !> The segments
    type(front_segment_t), allocatable :: segments(:)
    !> G_I, G_II, G_III of each segment; Eq. 11 gives no modes and stands in the second row, (3, segments)
    real(wp), allocatable :: modes(:, :)
    !> G over its critical value, of each segment
    real(wp), allocatable :: ratio(:)
  end type front_energy_release_t

contains

  !> Energy release rates along the front of a zone.
  function release_along_front(model, stiffness, faces, motion, zone, method) result(front)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Delaminated cells
    type(contact_and_ties_t), intent(in) :: faces
    !> Motion with its forces
    type(motion_t), intent(in) :: motion
    !> Index of the zone
    integer, intent(in) :: zone
    !> release_two_state or release_vcct
    integer, intent(in) :: method
    !> The front
    type(front_energy_release_t) :: front
    integer :: s

    front%segments = find_front(faces%regions(zone), model%mesh)
    if (method == release_two_state) then
      front%modes = two_state_rates(model, stiffness, motion, zone, front%segments)
    else
      front%modes = vcct_rates(model, motion, zone, front%segments)
    end if
    front%ratio = [(release_ratio(model%scene%delaminations(zone), front%modes(:, s)), s=1, size(front%segments))]
  end function release_along_front

  !> Rates by virtual crack closure, smoothed along the front, those of the edges into the same cell put together.
  function vcct_rates(model, motion, zone, segments) result(modes)
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
    modes = over_outside_cells(segments, smoothed_along_front(segments, model%thickness, &
      model%mesh%mirrored, modes))
  end function vcct_rates

  !> Force that holds the jump at a node, on the rank that owns it: external less internal and inertia forces.
  pure function tie_force(model, motion, zone, node) result(force)
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
    type(model_t), intent(in) :: model
    !> Index of the zone
    integer, intent(in) :: zone
    !> Node
    integer, intent(in) :: node

    i = model%mesh%lower_point(node, zone)
    if (i > 0) i = model%distribution%local(i)
    if (i > model%distribution%owned) i = 0
  end function owned_lower_point
end module front_energy_release
