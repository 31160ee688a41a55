!> Tied, open and closed surfaces: forces of ties and contact on the jumps.
!>
!> The pressure is constant over a step, and complementarity is required at its end. The work of contact is then minus
!> the pressure times the gap that closed: contact never creates energy, with any integrator of the plate.
module contact_and_ties
  use field_mappings, only: area_field
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: contact_augmented_lagrangian
  use interface_ties, only: interface_ties_t, create_interface_ties, tie_stiffness, connection_exact, &
                            connection_penalty, connection_contact
  use surface_contact, only: contact_pressure, contact_residual, updated_decay, updated_multiplier
  use composite_plates, only: composite_plate_t
  implicit none
  private
  public :: contact_and_ties_t, new_contact_and_ties

  !> State of all interfaces: their connections, and the contact pressure.
  type, extends(interface_ties_t) :: contact_and_ties_t
    !> Multiplier of the augmented Lagrangian and contact pressure, (local points)
    real(wp), allocatable :: multiplier(:), pressure(:)
    !> Derivative of the pressure with respect to the gap, not positive, (local points)
    real(wp), allocatable :: slope(:)
    !> Decay of the pressure with an open gap (beta of Eq. 12), 1/length, (zones), the same on every rank
    real(wp), allocatable :: decay(:)
    !> Largest pressure so far
    real(wp) :: peak = 0
  contains
    procedure :: add_to_residual
    procedure :: update_contact
    procedure :: complementarity
    procedure :: work
    procedure :: keep_contact_closed
    procedure :: added_stiffness
    procedure :: visit
  end type contact_and_ties_t

  !> Penalty of a tied jump relative to the diagonal of the operator: stiff enough for five digits in a preconditioner,
  !> soft enough for the tie to be released without a new factorization. A factor of ten either way changes the cost by
  !> up to 3 % (doc/studies/solution_controls.md).
  real(wp), parameter, public :: held_stiffness = 1.0e5_wp

