!> Inertia of the plate, theory (P7): consistent mass applied without a matrix, and mass lumped at the points.
module inertia_forces
  use kinds, only: wp
  use lagrange9, only: gauss_shapes
  use element_batches, only: element_batches_t, lanes
  use edge_beams, only: lumped_inertia
  use reference_fields, only: gather, scatter, reference_values, add_value_forces
  use stiffened_elements, only: add_beam_inertia
  implicit none
  private
  public :: add_inertia_force, add_lumped_mass

contains

  !> Adds the consistent mass times the accelerations of all elements, rotary inertia and eccentricity included.
  subroutine add_inertia_force(batches, a, f)
    type(element_batches_t), intent(in) :: batches
    !> Accelerations of the unknowns (5, points)
    real(wp), contiguous, intent(in) :: a(:, :)
    real(wp), contiguous, intent(inout) :: f(:, :)
    real(wp) :: r(lanes, 9, 5), values(lanes, 9, 5), of_beams(lanes, 9, 5)
    integer :: b, component

    do b = 1, batches%batches
      call gather(batches%points(:, :, b), a, r)
      if (batches%has_beams(b)) then
        of_beams = 0
        call add_beam_inertia(batches, b, r, of_beams)
      end if
      do component = 1, 5
        call reference_values(r(:, :, component), values(:, :, component))
      end do
      call momenta(batches%mass(:, :, b), batches%weight(:, :, b), values)
      r = 0.0_wp
      do component = 1, 5
        call add_value_forces(values(:, :, component), r(:, :, component))
      end do
      if (batches%has_beams(b)) r = r + of_beams
      call scatter(batches%targets(:, :, b), r, f)
    end do
  end subroutine add_inertia_force

  !> Turns accelerations at the Gauss points into inertia forces times the areas of the points.
  pure subroutine momenta(mass, weight, values)
    !> Section mass I0, I1, I2
    real(wp), intent(in) :: mass(lanes, 3)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Accelerations on entry, forces on return (lane, point, component)
    real(wp), intent(inout) :: values(lanes, 9, 5)
    real(wp) :: i0, i1, i2, u, v, w, theta_x, theta_y
    integer :: g, lane

    do g = 1, 9
      do lane = 1, lanes
        i0 = mass(lane, 1)*weight(lane, g)
        i1 = mass(lane, 2)*weight(lane, g)
        i2 = mass(lane, 3)*weight(lane, g)
        u = values(lane, g, 1)
        v = values(lane, g, 2)
        w = values(lane, g, 3)
        theta_x = values(lane, g, 4)
        theta_y = values(lane, g, 5)
        values(lane, g, 1) = i0*u + i1*theta_x
        values(lane, g, 2) = i0*v + i1*theta_y
        values(lane, g, 3) = i0*w
        values(lane, g, 4) = i1*u + i2*theta_x
        values(lane, g, 5) = i1*v + i2*theta_y
      end do
    end do
  end subroutine momenta

  !> Adds the mass of all elements lumped at their nodes by summing the rows of the consistent mass; for this element
  !> this is Simpson's nodal quadrature, so that every nodal mass is positive.
  subroutine add_lumped_mass(batches, sections, of_beams, mass)
    type(element_batches_t), intent(in) :: batches
    !> I0, I1, I2 of their sections, (lanes, 3, batches), and of their beams, (3, beams)
    real(wp), intent(in) :: sections(:, :, :), of_beams(:, :)
    !> Integrals of I0, I1, I2 that belong to each point (3, columns)
    real(wp), intent(inout) :: mass(:, :)
    real(wp) :: nodal(3, 9)
    integer :: b, lane, a, k, target

    do b = 1, batches%batches
      do lane = 1, batches%lanes_used(b)
        do a = 1, 9
          nodal(:, a) = dot_product(gauss_shapes(a, :), batches%weight(lane, :, b))*sections(lane, :, b)
        end do
        if (batches%has_beams(b)) then
          do k = batches%first_beam(b), batches%first_beam(b + 1) - 1
            if (batches%beams(k)%lane /= lane) cycle
            nodal(:, batches%beams(k)%nodes) = nodal(:, batches%beams(k)%nodes) + lumped_inertia(of_beams(:, k))
          end do
        end if
        do a = 1, 9
          target = batches%targets(lane, a, b)
          mass(:, target) = mass(:, target) + nodal(:, a)
        end do
      end do
    end do
  end subroutine add_lumped_mass
end module inertia_forces
