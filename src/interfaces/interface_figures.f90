!> Results of an interface: stage of failure, delaminated area and extents, dissipated energy.
module interface_figures
  use delamination_parameters, only: law_cohesive
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use mesh_parameters, only: symmetry_point
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: interface_figures_t, figures_of, stages_of

  !> Stage of failure of an interface beyond its starter: intact; a cohesive point softens; a point has failed or a cell
  !> has delaminated.
  integer, parameter, public :: stage_intact = 0, stage_damaged = 1, stage_grown = 2

  !> Bounds without delamination.
  real(wp), parameter :: empty_bound = -huge(empty_bound)

  !> Results of one interface of the full plate, the same on every rank.
  type :: interface_figures_t
    !> stage_intact, stage_damaged or stage_grown
    integer :: stage = stage_intact
    !> Delaminated area with the starter; with a cohesive law the area dissipated
    real(wp) :: area = 0
    !> Fracture energy
    real(wp) :: energy = 0
    !> Smallest and largest x, then y, of the delamination, from the plate's centre; all 0 without delamination
    real(wp) :: bounds(2, 2) = 0
  end type interface_figures_t

contains

  !> Results of all interfaces, in the order of the zones. Collective.
  function figures_of(plate, interfaces) result(figures)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> (zones)
    type(interface_figures_t) :: figures(size(plate%mesh%zones))
    real(wp) :: bounds(4, size(figures))
    integer :: zone, axis

    if (size(figures) == 0) return
    figures%stage = stages_of(plate, interfaces)
    figures%area = interfaces%contact%area(plate) + interfaces%cohesive%area(plate)
    figures%energy = interfaces%contact%fracture + interfaces%cohesive%energy(plate)
    bounds = bounds_of(plate, interfaces)
    do zone = 1, size(figures)
      if (any(bounds(:, zone) <= empty_bound)) cycle
      do axis = 1, 2
        associate (both => bounds(2*axis - 1:2*axis, zone))
          if (plate%mesh%mirrored(axis) .or. plate%setup%plate%symmetry == symmetry_point) both = maxval(both)
        end associate
      end do
      figures(zone)%bounds = reshape([-bounds(1, zone), bounds(2, zone), -bounds(3, zone), bounds(4, zone)], [2, 2])
    end do
  end function figures_of

  !> Stage of failure of each interface. Collective.
  function stages_of(plate, interfaces) result(stages)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> (zones)
    integer :: stages(size(plate%mesh%zones))
    real(wp) :: furthest(size(stages))
    integer :: i

    furthest = merge(stage_grown, stage_intact, interfaces%contact%fracture > 0)
    if (allocated(interfaces%cohesive%cohesive)) then
      do i = 1, plate%distribution%owned
        ! Starters are delaminated before the run.
        if (.not. interfaces%cohesive%cohesive(i) .or. interfaces%contact%free(i)) cycle
        associate (stage => furthest(plate%zone(i)), damage => interfaces%cohesive%points(i)%damage)
          if (damage > 0) stage = max(stage, real(merge(stage_grown, stage_damaged, damage >= 1), wp))
        end associate
      end do
      call plate%communicator%maximum(furthest)
    end if
    stages = nint(furthest)
  end function stages_of

  !> Largest -x, x, -y and y of the delamination in the modelled part: failed nodes of a cohesive law, entire cells
  !> where fronts release ties. Collective.
  function bounds_of(plate, interfaces) result(bounds)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> (4, zones); `empty_bound` without delamination
    real(wp) :: bounds(4, size(plate%mesh%zones))
    real(wp) :: all_bounds(size(bounds))
    integer :: i, zone

    bounds = empty_bound
    if (allocated(interfaces%cohesive%cohesive)) then
      do i = 1, plate%distribution%owned
        if (.not. interfaces%cohesive%cohesive(i)) cycle
        if (interfaces%cohesive%points(i)%damage < 1) cycle
        associate (place => plate%place_of(i))
          bounds(:, plate%zone(i)) = max(bounds(:, plate%zone(i)), [-place(1), place(1), -place(2), place(2)])
        end associate
      end do
    end if
    do zone = 1, size(plate%mesh%zones)
      if (plate%setup%delaminations(zone)%law /= law_cohesive) bounds(:, zone) = cell_bounds(plate, interfaces, zone)
    end do
    all_bounds = reshape(bounds, shape(all_bounds))
    call plate%communicator%maximum(all_bounds)
    bounds = reshape(all_bounds, shape(bounds))
  end function bounds_of

  !> Largest -x, x, -y and y of the delaminated cells of a zone.
  pure function cell_bounds(plate, interfaces, zone) result(bounds)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    integer, intent(in) :: zone
    !> `empty_bound` if there are none
    real(wp) :: bounds(4)
    integer :: i, j

    bounds = empty_bound
    associate (region => interfaces%contact%regions(zone), columns => plate%mesh%along(1), rows => plate%mesh%along(2))
      do j = region%rows(1), region%rows(2)
        do i = region%columns(1), region%columns(2)
          if (region%is_delaminated(i, j)) bounds = max(bounds, [[-1, 1]*columns%ends(i), [-1, 1]*rows%ends(j)])
        end do
      end do
    end associate
  end function cell_bounds
end module interface_figures