contains

  !> All interfaces with their starters.
  pure function new_contact_and_ties(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(contact_and_ties_t) :: self
    integer :: points

    call create_interface_ties(plate, self)
    allocate (self%decay(size(self%regions)), source=0.0_wp)
    if (.not. plate%map%layered) return
    points = size(plate%zone)
    allocate (self%multiplier(points), self%pressure(points), self%slope(points), source=0.0_wp)
  end function new_contact_and_ties

  !> Adds contact and penalty forces to a residual and removes the residual of tied jumps.
  subroutine add_to_residual(self, plate, displacement, residual)
    !> The state; receives pressures and slopes
    class(contact_and_ties_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    real(wp), intent(inout) :: residual(:, :)
    integer :: i

    if (.not. plate%map%layered) return
    do i = 1, plate%distribution%owned
      associate (zone => plate%zone(i))
        if (zone == 0) cycle
        self%pressure(i) = 0
        self%slope(i) = 0
        select case (self%connection(plate, i))
        case (connection_exact)
          residual(1:3, i) = 0
        case (connection_contact)
          call contact_pressure(plate%interfaces%contact_laws(zone), self%decay(zone), displacement(3, i), &
                                self%multiplier(i), self%pressure(i), self%slope(i))
        end select
        residual(1:3, i) = residual(1:3, i) + force(self, plate, i, displacement(1:3, i))
      end associate
    end do
  end subroutine add_to_residual

  !> Force of contact or a penalty tie on the jumps at a point. Pressures are those of the last residual.
  pure function force(self, plate, i, jumps)
    type(contact_and_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: i
    real(wp), intent(in) :: jumps(3)
    real(wp) :: force(3)

    force = 0
    select case (self%connection(plate, i))
    case (connection_penalty)
      force = -tie_stiffness(plate, i)*jumps
    case (connection_contact)
      force(3) = plate%interfaces%contact_area(i)*self%pressure(i)
    end select
  end function force

  !> Updates the multipliers by the pressures found, which have converged once they are consistent with the gaps.
  subroutine update_contact(self, plate, displacement, tolerance, updates, converged)
    class(contact_and_ties_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> Tolerance of complementarity
    real(wp), intent(in) :: tolerance
    !> Number of updates before convergence
    integer, intent(inout) :: updates
    !> True if they have
    logical, intent(out) :: converged
    real(wp) :: mismatch

    mismatch = self%complementarity(plate, displacement)
    converged = mismatch <= tolerance
    call update_multipliers(self, plate, displacement, converged)
    updates = updates + merge(1, 0, mismatch > 0)
  end subroutine update_contact

  !> Sets the multipliers to the pressures of the last residual, and updates the decay by the gaps.
  subroutine update_multipliers(self, plate, displacement, converged)
    type(contact_and_ties_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> True: the pressures agree with the gaps, the step has converged
    logical, intent(in) :: converged
    real(wp) :: sums(2, size(self%decay)), largest(size(self%decay))
    integer, allocatable :: points(:), zones(:)
    real(wp), allocatable :: gaps(:), forces(:)
    integer :: zone

    if (.not. plate%map%layered) return
    points = self%in_contact(plate)
    zones = plate%zone(points)
    gaps = displacement(3, points)
    forces = plate%interfaces%contact_area(points)*self%pressure(points)
    do zone = 1, size(largest)
      sums(:, zone) = [sum(forces*abs(gaps), mask=zones == zone), sum(forces, mask=zones == zone)]
      largest(zone) = maxval([0.0_wp, self%pressure(pack(points, zones == zone))])
      call plate%communicator%sum(sums(:, zone))
      call plate%communicator%maximum(largest(zone))
    end do
    self%multiplier(points) = updated_multiplier(plate%interfaces%contact_laws(zones), gaps, self%pressure(points))
    self%decay = updated_decay(plate%interfaces%contact_laws, sums(1, :), sums(2, :), largest, converged)
    self%peak = max(self%peak, maxval(largest))
  end subroutine update_multipliers

  !> Violation of complementarity: pressure on open surfaces or negative pressure, relative to the largest pressure so
  !> far. The same on every rank.
  real(wp) function complementarity(self, plate, displacement)
    class(contact_and_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    integer, allocatable :: points(:)
    real(wp) :: peak

    complementarity = 0
    if (.not. plate%map%layered) return
    points = self%in_contact(plate)
    peak = maxval([self%peak, self%pressure(points)])
    complementarity = maxval([0.0_wp, contact_residual(plate%interfaces%contact_laws(plate%zone(points)), &
                                                       displacement(3, points), self%pressure(points))])
    call plate%communicator%maximum(complementarity)
    call plate%communicator%maximum(peak)
    if (peak > 0) then
      complementarity = complementarity/peak
    else
      complementarity = 0
    end if
  end function complementarity

  !> Work of contact and penalty ties in a step, of this rank's points.
  pure real(wp) function work(self, plate, displacement, change)
    class(contact_and_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Unknowns at the end of the step and their change, (5, points)
    real(wp), intent(in) :: displacement(:, :), change(:, :)
    integer :: i

    work = 0
    do i = 1, plate%distribution%owned
      work = work + dot_product(force(self, plate, i, displacement(1:3, i)), change(1:3, i))
    end do
  end function work

  !> Keeps closed contacts closed in the predictor, and open ones from penetrating: the stiff law would turn small
  !> errors of the predictor into large pressures.
  subroutine keep_contact_closed(self, plate, guess)
    class(contact_and_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Predictor of the unknowns at its end, (5, points)
    real(wp), intent(inout) :: guess(:, :)
    integer, allocatable :: points(:)

    if (.not. plate%map%layered) return
    ! Pressures are known only on the rank that owns a point.
    points = self%in_contact(plate)
    guess(3, points) = merge(0.0_wp, max(0.0_wp, guess(3, points)), self%multiplier(points) > 0)
    call plate%halo%update(guess)
  end subroutine keep_contact_closed

  !> Stiffness that ties and contact add to the diagonal of the operator.
  pure subroutine added_stiffness(self, plate, diagonal, added)
    class(contact_and_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Diagonal of the operator without it, (5, points)
    real(wp), intent(in) :: diagonal(:, :)
    !> Stiffness added to the three jumps, (3, points); ghosts zero
    real(wp), intent(out) :: added(:, :)
    integer :: i

    added = 0
    do i = 1, plate%distribution%owned
      select case (self%connection(plate, i))
      case (connection_exact)
        added(:, i) = held_stiffness*maxval(diagonal(1:3, i))
        added(3, i) = tie_like_contact(i)
      case (connection_penalty)
        added(:, i) = tie_stiffness(plate, i)
      case (connection_contact)
        added(3, i) = -plate%interfaces%contact_area(i)*self%slope(i)
      end select
    end do

  contains

    !> Penalty of a tied opening: the contact stiffness if that is as large, so that the release of surfaces under
    !> pressure does not change the operator.
    pure real(wp) function tie_like_contact(i) result(stiffness)
      integer, intent(in) :: i

      stiffness = added(3, i)
      associate (law => plate%interfaces%contact_laws(plate%zone(i)))
        if (law%method /= contact_augmented_lagrangian) return
        if (plate%interfaces%contact_area(i)*law%stiffness >= held_stiffness*diagonal(3, i)) &
          stiffness = plate%interfaces%contact_area(i)*law%stiffness
      end associate
    end function tie_like_contact
  end subroutine added_stiffness

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(contact_and_ties_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: fields(:, :)

    call self%interface_ties_t%visit(archive, plate)
    if (.not. plate%map%layered) return
    call archive%item('faces/peak', self%peak)
    call archive%item('faces/decay', self%decay)
    allocate (fields(3, size(self%free)))
    fields(1, :) = self%multiplier
    fields(2, :) = self%pressure
    fields(3, :) = self%slope
    call plate%visit_points(archive, 'faces/pressures', fields, area_field)
    if (.not. archive%loading) return
    self%multiplier = fields(1, :)
    self%pressure = fields(2, :)
    self%slope = fields(3, :)
  end subroutine visit
end module contact_and_ties
