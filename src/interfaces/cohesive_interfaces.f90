!> Cohesive interfaces: tractions between layers, damage and dissipated energy.
!>
!> Tractions act at nodal points as internal forces on the jumps. Closing surfaces touch by the penalty stiffness of the
!> undamaged interface, independent of the damage: contact is conservative, and the factored operator does not change
!> where undamaged surfaces change between pressure and tension.
module cohesive_interfaces
  use field_mappings, only: area_field
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: law_cohesive, contact_none
  use cohesive_laws, only: cohesive_law_t, stiffness_of, weakened
  use cohesive_surfaces, only: cohesive_surfaces_t
  use cohesive_points, only: cohesive_point_t, dissipated_fraction, mode_mixture
  use cohesive_tangents, only: dissipation_slopes
  use exact_sums, only: exact_sum_t
  use composite_plates, only: composite_plate_t
  use rank_totals, only: total_of, totals_of
  implicit none
  private
  public :: cohesive_interfaces_t, new_cohesive_interfaces, prevents_penetration

  !> Factor of the toughness of interfaces whose damage is held: no jump of a plate has so much energy.
  real(wp), parameter :: unreached = 1.0e30_wp

  !> Points of all cohesive interfaces.
  type :: cohesive_interfaces_t
    !> True for this rank's points with a cohesive law, (local points); unallocated: there are none
    logical, allocatable :: cohesive(:)
    !> Damage and dissipated energy per area of each point, (local points)
    type(cohesive_point_t), allocatable :: points(:)
    !> Factor of the strengths at each point, of flaws and of onset by energy, and factor of the stiffness of opening
    !> after an onset by energy, (local points)
    real(wp), allocatable :: strength(:), opening(:)
    !> True at points whose law was reduced by an onset by energy, (local points)
    logical, allocatable :: by_energy(:)
    !> True: damage does not grow
    logical :: is_held = .false.
    !> Stiffness of the jumps for the factored operator, (3, local points)
    real(wp), allocatable :: stiffness(:, :)
    !> Consistent tangents, used in load steps instead, unsymmetric, (3, 3, local points)
    real(wp), allocatable :: tangents(:, :, :)
  contains
    procedure :: add_forces
    procedure :: tangents_at
    procedure :: dissipation
    procedure :: add_dissipation_slopes
    procedure :: area
    procedure :: energy => dissipated_energy
    !> Damage, dissipated fraction of the toughness, fraction of shear, and pressure at the points.
    procedure :: damage
    procedure :: dissipated_fractions
    procedure :: shear_share
    procedure :: pressure
    procedure :: border_reached
    procedure :: surfaces_of
    procedure :: law_at
    procedure :: visit
  end type cohesive_interfaces_t

