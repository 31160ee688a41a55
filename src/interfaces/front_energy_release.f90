!> Energy release rates along the fronts of a state.
module front_energy_release
  use kinds, only: wp
  use delamination_parameters, only: release_two_state, default_smoothing
  use delamination_fronts, only: front_segment_t, find_front
  use virtual_crack_closure, only: closure_moments, closure_rates, closure_figures, closure_odd
  use front_smoothing, only: smooth_front_t, near_front_t, create_smooth_front
  use benzeggagh_kenane, only: release_ratio
  use motions, only: motion_t
  use contact_and_ties, only: contact_and_ties_t
  use composite_plates, only: composite_plate_t
  use two_state_energy_release, only: two_state_rates
  implicit none
  private
  public :: front_energy_release_t, release_along_front, front_reach

  !> Front of a zone with its energy release rates, the same on every rank.
  type :: front_energy_release_t
    type(front_segment_t), allocatable :: segments(:)
    !> The smooth line through them
    type(smooth_front_t) :: line
    !> G_I, G_II, G_III of each segment, (3, segments); Eq. 11 gives no modes, its rate is in the second row
    real(wp), allocatable :: modes(:, :)
    !> G over its critical value, of each segment
    real(wp), allocatable :: ratio(:)
  end type front_energy_release_t

contains

  !> Energy release rates along the front of a zone.
  function release_along_front(plate, stiffness, contact, motion, zone, method) result(front)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Delaminated cells
    type(contact_and_ties_t), intent(in) :: contact
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: zone
    !> release_two_state or release_vcct
    integer, intent(in) :: method
    type(front_energy_release_t) :: front
    integer :: s

    front%segments = find_front(contact%regions(zone), plate%mesh)
    front%line = create_smooth_front(front%segments, plate%mesh)
    if (method == release_two_state) then
      front%modes = two_state_rates(plate, stiffness, motion, zone, front%segments)
    else
      front%modes = vcct_rates(plate, contact, motion, zone, front%segments, front%line)
    end if
    front%ratio = [(release_ratio(plate%setup%delaminations(zone), front%modes(:, s)), s=1, size(front%segments))]
  end function release_along_front

  !> Rates by virtual crack closure, from forces and jumps averaged along the front.
  function vcct_rates(plate, contact, motion, zone, segments, line) result(modes)
    type(composite_plate_t), intent(in) :: plate
    !> Delaminated cells
    type(contact_and_ties_t), intent(in) :: contact
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: zone
    type(front_segment_t), intent(in) :: segments(:)
    !> Its smooth line
    type(smooth_front_t), intent(in) :: line
    !> G_I, G_II, G_III, (3, segments)
    real(wp), allocatable :: modes(:, :)
    real(wp) :: figures(closure_figures + 2, size(segments)), sums(closure_figures + 2)
    logical :: odd(closure_figures + 2)
    integer :: s

    figures(:closure_figures, :) = moments_of(plate, contact, motion, zone, segments, line)
    figures(closure_figures + 1, :) = line%length
    figures(closure_figures + 2, :) = line%length*line%ahead
    odd = .false.
    odd(:closure_figures) = closure_odd
    allocate (modes(3, size(segments)), source=0.0_wp)
    do s = 1, size(segments)
      if (.not. line%length(s) > 0) cycle
      sums = line%means(s, front_reach(plate, zone), figures, odd)
      associate (length => sums(closure_figures + 1))
        modes(:, s) = closure_rates(sums(:closure_figures), length, sums(closure_figures + 2)/length)
      end associate
    end do
  end function vcct_rates

  !> Contributions of the nodes next to each segment to its crack closure integral. Collective.
  function moments_of(plate, contact, motion, zone, segments, line) result(figures)
    type(composite_plate_t), intent(in) :: plate
    !> Delaminated cells
    type(contact_and_ties_t), intent(in) :: contact
    type(motion_t), intent(in) :: motion
    integer, intent(in) :: zone
    type(front_segment_t), intent(in) :: segments(:)
    !> Its smooth line
    type(smooth_front_t), intent(in) :: line
    !> Sums over nodes, (quantities, segments)
    real(wp), allocatable :: figures(:, :)
    type(near_front_t) :: nodes
    real(wp) :: weight, force(3)
    integer :: i, k

    allocate (figures(closure_figures, size(segments)), source=0.0_wp)
    nodes = line%nodes_near(segments, plate%mesh)
    do k = 1, size(nodes%node)
      i = plate%mesh%lower_point(nodes%node(k), zone)
      if (i > 0) i = plate%distribution%local(i)
      if (i == 0 .or. i > plate%distribution%owned) cycle
      ! A node on a line of symmetry has half of its force, but the full jump.
      weight = product(merge(0.5_wp, 1.0_wp, plate%mesh%lines_of(nodes%node(k)) == 0 .and. plate%mesh%mirrored))
      ! External less internal and inertia forces, without reactions of a line of symmetry or an edge of the plate.
      force = -motion%internal(1:3, i) - motion%inertia(1:3, i)
      where (plate%constraints%fixed(1:3, plate%distribution%points(i))) force = 0
      associate (s => nodes%segment(k))
        figures(:, s) = figures(:, s) + nodes%share(k)*closure_moments(line%normal(:, s), nodes%distance(k), &
          line%ahead(s), line%behind(s), .not. contact%free(i), weight, force, motion%displacement(1:3, i))
      end associate
    end do
    call plate%communicator%sum(figures)
  end function moments_of

  !> Distance along a front over which forces and jumps are averaged.
  pure real(wp) function front_reach(plate, zone) result(reach)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: zone

    reach = plate%setup%delaminations(zone)%smoothing
    if (.not. reach > 0) reach = default_smoothing(plate%layup%thickness, plate%mesh%mean_cell(zone))
  end function front_reach
end module front_energy_release
