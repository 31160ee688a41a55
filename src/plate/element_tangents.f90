!> Stiffness and mass matrices of a batch of elements: the derivative of `add_internal_force`.
module element_tangents
  use kinds, only: wp
  use lagrange9, only: gauss_shapes
  use plate_options, only: kinematics_linear
  use element_batches, only: element_batches_t, lanes
  use reference_fields, only: gather
  use batch_strains, only: depends_on_slopes, strains_of_batch
  use stiffened_elements, only: add_beam_matrices
  use batch_resultants, only: in_plane_resultants, take_free_resultants
  use slope_operators, only: slopes_and_values
  use geometric_tangents, only: add_geometric_tangent
  use shear_tangents, only: add_shear_tangent
  implicit none
  private
  public :: tangent

contains

  !> stiffness_factor * tangent stiffness + mass_factor * consistent mass of the elements of a batch.
  subroutine tangent(batches, b, stiffness, kinematics, u, stiffness_factor, mass_factor, k, free)
    type(element_batches_t), intent(in) :: batches
    integer, intent(in) :: b
    !> Section stiffness of the damaged plies in the batch (lanes, 21)
    real(wp), intent(in) :: stiffness(:, :)
    integer, intent(in) :: kinematics
    !> Unknowns (5, points), used where strains depend on slopes only
    real(wp), contiguous, intent(in) :: u(:, :)
    !> Factors of stiffness and mass
    real(wp), intent(in) :: stiffness_factor, mass_factor
    !> Matrix of each element (lane, row, column); unknown = 5 (node - 1) + component
    real(wp), intent(out) :: k(lanes, 45, 45)
    !> Resultants of stress-free strains, and their energy per area; absent: none
    real(wp), intent(in), optional :: free(lanes, 7)
    real(wp) :: c(lanes, 21), x_slopes(lanes, 9, 9), y_slopes(lanes, 9, 9), values(9, 9)
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2), energies(lanes)

    k = 0.0_wp
    c = stiffness_factor*stiffness
    call slopes_and_values(9, batches%inverse_jacobian(:, :, :, b), x_slopes, y_slopes, values)
    call add_linear_tangent(c, batches%weight(:, :, b), x_slopes, y_slopes, k)
    call add_shear_tangent(batches, b, c, k)
    if (depends_on_slopes(batches, kinematics)) then
      energies = 0.0_wp
      call gather(batches%points(:, :, b), u, r)
      call strains_of_batch(batches, b, kinematics, r, strains, slopes)
      call in_plane_resultants(c, batches%weight(:, :, b), strains, energies)
      if (present(free)) call take_free_resultants(stiffness_factor*free, batches%weight(:, :, b), strains)
      if (kinematics == kinematics_linear) strains = 0
      call add_geometric_tangent(c, batches%weight(:, :, b), x_slopes, y_slopes, slopes, strains, k)
    end if
    if (allocated(batches%surface_slopes)) call turn_matrix(batches%surface_slopes(:, :, :, b), k)
    if (abs(mass_factor) > 0.0_wp) call add_mass(mass_factor*batches%mass(:, :, b), batches%weight(:, :, b), k)
    call copy_upper_triangle(k)
    if (.not. batches%has_beams(b)) return
    call gather(batches%points(:, :, b), u, r)
    call add_beam_matrices(batches, b, kinematics, r, stiffness_factor, mass_factor, k)
  end subroutine tangent

  !> Makes a matrix symmetric, of which the blocks of node pairs a <= b are known.
  pure subroutine copy_upper_triangle(k)
    real(wp), intent(inout) :: k(lanes, 45, 45)
    integer :: row, column

    do column = 1, 45
      do row = 1, column - 1
        k(:, column, row) = k(:, row, column)
      end do
    end do
  end subroutine copy_upper_triangle

  !> Turns the stiffness for displacements along the plan into that for displacements along a surface.
  pure subroutine turn_matrix(slopes, k)
    !> Slopes of the surface at the nodes (lane, node, direction)
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    real(wp), intent(inout) :: k(lanes, 45, 45)
    integer :: node, i

    call copy_upper_triangle(k)
    do node = 1, 9
      associate (u => 5*node - 4, v => 5*node - 3, w => 5*node - 2)
        do i = 1, 45
          k(:, i, w) = k(:, i, w) - slopes(:, node, 1)*k(:, i, u) - slopes(:, node, 2)*k(:, i, v)
        end do
      end associate
    end do
    do node = 1, 9
      associate (u => 5*node - 4, v => 5*node - 3, w => 5*node - 2)
        do i = 1, 45
          k(:, w, i) = k(:, w, i) - slopes(:, node, 1)*k(:, u, i) - slopes(:, node, 2)*k(:, v, i)
        end do
      end associate
    end do
  end subroutine turn_matrix

  !> Adds the linear membrane, bending and coupling stiffness to the blocks of node pairs a <= b.
  subroutine add_linear_tangent(c, weight, x_slopes, y_slopes, k)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Derivatives of the shape functions with respect to x and y (lane, point, node)
    real(wp), intent(in) :: x_slopes(lanes, 9, 9), y_slopes(lanes, 9, 9)
    !> Stiffness (lane, row, column), added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: products(lanes, 4)
    integer :: a, b, row, column

    do b = 1, 9
      column = 5*(b - 1)
      do a = 1, b
        row = 5*(a - 1)
        call slope_products(weight, x_slopes(:, :, a), y_slopes(:, :, a), x_slopes(:, :, b), y_slopes(:, :, b), &
                            products)
        call add_plane_block(c(:, 1:6), products, k(:, row + 1, column + 1), k(:, row + 1, column + 2), &
                             k(:, row + 2, column + 1), k(:, row + 2, column + 2))
        call add_plane_block(c(:, 7:12), products, k(:, row + 1, column + 4), k(:, row + 1, column + 5), &
                             k(:, row + 2, column + 4), k(:, row + 2, column + 5))
        call add_plane_block(c(:, 7:12), products, k(:, row + 4, column + 1), k(:, row + 4, column + 2), &
                             k(:, row + 5, column + 1), k(:, row + 5, column + 2))
        call add_plane_block(c(:, 13:18), products, k(:, row + 4, column + 4), k(:, row + 4, column + 5), &
                             k(:, row + 5, column + 4), k(:, row + 5, column + 5))
      end do
    end do
  end subroutine add_linear_tangent

  !> Integrals of the products of the slopes of two shape functions.
  pure subroutine slope_products(weight, ax, ay, bx, by, products)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Slopes of the shape functions of nodes a and b at the Gauss points
    real(wp), intent(in) :: ax(lanes, 9), ay(lanes, 9), bx(lanes, 9), by(lanes, 9)
    !> Integrals of a,x b,x; a,x b,y; a,y b,x; a,y b,y
    real(wp), intent(out) :: products(lanes, 4)
    integer :: g, lane

    products = 0.0_wp
    do g = 1, 9
      do lane = 1, lanes
        products(lane, 1) = products(lane, 1) + weight(lane, g)*ax(lane, g)*bx(lane, g)
        products(lane, 2) = products(lane, 2) + weight(lane, g)*ax(lane, g)*by(lane, g)
        products(lane, 3) = products(lane, 3) + weight(lane, g)*ay(lane, g)*bx(lane, g)
        products(lane, 4) = products(lane, 4) + weight(lane, g)*ay(lane, g)*by(lane, g)
      end do
    end do
  end subroutine slope_products

  !> Adds the stiffness of the strains of a vector field of node b against those of node a.
  pure subroutine add_plane_block(c, p, k11, k12, k21, k22)
    !> Stiffness 11, 12, 16, 22, 26, 66
    real(wp), intent(in) :: c(lanes, 6)
    !> Integrals from `slope_products`
    real(wp), intent(in) :: p(lanes, 4)
    !> The four entries of the block
    real(wp), intent(inout) :: k11(lanes), k12(lanes), k21(lanes), k22(lanes)
    real(wp) :: both
    integer :: lane

    do lane = 1, lanes
      k11(lane) = k11(lane) + c(lane, 1)*p(lane, 1) + c(lane, 3)*(p(lane, 2) + p(lane, 3)) + c(lane, 6)*p(lane, 4)
      both = c(lane, 3)*p(lane, 1) + c(lane, 5)*p(lane, 4)
      k12(lane) = k12(lane) + both + c(lane, 2)*p(lane, 2) + c(lane, 6)*p(lane, 3)
      k21(lane) = k21(lane) + both + c(lane, 2)*p(lane, 3) + c(lane, 6)*p(lane, 2)
      k22(lane) = k22(lane) + c(lane, 4)*p(lane, 4) + c(lane, 5)*(p(lane, 2) + p(lane, 3)) + c(lane, 6)*p(lane, 1)
    end do
  end subroutine add_plane_block

  !> Adds the consistent mass to the blocks of node pairs a <= b.
  subroutine add_mass(mass, weight, k)
    !> Section mass I0, I1, I2
    real(wp), intent(in) :: mass(lanes, 3)
    real(wp), intent(in) :: weight(lanes, 9)
    !> Matrix (lane, row, column), added to
    real(wp), intent(inout) :: k(lanes, 45, 45)
    real(wp) :: area(lanes)
    integer :: a, b, g, m, row, column

    do b = 1, 9
      column = 5*(b - 1)
      do a = 1, b
        row = 5*(a - 1)
        area = 0.0_wp
        do g = 1, 9
          area = area + gauss_shapes(a, g)*gauss_shapes(b, g)*weight(:, g)
        end do
        do m = 1, 3
          k(:, row + m, column + m) = k(:, row + m, column + m) + mass(:, 1)*area
        end do
        do m = 1, 2
          k(:, row + m, column + 3 + m) = k(:, row + m, column + 3 + m) + mass(:, 2)*area
          k(:, row + 3 + m, column + m) = k(:, row + 3 + m, column + m) + mass(:, 2)*area
          k(:, row + 3 + m, column + 3 + m) = k(:, row + 3 + m, column + 3 + m) + mass(:, 3)*area
        end do
      end do
    end do
  end subroutine add_mass
end module element_tangents
