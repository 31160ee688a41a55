!> Model of a setup: mesh, supports, loads and laws, and forces of a motion. Steps do not change it; a change of layers
!> requires a new model.
module models
  use kinds, only: wp
  use bending_forces, only: add_bending_force, add_bending_inertia
  use contact_areas, only: contact_area_t
  use contact_patches, only: contact_patch_t
  use inertia_forces, only: add_inertia_force
  use internal_forces, only: add_internal_force
  use plate_loads, only: loaded_plate_t
  use rig_models, only: hold_openings
  use section_laws, only: section_law_t
  implicit none
  private
  public :: model_t

  !> Model on this rank's part of the mesh: plate, laws and loads, which are constant in a run. It has many components
  !> because it has those of the loaded plate. A module that needs a part of it takes that part: discretization_t,
  !> composite_plate_t or loaded_plate_t.
  type, extends(loaded_plate_t) :: model_t
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
    procedure, private :: add_elements
    procedure, private :: add_inertia
    procedure :: inertia
    procedure :: held_unknowns
  end type model_t

contains

  !> Unknowns that implicit steps hold: the fixed ones, and openings over frames that act on the first layer only.
  pure function held_unknowns(self) result(held)
    class(model_t), intent(in) :: self
    !> u, v, w, theta_x, theta_y of every point of the mesh, (5, points)
    logical, allocatable :: held(:, :)

    held = self%fixed
    if (allocated(self%setup%supports)) call hold_openings(self%mesh, self%setup%plate, self%setup%supports, held)
  end function held_unknowns

  !> Internal forces at the owned points and strain energy of this rank's elements.
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
    !> Resultants of stress-free strains, and their energy per area, (lanes, 7, batches); absent: none
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
    !> Resultants of stress-free strains, and their energy per area, (lanes, 7, batches); absent: none
    real(wp), contiguous, intent(in), optional :: free(:, :, :)

    if (self%map%layered) then
      call add_internal_force(self%elements, stiffness, self%setup%mesh%kinematics, self%motion_of(displacement), &
                              field, energy, law, free)
    else if (self%membrane_idle) then
      call add_bending_force(self%elements, stiffness, displacement, field, energy)
    else
      call add_internal_force(self%elements, stiffness, self%setup%mesh%kinematics, displacement, field, energy, law, &
                              free)
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
end module models
