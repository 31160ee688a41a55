!> A setup prepared for steps: mesh, supports, loads and their distribution; and the forces that follow from a motion.
!> In a run only layers and the contact area change, between steps.
module models
  use kinds, only: wp
  use communicators, only: communicator_t
  use contact_areas, only: contact_area_t
  use border_sums, only: border_sum_t
  use halos, only: halo_t
  use element_batches, only: element_batches_t
  use bending_forces, only: add_bending_force, add_bending_inertia
  use internal_forces, only: add_internal_force
  use inertia_forces, only: add_inertia_force
  use section_laws, only: section_law_t
  use stacking, only: section_t
  use plies, only: ply_t
  use profiles, only: profile_t
  use rank_totals, only: total_of
  use layered_meshes, only: layered_mesh_t
  use layer_maps, only: layer_map_t
  use face_contact, only: contact_law_t
  use cohesive_laws, only: cohesive_law_t
  use distributions, only: distribution_t
  use placed_lines, only: placed_line_t
  use rig_models, only: rig_model_t
  use setups, only: setup_t
  use symmetry_images, only: symmetry_images_t
  implicit none
  private
  public :: model_t

  !> A setup made ready for computing on this rank's share of the mesh. It has many components because all that steps
  !> share is found once, before them.
  type :: model_t
    !> What the deck asked for
    type(setup_t) :: setup
    !> The ranks
    type(communicator_t) :: communicator
    !> Mesh of the modelled part, whole on every rank
    type(layered_mesh_t) :: mesh
    !> Profile of time and memory, if requested
    type(profile_t) :: profile
    !> This rank's share
    type(distribution_t) :: distribution
    !> Exchange of ghost points
    type(halo_t) :: halo
    !> Sums of elements' contributions to points on the borders between ranks: what adds to points by `elements` takes
    !> a field with `borders%columns` columns and then calls `borders%add`, before forces are turned to unknowns
    type(border_sum_t) :: borders
    !> This rank's elements
    type(element_batches_t) :: elements
    !> Plies of the laminate, struck face first
    type(ply_t), allocatable :: plies(:)
    !> Transverse shear stresses of its plies under unit shear forces, (2, 2, plies)
    real(wp), allocatable :: shear_shares(:, :, :)
    !> Section of the whole laminate
    type(section_t) :: section
    !> Thickness of the laminate
    real(wp) :: thickness = 0
    !> Resultants of the strains that the plies' cooling would give them without stress, and their energy per area,
    !> without damage, (lanes, 7, batches); allocated only if they are modelled
    real(wp), allocatable :: free(:, :, :)
    !> Fixed unknowns of every point of the mesh, (5, points of the mesh)
    logical, allocatable :: held(:, :)
    !> Images of the points of a full plate that keeps its symmetry during failure
    type(symmetry_images_t) :: images
    !> Weights whose product with w is the mean deflection of the patch, (local points); ghosts zero
    real(wp), allocatable :: patch(:)
    !> Points that have one
    integer, allocatable :: patch_points(:)
    !> Nose that determines the patch in each step; unallocated: a constant patch
    type(contact_area_t), allocatable :: nose
    !> Difference of the mean deflection between successive patches, so that it is continuous
    real(wp) :: patch_offset = 0
    !> Nodal forces of the deck's pressure, (5, local points); ghosts zero. Allocated only with a pressure
    real(wp), allocatable :: pressure(:, :)
    !> Lines that fix, move or load; empty: none
    type(placed_line_t), allocatable :: lines(:)
    !> Nodal I0, I1, I2 of a lumped mass, (3, local points); allocated only if asked for
    real(wp), allocatable :: lumped(:, :)
    !> Motion of stacked layers from their unknowns
    type(layer_map_t) :: map
    !> Area that belongs to each point of a lower layer, (local points)
    real(wp), allocatable :: contact_area(:)
    !> Contact of each zone's faces
    type(contact_law_t), allocatable :: contact_laws(:)
    !> Cohesive law of each zone; without meaning where fronts release ties
    type(cohesive_law_t), allocatable :: cohesive_laws(:)
    !> How rigs hold the plate
    type(rig_model_t) :: rig
    !> Area that belongs to each node, (local points); allocated only if the plate may lift off a frame
    real(wp), allocatable :: rig_area(:)
    !> Contact with that frame
    type(contact_law_t) :: rig_law
    !> True if layers, frames or clamps add stiffness to the operator's diagonal
    logical :: has_bonds = .false.
    !> True for points next to the border of their zone, where growth ends, (local points)
    logical, allocatable :: beside_border(:)
    !> Zone of each of this rank's points; 0: first layer
    integer, allocatable :: zone(:)
    !> Position of the struck node's first point on the rank that owns it; 0 elsewhere
    integer :: struck = 0
    !> This rank's elements around the struck node
    integer, allocatable :: struck_elements(:)
    !> Elements around the struck node on all ranks
    integer :: struck_count = 0
    !> True: u and v are zero (linear, no coupling) and have no equations
    logical :: membrane_idle = .false.
  contains
    !> Motion of every layer from the unknowns.
    procedure :: motion_of
    !> Internal forces and strain energy of a displacement field.
    procedure :: internal
    procedure, private :: add_elements
    procedure, private :: add_inertia
    !> Forces of the lines, loads of a static analysis, and their change with the load factor.
    procedure :: line_forces
    procedure :: add_holding_lines
    procedure :: static_loads
    procedure :: load_slopes
    !> Mass times a field.
    procedure :: inertia
    !> Mean deflection of the patch, and nodal forces of a force on it.
    procedure :: patch_mean
    procedure :: add_contact_force
    !> Deflection below the impactor, its contact area, and the new distribution of its force.
    procedure :: contact_deflection
    procedure :: pressed_area
    procedure :: spread_force
    !> Deflection at the struck point.
    procedure :: deflection
    !> Product of two fields over all points of the plate's modelled part.
    procedure :: product => field_product
  end type model_t

