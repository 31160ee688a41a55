!> The tangent stiffness of the plate times a motion: the derivative of its internal force along that motion, evaluated
!> without any matrix.
module tangent_forces
  use kinds, only: wp
  use plate_options, only: kinematics_linear, kinematics_von_karman
  use element_batches, only: element_batches_t, lanes
  use internal_forces, only: turn_into_forces
  use reference_fields, only: gather, scatter, add_gradient_forces
  use batch_strains, only: depends_on_slopes, in_plane_strains, strains_of_batch, turn_into_plan
  use stiffened_elements, only: add_beam_tangent_forces
  use batch_resultants, only: in_plane_resultants, take_free_resultants, element_means, mean_resultants
  implicit none
  private
  public :: add_tangent_force

contains

  !> Adds the tangent stiffness at a displacement times a motion to the forces on the points.
  subroutine add_tangent_force(batches, stiffness, kinematics, u, v, f, free, mean_change)
    type(element_batches_t), intent(in) :: batches
    !> Section stiffness left, as in the batches (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    integer, intent(in) :: kinematics
    !> Unknowns at which the tangent is taken, and the motion (5, points)
    real(wp), contiguous, intent(in) :: u(:, :), v(:, :)
    real(wp), contiguous, intent(inout) :: f(:, :)
    !> Resultants Nxx to Mxy of stress-free strains, and their energy per area, (lanes, 7, batches)
    real(wp), contiguous, intent(in), optional :: free(:, :, :)
    !> Changes of the sections against mean strains, packed as the section stiffness, (lanes, 18 or more, batches)
    real(wp), contiguous, intent(in), optional :: mean_change(:, :, :)
    real(wp) :: at(lanes, 9, 5), r(lanes, 9, 5), forces(lanes, 9, 6), strains(lanes, 9, 6)
    real(wp) :: slopes(lanes, 9, 2), change(lanes, 9, 2), unused(lanes), means(lanes, 7), of_beams(lanes, 9, 5)
    logical :: sloped
    integer :: b

    sloped = depends_on_slopes(batches, kinematics)
    unused = 0
    slopes = 0
    do b = 1, batches%batches
      associate (inverse => batches%inverse_jacobian(:, :, :, b), weight => batches%weight(:, :, b))
        call gather(batches%points(:, :, b), v, r)
        if (batches%has_beams(b)) then
          of_beams = 0
          call gather(batches%points(:, :, b), u, at)
          call add_beam_tangent_forces(batches, b, kinematics, at, r, of_beams)
        end if
        if (kinematics == kinematics_von_karman) then
          call gather(batches%points(:, :, b), u, at)
          call strains_of_batch(batches, b, kinematics, at, forces, slopes)
          call in_plane_resultants(stiffness(:, :, b), weight, forces, unused)
          if (present(free)) call take_free_resultants(free(:, :, b), weight, forces)
          call turn_into_plan(batches, b, r)
          call in_plane_strains(inverse, kinematics, r, strains, change)
          ! The strains of the motion contain half the square of its slopes. In the derivative these terms are replaced
          ! by the following ones.
          call change_strains(slopes, change, strains)
        else
          call strains_of_batch(batches, b, kinematics_linear, r, strains, slopes)
        end if
        if (present(mean_change)) then
          means(:, :6) = mean_resultants(mean_change(:, :18, b), element_means(weight, strains))
          means(:, 7) = 0
          call turn_into_forces(batches, b, stiffness(:, :, b), sloped, slopes, strains, r, unused, -means)
        else
          call turn_into_forces(batches, b, stiffness(:, :, b), sloped, slopes, strains, r, unused)
        end if
        if (kinematics == kinematics_von_karman) call add_turned_forces(inverse, forces, change, r(:, :, 3))
        if (batches%has_beams(b)) r = r + of_beams
        call scatter(batches%targets(:, :, b), r, f)
      end associate
    end do
  end subroutine add_tangent_force

  !> Converts von Karman's strains of a motion to the change of the strains by that motion.
  pure subroutine change_strains(slopes, change, strains)
    !> Slopes w,x and w,y, and their change (lane, point, direction)
    real(wp), intent(in) :: slopes(lanes, 9, 2), change(lanes, 9, 2)
    !> Strains of the motion on entry, change of the strains on return (lane, point, component)
    real(wp), intent(inout) :: strains(lanes, 9, 6)

    strains(:, :, 1) = strains(:, :, 1) + (slopes(:, :, 1) - 0.5_wp*change(:, :, 1))*change(:, :, 1)
    strains(:, :, 2) = strains(:, :, 2) + (slopes(:, :, 2) - 0.5_wp*change(:, :, 2))*change(:, :, 2)
    strains(:, :, 3) = strains(:, :, 3) + slopes(:, :, 1)*change(:, :, 2) + slopes(:, :, 2)*change(:, :, 1) &
                       - change(:, :, 1)*change(:, :, 2)
  end subroutine change_strains

  !> Adds the forces on w by membrane forces times the change of the slopes (geometric stiffness).
  pure subroutine add_turned_forces(inverse, forces, change, f)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> Membrane forces Nxx, Nyy, Nxy and moments, times the areas of the points
    real(wp), intent(in) :: forces(lanes, 9, 6)
    !> Change of the slopes (lane, point, direction)
    real(wp), intent(in) :: change(lanes, 9, 2)
    !> Nodal forces on w
    real(wp), intent(inout) :: f(lanes, 9)
    real(wp) :: along(lanes, 9, 2), x_force(lanes, 9), y_force(lanes, 9)

    x_force = forces(:, :, 1)*change(:, :, 1) + forces(:, :, 3)*change(:, :, 2)
    y_force = forces(:, :, 3)*change(:, :, 1) + forces(:, :, 2)*change(:, :, 2)
    along(:, :, 1) = inverse(:, :, 1)*x_force + inverse(:, :, 3)*y_force
    along(:, :, 2) = inverse(:, :, 2)*x_force + inverse(:, :, 4)*y_force
    call add_gradient_forces(along, f)
  end subroutine add_turned_forces
end module tangent_forces
