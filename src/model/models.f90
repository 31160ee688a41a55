!> Model of a setup: mesh, supports, loads and laws, and forces of a motion. Steps do not change it; a change of layers
!> requires a new model.
module models
  use kinds, only: wp
  use bending_forces, only: add_bending_force, add_bending_inertia
  use composite_plates, only: composite_plate_t
  use contact_areas, only: contact_area_t
  use contact_patches, only: contact_patch_t
  use inertia_forces, only: add_inertia_force
  use internal_forces, only: add_internal_force
  use plate_loads, only: plate_loads_t
  use rig_models, only: hold_openings, rig_model_t
  use section_laws, only: section_law_t
  use surface_contact, only: contact_law_t
  implicit none
  private
  public :: model_t

  !> Model on this rank's part of the mesh, which is constant in a run. A procedure that needs a part of it takes that
  !> part.
  type :: model_t
    type(composite_plate_t) :: plate
    !> Pressure and lines
    type(plate_loads_t) :: loads
    !> Supports by rigs
    type(rig_model_t) :: rig
    !> Area of each node, (local points); allocated only with a unilateral frame
    real(wp), allocatable :: rig_area(:)
    !> Contact with that frame
    type(contact_law_t) :: rig_law
    !> Nodal I0, I1, I2 of a lumped mass, (3, local points); allocated only if requested
    real(wp), allocatable :: lumped(:, :)
    !> True if layers, frames or clamps add stiffness to the operator's diagonal
    logical :: has_point_stiffness = .false.
    !> The deck's patch under the impactor; the state has the present one
    type(contact_patch_t) :: patch
    !> Nose that determines the present patch; unallocated: the present patch is that of the deck
    type(contact_area_t), allocatable :: nose
  contains
    procedure :: internal
    procedure :: inertia
    procedure :: held_unknowns
  end type model_t

contains

  !> Unknowns that implicit steps hold: the fixed ones, and openings over frames that act on the first layer only.
  pure function held_unknowns(self) result(held)
    class(model_t), intent(in) :: self
    !> u, v, w, theta_x, theta_y of every point of the mesh, (5, points)
    logical, allocatable :: held(:, :)

    held = self%plate%constraints%fixed
    associate (setup => self%plate%setup)
      if (allocated(setup%supports)) call hold_openings(self%plate%mesh, setup%plate, setup%supports, held)
    end associate
  end function held_unknowns

  !> Internal forces at the owned points and strain energy of this rank's elements.
  subroutine internal(self, stiffness, displacement, force, energy, law, free)
    class(model_t), intent(in) :: self
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: displacement(:, :)
    !> Internal forces, (5, points); ghosts zero
    real(wp), contiguous, intent(inout) :: force(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    !> Updates the stiffness from the strains; absent: it is constant
    class(section_law_t), intent(inout), optional :: law
    !> Resultants of stress-free strains, and their energy per area, (lanes, 7, batches); absent: none
    real(wp), contiguous, intent(in), optional :: free(:, :, :)

    real(wp), allocatable :: field(:, :)

    if (self%plate%borders%columns > size(force, 2)) then
      allocate (field(5, self%plate%borders%columns), source=0.0_wp)
      call add_elements(self%plate, stiffness, displacement, field, energy, law, free)
      call self%plate%borders%add(field)
      force = field(:, :size(force, 2))
    else
      force = 0
      call add_elements(self%plate, stiffness, displacement, force, energy, law, free)
      call self%plate%borders%add(force)
    end if
    if (self%plate%map%layered) call self%plate%map%to_unknowns(force)
    call self%rig%add_line_forces(displacement, force, energy)
  end subroutine internal

  !> Adds the internal forces of this rank's elements on the motion of their layers.
  subroutine add_elements(plate, stiffness, displacement, field, energy, law, free)
    type(composite_plate_t), intent(in) :: plate
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Displacement, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: displacement(:, :)
    !> Forces, (5, columns)
    real(wp), contiguous, intent(inout) :: field(:, :)
    !> Strain energy of this rank's elements
    real(wp), intent(out) :: energy
    !> Updates the stiffness from the strains; absent: it is constant
    class(section_law_t), intent(inout), optional :: law
    !> Resultants of stress-free strains, and their energy per area, (lanes, 7, batches); absent: none
    real(wp), contiguous, intent(in), optional :: free(:, :, :)

    if (plate%map%layered) then
      call add_internal_force(plate%elements, stiffness, plate%setup%mesh%kinematics, plate%motion_of(displacement), &
                              field, energy, law, free)
    else if (plate%constraints%membrane_idle) then
      call add_bending_force(plate%elements, stiffness, displacement, field, energy)
    else
      call add_internal_force(plate%elements, stiffness, plate%setup%mesh%kinematics, displacement, field, energy, &
                              law, free)
    end if
  end subroutine add_elements

  !> Mass times a field, at the owned points.
  subroutine inertia(self, field, force)
    class(model_t), intent(in) :: self
    !> Acceleration or velocity, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: field(:, :)
    !> Product, (5, points); ghosts zero
    real(wp), contiguous, intent(inout) :: force(:, :)
    real(wp), allocatable :: forces(:, :)
    integer :: point

    call self%plate%profile%enter('inertia forces')
    force = 0
    if (allocated(self%lumped)) then
      force = self%plate%motion_of(field)
      force(:, self%plate%distribution%owned + 1:) = 0
      do point = 1, self%plate%distribution%owned
        associate (mass => self%lumped(:, point), value => force(:, point))
          value = [mass(1)*value(1:2) + mass(2)*value(4:5), mass(1)*value(3), mass(2)*value(1:2) + mass(3)*value(4:5)]
        end associate
      end do
    else if (self%plate%borders%columns > size(force, 2)) then
      allocate (forces(5, self%plate%borders%columns), source=0.0_wp)
      call add_inertia(self%plate, field, forces)
      call self%plate%borders%add(forces)
      force = forces(:, :size(force, 2))
    else
      call add_inertia(self%plate, field, force)
      call self%plate%borders%add(force)
    end if
    if (self%plate%map%layered) call self%plate%map%to_unknowns(force)
    call self%plate%profile%leave()
  end subroutine inertia

  !> Adds the consistent mass of this rank's elements times a field, on the motion of their layers.
  subroutine add_inertia(plate, field, force)
    type(composite_plate_t), intent(in) :: plate
    !> Acceleration or velocity, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: field(:, :)
    !> Product, (5, columns)
    real(wp), contiguous, intent(inout) :: force(:, :)

    if (plate%map%layered) then
      call add_inertia_force(plate%elements, plate%motion_of(field), force)
    else if (plate%constraints%membrane_idle) then
      call add_bending_inertia(plate%elements, field, force)
    else
      call add_inertia_force(plate%elements, field, force)
    end if
  end subroutine add_inertia
end module models