contains

  !> Motion of every layer from the unknowns.
  pure function motion_of(self, unknowns) result(motion)
    class(model_t), intent(in) :: self
    !> Unknowns, (5, points)
    real(wp), contiguous, intent(in) :: unknowns(:, :)
    !> Motion of each point's layer, (5, points)
    real(wp), allocatable :: motion(:, :)

    motion = unknowns
    if (self%map%layered) call self%map%to_motion(motion)
  end function motion_of

  !> Internal forces at the owned points and this rank's share of the strain energy.
  subroutine internal(self, stiffness, displacement, force, energy, law, free)
    class(model_t), intent(in) :: self
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: displacement(:, :)
    !> Internal forces, (5, points); ghosts zero
    real(wp), contiguous, intent(inout) :: force(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    !> Updates the stiffness from the strains; absent: it is constant
    class(section_law_t), intent(inout), optional :: law
    !> Resultants of strains that go without stress, and their energy per area, (lanes, 7, batches); absent: none
    real(wp), contiguous, intent(in), optional :: free(:, :, :)

    real(wp), allocatable :: field(:, :)

    if (self%borders%columns > size(force, 2)) then
      allocate (field(5, self%borders%columns), source=0.0_wp)
      call self%add_elements(stiffness, displacement, field, energy, law, free)
      call self%borders%add(field)
      force = field(:, :size(force, 2))
    else
      force = 0
      call self%add_elements(stiffness, displacement, force, energy, law, free)
      call self%borders%add(force)
    end if
    if (self%map%layered) call self%map%to_unknowns(force)
    call self%rig%add_line_forces(displacement, force, energy)
  end subroutine internal

  !> Adds the internal forces of this rank's elements on the motion of their layers.
  subroutine add_elements(self, stiffness, displacement, field, energy, law, free)
    class(model_t), intent(in) :: self
    !> Section stiffness of the damaged elements, (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: displacement(:, :)
    !> Forces, (5, columns)
    real(wp), contiguous, intent(inout) :: field(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    !> Updates the stiffness from the strains; absent: it is constant
    class(section_law_t), intent(inout), optional :: law
    !> Resultants of strains that go without stress, and their energy per area, (lanes, 7, batches); absent: none
    real(wp), contiguous, intent(in), optional :: free(:, :, :)

    if (self%map%layered) then
      call add_internal_force(self%elements, stiffness, self%setup%kinematics, self%motion_of(displacement), field, &
                              energy, law, free)
    else if (self%membrane_idle) then
      call add_bending_force(self%elements, stiffness, displacement, field, energy)
    else
      call add_internal_force(self%elements, stiffness, self%setup%kinematics, displacement, field, energy, law, free)
    end if
  end subroutine add_elements

  !> Nodal forces of the lines at the owned points, of all of them or of those that are prescribed or not.
  pure subroutine line_forces(self, displacement, load_factor, forces, prescribed)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Ramps over their full values
    real(wp), intent(in) :: load_factor
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: forces(:, :)
    !> Whether the lines are prescribed; left out: all of them
    logical, intent(in), optional :: prescribed
    integer :: i

    forces = 0
    do i = 1, size(self%lines)
      if (present(prescribed)) then
        if (self%lines(i)%load%prescribed .neqv. prescribed) cycle
      end if
      call self%lines(i)%add_forces(displacement, load_factor, forces)
    end do
  end subroutine line_forces

  !> Adds the nodal forces of the lines that support the plate before any load or motion.
  pure subroutine add_holding_lines(self, displacement, forces)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Forces on the unknowns of the owned points, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%lines)
      call self%lines(i)%add_holding_forces(displacement, forces)
    end do
  end subroutine add_holding_lines

  !> Nodal loads of a static analysis: pressure and lines, at the owned points.
  pure subroutine static_loads(self, displacement, load_factor, loads)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Ramps over their full values
    real(wp), intent(in) :: load_factor
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: loads(:, :)

    call self%line_forces(displacement, load_factor, loads)
    if (allocated(self%pressure)) loads = loads + load_factor*self%pressure
  end subroutine static_loads

  !> Change of these loads with the load factor.
  pure subroutine load_slopes(self, loads)
    class(model_t), intent(in) :: self
    !> Forces on the unknowns, (5, points); ghosts zero
    real(wp), intent(out) :: loads(:, :)
    integer :: i

    loads = 0
    if (allocated(self%pressure)) loads = self%pressure
    do i = 1, size(self%lines)
      call self%lines(i)%add_slopes(loads)
    end do
  end subroutine load_slopes

  !> Mass times a field, at the owned points.
  subroutine inertia(self, field, force)
    class(model_t), intent(in) :: self
    !> Acceleration or velocity, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: field(:, :)
    !> Product, (5, points); ghosts zero
    real(wp), contiguous, intent(inout) :: force(:, :)
    real(wp), allocatable :: forces(:, :)
    integer :: point

    call self%profile%enter('inertia forces')
    force = 0
    if (allocated(self%lumped)) then
      force = self%motion_of(field)
      force(:, self%distribution%owned + 1:) = 0
      do point = 1, self%distribution%owned
        associate (mass => self%lumped(:, point), value => force(:, point))
          value = [mass(1)*value(1:2) + mass(2)*value(4:5), mass(1)*value(3), mass(2)*value(1:2) + mass(3)*value(4:5)]
        end associate
      end do
    else if (self%borders%columns > size(force, 2)) then
      allocate (forces(5, self%borders%columns), source=0.0_wp)
      call self%add_inertia(field, forces)
      call self%borders%add(forces)
      force = forces(:, :size(force, 2))
    else
      call self%add_inertia(field, force)
      call self%borders%add(force)
    end if
    if (self%map%layered) call self%map%to_unknowns(force)
    call self%profile%leave()
  end subroutine inertia

  !> Adds the consistent mass of this rank's elements times a field, on the motion of their layers.
  subroutine add_inertia(self, field, force)
    class(model_t), intent(in) :: self
    !> Acceleration or velocity, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: field(:, :)
    !> Product, (5, columns)
    real(wp), contiguous, intent(inout) :: force(:, :)

    if (self%map%layered) then
      call add_inertia_force(self%elements, self%motion_of(field), force)
    else if (self%membrane_idle) then
      call add_bending_inertia(self%elements, field, force)
    else
      call add_inertia_force(self%elements, field, force)
    end if
  end subroutine add_inertia

  !> Mean deflection of the patch, the same on every rank.
  real(wp) function patch_mean(self, displacement) result(mean)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)

    mean = total_of(self%communicator, self%patch(self%patch_points)*displacement(3, self%patch_points))
  end function patch_mean

  !> Deflection of the plate under the impactor, the same on every rank.
  real(wp) function contact_deflection(self, displacement) result(w)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)

    w = self%patch_mean(displacement) + self%patch_offset
  end function contact_deflection

  !> Area of the full plate that the impactor presses on, the same on every rank.
  real(wp) function pressed_area(self) result(area)
    class(model_t), intent(in) :: self

    area = self%setup%mesh%patch**2
    if (allocated(self%nose)) area = self%nose%touched(self%communicator, self%patch)*self%mesh%multiplicity
  end function pressed_area

  !> Spreads the impactor's force in another way.
  pure subroutine spread_force(self, weights, offset)
    class(model_t), intent(inout) :: self
    !> Weights, (local points); ghosts zero
    real(wp), intent(in) :: weights(:)
    !> Difference of the mean deflection from the patch before
    real(wp), intent(in) :: offset
    integer :: point

    self%patch = weights
    self%patch_points = pack([(point, point=1, size(weights))], abs(weights) > 0)
    self%patch_offset = offset
  end subroutine spread_force

  !> Adds the nodal forces of a force on the full plate's patch.
  pure subroutine add_contact_force(self, force, forces)
    class(model_t), intent(in) :: self
    !> The force
    real(wp), intent(in) :: force
    !> Forces on the unknowns, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%patch_points)
      associate (point => self%patch_points(i))
        forces(3, point) = forces(3, point) + force/self%mesh%multiplicity*self%patch(point)
      end associate
    end do
  end subroutine add_contact_force

  !> Deflection at the struck point, the same on every rank.
  real(wp) function deflection(self, displacement) result(w)
    class(model_t), intent(in) :: self
    !> Displacement, (5, points)
    real(wp), intent(in) :: displacement(:, :)

    w = 0
    if (self%struck > 0) w = displacement(3, self%struck)
    call self%communicator%sum(w)
  end function deflection

  !> Product of two fields summed over the owned points of this rank only.
  pure real(wp) function field_product(self, left, right) result(total)
    class(model_t), intent(in) :: self
    !> The fields, (5, points)
    real(wp), intent(in) :: left(:, :), right(:, :)

    total = sum(left(:, :self%distribution%owned)*right(:, :self%distribution%owned))
  end function field_product
end module models