contains

  !> All cohesive interfaces, failed within their starters.
  pure function new_cohesive_interfaces(plate, free) result(self)
    type(composite_plate_t), intent(in) :: plate
    !> True for jumps released by starters, (local points)
    logical, intent(in) :: free(:)
    type(cohesive_interfaces_t) :: self
    integer :: i

    if (.not. plate%map%layered) return
    if (.not. any(plate%setup%delaminations%law == law_cohesive)) return
    allocate (self%cohesive(size(plate%zone)), source=.false.)
    allocate (self%points(size(plate%zone)))
    allocate (self%strength(size(plate%zone)), self%opening(size(plate%zone)), source=1.0_wp)
    allocate (self%by_energy(size(plate%zone)), source=.false.)
    allocate (self%stiffness(3, size(plate%zone)), source=0.0_wp)
    if (.not. plate%setup%has_inertia()) allocate (self%tangents(3, 3, size(plate%zone)), source=0.0_wp)
    do i = 1, size(plate%zone)
      if (plate%zone(i) == 0) cycle
      self%cohesive(i) = plate%setup%delaminations(plate%zone(i))%law == law_cohesive
      if (.not. self%cohesive(i)) cycle
      if (free(i)) self%points(i)%damage = 1
      self%stiffness(:, i) = (1 - self%points(i)%damage)*plate%interfaces%contact_area(i) &
                             *stiffness_of(plate%interfaces%cohesive_laws(plate%zone(i)))
    end do
  end function new_cohesive_interfaces

  !> Adds the forces of the tractions on the jumps, and updates the history variables of the trial state.
  pure subroutine add_forces(self, plate, old, displacement, force, energy)
    class(cohesive_interfaces_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: old
    real(wp), intent(in) :: displacement(:, :)
    !> Internal forces at the owned points, (5, points)
    real(wp), intent(inout) :: force(:, :)
    !> Strain energy of this rank; that stored by the points is added
    real(wp), intent(inout) :: energy
    type(cohesive_surfaces_t) :: surfaces
    type(cohesive_point_t) :: start
    real(wp) :: traction(3)
    integer :: i, k

    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      surfaces = self%surfaces_of(plate, i)
      associate (jumps => displacement(1:3, i), area => plate%interfaces%contact_area(i))
        start = old%points(i)
        start%sliding%limit = self%points(i)%sliding%limit
        call surfaces%traction(jumps, start, traction, self%points(i))
        self%stiffness(:, i) = area*surfaces%diagonal(jumps, start)
        energy = energy + area*surfaces%stored(jumps, self%points(i))
        if (allocated(self%tangents)) then
          self%tangents(:, :, i) = area*surfaces%slopes(jumps, start)
          self%stiffness(:, i) = [(self%tangents(k, k, i), k=1, 3)]
        end if
        force(1:3, i) = force(1:3, i) + area*traction
      end associate
    end do
  end subroutine add_forces

  !> Consistent tangents: derivatives of the forces by the jumps at this rank's points, unsymmetric where damage grows
  !> in a mixed mode.
  pure function tangents_at(self, plate, old, displacement) result(tangents)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: old
    real(wp), intent(in) :: displacement(:, :)
    !> Force per jump, (3, 3, owned points); zero where there is no cohesive law
    real(wp), allocatable :: tangents(:, :, :)
    type(cohesive_surfaces_t) :: surfaces
    type(cohesive_point_t) :: start
    integer :: i

    allocate (tangents(3, 3, plate%distribution%owned), source=0.0_wp)
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      surfaces = self%surfaces_of(plate, i)
      start = old%points(i)
      start%sliding%limit = self%points(i)%sliding%limit
      tangents(:, :, i) = plate%interfaces%contact_area(i)*surfaces%slopes(displacement(1:3, i), start)
    end do
  end function tangents_at

  !> Adds the derivative of the dissipated energy of this rank's points with respect to the unknowns.
  pure subroutine add_dissipation_slopes(self, plate, old, displacement, slopes)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    type(cohesive_interfaces_t), intent(in) :: old
    real(wp), intent(in) :: displacement(:, :)
    !> Derivative with respect to the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: slopes(:, :)
    integer :: i

    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (self%cohesive(i)) slopes(1:3, i) = slopes(1:3, i) + plate%interfaces%contact_area(i) &
        *dissipation_slopes(self%law_at(plate, i), displacement(1:3, i), old%points(i))
    end do
  end subroutine add_dissipation_slopes

  !> Energy dissipated since an earlier state, of the full plate, the same on every rank.
  real(wp) function dissipation(self, plate, old) result(energy)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The interfaces in the earlier state
    type(cohesive_interfaces_t), intent(in) :: old

    energy = 0
    if (.not. allocated(self%cohesive)) return
    associate (owned => plate%distribution%owned)
      energy = plate%mesh%multiplicity*total_of(plate%communicator, plate%interfaces%contact_area(:owned) &
        *(self%points(:owned)%dissipated - old%points(:owned)%dissipated))
    end associate
  end function dissipation

  !> Area dissipated in each zone of the full plate: sum of the points' areas times the dissipated fraction of their
  !> toughness. The same on every rank.
  function area(self, plate)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The area, (zones); zero for zones without a cohesive law
    real(wp) :: area(size(plate%mesh%zones))

    area = total_in_zones(self, plate, self%dissipated_fractions(plate))
  end function area

  !> Energy dissipated in each zone of the full plate, the same on every rank.
  function dissipated_energy(self, plate) result(energy)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The energy, (zones); zero for zones without a cohesive law
    real(wp) :: energy(size(plate%mesh%zones))

    energy = 0
    if (allocated(self%cohesive)) energy = total_in_zones(self, plate, self%points%dissipated)
  end function dissipated_energy

  !> Sum of the areas of the cohesive points times a value, in each zone of the full plate. Collective.
  function total_in_zones(self, plate, values) result(totals)
    type(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Values, (local points)
    real(wp), intent(in) :: values(:)
    !> (zones); zero for zones without a cohesive law
    real(wp) :: totals(size(plate%mesh%zones))
    type(exact_sum_t) :: sums(size(totals))
    integer :: i

    totals = 0
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      ! Most values are zero.
      if (self%cohesive(i) .and. .not. abs(values(i)) <= 0) &
        call sums(plate%zone(i))%add(plate%interfaces%contact_area(i)*values(i))
    end do
    totals = totals_of(plate%communicator, sums)*plate%mesh%multiplicity
  end function total_in_zones

  !> Damage of this rank's points.
  pure function damage(self, plate)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> 0 to 1; 0 where there is no cohesive law, (local points)
    real(wp) :: damage(size(plate%zone))

    damage = 0
    if (allocated(self%cohesive)) damage = merge(self%points%damage, 0.0_wp, self%cohesive)
  end function damage

  !> Dissipated fraction of the toughness at this rank's points.
  pure function dissipated_fractions(self, plate)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> 0 to 1; 0 where there is no cohesive law, (local points)
    real(wp) :: dissipated_fractions(size(plate%zone))
    integer :: i

    dissipated_fractions = 0
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      if (self%points(i)%damage > 0) &
        dissipated_fractions(i) = dissipated_fraction(self%law_at(plate, i), self%points(i)%damage)
    end do
  end function dissipated_fractions

  !> Fraction of shear in the energy of the jumps at this rank's points.
  pure function shear_share(self, plate, displacement)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> 0 to 1; 0 where there is no cohesive law, (local points)
    real(wp) :: shear_share(size(plate%zone))
    integer :: i

    shear_share = 0
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (self%cohesive(i)) shear_share(i) = mode_mixture(self%law_at(plate, i), displacement(1:3, i))
    end do
  end function shear_share

  !> Pressure on closed surfaces at this rank's points.
  pure function pressure(self, plate, displacement)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)
    !> Pressure; 0 where there is no cohesive law, (local points)
    real(wp) :: pressure(size(plate%zone))
    integer :: i

    pressure = 0
    if (.not. allocated(self%cohesive)) return
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      if (prevents_penetration(plate, plate%zone(i))) &
        pressure(i) = max(0.0_wp, -plate%interfaces%cohesive_laws(plate%zone(i))%stiffness_opening*displacement(3, i))
    end do
  end function pressure

  !> True if contact prevents penetration of the surfaces of a zone.
  pure logical function prevents_penetration(plate, zone)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: zone

    prevents_penetration = plate%setup%delaminations(zone)%contact /= contact_none
  end function prevents_penetration

  !> True for zones with a damaged point next to the border, where growth ends. The same on every rank.
  function border_reached(self, plate)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> (zones)
    logical :: border_reached(size(plate%mesh%zones))
    real(wp) :: reached(size(plate%mesh%zones))
    integer :: i

    border_reached = .false.
    if (.not. allocated(self%cohesive)) return
    reached = 0
    do i = 1, plate%distribution%owned
      if (.not. self%cohesive(i)) cycle
      if (self%points(i)%damage > 0 .and. plate%interfaces%beside_border(i)) reached(plate%zone(i)) = 1
    end do
    call plate%communicator%maximum(reached)
    border_reached = reached > 0
  end function border_reached

  !> Law of one of this rank's cohesive points. The toughness of one whose damage is held is not reached.
  pure type(cohesive_law_t) function law_at(self, plate, i) result(law)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: i

    law = weakened(plate%interfaces%cohesive_laws(plate%zone(i)), self%strength(i), self%opening(i))
    if (.not. self%is_held) return
    law%toughness_opening = unreached*law%toughness_opening
    law%toughness_shear = unreached*law%toughness_shear
  end function law_at

  !> Surfaces at one of this rank's cohesive points.
  pure type(cohesive_surfaces_t) function surfaces_of(self, plate, i) result(surfaces)
    class(cohesive_interfaces_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: i

    surfaces%law = self%law_at(plate, i)
    surfaces%closing = prevents_penetration(plate, plate%zone(i))
    surfaces%friction = plate%setup%delaminations(plate%zone(i))%friction
  end function surfaces_of

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(cohesive_interfaces_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp), allocatable :: fields(:, :)

    if (.not. allocated(self%cohesive)) return
    allocate (fields(5, size(self%points)))
    fields(1, :) = self%points%damage
    fields(2, :) = self%points%dissipated
    fields(3:, :) = self%stiffness
    call plate%visit_points(archive, 'cohesive/points', fields, area_field)
    if (.not. archive%loading) return
    self%points%damage = fields(1, :)
    self%points%dissipated = fields(2, :)
    self%stiffness = fields(3:, :)
  end subroutine visit
end module cohesive_interfaces
