!> Growth of delaminations: cells that delaminate in a state, and their fracture energy.
module front_growth
  use kinds, only: wp
  use delamination_parameters, only: growth_one_per_step, growth_equilibrium, law_cohesive, unloading_glued
  use benzeggagh_kenane, only: critical_release_rate
  use front_energy_release, only: front_energy_release_t, release_along_front, front_reach
  use motions, only: motion_t
  use interface_states, only: interface_state_t
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: grow_fronts, find_release_ratio

  !> Segments whose ratio is within this fraction of the largest delaminate together, so that a symmetric front remains
  !> symmetric. With .9 and .99 histories are the same (doc/studies/solution_controls.md).
  real(wp), parameter :: together = 0.95_wp

contains

  !> Delaminates cells where the energy release rate exceeds its critical value.
  subroutine grow_fronts(plate, stiffness, motion, state, fracture, grown)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(motion_t), intent(in) :: motion
    !> The interfaces; receive new delaminated cells and the largest ratio
    type(interface_state_t), intent(inout) :: state
    !> Fracture energy of the full plate; that of the new surfaces is added
    real(wp), intent(inout) :: fracture
    !> True if cells delaminated
    logical, intent(out) :: grown
    type(front_energy_release_t) :: front
    integer :: zone

    grown = .false.
    state%release_ratio = 0
    state%growth_ratio = 0
    do zone = 1, size(plate%mesh%zones)
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      front = release_along_front(plate, stiffness, state%contact, motion, zone, &
                                  plate%setup%delaminations(zone)%energy_release)
      if (size(front%segments) == 0) cycle
      state%release_ratio = max(state%release_ratio, maxval(front%ratio))
      call release_cells(plate, state, zone, front, fracture, grown)
    end do
    if (grown) call open_faces(plate, motion, state)
  end subroutine grow_fronts

  !> Largest ratio of energy release rate to its critical value in a static analysis, where fronts do not grow.
  subroutine find_release_ratio(plate, stiffness, motion, state)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(motion_t), intent(in) :: motion
    !> The interfaces; receive the largest ratio
    type(interface_state_t), intent(inout) :: state
    type(front_energy_release_t) :: front
    integer :: zone

    state%release_ratio = 0
    do zone = 1, size(plate%mesh%zones)
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      front = release_along_front(plate, stiffness, state%contact, motion, zone, &
                                  plate%setup%delaminations(zone)%energy_release)
      if (size(front%segments) > 0) state%release_ratio = max(state%release_ratio, maxval(front%ratio))
    end do
  end subroutine find_release_ratio

  !> Delaminates the cells ahead of the most loaded segments of one front.
  subroutine release_cells(plate, state, zone, front, fracture, grown)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(inout) :: state
    integer, intent(in) :: zone
    type(front_energy_release_t), intent(in) :: front
    !> Fracture energy of the full plate; that of the new surfaces is added
    real(wp), intent(inout) :: fracture
    !> Set true if cells delaminated
    logical, intent(inout) :: grown
    real(wp) :: largest, enough, energy
    logical :: enters(size(front%segments))
    integer :: s, foremost

    ! At the border of the layers there is no tie force for virtual crack closure, so the rate cannot indicate that
    ! growth is blocked there.
    state%border_reached(zone) = state%border_reached(zone) .or. any(front%segments%at_border)
    foremost = maxloc(front%ratio, mask=.not. front%segments%at_border, dim=1)
    ! A delamination that fills its zone has no front except the border; glued surfaces cannot delaminate.
    if (foremost == 0) return
    if (state%contact%glued .and. plate%setup%delaminations(zone)%unloading == unloading_glued) return
    largest = front%ratio(foremost)
    state%growth_ratio = max(state%growth_ratio, largest)
    if (.not. largest > 1) return
    enough = max(1.0_wp, together*largest)
    if (plate%setup%delaminations(zone)%growth == growth_one_per_step) enough = largest
    enters = .not. front%segments%at_border .and. front%ratio >= enough
    if (plate%setup%delaminations(zone)%growth == growth_equilibrium) &
      enters = enters .and. closest_to_front(front, enters, front_reach(plate, zone))
    do s = 1, size(front%segments)
      associate (segment => front%segments(s), region => state%contact%regions(zone))
        if (.not. enters(s)) cycle
        if (region%is_delaminated(segment%outside(1), segment%outside(2))) cycle
        call region%release(segment%outside)
        energy = critical_release_rate(plate%setup%delaminations(zone), front%modes(:, s)) &
                 *plate%mesh%cell_area(segment%outside)*plate%mesh%multiplicity
        fracture = fracture + energy
        state%contact%fracture(zone) = state%contact%fracture(zone) + energy
        grown = .true.
        if (plate%setup%delaminations(zone)%growth == growth_one_per_step) return
      end associate
    end do
  end subroutine release_cells

  !> Of the candidate cells within the averaging length, those whose centre is closest to the front: a rate averaged
  !> over that length cannot distinguish between them.
  pure function closest_to_front(front, open, reach) result(first)
    type(front_energy_release_t), intent(in) :: front
    !> True for segments with candidate cells
    logical, intent(in) :: open(:)
    !> The averaging length
    real(wp), intent(in) :: reach
    !> True for the closest ones
    logical :: first(size(open))
    !> Tolerance of equal distances, relative to a cell: far above round-off, 1e-16, and far below the differences of
    !> distances, which are parts of a cell.
    real(wp), parameter :: distance_tolerance = 1.0e-6_wp
    integer :: s, t, image

    first = open
    do s = 1, size(open)
      if (.not. open(s)) cycle
      do t = 1, size(open)
        if (.not. open(t) .or. front%line%offset(t) > front%line%offset(s) &
            - distance_tolerance*front%line%ahead(s)) cycle
        if (any([(front%line%weight(s, t, image, reach) > 0, image=0, 3)])) first(s) = .false.
      end do
    end do
  end function closest_to_front

  !> Releases the jumps of the new delamination; surfaces under pressure start in contact.
  subroutine open_faces(plate, motion, state)
    type(composite_plate_t), intent(in) :: plate
    type(motion_t), intent(in) :: motion
    type(interface_state_t), intent(inout) :: state
    logical, allocatable :: before(:)
    integer :: i

    before = state%contact%free
    call state%contact%free_jumps(plate)
    do i = 1, plate%distribution%owned
      if (before(i) .or. .not. state%contact%free(i)) cycle
      state%contact%multiplier(i) = max(0.0_wp, (motion%internal(3, i) + motion%inertia(3, i)) &
                                           /plate%interfaces%contact_area(i))
    end do
  end subroutine open_faces
end module front_growth
