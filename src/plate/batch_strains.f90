!> Generalised strains of a batch of elements from the unknowns of its nodes, theory (P2), and the transpose of this
!> operation.
module batch_strains
  use kinds, only: wp
  use plate_options, only: kinematics_linear, kinematics_von_karman, shear_assumed
  use element_batches, only: element_batches_t, lanes
  use reference_fields, only: gather, reference_gradient, add_gradient_forces
  use assumed_shear, only: assumed_shear_strains, add_assumed_shear_forces
  use integrated_shear, only: integrated_shear_strains, add_integrated_shear_forces
  implicit none
  private
  public :: set_initial_shape, set_surface, depends_on_slopes, turn_into_plan, turn_into_surface, strains_of_batch, &
            in_plane_strains, add_in_plane_forces, plane_strains, add_plane_forces, shear_strains, add_shear_forces

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

  !> Measures u and v along a surface and w normal to it.
  subroutine set_surface(batches, slopes)
    type(element_batches_t), intent(inout) :: batches
    !> Slopes of the surface at each point along x and y (2, points)
    real(wp), intent(in) :: slopes(:, :)
    integer :: b, node

    allocate (batches%surface_slopes(lanes, 9, 2, batches%batches))
    do b = 1, batches%batches
      do node = 1, 9
        batches%surface_slopes(:, node, :, b) = transpose(slopes(:, batches%points(:, node, b)))
      end do
    end do
  end subroutine set_surface

  !> Turns displacements along a surface into those along the plan, to first order of its slopes.
  pure subroutine turn_into_plan(batches, b, r)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    real(wp), intent(inout) :: r(lanes, 9, 5)

    if (.not. allocated(batches%surface_slopes)) return
    associate (slopes => batches%surface_slopes(:, :, :, b))
      r(:, :, 1) = r(:, :, 1) - slopes(:, :, 1)*r(:, :, 3)
      r(:, :, 2) = r(:, :, 2) - slopes(:, :, 2)*r(:, :, 3)
    end associate
  end subroutine turn_into_plan

  !> Transpose of `turn_into_plan` for forces.
  pure subroutine turn_into_surface(batches, b, f)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    real(wp), intent(inout) :: f(lanes, 9, 5)

    if (.not. allocated(batches%surface_slopes)) return
    associate (slopes => batches%surface_slopes(:, :, :, b))
      f(:, :, 3) = f(:, :, 3) - slopes(:, :, 1)*f(:, :, 1) - slopes(:, :, 2)*f(:, :, 2)
    end associate
  end subroutine turn_into_surface

  !> True if membrane strains depend on the slopes of the deflection: with von Karman's strains, or on a plate that is
  !> not flat.
  pure logical function depends_on_slopes(batches, kinematics)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: kinematics

    depends_on_slopes = kinematics == kinematics_von_karman .or. allocated(batches%initial_slopes)
  end function depends_on_slopes

  !> Membrane strains and curvatures at the Gauss points of a batch, relative to the stress-free shape w0 (K. Marguerre,
  !> Proc. 5th Int. Congress of Applied Mechanics, 1938, 93-101; theory (P10)): e = (grad(w0 + w)**2 - grad(w0)**2)/2,
  !> or grad(w0) grad(w) with linear strains.
  pure subroutine strains_of_batch(batches, b, kinematics, r, strains, slopes)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    integer, intent(in) :: kinematics
    real(wp), intent(in) :: r(lanes, 9, 5)
    real(wp), intent(out) :: strains(lanes, 9, 6)
    !> Slopes by which the membrane strains change with those of w (lane, point, direction): of w0 + w, or of w0 with
    !> linear strains; not set where the strains do not depend on slopes
    real(wp), intent(out) :: slopes(lanes, 9, 2)
    real(wp) :: plan(lanes, 9, 5)

    if (allocated(batches%surface_slopes)) then
      plan = r
      call turn_into_plan(batches, b, plan)
      call in_plane_strains(batches%inverse_jacobian(:, :, :, b), kinematics, plan, strains, slopes)
    else
      call in_plane_strains(batches%inverse_jacobian(:, :, :, b), kinematics, r, strains, slopes)
    end if
    if (.not. allocated(batches%initial_slopes)) return
    if (kinematics == kinematics_linear) call gradient(batches%inverse_jacobian(:, :, :, b), r(:, :, 3), slopes)
    associate (initial => batches%initial_slopes(:, :, :, b))
      strains(:, :, 1) = strains(:, :, 1) + slopes(:, :, 1)*initial(:, :, 1)
      strains(:, :, 2) = strains(:, :, 2) + slopes(:, :, 2)*initial(:, :, 2)
      strains(:, :, 3) = strains(:, :, 3) + slopes(:, :, 1)*initial(:, :, 2) + slopes(:, :, 2)*initial(:, :, 1)
      if (kinematics == kinematics_linear) slopes = 0
      slopes = slopes + initial
    end associate
  end subroutine strains_of_batch

  !> Membrane strains and curvatures at the Gauss points of a batch.
  pure subroutine in_plane_strains(inverse, kinematics, r, strains, slopes)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    integer, intent(in) :: kinematics
    real(wp), intent(in) :: r(lanes, 9, 5)
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

  !> Derivatives of a field with respect to x and y at the Gauss points.
  pure subroutine gradient(inverse, field, slopes)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> Values at the nodes
    real(wp), intent(in) :: field(lanes, 9)
    real(wp), intent(out) :: slopes(lanes, 9, 2)
    real(wp) :: along(lanes, 9, 2)

    call reference_gradient(field, along)
    slopes(:, :, 1) = inverse(:, :, 1)*along(:, :, 1) + inverse(:, :, 2)*along(:, :, 2)
    slopes(:, :, 2) = inverse(:, :, 3)*along(:, :, 1) + inverse(:, :, 4)*along(:, :, 2)
  end subroutine gradient

  !> Adds the nodal forces of membrane forces and moments at the Gauss points.
  pure subroutine add_in_plane_forces(inverse, sloped, resultants, slopes, f)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> True: membrane strains depend on the slopes of w
    logical, intent(in) :: sloped
    !> Forces Nxx, Nyy, Nxy and moments Mxx, Myy, Mxy, times the areas of the points
    real(wp), intent(in) :: resultants(lanes, 9, 6)
    !> Slopes by which they change, used in this case only
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: along(lanes, 9, 2), x_force, y_force
    integer :: g, lane

    call add_plane_forces(inverse, resultants(:, :, 1:3), f(:, :, 1), f(:, :, 2))
    call add_plane_forces(inverse, resultants(:, :, 4:6), f(:, :, 4), f(:, :, 5))
    if (.not. sloped) return
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
    integer, intent(in) :: b
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
    integer, intent(in) :: b
    !> Shear forces xz, yz, times the areas of the points
    real(wp), intent(in) :: shear(lanes, batches%shear_points, 2)
    real(wp), intent(inout) :: f(lanes, 9, 5)

    if (batches%shear == shear_assumed) then
      call add_assumed_shear_forces(batches%shear_tangents(:, :, :, b), batches%inverse_jacobian(:, :, :, b), shear, f)
    else
      call add_integrated_shear_forces(batches%shear_points, batches%shear_inverse_jacobian(:, :, :, b), shear, f)
    end if
  end subroutine add_shear_forces
end module batch_strains
