!> Friction between the surfaces of cohesive interfaces: friction limits at their points, and frictional heat.
module cohesive_sliding
  use field_mappings, only: vector_field
  use kinds, only: wp
  use archives, only: archive_t
  use cohesive_surfaces, only: cohesive_surfaces_t
  use cohesive_interfaces, only: cohesive_interfaces_t
  use composite_plates, only: composite_plate_t
  use rank_totals, only: total_of
  implicit none
  private
  public :: heat_since, update_friction_limits, visit_friction

  !> Relative change of a friction limit at which load steps have converged: the usual tolerance of forces.
  real(wp), parameter :: limit_tolerance = 1.0e-6_wp

contains

  !> Updates the friction limits by pressures and damage. A time step uses the limits in the next step; a load step is
  !> repeated until the limits have converged.
  subroutine update_friction_limits(interfaces, plate, displacement, updates, converged)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> Number of updates before convergence
    integer, intent(inout) :: updates
    !> False on return if it has not converged
    logical, intent(inout) :: converged
    type(cohesive_surfaces_t) :: surfaces
    real(wp) :: limit, largest(2)
    integer :: i

    if (.not. present_in(interfaces, plate)) return
    largest = 0
    do i = 1, plate%distribution%owned
      if (.not. interfaces%cohesive(i)) cycle
      surfaces = interfaces%surfaces_of(plate, i)
      limit = surfaces%friction_limit(displacement(1:3, i), interfaces%points(i))
      associate (before => interfaces%points(i)%sliding%limit)
        largest = max(largest, [limit, abs(limit - before)])
        before = limit
      end associate
    end do
    if (plate%setup%has_inertia()) return
    call plate%communicator%maximum(largest)
    converged = converged .and. largest(2) <= limit_tolerance*largest(1)
    updates = updates + merge(1, 0, largest(2) > 0)
  end subroutine update_friction_limits

  !> True if any interface has friction.
  pure logical function present_in(interfaces, plate)
    type(cohesive_interfaces_t), intent(in) :: interfaces
    type(composite_plate_t), intent(in) :: plate

    present_in = allocated(interfaces%cohesive)
    if (present_in) present_in = any(plate%setup%delaminations%friction > 0)
  end function present_in

  !> Frictional heat between two states, of the full plate, the same on every rank.
  real(wp) function heat_since(plate, old, new) result(heat)
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces in both states
    type(cohesive_interfaces_t), intent(in) :: old, new

    heat = 0
    if (.not. present_in(new, plate)) return
    associate (owned => plate%distribution%owned)
      heat = plate%mesh%multiplicity*total_of(plate%communicator, plate%interfaces%contact_area(:owned) &
        *(new%points(:owned)%sliding%heat - old%points(:owned)%sliding%heat))
    end associate
  end function heat_since

  !> Saves or loads.
  subroutine visit_friction(interfaces, archive, plate)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: fields(:, :)
    integer :: i

    if (.not. present_in(interfaces, plate)) return
    allocate (fields(4, size(interfaces%points)))
    do i = 1, size(fields, 2)
      associate (sliding => interfaces%points(i)%sliding)
        fields(:, i) = [sliding%slip, sliding%limit, sliding%heat]
      end associate
    end do
    call plate%visit_points(archive, 'cohesive/sliding', fields, vector_field)
    if (.not. archive%loading) return
    interfaces%points%sliding%limit = fields(3, :)
    interfaces%points%sliding%heat = fields(4, :)
    do i = 1, size(fields, 2)
      interfaces%points(i)%sliding%slip = fields(1:2, i)
    end do
  end subroutine visit_friction
end module cohesive_sliding
