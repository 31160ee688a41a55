!> Delaminated areas in projection, as in a C-scan: interfaces above each other count once, where the point of the node
!> that is damaged most decides. They differ in what counts as delaminated.
module projected_areas
  use delamination_parameters, only: law_cohesive
  use exact_sums, only: exact_sum_t
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use load_vectors, only: add_patch_weights
  use composite_plates, only: composite_plate_t
  use rank_totals, only: totals_of
  implicit none
  private
  public :: projected_areas_of

  !> Rules: dissipated fraction of the toughness; failed points; softened points, which include the process zones. With
  !> fronts all three have the delaminated cells.
  integer, parameter, public :: area_dissipated = 1, area_failed = 2, area_softened = 3, area_rules = 3
  !> Damage from which a point has failed or softened: relative loss of the stiffness.
  real(wp), parameter :: failed_from = 0.99_wp, softened_from = 0.5_wp
  !> The first rule in words.
  character(len=*), parameter, public :: projected_rule = &
    'each point counts with the largest dissipated fraction of the toughness of all interfaces'

contains

  !> Areas of the full plate by all rules: sums of nodal areas times the largest fraction of all interfaces at the node.
  !> All points of a node belong to one rank, so that only the sums are collective.
  function projected_areas_of(plate, interfaces) result(areas)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> In the order of the rules
    real(wp) :: areas(area_rules)
    type(exact_sum_t) :: sums(area_rules)
    real(wp), allocatable :: points(:, :)
    real(wp) :: largest(area_rules)
    integer :: i, rule

    areas = 0
    if (.not. plate%map%layered) return
    points = areas_of_points(plate, interfaces)
    largest = 0
    do i = 1, plate%distribution%owned
      largest = max(largest, points(:, i))
      if (i < plate%distribution%owned) then
        if (node_of(i + 1) == node_of(i)) cycle
      end if
      do rule = 1, area_rules
        call sums(rule)%add(largest(rule))
      end do
      largest = 0
    end do
    areas = totals_of(plate%communicator, sums)*plate%mesh%multiplicity

  contains

    !> Node of a point of this rank.
    pure integer function node_of(i)
      integer, intent(in) :: i

      node_of = plate%mesh%point_node(plate%distribution%points(i))
    end function node_of
  end function projected_areas_of

  !> Delaminated area of each point by all rules. Collective.
  function areas_of_points(plate, interfaces) result(areas)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> (rules, local points); at the border of a zone a point of the joined layers has its part
    real(wp) :: areas(area_rules, size(plate%zone))
    real(wp) :: fractions(area_rules, size(plate%zone)), damage(size(plate%zone))
    integer :: i

    areas = 0
    if (any(plate%setup%delaminations%law /= law_cohesive)) &
      areas = spread(areas_of_fronts(plate, interfaces), 1, area_rules)
    ! A point has the cohesive interface below it only.
    damage = interfaces%cohesive%damage(plate)
    fractions(area_dissipated, :) = interfaces%cohesive%dissipated_fractions(plate)
    fractions(area_failed, :) = merge(1.0_wp, 0.0_wp, damage >= failed_from)
    fractions(area_softened, :) = merge(1.0_wp, 0.0_wp, damage >= softened_from)
    do i = 1, plate%distribution%owned
      if (plate%zone(i) > 0) areas(:, i) = max(areas(:, i), fractions(:, i)*plate%interfaces%contact_area(i))
    end do
  end function areas_of_points

  !> Largest part of delaminated cells at each point, of all zones in which fronts release ties. Collective.
  function areas_of_fronts(plate, interfaces) result(areas)
    type(composite_plate_t), intent(in) :: plate
    type(interface_state_t), intent(in) :: interfaces
    !> (local points)
    real(wp) :: areas(size(plate%zone))
    real(wp) :: field(1, plate%borders%columns)
    integer :: zone, i

    areas = 0
    do zone = 1, size(plate%mesh%zones)
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      field = 0
      call add_patch_weights(plate%elements, pack([(i, i=1, plate%elements%elements)], &
                                                  [(in_delaminated_cell(i), i=1, plate%elements%elements)]), &
                             field(1, :))
      call plate%borders%add(field)
      areas = max(areas, field(1, :size(areas)))
    end do

  contains

    !> True: an element lies below a delaminated cell of the zone.
    logical function in_delaminated_cell(i)
      !> Number of the element on this rank
      integer, intent(in) :: i
      integer :: place(2)

      associate (mesh => plate%mesh, element => plate%distribution%elements(i))
        in_delaminated_cell = mesh%is_below(element, zone)
        if (.not. in_delaminated_cell) return
        place = mesh%place_of(mesh%element_cell(element))
        in_delaminated_cell = interfaces%contact%regions(zone)%is_delaminated(place(1), place(2))
      end associate
    end function in_delaminated_cell
  end function areas_of_fronts
end module projected_areas
