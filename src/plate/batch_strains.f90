!> Generalised strains of a batch of elements from the unknowns of its nodes, theory (P2), and the transpose of this
!> operation.
module batch_strains
  use kinds, only: wp
  use plate_options, only: kinematics_von_karman, shear_assumed
  use element_batches, only: element_batches_t, lanes
  use reference_fields, only: gather, reference_gradient, add_gradient_forces
  use assumed_shear, only: assumed_shear_strains, add_assumed_shear_forces
  use integrated_shear, only: integrated_shear_strains, add_integrated_shear_forces
  implicit none
  private
  public :: set_initial_shape, strains_of_batch, in_plane_strains, add_in_plane_forces, plane_strains, &
            add_plane_forces, shear_strains, add_shear_forces

contains

  !> Sets the initial deflection w0 of a plate that is free of stress in this shape.
  subroutine set_initial_shape(batches, deflection)
    type(element_batches_t), intent(inout) :: batches
    !> Initial deflection of each point
    real(wp), intent(in) :: deflection(:)
    real(wp) :: u(5, size(deflection)), r(lanes, 9, 5), strains(lanes, 9, 6)
    integer :: b

    u = 0
    u(3, :) = deflection
    allocate (batches%initial_slopes(lanes, 9, 2, batches%batches))
    do b = 1, batches%batches
      call gather(batches%points(:, :, b), u, r)
      call in_plane_strains(batches%inverse_jacobian(:, :, :, b), kinematics_von_karman, r, strains, &
                            batches%initial_slopes(:, :, :, b))
    end do
  end subroutine set_initial_shape

  !> Membrane strains and curvatures at the Gauss points of a batch, relative to the stress-free shape w0 (K. Marguerre,
  !> Proc. 5th Int. Congress of Applied Mechanics, 1938, 93-101; theory (P10)): e = (grad(w0 + w)**2 - grad(w0)**2)/2.
  pure subroutine strains_of_batch(batches, b, kinematics, r, strains, slopes)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch
    integer, intent(in) :: b
    !> One of the kinematics_* choices
    integer, intent(in) :: kinematics
    !> Unknowns of the nodes
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Strains exx, eyy, gxy, kxx, kyy, kxy (lane, point, component)
    real(wp), intent(out) :: strains(lanes, 9, 6)
    !> Slopes of w0 + w (lane, point, direction), set for von Karman's strains only
    real(wp), intent(out) :: slopes(lanes, 9, 2)

    call in_plane_strains(batches%inverse_jacobian(:, :, :, b), kinematics, r, strains, slopes)
    if (kinematics /= kinematics_von_karman .or. .not. allocated(batches%initial_slopes)) return
    associate (initial => batches%initial_slopes(:, :, :, b))
      strains(:, :, 1) = strains(:, :, 1) + slopes(:, :, 1)*initial(:, :, 1)
      strains(:, :, 2) = strains(:, :, 2) + slopes(:, :, 2)*initial(:, :, 2)
      strains(:, :, 3) = strains(:, :, 3) + slopes(:, :, 1)*initial(:, :, 2) + slopes(:, :, 2)*initial(:, :, 1)
      slopes = slopes + initial
    end associate
  end subroutine strains_of_batch

  !> Membrane strains and curvatures at the Gauss points of a batch.
  pure subroutine in_plane_strains(inverse, kinematics, r, strains, slopes)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> One of the kinematics_* choices
    integer, intent(in) :: kinematics
    !> Unknowns of the nodes
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Strains exx, eyy, gxy, kxx, kyy, kxy (lane, point, component)
    real(wp), intent(out) :: strains(lanes, 9, 6)
    !> Slopes w,x and w,y (lane, point, direction), set for von Karman's strains only
    real(wp), intent(out) :: slopes(lanes, 9, 2)
    real(wp) :: along(lanes, 9, 2)
    integer :: g, lane

    call plane_strains(inverse, r(:, :, 1), r(:, :, 2), strains(:, :, 1:3))
    call plane_strains(inverse, r(:, :, 4), r(:, :, 5), strains(:, :, 4:6))
    if (kinematics /= kinematics_von_karman) return
    call reference_gradient(r(:, :, 3), along)
    do g = 1, 9
      do lane = 1, lanes
        slopes(lane, g, 1) = inverse(lane, g, 1)*along(lane, g, 1) + inverse(lane, g, 2)*along(lane, g, 2)
        slopes(lane, g, 2) = inverse(lane, g, 3)*along(lane, g, 1) + inverse(lane, g, 4)*along(lane, g, 2)
        strains(lane, g, 1) = strains(lane, g, 1) + 0.5_wp*slopes(lane, g, 1)**2
        strains(lane, g, 2) = strains(lane, g, 2) + 0.5_wp*slopes(lane, g, 2)**2
        strains(lane, g, 3) = strains(lane, g, 3) + slopes(lane, g, 1)*slopes(lane, g, 2)
      end do
    end do
  end subroutine in_plane_strains

  !> Adds the nodal forces of membrane forces and moments at the Gauss points.
  pure subroutine add_in_plane_forces(inverse, kinematics, resultants, slopes, f)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> One of the kinematics_* choices
    integer, intent(in) :: kinematics
    !> Forces Nxx, Nyy, Nxy and moments Mxx, Myy, Mxy, times the areas of the points
    real(wp), intent(in) :: resultants(lanes, 9, 6)
    !> Slopes w,x and w,y, used for von Karman's strains only
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> Nodal forces
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: along(lanes, 9, 2), x_force, y_force
    integer :: g, lane

    call add_plane_forces(inverse, resultants(:, :, 1:3), f(:, :, 1), f(:, :, 2))
    call add_plane_forces(inverse, resultants(:, :, 4:6), f(:, :, 4), f(:, :, 5))
    if (kinematics /= kinematics_von_karman) return
    do g = 1, 9
      do lane = 1, lanes
        x_force = resultants(lane, g, 1)*slopes(lane, g, 1) + resultants(lane, g, 3)*slopes(lane, g, 2)
        y_force = resultants(lane, g, 3)*slopes(lane, g, 1) + resultants(lane, g, 2)*slopes(lane, g, 2)
        along(lane, g, 1) = inverse(lane, g, 1)*x_force + inverse(lane, g, 3)*y_force
        along(lane, g, 2) = inverse(lane, g, 2)*x_force + inverse(lane, g, 4)*y_force
      end do
    end do
    call add_gradient_forces(along, f(:, :, 3))
  end subroutine add_in_plane_forces

  !> Strains x,x y,y x,y + y,x of a vector field at the Gauss points.
  pure subroutine plane_strains(inverse, x_field, y_field, strains)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> The two components of the field at the nodes
    real(wp), intent(in) :: x_field(lanes, 9), y_field(lanes, 9)
    !> Its strains (lane, point, component)
    real(wp), intent(out) :: strains(lanes, 9, 3)
    real(wp) :: x_along(lanes, 9, 2), y_along(lanes, 9, 2)
    integer :: g, lane

    call reference_gradient(x_field, x_along)
    call reference_gradient(y_field, y_along)
    do g = 1, 9
      do lane = 1, lanes
        strains(lane, g, 1) = inverse(lane, g, 1)*x_along(lane, g, 1) + inverse(lane, g, 2)*x_along(lane, g, 2)
        strains(lane, g, 2) = inverse(lane, g, 3)*y_along(lane, g, 1) + inverse(lane, g, 4)*y_along(lane, g, 2)
        strains(lane, g, 3) = inverse(lane, g, 3)*x_along(lane, g, 1) + inverse(lane, g, 4)*x_along(lane, g, 2) &
                              + inverse(lane, g, 1)*y_along(lane, g, 1) + inverse(lane, g, 2)*y_along(lane, g, 2)
      end do
    end do
  end subroutine plane_strains

  !> Transpose of `plane_strains`.
  pure subroutine add_plane_forces(inverse, stresses, x_force, y_force)
    !> Derivatives xi,x eta,x xi,y eta,y at the Gauss points
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> Stresses conjugate to the strains
    real(wp), intent(in) :: stresses(lanes, 9, 3)
    !> The two components of the nodal forces
    real(wp), intent(inout) :: x_force(lanes, 9), y_force(lanes, 9)
    real(wp) :: x_along(lanes, 9, 2), y_along(lanes, 9, 2)
    integer :: g, lane

    do g = 1, 9
      do lane = 1, lanes
        x_along(lane, g, 1) = inverse(lane, g, 1)*stresses(lane, g, 1) + inverse(lane, g, 3)*stresses(lane, g, 3)
        x_along(lane, g, 2) = inverse(lane, g, 2)*stresses(lane, g, 1) + inverse(lane, g, 4)*stresses(lane, g, 3)
        y_along(lane, g, 1) = inverse(lane, g, 1)*stresses(lane, g, 3) + inverse(lane, g, 3)*stresses(lane, g, 2)
        y_along(lane, g, 2) = inverse(lane, g, 2)*stresses(lane, g, 3) + inverse(lane, g, 4)*stresses(lane, g, 2)
      end do
    end do
    call add_gradient_forces(x_along, x_force)
    call add_gradient_forces(y_along, y_force)
  end subroutine add_plane_forces

  !> Transverse shear strains of a batch at its shear points.
  pure subroutine shear_strains(batches, b, r, strains)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch
    integer, intent(in) :: b
    !> Unknowns of the nodes
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Strains xz, yz (lane, point, component)
    real(wp), intent(out) :: strains(lanes, batches%shear_points, 2)

    if (batches%shear == shear_assumed) then
      call assumed_shear_strains(batches%shear_tangents(:, :, :, b), batches%inverse_jacobian(:, :, :, b), r, strains)
    else
      call integrated_shear_strains(batches%shear_points, batches%shear_inverse_jacobian(:, :, :, b), r, strains)
    end if
  end subroutine shear_strains

  !> Adds the nodal forces of transverse shear forces at the shear points of a batch.
  pure subroutine add_shear_forces(batches, b, shear, f)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch
    integer, intent(in) :: b
    !> Shear forces xz, yz, times the areas of the points
    real(wp), intent(in) :: shear(lanes, batches%shear_points, 2)
    !> Nodal forces
    real(wp), intent(inout) :: f(lanes, 9, 5)

    if (batches%shear == shear_assumed) then
      call add_assumed_shear_forces(batches%shear_tangents(:, :, :, b), batches%inverse_jacobian(:, :, :, b), shear, f)
    else
      call add_integrated_shear_forces(batches%shear_points, batches%shear_inverse_jacobian(:, :, :, b), shear, f)
    end if
  end subroutine add_shear_forces
end module batch_strains
