!> Elements with beams on their edges: forces, matrices and inertia of the beams of a batch.
module stiffened_elements
  use edge_beams, only: beam_strains
  use element_batches, only: element_batches_t, lanes
  use kinds, only: wp
  use plate_options, only: kinematics_von_karman
  implicit none
  private
  public :: add_beam_forces, add_beam_tangent_forces, add_beam_matrices, add_beam_inertia, beam_mass, strains_of_beam

contains

  !> Adds the forces of the beams of a batch, and their strain energy to that of their elements.
  pure subroutine add_beam_forces(batches, b, kinematics, r, f, energies)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch, and one of the kinematics_* choices
    integer, intent(in) :: b, kinematics
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Forces on them, and energies of the lanes
    real(wp), intent(inout) :: f(lanes, 9, 5), energies(lanes)
    real(wp) :: force(45)
    integer :: k

    do k = batches%first_beam(b), batches%first_beam(b + 1) - 1
      associate (beam => batches%beams(k), lane => batches%beams(k)%lane)
        force = 0
        call beam%add_force(kinematics == kinematics_von_karman, row_of(r, lane), force, energies(lane))
        f(lane, :, :) = f(lane, :, :) + transpose(reshape(force, [5, 9]))
      end associate
    end do
  end subroutine add_beam_forces

  !> Adds the tangent stiffness of the beams of a batch at a displacement times a motion.
  pure subroutine add_beam_tangent_forces(batches, b, kinematics, r, motion, f)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch, and one of the kinematics_* choices
    integer, intent(in) :: b, kinematics
    !> Unknowns of the nodes, and their motion
    real(wp), intent(in) :: r(lanes, 9, 5), motion(lanes, 9, 5)
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: force(45)
    integer :: k

    do k = batches%first_beam(b), batches%first_beam(b + 1) - 1
      associate (beam => batches%beams(k), lane => batches%beams(k)%lane)
        force = 0
        call beam%add_tangent_force(kinematics == kinematics_von_karman, row_of(r, lane), row_of(motion, lane), force)
        f(lane, :, :) = f(lane, :, :) + transpose(reshape(force, [5, 9]))
      end associate
    end do
  end subroutine add_beam_tangent_forces

  !> Adds tangent stiffness and consistent mass of the beams of a batch to the matrices of its elements.
  pure subroutine add_beam_matrices(batches, b, kinematics, r, stiffness_factor, mass_factor, matrices)
    type(element_batches_t), intent(in) :: batches
    !> Number of the batch, and one of the kinematics_* choices
    integer, intent(in) :: b, kinematics
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Matrix of each element (lane, row, column)
    real(wp), intent(inout) :: matrices(lanes, 45, 45)
    real(wp) :: matrix(45, 45)
    integer :: k

    do k = batches%first_beam(b), batches%first_beam(b + 1) - 1
      associate (beam => batches%beams(k), lane => batches%beams(k)%lane)
        matrix = 0
        call beam%add_stiffness(kinematics == kinematics_von_karman, row_of(r, lane), stiffness_factor, matrix)
        if (abs(mass_factor) > 0) call beam%add_mass(mass_factor, matrix)
        matrices(lane, :, :) = matrices(lane, :, :) + matrix
      end associate
    end do
  end subroutine add_beam_matrices

  !> Adds the consistent mass of the beams of a batch times accelerations.
  pure subroutine add_beam_inertia(batches, b, a, f)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    !> Accelerations of the nodes (lane, node, component)
    real(wp), intent(in) :: a(lanes, 9, 5)
    real(wp), intent(inout) :: f(lanes, 9, 5)
    real(wp) :: force(5, 9)
    integer :: k

    do k = batches%first_beam(b), batches%first_beam(b + 1) - 1
      associate (lane => batches%beams(k)%lane)
        force = 0
        call batches%beams(k)%add_inertia(transpose(a(lane, :, :)), force)
        f(lane, :, :) = f(lane, :, :) + transpose(force)
      end associate
    end do
  end subroutine add_beam_inertia

  !> I0, I1, I2 of all beams.
  pure function beam_mass(batches) result(mass)
    type(element_batches_t), intent(in) :: batches
    !> (3, beams)
    real(wp), allocatable :: mass(:, :)
    integer :: k

    if (.not. allocated(batches%beams)) then
      allocate (mass(3, 0))
    else
      mass = reshape([(batches%beams(k)%mass, k=1, size(batches%beams))], [3, size(batches%beams)])
    end if
  end function beam_mass

  !> Strains of a beam in a motion of the layers.
  pure function strains_of_beam(batches, k, kinematics, r) result(strains)
    type(element_batches_t), intent(in) :: batches
    !> Beam, and one of the kinematics_* choices
    integer, intent(in) :: k, kinematics
    !> Unknowns of the nodes of its batch
    real(wp), intent(in) :: r(lanes, 9, 5)
    real(wp) :: strains(beam_strains)

    strains = batches%beams(k)%strains_of(kinematics == kinematics_von_karman, row_of(r, batches%beams(k)%lane))
  end function strains_of_beam

  !> Unknowns of one element in the order of its matrix.
  pure function row_of(r, lane) result(row)
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Lane of the element
    integer, intent(in) :: lane
    real(wp) :: row(45)

    row = reshape(transpose(r(lane, :, :)), [45])
  end function row_of
end module stiffened_elements
