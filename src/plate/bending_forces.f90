!> Internal and inertia forces of a plate that moves out of its plane only: linear strains, sections without coupling.
!> Membrane strains and their forces, which are zero, are left out.
module bending_forces
  use kinds, only: wp
  use plate_options, only: shear_assumed
  use element_batches, only: element_batches_t, lanes, shear_size
  use reference_fields, only: reference_values, add_value_forces
  use batch_strains, only: plane_strains, add_plane_forces, shear_strains, add_shear_forces
  use batch_resultants, only: shear_resultants
  implicit none
  private
  public :: add_bending_force, add_bending_inertia

contains

  !> Adds the internal force of all elements to the forces on the points, components 3 to 5.
  subroutine add_bending_force(batches, stiffness, u, f, energy, energies)
    type(element_batches_t), intent(in) :: batches
    !> Section stiffness left, as in the batches (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    real(wp), contiguous, intent(in) :: u(:, :)
    real(wp), contiguous, intent(inout) :: f(:, :)
    !> Strain energy of these elements
    real(wp), intent(out) :: energy
    !> Strain energy of each element, whose exact sum does not depend on ranks, (lanes, batches); 0 in unused lanes
    real(wp), contiguous, intent(out), optional :: energies(:, :)
    real(wp) :: r(lanes, 9, 5), curvatures(lanes, 9, 3), shear(shear_size), stored(lanes)
    integer :: b

    stored = 0.0_wp
    do b = 1, batches%batches
      call gather_bending(batches%points(:, :, b), u, r)
      call plane_strains(batches%inverse_jacobian(:, :, :, b), r(:, :, 4), r(:, :, 5), curvatures)
      call shear_strains(batches, b, r, shear)
      call moments(stiffness(:, :, b), batches%weight(:, :, b), curvatures, stored)
      if (batches%shear == shear_assumed) then
        call shear_resultants(9, stiffness(:, :, b), batches%weight(:, :, b), shear, stored)
      else
        call shear_resultants(batches%shear_points, stiffness(:, :, b), batches%shear_weight(:, :, b), shear, stored)
      end if
      r(:, :, 3:5) = 0.0_wp
      call add_plane_forces(batches%inverse_jacobian(:, :, :, b), curvatures, r(:, :, 4), r(:, :, 5))
      call add_shear_forces(batches, b, shear, r)
      call scatter_bending(batches%targets(:, :, b), r, f)
      if (.not. present(energies)) cycle
      energies(:, b) = stored
      stored = 0.0_wp
    end do
    energy = sum(stored)
    if (present(energies)) energy = sum(energies)
  end subroutine add_bending_force

  !> Adds the consistent mass times the accelerations of all elements, components 3 to 5.
  subroutine add_bending_inertia(batches, a, f)
    type(element_batches_t), intent(in) :: batches
    !> Accelerations of the unknowns (5, points)
    real(wp), contiguous, intent(in) :: a(:, :)
    real(wp), contiguous, intent(inout) :: f(:, :)
    real(wp) :: r(lanes, 9, 5), values(lanes, 9)
    integer :: b, component, g

    do b = 1, batches%batches
      call gather_bending(batches%points(:, :, b), a, r)
      do component = 3, 5
        call reference_values(r(:, :, component), values)
        associate (mass => batches%mass(:, merge(1, 3, component == 3), b))
          do g = 1, 9
            values(:, g) = mass*batches%weight(:, g, b)*values(:, g)
          end do
        end associate
        r(:, :, component) = 0.0_wp
        call add_value_forces(values, r(:, :, component))
      end do
      call scatter_bending(batches%targets(:, :, b), r, f)
    end do
  end subroutine add_bending_inertia

  !> Turns curvatures into moments times the areas of the Gauss points.
  pure subroutine moments(c, weight, s, energies)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Curvatures on entry, moments on return (lane, point, component)
    real(wp), intent(inout) :: s(lanes, 9, 3)
    real(wp), intent(inout) :: energies(lanes)
    real(wp) :: xx, yy, xy
    integer :: g, lane

    do g = 1, 9
      do lane = 1, lanes
        xx = weight(lane, g)*(c(lane, 13)*s(lane, g, 1) + c(lane, 14)*s(lane, g, 2) + c(lane, 15)*s(lane, g, 3))
        yy = weight(lane, g)*(c(lane, 14)*s(lane, g, 1) + c(lane, 16)*s(lane, g, 2) + c(lane, 17)*s(lane, g, 3))
        xy = weight(lane, g)*(c(lane, 15)*s(lane, g, 1) + c(lane, 17)*s(lane, g, 2) + c(lane, 18)*s(lane, g, 3))
        energies(lane) = energies(lane) + 0.5_wp*(s(lane, g, 1)*xx + s(lane, g, 2)*yy + s(lane, g, 3)*xy)
        s(lane, g, 1) = xx
        s(lane, g, 2) = yy
        s(lane, g, 3) = xy
      end do
    end do
  end subroutine moments

  !> Deflection and rotations of the nodes of a batch.
  pure subroutine gather_bending(points, u, r)
    !> Point of each node
    integer, intent(in) :: points(lanes, 9)
    real(wp), contiguous, intent(in) :: u(:, :)
    !> Unknowns of the nodes (lane, node, component); the first two components are not changed
    real(wp), intent(inout) :: r(lanes, 9, 5)
    integer :: lane, a

    do a = 1, 9
      do lane = 1, lanes
        r(lane, a, 3) = u(3, points(lane, a))
        r(lane, a, 4) = u(4, points(lane, a))
        r(lane, a, 5) = u(5, points(lane, a))
      end do
    end do
  end subroutine gather_bending

  !> Adds nodal forces of a batch to those of the points, components 3 to 5, element by element.
  pure subroutine scatter_bending(targets, r, f)
    !> Column of each node
    integer, intent(in) :: targets(lanes, 9)
    !> Forces on the nodes (lane, node, component)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Forces on all points
    real(wp), contiguous, intent(inout) :: f(:, :)
    integer :: lane, a

    do lane = 1, lanes
      do a = 1, 9
        f(3, targets(lane, a)) = f(3, targets(lane, a)) + r(lane, a, 3)
        f(4, targets(lane, a)) = f(4, targets(lane, a)) + r(lane, a, 4)
        f(5, targets(lane, a)) = f(5, targets(lane, a)) + r(lane, a, 5)
      end do
    end do
  end subroutine scatter_bending
end module bending_forces
