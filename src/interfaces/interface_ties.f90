!> Ties of all interfaces: delaminated cells, and free jumps.
module interface_ties
  use kinds, only: wp
  use archives, only: archive_t
  use delamination_parameters, only: contact_none, law_cohesive, tie_penalty, unloading_glued
  use delaminated_regions, only: delaminated_region_t, create_region
  use composite_plates, only: composite_plate_t
  use text, only: to_text
  implicit none
  private
  public :: interface_ties_t, create_interface_ties, tie_stiffness

  !> Connections of a point: none, exact ties, penalty ties, contact, a cohesive law.
  integer, parameter, public :: connection_none = 0, connection_exact = 1, connection_penalty = 2, &
                                connection_contact = 3, connection_cohesive = 4

  !> Ties of all interfaces.
  type :: interface_ties_t
    !> Delaminated cells of each zone, the same on every rank
    type(delaminated_region_t), allocatable :: regions(:)
    !> True where a lower point's jumps are free, (local points); allocated only with layers
    logical, allocatable :: free(:)
    !> True: separated surfaces move together (unloading = 'glued', Eq. 13b of the paper)
    logical :: glued = .false.
    !> Fracture energy of the cells that fronts have released, of the full plate, (zones), the same on every rank
    real(wp), allocatable :: fracture(:)
  contains
    procedure :: free_jumps
    procedure :: connection
    procedure :: in_contact
    procedure :: constrain_correction
    procedure :: penetration
    procedure :: area
    procedure :: visit
  end type interface_ties_t

contains

  !> Ties of all interfaces with their starters.
  pure subroutine create_interface_ties(plate, self)
    type(composite_plate_t), intent(in) :: plate
    class(interface_ties_t), intent(inout) :: self
    integer :: zone

    allocate (self%regions(size(plate%mesh%zones)))
    allocate (self%fracture(size(plate%mesh%zones)), source=0.0_wp)
    do zone = 1, size(self%regions)
      associate (starter => plate%setup%delaminations(zone))
        self%regions(zone) = create_region(plate%mesh, zone, starter%starter, starter%starter_strip, &
                                           starter%starter_round, starter%starter_at)
      end associate
    end do
    if (.not. plate%map%layered) return
    allocate (self%free(size(plate%zone)), source=.false.)
    call self%free_jumps(plate)
  end subroutine create_interface_ties

  !> Updates the free jumps: those at nodes around which all cells have delaminated.
  pure subroutine free_jumps(self, plate)
    class(interface_ties_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    integer :: i, line(2)

    do i = 1, size(self%free)
      if (plate%zone(i) == 0) cycle
      line = plate%mesh%lines_of(plate%mesh%point_node(plate%distribution%points(i)))
      self%free(i) = self%regions(plate%zone(i))%released(line(1), line(2), &
                                                             plate%mesh%zones(plate%zone(i))%bonded)
    end do
  end subroutine free_jumps

  !> Kind of connection at a point.
  pure integer function connection(self, plate, i)
    class(interface_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: i

    connection = connection_none
    if (plate%zone(i) == 0) return
    associate (interface => plate%setup%delaminations(plate%zone(i)))
      if (interface%law == law_cohesive) then
        connection = connection_cohesive
      else if (.not. self%free(i)) then
        connection = merge(connection_penalty, connection_exact, interface%tie == tie_penalty)
      else if (self%glued .and. interface%unloading == unloading_glued) then
        connection = connection_exact
      else if (interface%contact /= contact_none) then
        connection = connection_contact
      end if
    end associate
  end function connection

  !> Stiffness of a penalty tie at a point.
  pure real(wp) function tie_stiffness(plate, i) result(stiffness)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: i

    stiffness = plate%setup%delaminations(plate%zone(i))%penalty_stiffness
    if (stiffness <= 0) stiffness = 1.0e6_wp*plate%interfaces%contact_laws(plate%zone(i))%layer_stiffness
    stiffness = stiffness*plate%interfaces%contact_area(i)
  end function tie_stiffness

  !> Owned points with contact of surfaces.
  pure function in_contact(self, plate) result(points)
    class(interface_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Points of this rank, ascending
    integer, allocatable :: points(:)
    integer :: i

    associate (owned => plate%distribution%owned)
      points = pack([(i, i=1, owned)], [(self%connection(plate, i) == connection_contact, i=1, owned)])
    end associate
  end function in_contact

  !> Sets the correction of tied jumps to zero.
  pure subroutine constrain_correction(self, plate, correction)
    class(interface_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Correction of the unknowns, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    integer :: i

    if (.not. plate%map%layered) return
    do i = 1, size(correction, 2)
      if (self%connection(plate, i) == connection_exact) correction(1:3, i) = 0
    end do
  end subroutine constrain_correction

  !> Largest penetration of separated surfaces, the same on every rank.
  real(wp) function penetration(self, plate, displacement)
    class(interface_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: displacement(:, :)

    integer :: i

    penetration = 0
    if (.not. plate%map%layered) return
    do i = 1, plate%distribution%owned
      if (self%free(i) .or. self%connection(plate, i) == connection_cohesive) &
        penetration = max(penetration, -displacement(3, i))
    end do
    call plate%communicator%maximum(penetration)
  end function penetration

  !> Delaminated area of each zone of the full plate where fronts release ties.
  pure function area(self, plate)
    class(interface_ties_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> The area, (zones); zero for zones with a cohesive law
    real(wp) :: area(size(self%regions))
    integer :: zone, i, j

    area = 0
    do zone = 1, size(self%regions)
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      do j = self%regions(zone)%rows(1), self%regions(zone)%rows(2)
        do i = self%regions(zone)%columns(1), self%regions(zone)%columns(2)
          if (self%regions(zone)%is_delaminated(i, j)) area(zone) = area(zone) + plate%mesh%cell_area([i, j])
        end do
      end do
    end do
    area = area*plate%mesh%multiplicity
  end function area

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(interface_ties_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    integer :: zone

    do zone = 1, size(self%regions)
      ! The region of a cohesive interface remains its starter.
      if (plate%setup%delaminations(zone)%law == law_cohesive) cycle
      call self%regions(zone)%visit(archive, 'zone'//to_text(zone))
    end do
    if (.not. plate%map%layered) return
    call archive%item('faces/fracture', self%fracture)
    call archive%item('faces/glued', self%glued)
    if (archive%loading) call self%free_jumps(plate)
  end subroutine visit
end module interface_ties
