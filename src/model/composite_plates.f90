!> The plate of composite on this rank: mesh, points, elements, plies and interfaces, without loads. All are constant in
!> a run; new layers require a new one.
module composite_plates
  use archives, only: archive_t
  use border_sums, only: border_sum_t
  use communicators, only: communicator_t
  use distributions, only: distribution_t
  use element_batches, only: element_batches_t
  use field_mappings, only: field_mapping_t
  use halos, only: halo_t
  use interface_laws, only: interface_laws_t
  use kinds, only: wp
  use layer_maps, only: layer_map_t
  use layered_meshes, only: layered_mesh_t
  use layups, only: layup_t
  use load_vectors, only: add_patch_weights
  use mathematical_constants, only: pi
  use plate_constraints, only: constraints_t
  use profiles, only: profile_t
  use setups, only: setup_t
  use struck_points, only: struck_point_t
  implicit none
  private
  public :: composite_plate_t

  !> Fraction of the stiffness of the plate's lowest bending wave that is negligible in an operator: with exact
  !> residuals, the corrections of elastic modes are then exact to a thousandth.
  real(wp), parameter :: negligible_share = 1.0e-3_wp

  !> The plate, distributed over ranks.
  type :: composite_plate_t
    !> The setup of the deck
    type(setup_t) :: setup
    !> The ranks
    type(communicator_t) :: communicator
    !> Profile of time and memory, if requested
    type(profile_t) :: profile
    !> Complete mesh of the modelled part, on every rank
    type(layered_mesh_t) :: mesh
    !> Its constrained unknowns
    type(constraints_t) :: constraints
    !> Laminates, and stacks of the elements
    type(layup_t) :: layup
    !> Distribution over ranks
    type(distribution_t) :: distribution
    !> Exchange of ghost points
    type(halo_t) :: halo
    !> Sums of elements' contributions to points on the borders between ranks: a field assembled by `elements` has
    !> `borders%columns` columns and is summed by `borders%add`, before forces are transformed to unknowns
    type(border_sum_t) :: borders
    !> This rank's elements
    type(element_batches_t) :: elements
    !> Motion of stacked layers from their unknowns
    type(layer_map_t) :: map
    !> Zone of each of this rank's points; 0: first layer
    integer, allocatable :: zone(:)
    !> Laws and areas of the interfaces
    type(interface_laws_t) :: interfaces
    type(struck_point_t) :: struck
  contains
    procedure :: place_of
    procedure :: motion_of
    procedure :: deflection
    procedure :: product => field_product
    procedure :: nodal_areas
    procedure :: negligible_stiffness
    procedure :: visit_points
  end type composite_plate_t

contains

  !> Coordinates of one of this rank's points from the plate's centre.
  pure function place_of(self, point) result(place)
    class(composite_plate_t), intent(in) :: self
    integer, intent(in) :: point
    real(wp) :: place(2)

    place = self%mesh%node_coordinates(:, self%mesh%point_node(self%distribution%points(point)))
  end function place_of

  !> Motion of every layer from the unknowns.
  pure function motion_of(self, unknowns) result(motion)
    class(composite_plate_t), intent(in) :: self
    !> Unknowns, (5, points)
    real(wp), contiguous, intent(in) :: unknowns(:, :)
    !> Motion of each point's layer, (5, points)
    real(wp), allocatable :: motion(:, :)

    motion = unknowns
    if (self%map%layered) call self%map%to_motion(motion)
  end function motion_of

  !> Deflection at the struck point, the same on every rank.
  real(wp) function deflection(self, displacement) result(w)
    class(composite_plate_t), intent(in) :: self
    real(wp), intent(in) :: displacement(:, :)

    w = 0
    if (self%struck%point > 0) w = displacement(3, self%struck%point)
    call self%communicator%sum(w)
  end function deflection

  !> Product of two fields summed over the owned points of this rank only.
  pure real(wp) function field_product(self, left, right) result(total)
    class(composite_plate_t), intent(in) :: self
    !> The fields, (5, points)
    real(wp), intent(in) :: left(:, :), right(:, :)

    total = sum(left(:, :self%distribution%owned)*right(:, :self%distribution%owned))
  end function field_product

  !> Nodal areas of some of this rank's elements. Collective.
  function nodal_areas(self, elements) result(areas)
    class(composite_plate_t), intent(in) :: self
    !> Positions among this rank's elements
    integer, intent(in) :: elements(:)
    !> (local points); ghosts zero
    real(wp), allocatable :: areas(:)
    real(wp) :: field(1, self%borders%columns)

    field = 0
    call add_patch_weights(self%elements, elements, field(1, :))
    call self%borders%add(field)
    areas = field(1, :self%halo%points)
  end function nodal_areas

  !> Stiffness per area that is negligible in an operator but keeps it from being singular (doc/theory/newton.md,
  !> assumptions): a small fraction of that of the plate's lowest bending wave, D (pi/L)^4 with the smaller bending
  !> stiffness D and the longer side L.
  pure real(wp) function negligible_stiffness(self) result(stiffness)
    class(composite_plate_t), intent(in) :: self

    stiffness = negligible_share*min(self%layup%section%stiffness(13), self%layup%section%stiffness(16)) &
                *(pi/maxval(self%setup%plate%length))**4
  end function negligible_stiffness

  !> Saves or loads values at the points.
  subroutine visit_points(self, archive, name, values, mapping)
    class(composite_plate_t), intent(in) :: self
    class(archive_t), intent(inout) :: archive
    !> Name within the archive
    character(len=*), intent(in) :: name
    !> (any, local points); those of ghosts are not changed
    real(wp), intent(inout) :: values(:, :)
    !> How they are mapped to another mesh
    type(field_mapping_t), intent(in) :: mapping

    call archive%field(name, self%distribution%points(:self%distribution%owned), self%mesh%points(), values, mapping)
  end subroutine visit_points
end module composite_plates
