!> Released ties: their forces are ramped down, and the energy released is summed.
!>
!> Sudden removal of a tie would excite vibrations: the energy would remain as kinetic energy, and the shorter the
!> steps, the less of it would appear as work against the tie. The force is therefore ramped down linearly in time,
!> while a shear wave crosses a few elements, or within one step if that is longer. The work against it is the energy
!> released.
module tie_release
  use field_mappings, only: vector_field
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: contact_none
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: tie_release_t, new_tie_release

  !> Forces of released ties, and the energy that they release.
  type :: tie_release_t
    !> Forces on the jumps when the ties were released, (3, local points)
    real(wp), allocatable :: force(:, :)
    !> Remaining fraction of these forces, (local points)
    real(wp), allocatable :: remaining(:)
    !> Duration of the ramp, (zones)
    real(wp), allocatable :: duration(:)
    !> Energy released by released ties, full plate, (zones)
    real(wp), allocatable :: set_free(:)
    !> Time until the last of them is zero, the same on every rank
    real(wp) :: left = 0
  contains
    procedure :: release
    procedure :: first_opening
    procedure :: ramp_down
    procedure :: add_to_residual
    procedure :: record
    procedure :: visit
  end type tie_release_t

contains

  !> No tie has been released.
  pure function new_tie_release(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(tie_release_t) :: self
    !> Number of elements that a shear wave crosses while the force of a released tie decreases to zero. With 10 the
    !> energy released is the same within a few per cent for all shorter steps. With 5 and 20 the force history changes
    !> by up to 8 and 5 % of its peak (doc/studies/solution_controls.md).
    real(wp), parameter :: elements_crossed = 10
    real(wp) :: slowness
    integer :: points, zones, zone, i

    zones = size(plate%mesh%zones)
    allocate (self%set_free(zones), self%duration(zones), source=0.0_wp)
    if (.not. plate%map%layered) return
    points = size(plate%zone)
    allocate (self%force(3, points), self%remaining(points), source=0.0_wp)
    slowness = 0
    do i = 1, size(plate%layup%laminates)
      associate (plies => plate%layup%laminates(i)%plies)
        slowness = max(slowness, sqrt(minval(plies%density/max(plies%elasticity%g13, plies%elasticity%g23))))
      end associate
    end do
    do zone = 1, zones
      self%duration(zone) = elements_crossed*plate%mesh%mean_cell(zone)*slowness
    end do
  end function new_tie_release

  !> Releases the ties whose jumps have become free. Where surfaces are under pressure, contact, if it is modelled,
  !> carries the normal force at once, so that only the shear forces are ramped down.
  pure subroutine release(self, plate, free_before, free, forces)
    class(tie_release_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> True where jumps were free and where they are now, (local points)
    logical, intent(in) :: free_before(:), free(:)
    !> Forces that held the jumps, (3, local points)
    real(wp), intent(in) :: forces(:, :)
    integer :: i

    do i = 1, plate%distribution%owned
      if (free_before(i) .or. .not. free(i)) cycle
      self%force(:, i) = forces(:, i)
      if (plate%setup%delaminations(plate%zone(i))%contact /= contact_none) self%force(3, i) = min(0.0_wp, forces(3, i))
      self%remaining(i) = 1
    end do
    self%left = maxval(self%duration)
  end subroutine release

  !> Energy released by the first opening of newly released ties, after the step was repeated without them. Opening by
  !> cells released later in the same step is attributed to these.
  function first_opening(self, plate, free_before, free, opening) result(energy)
    !> The ties at the end of the step
    class(tie_release_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> True where jumps were free and where they are now, (local points)
    logical, intent(in) :: free_before(:), free(:)
    !> Jumps, (5, points)
    real(wp), intent(in) :: opening(:, :)
    !> The energy, of the full plate, (zones)
    real(wp) :: energy(size(self%set_free))
    integer :: i

    energy = 0
    do i = 1, plate%distribution%owned
      if (free_before(i) .or. .not. free(i)) cycle
      associate (zone => plate%zone(i))
        energy(zone) = energy(zone) - (1 - self%remaining(i))/2*dot_product(self%force(:, i), opening(1:3, i))
      end associate
    end do
    call plate%communicator%sum(energy)
    energy = energy*plate%mesh%multiplicity
  end function first_opening

  !> Reduces the forces over a step.
  pure subroutine ramp_down(self, plate, step)
    class(tie_release_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: step
    integer :: i

    if (.not. self%left > 0) return
    do i = 1, plate%distribution%owned
      if (.not. self%remaining(i) > 0) cycle
      associate (duration => self%duration(plate%zone(i)))
        if (step < self%remaining(i)*duration) then
          self%remaining(i) = self%remaining(i) - step/duration
        else
          self%remaining(i) = 0
        end if
      end associate
    end do
    self%left = max(0.0_wp, self%left - step)
    if (.not. self%left > 0) self%remaining = 0
  end subroutine ramp_down

  !> Adds the forces to a residual.
  pure subroutine add_to_residual(self, plate, residual)
    class(tie_release_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(inout) :: residual(:, :)
    integer :: i

    if (.not. self%left > 0) return
    do i = 1, plate%distribution%owned
      if (self%remaining(i) > 0) residual(1:3, i) = residual(1:3, i) + self%remaining(i)*self%force(:, i)
    end do
  end subroutine add_to_residual

  !> Records the work against the forces in a step: that of the step with the force at its end, and the energy released
  !> with the mean of the forces at its start and end. For ties released in this step the difference is that of
  !> `first_opening`.
  subroutine record(self, plate, old, change, taken)
    !> The ties at the end of the step
    class(tie_release_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The ties at its start
    type(tie_release_t), intent(in) :: old
    !> Change of the unknowns, (5, points)
    real(wp), intent(in) :: change(:, :)
    !> Energy extracted from the full plate by the forces
    real(wp), intent(out) :: taken
    real(wp) :: sums(size(self%set_free) + 1), work, mean
    integer :: i

    taken = 0
    if (.not. old%left > 0) return
    sums = 0
    do i = 1, plate%distribution%owned
      if (.not. old%remaining(i) > 0) cycle
      work = -dot_product(self%force(:, i), change(1:3, i))
      sums(1) = sums(1) + self%remaining(i)*work
      mean = (old%remaining(i) + self%remaining(i))/2
      if (old%remaining(i) >= 1) mean = self%remaining(i)
      sums(1 + plate%zone(i)) = sums(1 + plate%zone(i)) + mean*work
    end do
    call plate%communicator%sum(sums)
    sums = sums*plate%mesh%multiplicity
    taken = sums(1)
    self%set_free = self%set_free + sums(2:)
  end subroutine record

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(tie_release_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: fields(:, :)

    if (.not. plate%map%layered) return
    call archive%item('ties/set_free', self%set_free)
    call archive%item('ties/left', self%left)
    allocate (fields(4, size(self%remaining)))
    fields(:3, :) = self%force
    fields(4, :) = self%remaining
    call plate%visit_points(archive, 'ties/forces', fields, vector_field)
    if (.not. archive%loading) return
    self%force = fields(:3, :)
    self%remaining = fields(4, :)
  end subroutine visit
end module tie_release
