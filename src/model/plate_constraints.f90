!> Constrained unknowns of the plate's points.
module plate_constraints
  use idle_membranes, only: is_membrane_idle
  use kinds, only: wp
  use layered_meshes, only: layered_mesh_t
  use line_loads, only: along_y
  use mesh_parameters, only: edge_free, in_plane_fixed, in_plane_free, in_plane_tangential, plate_t, symmetry_quarter
  use rig_models, only: fix_by_rigs
  use setups, only: setup_t
  use stacking, only: section_t
  use supports, only: fixed_unknowns
  use symmetry_images, only: find_images, symmetry_images_t
  implicit none
  private
  public :: constraints_t, new_constraints, unrestrained

  !> Unknowns fixed by supports, and those that images share.
  type :: constraints_t
    !> True: u and v are zero (linear, no coupling) and have no equations
    logical :: membrane_idle = .false.
    !> True for constrained unknowns of every point of the mesh, (5, points of the mesh)
    logical, allocatable :: fixed(:, :)
    !> Images of the points of a full plate whose symmetry is enforced during failure
    type(symmetry_images_t) :: images
  end type constraints_t

contains

  !> Constraints of a mesh.
  pure type(constraints_t) function new_constraints(setup, mesh, section) result(self)
    type(setup_t), intent(in) :: setup
    type(layered_mesh_t), intent(in) :: mesh
    !> That of the full laminate
    type(section_t), intent(in) :: section

    self%membrane_idle = is_membrane_idle(setup, size(mesh%zones), section)
    self%fixed = fixed_unknowns(mesh, setup%plate, self%membrane_idle, unrestrained(setup))
    if (allocated(setup%supports)) call fix_by_rigs(mesh, setup%plate, setup%supports, self%fixed)
    self%images = find_images(mesh, setup%plate%kept, self%fixed)
  end function new_constraints

  !> In-plane rigid-body motions of a static plate without support: along x, along y, rotation.
  pure function unrestrained(setup)
    type(setup_t), intent(in) :: setup
    !> True: it must be constrained unless symmetry does
    logical :: unrestrained(3)
    integer :: i

    unrestrained = .not. setup%has_inertia() .and. setup%plate%symmetry /= symmetry_quarter .and. &
                   .not. held_by_edges(setup%plate)
    if (allocated(setup%supports)) then
      do i = 1, size(setup%supports)
        if (allocated(setup%supports(i)%clamps) .and. .not. setup%supports(i)%clamp_force > 0) &
          unrestrained = unrestrained .and. setup%plate%in_plane == in_plane_free
      end do
    end if
    if (.not. allocated(setup%lines)) return
    associate (in_plane => setup%lines%prescribed .and. setup%lines%component <= 2, lines => setup%lines)
      unrestrained(1) = unrestrained(1) .and. .not. any(in_plane .and. lines%component == 1)
      unrestrained(2) = unrestrained(2) .and. .not. any(in_plane .and. lines%component == 2)
      ! A line fixed along its normal cannot rotate.
      unrestrained(3) = unrestrained(3) .and. .not. any(in_plane &
                                                        .and. (lines%component == 1 .eqv. lines%direction == along_y))
    end associate
  end function unrestrained

  !> In-plane rigid-body motions that supported edges prevent: along x, along y, rotation. An edge that holds the
  !> displacement along itself only does not prevent a rotation about one of its points, nor do two that meet about
  !> their common corner.
  pure function held_by_edges(plate) result(held)
    type(plate_t), intent(in) :: plate
    logical :: held(3)
    logical :: supported(4)

    supported = plate%edges /= edge_free
    held = plate%in_plane == in_plane_fixed .and. any(supported)
    if (plate%in_plane == in_plane_tangential) &
      held = [any(supported(3:4)), any(supported(1:2)), all(supported(1:2)) .or. all(supported(3:4))]
  end function held_by_edges
end module plate_constraints
