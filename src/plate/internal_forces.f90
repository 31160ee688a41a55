!> Internal force of the plate: the exact gradient of its strain energy, evaluated without any matrix.
module internal_forces
  use kinds, only: wp
  use plate_options, only: kinematics_linear, shear_assumed
  use element_batches, only: element_batches_t, lanes, shear_size
  use reference_fields, only: gather, scatter
  use batch_strains, only: depends_on_slopes, in_plane_strains, strains_of_batch, add_in_plane_forces, shear_strains, &
                           add_shear_forces, turn_into_surface
  use batch_resultants, only: in_plane_resultants, shear_resultants, add_free_energy, take_free_resultants
  use section_laws, only: section_law_t
  use stiffened_elements, only: add_beam_forces
  implicit none
  private
  public :: add_internal_force, batch_force, turn_into_forces

contains

  !> Adds the internal force of all elements to the forces on the points.
  subroutine add_internal_force(batches, stiffness, kinematics, u, f, energy, law, free, energies)
    type(element_batches_t), intent(in) :: batches
    !> Section stiffness left, as in the batches (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    integer, intent(in) :: kinematics
    real(wp), contiguous, intent(in) :: u(:, :)
    real(wp), contiguous, intent(inout) :: f(:, :)
    !> Strain energy of these elements
    real(wp), intent(out) :: energy
    !> Updates the stiffness from the strains; absent: it is constant
    class(section_law_t), intent(inout), optional :: law
    !> Resultants Nxx to Mxy of stress-free strains, and their energy per area, (lanes, 7, batches)
    real(wp), contiguous, intent(in), optional :: free(:, :, :)
    !> Strain energy of each element, whose exact sum does not depend on ranks, (lanes, batches); 0 in unused lanes
    real(wp), contiguous, intent(out), optional :: energies(:, :)
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2), c(lanes, 21), stored(lanes)
    real(wp) :: resultants(lanes, 7), of_beams(lanes, 9, 5)
    logical :: sloped, is_stiffened
    integer :: b

    sloped = depends_on_slopes(batches, kinematics)
    if (present(law)) call share_strains(batches, kinematics, u, law)
    stored = 0.0_wp
    do b = 1, batches%batches
      call gather(batches%points(:, :, b), u, r)
      is_stiffened = batches%has_beams(b)
      if (is_stiffened) then
        of_beams = 0
        call add_beam_forces(batches, b, kinematics, r, of_beams, stored)
      end if
      call strains_of_batch(batches, b, kinematics, r, strains, slopes)
      if (present(law)) then
        c = stiffness(:, :, b)
        if (present(free)) then
          resultants = free(:, :, b)
          call law%soften(b, batches%weight(:, :, b), strains, c, resultants)
          call turn_into_forces(batches, b, c, sloped, slopes, strains, r, stored, resultants)
        else
          call law%soften(b, batches%weight(:, :, b), strains, c)
          call turn_into_forces(batches, b, c, sloped, slopes, strains, r, stored)
        end if
      else if (present(free)) then
        call turn_into_forces(batches, b, stiffness(:, :, b), sloped, slopes, strains, r, stored, free(:, :, b))
      else
        call turn_into_forces(batches, b, stiffness(:, :, b), sloped, slopes, strains, r, stored)
      end if
      if (is_stiffened) r = r + of_beams
      call scatter(batches%targets(:, :, b), r, f)
      if (.not. present(energies)) cycle
      energies(:, b) = stored
      stored = 0.0_wp
    end do
    energy = sum(stored)
    if (present(energies)) energy = sum(energies)
  end subroutine add_internal_force

  !> Passes the strains of sections with a common state to a law. Collective.
  subroutine share_strains(batches, kinematics, u, law)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: kinematics
    real(wp), contiguous, intent(in) :: u(:, :)
    class(section_law_t), intent(inout) :: law
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2)
    integer :: b

    do b = 1, batches%batches
      if (.not. law%needs_joined_strains(b)) cycle
      call gather(batches%points(:, :, b), u, r)
      call strains_of_batch(batches, b, kinematics, r, strains, slopes)
      call law%accumulate_strains(b, batches%weight(:, :, b), strains)
    end do
    call law%exchange()
  end subroutine share_strains

  !> Replaces the unknowns of a batch by its nodal forces, for linear strains. Stress-free shapes count only if u and v
  !> are measured along their surface.
  pure subroutine batch_force(batches, b, c, r)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    real(wp), intent(in) :: c(lanes, 21)
    !> Unknowns of the nodes on entry, forces on them on return (lane, node, component)
    real(wp), intent(inout) :: r(lanes, 9, 5)
    real(wp) :: strains(lanes, 9, 6), slopes(lanes, 9, 2), energies(lanes), of_beams(lanes, 9, 5)

    energies = 0
    if (batches%has_beams(b)) then
      of_beams = 0
      call add_beam_forces(batches, b, kinematics_linear, r, of_beams, energies)
    end if
    if (allocated(batches%surface_slopes)) then
      call strains_of_batch(batches, b, kinematics_linear, r, strains, slopes)
    else
      call in_plane_strains(batches%inverse_jacobian(:, :, :, b), kinematics_linear, r, strains, slopes)
    end if
    call turn_into_forces(batches, b, c, allocated(batches%surface_slopes), slopes, strains, r, energies)
    if (batches%has_beams(b)) r = r + of_beams
  end subroutine batch_force

  !> Computes the nodal forces of a batch from its unknowns and in-plane strains, or from a motion and the change of the
  !> strains by it.
  pure subroutine turn_into_forces(batches, b, c, sloped, slopes, strains, r, energies, free)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    real(wp), intent(in) :: c(lanes, 21)
    !> True: membrane strains depend on the slopes of w
    logical, intent(in) :: sloped
    !> Slopes by which they change (lane, point, direction), used in this case only
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> In-plane strains on entry, their resultants on return (lane, point, component)
    real(wp), intent(inout) :: strains(lanes, 9, 6)
    !> Unknowns of the nodes on entry, forces on them on return
    real(wp), intent(inout) :: r(lanes, 9, 5)
    real(wp), intent(inout) :: energies(lanes)
    !> Resultants of stress-free strains, and their energy per area
    real(wp), intent(in), optional :: free(lanes, 7)
    real(wp) :: shear(shear_size)

    call shear_strains(batches, b, r, shear)
    if (present(free)) call add_free_energy(free, batches%weight(:, :, b), strains, energies)
    call in_plane_resultants(c, batches%weight(:, :, b), strains, energies)
    if (present(free)) call take_free_resultants(free, batches%weight(:, :, b), strains)
    if (batches%shear == shear_assumed) then
      call shear_resultants(9, c, batches%weight(:, :, b), shear, energies)
    else
      call shear_resultants(batches%shear_points, c, batches%shear_weight(:, :, b), shear, energies)
    end if
    r = 0.0_wp
    call add_in_plane_forces(batches%inverse_jacobian(:, :, :, b), sloped, strains, slopes, r)
    call turn_into_surface(batches, b, r)
    call add_shear_forces(batches, b, shear, r)
  end subroutine turn_into_forces
end module internal_forces
