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
  subroutine update_friction_limits(interfaces, model, displacement, updates, converged)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    class(composite_plate_t), intent(in) :: model
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Number of updates before convergence
    integer, intent(inout) :: updates
    !> False on return if it has not converged
    logical, intent(inout) :: converged
    type(cohesive_surfaces_t) :: surfaces
    real(wp) :: limit, largest(2)
    integer :: i

    if (.not. present_in(interfaces, model)) return
    largest = 0
    do i = 1, model%distribution%owned
      if (.not. interfaces%cohesive(i)) cycle
      surfaces = interfaces%surfaces_of(model, i)
      limit = surfaces%friction_limit(displacement(1:3, i), interfaces%points(i))
      associate (before => interfaces%points(i)%sliding%limit)
        largest = max(largest, [limit, abs(limit - before)])
        before = limit
      end associate
    end do
    if (model%setup%has_inertia()) return
    call model%communicator%maximum(largest)
    converged = converged .and. largest(2) <= limit_tolerance*largest(1)
    updates = updates + merge(1, 0, largest(2) > 0)
  end subroutine update_friction_limits

  !> True if any interface has friction.
  pure logical function present_in(interfaces, model)
    type(cohesive_interfaces_t), intent(in) :: interfaces
    class(composite_plate_t), intent(in) :: model

    present_in = allocated(interfaces%cohesive)
    if (present_in) present_in = any(model%setup%delaminations%friction > 0)
  end function present_in

  !> Frictional heat between two states, of the full plate, the same on every rank.
  real(wp) function heat_since(model, old, new) result(heat)
    class(composite_plate_t), intent(in) :: model
    !> The interfaces in both states
    type(cohesive_interfaces_t), intent(in) :: old, new

    heat = 0
    if (.not. present_in(new, model)) return
    associate (owned => model%distribution%owned)
      heat = model%mesh%multiplicity*total_of(model%communicator, model%contact_area(:owned) &
        *(new%points(:owned)%sliding%heat - old%points(:owned)%sliding%heat))
    end associate
  end function heat_since

  !> Saves or loads.
  subroutine visit_friction(interfaces, archive, model)
    type(cohesive_interfaces_t), intent(inout) :: interfaces
    class(archive_t), intent(inout) :: archive
    class(composite_plate_t), intent(in) :: model
    real(wp), allocatable :: fields(:, :)
    integer :: i

    if (.not. present_in(interfaces, model)) return
    allocate (fields(4, size(interfaces%points)))
    do i = 1, size(fields, 2)
      associate (sliding => interfaces%points(i)%sliding)
        fields(:, i) = [sliding%slip, sliding%limit, sliding%heat]
      end associate
    end do
    associate (partition => model%distribution)
      call archive%field('cohesive/sliding', partition%points(:partition%owned), model%mesh%points(), fields, &
                         vector_field)
    end associate
    if (.not. archive%loading) return
    interfaces%points%sliding%limit = fields(3, :)
    interfaces%points%sliding%heat = fields(4, :)
    do i = 1, size(fields, 2)
      interfaces%points(i)%sliding%slip = fields(1:2, i)
    end do
  end subroutine visit_friction
end module cohesive_sliding
