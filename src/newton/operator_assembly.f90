!> Assembles the operator of a step: tangent stiffness and mass of the elements, ties, contact and cohesive laws between
!> stacked layers.
module operator_assembly
  use kinds, only: wp
  use errors, only: error_t
  use element_batches, only: lanes, first_element
  use element_tangents, only: tangent
  use linear_solvers, only: linear_solver_t
  use plate_options, only: kinematics_linear, kinematics_von_karman
  use delamination_parameters, only: law_cohesive
  use numberings, only: numbering_t
  use idle_membranes, only: uncoupled
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  implicit none
  private
  public :: assemble_elements, assemble_diagonal, assemble_tangents, is_positive_definite, has_separate_membrane

contains

  !> True if all operators of a model are positive definite: in steps in time, with secant stiffness of the laws, or
  !> without buckling and softening.
  pure logical function is_positive_definite(plate) result(positive)
    type(composite_plate_t), intent(in) :: plate

    positive = plate%setup%has_inertia() .or. plate%setup%mesh%kinematics == kinematics_linear
    if (.not. plate%setup%has_inertia() .and. plate%map%layered) &
      positive = positive .and. .not. any(plate%setup%delaminations%law == law_cohesive)
  end function is_positive_definite

  !> True if the tangent does not couple in-plane displacements with bending: an undeflected, flat plate of a symmetric
  !> laminate. Both are then factorized separately, and the factors are half as large as one for both. Collective.
  logical function has_separate_membrane(model, stiffness, displacement) result(separate)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Displacement at which the tangent is taken, (5, points)
    real(wp), intent(in) :: displacement(:, :)

    separate = .not. (model%plate%constraints%membrane_idle .or. model%plate%map%layered &
                      .or. size(model%loads%lines) > 0 .or. &
                      allocated(model%plate%elements%initial_slopes) .or. allocated(model%plate%elements%beams))
    if (model%plate%setup%mesh%kinematics == kinematics_von_karman) &
      separate = separate .and. all(abs(displacement(3, :)) <= 0)
    separate = model%plate%communicator%all(separate .and. uncoupled(stiffness, model%plate%elements%mass))
  end function has_separate_membrane

  !> Adds the element matrices and a lumped mass to a cleared solver; diagonals of ghosts are added to their owners.
  subroutine assemble_elements(model, stiffness, numbering, displacement, stiffness_factor, mass_factor, solver, &
                               diagonal)
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: stiffness(:, :, :)
    type(numbering_t), intent(in) :: numbering
    !> Displacement at which the tangent is taken, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    class(linear_solver_t), intent(inout) :: solver
    !> Receives the diagonal, (5, points)
    real(wp), intent(inout) :: diagonal(:, :)
    real(wp), allocatable :: matrices(:, :, :), transposed(:, :, :), motion(:, :)
    real(wp) :: consistent_factor
    integer :: b, lane, point, column

    diagonal = 0
    consistent_factor = mass_factor
    if (allocated(model%lumped)) consistent_factor = 0
    allocate (matrices(lanes, 45, 45), transposed(45, 45, lanes))
    motion = model%plate%motion_of(displacement)
    do b = 1, model%plate%elements%batches
      if (allocated(model%plate%layup%free)) then
        call tangent(model%plate%elements, b, stiffness(:, :, b), model%plate%setup%mesh%kinematics, motion, &
                     stiffness_factor, consistent_factor, matrices, model%plate%layup%free(:, :, b))
      else
        call tangent(model%plate%elements, b, stiffness(:, :, b), model%plate%setup%mesh%kinematics, motion, &
                     stiffness_factor, consistent_factor, matrices)
      end if
      do column = 1, 45
        transposed(:, column, :) = transpose(matrices(:, :, column))
      end do
      do lane = 1, model%plate%elements%lanes_used(b)
        call add_block(model%plate, numbering, model%plate%distribution%connectivity(:, first_element(b) + lane - 1), &
                       transposed(:, :, lane), solver, diagonal, first_element(b) + lane - 1)
      end do
    end do
    if (allocated(model%lumped)) then
      do point = 1, model%plate%distribution%owned
        call add_block(model%plate, numbering, [point], mass_factor*nodal_mass(model%lumped(:, point)), solver, &
                       diagonal)
      end do
    end if
    call add_line_supports(model, stiffness_factor, numbering, solver, diagonal)
    call add_lines(model, numbering, solver, diagonal)
    call model%plate%halo%accumulate(diagonal)
  end subroutine assemble_elements

  !> Adds the stiffness of line supports: w on the edges of circular windows, and elastic edges.
  subroutine add_line_supports(model, stiffness_factor, numbering, solver, diagonal)
    type(model_t), intent(in) :: model
    !> Factor of stiffness
    real(wp), intent(in) :: stiffness_factor
    type(numbering_t), intent(in) :: numbering
    class(linear_solver_t), intent(inout) :: solver
    !> Receives the diagonal, (5, points)
    real(wp), intent(inout) :: diagonal(:, :)
    real(wp) :: matrix(15, 15)
    integer :: k, a, b

    if (.not. allocated(model%rig%line_rig)) return
    do k = 1, size(model%rig%line_rig)
      matrix = 0
      do b = 1, 3
        do a = 1, 3
          associate (i => model%rig%line_component(k) - 5)
            matrix(5*a + i, 5*b + i) = stiffness_factor*model%rig%line_stiffness(k)*model%rig%line_weights(a, k) &
                                       *model%rig%line_weights(b, k)
          end associate
        end do
      end do
      call add_to(numbering, model%rig%line_points(:, k), matrix, solver, diagonal)
    end do
  end subroutine add_line_supports

  !> Adds the springs of lines whose displacement is prescribed. They act at the end of a step, so no
  !> factor of stiffness weights them.
  subroutine add_lines(model, numbering, solver, diagonal)
    type(model_t), intent(in) :: model
    type(numbering_t), intent(in) :: numbering
    class(linear_solver_t), intent(inout) :: solver
    !> Receives their diagonal
    real(wp), intent(inout) :: diagonal(:, :)
    real(wp), allocatable :: coefficients(:)
    real(wp) :: spring
    integer :: i, node, column

    do i = 1, size(model%loads%lines)
      associate (line => model%loads%lines(i))
        if (.not. line%load%prescribed) cycle
        do node = 1, size(line%weight)
          associate (first => line%first(node), last => line%first(node + 1) - 1)
            coefficients = reshape(line%coefficient(:, first:last), [5*(last - first + 1)])
            spring = line%share*line%stiffness*line%weight(node)
            call add_to(numbering, line%point(first:last), spring*reshape( &
                        [(coefficients(column)*coefficients, column=1, size(coefficients))], &
                        [size(coefficients), size(coefficients)]), solver, diagonal)
          end associate
        end do
      end associate
    end do
  end subroutine add_lines

  !> Adds a matrix of layer motions, transformed to the unknowns.
  subroutine add_block(plate, numbering, points, matrix, solver, diagonal, element)
    type(composite_plate_t), intent(in) :: plate
    type(numbering_t), intent(in) :: numbering
    !> The points
    integer, intent(in) :: points(:)
    !> Matrix, five rows per point
    real(wp), intent(in) :: matrix(:, :)
    class(linear_solver_t), intent(inout) :: solver
    !> Receives its diagonal
    real(wp), intent(inout) :: diagonal(:, :)
    !> Number of the element whose matrix it is
    integer, intent(in), optional :: element
    integer, allocatable :: unknown_points(:)
    real(wp), allocatable :: expanded(:, :)

    if (plate%map%layered) then
      if (any(plate%map%above(points) > 0)) then
        call plate%map%expand(points, matrix, unknown_points, expanded)
        call add_to(numbering, unknown_points, expanded, solver, diagonal, element)
        return
      end if
    end if
    call add_to(numbering, points, matrix, solver, diagonal, element)
  end subroutine add_block

  !> Adds a matrix of the unknowns of some points.
  subroutine add_to(numbering, points, matrix, solver, diagonal, element)
    type(numbering_t), intent(in) :: numbering
    !> The points
    integer, intent(in) :: points(:)
    !> Matrix, five rows per point
    real(wp), intent(in) :: matrix(:, :)
    class(linear_solver_t), intent(inout) :: solver
    !> Receives its diagonal
    real(wp), intent(inout) :: diagonal(:, :)
    !> Number of the element whose matrix it is
    integer, intent(in), optional :: element
    real(wp), allocatable :: signs(:)
    integer :: a, component

    if (any(numbering%master(points) > 0)) then
      signs = [(merge(numbering%signs(:, points(a)), 1.0_wp, numbering%master(points(a)) > 0), a=1, size(points))]
      call add_parts(numbering, points, matrix*spread(signs, 1, size(signs))*spread(signs, 2, size(signs)), solver)
    else
      call add_parts(numbering, points, matrix, solver, element)
    end if
    do a = 1, size(points)
      do component = 1, 5
        diagonal(component, points(a)) = diagonal(component, points(a)) &
                                         + matrix(5*(a - 1) + component, 5*(a - 1) + component)
      end do
    end do
  end subroutine add_to

  !> Adds a matrix of the unknowns of some points, in-plane displacements and bending separately if they are not
  !> coupled.
  subroutine add_parts(numbering, points, matrix, solver, element)
    type(numbering_t), intent(in) :: numbering
    !> The points
    integer, intent(in) :: points(:)
    !> Matrix, five rows per point
    real(wp), intent(in) :: matrix(:, :)
    class(linear_solver_t), intent(inout) :: solver
    !> Number of the element whose matrix it is
    integer, intent(in), optional :: element
    integer :: equations(5*size(points)), part, a, component
    integer, allocatable :: rows(:), number

    if (present(element)) number = element
    equations = [numbering%equation(:, points)]
    if (.not. numbering%is_separate) call solver%matrix%add(equations, matrix, number)
    do part = 1, merge(2, 0, numbering%is_separate)
      rows = [((5*a + component, component=merge(1, 3, part == 1), merge(2, 5, part == 1)), a=0, size(points) - 1)]
      if (present(element)) number = 2*(element - 1) + part
      call solver%matrix%add(equations(rows), matrix(rows, rows), number)
    end do
  end subroutine add_parts

  !> Adds stiffness to the diagonals of the jumps, and of w and the clamped unknowns on rigs.
  subroutine assemble_diagonal(plate, numbering, added, solver)
    type(composite_plate_t), intent(in) :: plate
    type(numbering_t), intent(in) :: numbering
    !> Stiffness added to the three jumps, and to u, v and w of first points, (3, points)
    real(wp), intent(in) :: added(:, :)
    class(linear_solver_t), intent(inout) :: solver
    integer :: i, component

    do i = 1, plate%distribution%owned
      if (plate%zone(i) == 0 .and. .not. any(abs(added(:, i)) > 0)) cycle
      do component = 1, 3
        if (numbering%equation(component, i) >= 0) &
          call solver%matrix%add([numbering%equation(component, i)], reshape([added(component, i)], [1, 1]))
      end do
    end do
  end subroutine assemble_diagonal

  !> Adds the symmetric off-diagonal terms of the consistent tangents of cohesive laws; their diagonals are added with
  !> those of the other interfaces.
  subroutine assemble_tangents(plate, numbering, tangents, solver)
    type(composite_plate_t), intent(in) :: plate
    type(numbering_t), intent(in) :: numbering
    !> Force per jump, (3, 3, points)
    real(wp), intent(in) :: tangents(:, :, :)
    class(linear_solver_t), intent(inout) :: solver
    real(wp) :: coupling(3, 3)
    integer :: i, k

    do i = 1, plate%distribution%owned
      if (plate%zone(i) == 0) cycle
      coupling = (tangents(:, :, i) + transpose(tangents(:, :, i)))/2
      do k = 1, 3
        coupling(k, k) = 0
      end do
      if (numbering%master(i) > 0) coupling = coupling*spread(numbering%signs(:3, i), 1, 3) &
                                                 *spread(numbering%signs(:3, i), 2, 3)
      call solver%matrix%add(numbering%equation(1:3, i), coupling)
    end do
  end subroutine assemble_tangents

  !> Mass matrix of one point from its nodal I0, I1, I2.
  pure function nodal_mass(lumped) result(mass)
    !> I0, I1, I2
    real(wp), intent(in) :: lumped(3)
    !> Mass of u, v, w, theta_x, theta_y
    real(wp) :: mass(5, 5)
    integer :: i

    mass = 0
    do i = 1, 3
      mass(i, i) = lumped(1)
    end do
    do i = 1, 2
      mass(i, 3 + i) = lumped(2)
      mass(3 + i, i) = lumped(2)
      mass(3 + i, 3 + i) = lumped(3)
    end do
  end function nodal_mass
end module operator_assembly
