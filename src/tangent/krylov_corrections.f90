!> The correction that a step's tangent asks for, by generalised minimal residuals (GMRES) with the factored operator as
!> their preconditioner on the right (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869; Y. Saad, SIAM
!> J. Sci. Comput. 14 (1993) 461-469).
!>
!> A factor that lags behind contacts, ties, cohesive points, cracked plies and von Karman's strains costs solves and
!> no accuracy. Forces are held against each other by the diagonal of the tangent, so that forces and moments, plate and
!> hard contacts compare. Where cohesive points soften, the directions found also show negative curvature.
module krylov_corrections
  use kinds, only: wp
  use descent_directions, only: find_descent_direction
  use errors, only: error_t
  use models, only: model_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_krylov_correction, max_directions

  !> Directions of a correction at most: the solves take about as long as a factorization then.
  integer, parameter :: max_directions = 30

  !> The space of motions, in rows of this rank.
  type :: krylov_space_t
    !> Motions, (rows, directions), and orthonormal forces, (rows, directions + 1)
    real(wp), allocatable :: motions(:, :), forces(:, :)
    !> The tangent's forces of the motions in terms of these, (directions + 1, directions)
    real(wp) :: coefficients(max_directions + 1, max_directions) = 0
    !> Directions found
    integer :: directions = 0
    !> Weight of each force
    real(wp), allocatable :: weight(:)
  end type krylov_space_t

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(operator, model, tangent, diagonal, residual, tolerance, correction, error, &
                                    negative, &
                             converged)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> Its diagonal, (5, points); unallocated: the tangent is the factored operator
    real(wp), allocatable, intent(in) :: diagonal(:, :)
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Part of the residual that may be left
    real(wp), intent(in) :: tolerance
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    !> True: the tangent has negative curvature, and the correction descends
    logical, intent(out), optional :: negative
    !> False: more than the tolerance is left
    logical, intent(out), optional :: converged
    type(krylov_space_t) :: space
    real(wp) :: rows(operator%numbering%rows), solution(operator%numbering%rows), initial_norm, remaining
    real(wp), allocatable :: coefficients(:)
    logical :: curved_down

    call operator%numbering%gather(residual, rows)
    if (present(negative)) negative = .false.
    if (present(converged)) converged = .true.
    if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
      call operator%solve_rows(rows, solution, error)
      operator%solves = operator%solves + 1
    else
      space%weight = 1/abs(operator%rows_of(diagonal))
      call build_krylov_space(operator, model, tangent, rows, tolerance, space, initial_norm, coefficients, &
                              remaining, error)
      if (allocated(error)) return
      if (present(negative) .and. tangent%softens) then
        call find_negative_curvature(model, space, initial_norm, coefficients, curved_down)
        negative = curved_down
      end if
      if (present(converged)) converged = remaining <= tolerance*initial_norm
      solution = matmul(space%motions(:, :space%directions), coefficients)
    end if
    if (allocated(error)) return
    call operator%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine find_krylov_correction

  !> Spans the space until a combination of its motions leaves little enough of the forces.
  subroutine build_krylov_space(operator, model, tangent, rows, tolerance, space, initial_norm, coefficients, &
                                remaining, error)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> The forces
    real(wp), intent(in) :: rows(:)
    !> Part of them that may be left
    real(wp), intent(in) :: tolerance
    !> The space
    type(krylov_space_t), intent(inout) :: space
    !> Size of the forces, and of what is left
    real(wp), intent(out) :: initial_norm, remaining
    !> Shares of the motions in the best combination
    real(wp), allocatable, intent(out) :: coefficients(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: product(size(rows)), norm_of_product
    integer :: k

    allocate (space%motions(size(rows), max_directions), space%forces(size(rows), max_directions + 1))
    initial_norm = norm_of(model, space%weight, rows)
    remaining = initial_norm
    allocate (coefficients(0))
    if (.not. initial_norm > 0) return
    space%forces(:, 1) = rows/initial_norm
    do k = 1, max_directions
      call precondition(operator, tangent, space%forces(:, k), space%motions(:, k), error)
      if (allocated(error)) return
      call tangent%multiply(space%motions(:, k), factored_product(tangent, space%forces(:, k), space%motions(:, k)), &
                            product)
      call orthogonalize(model, space, k, product)
      norm_of_product = norm_of(model, space%weight, product)
      space%coefficients(k + 1, k) = norm_of_product
      space%directions = k
      space%forces(:, k + 1) = product/max(norm_of_product, tiny(initial_norm))
      call least_squares(space%coefficients(:k + 1, :k), initial_norm, coefficients, remaining)
      if (remaining <= tolerance*initial_norm &
          .or. .not. norm_of_product > epsilon(initial_norm)*norm2(space%coefficients(:k, k))) exit
    end do
  end subroutine build_krylov_space

  !> Motion under forces by the factored operator, with the impactor's force that goes with it (Sherman and Morrison).
  subroutine precondition(operator, tangent, forces, motion, error)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> The forces
    real(wp), intent(in) :: forces(:)
    !> The motion
    real(wp), intent(out) :: motion(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error

    call operator%solve_rows(forces, motion, error)
    operator%solves = operator%solves + 1
    if (allocated(error) .or. .not. tangent%force_slope > 0) return
    motion = motion - tangent%force_slope*tangent%mean(motion)/(1 + tangent%force_slope*operator%compliance) &
             *operator%response_rows
  end subroutine precondition

  !> The factored operator times a motion that it was asked for.
  function factored_product(tangent, forces, motion) result(product)
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> Forces that it was asked for
    real(wp), intent(in) :: forces(:)
    !> The motion
    real(wp), intent(in) :: motion(:)
    !> The product
    real(wp) :: product(size(forces))

    product = forces
    if (tangent%force_slope > 0) product = product - tangent%force_slope*tangent%mean(motion)*tangent%pattern
  end function factored_product

  !> Frees a product from the forces of the space, twice, as digits are lost (L. Giraud, J. Langou, M. Rozloznik,
  !> Comput. Math. Appl. 50 (2005) 1069-1075), and notes their shares.
  subroutine orthogonalize(model, space, k, product)
    type(model_t), intent(in) :: model
    !> The space
    type(krylov_space_t), intent(inout) :: space
    !> Forces in it
    integer, intent(in) :: k
    !> The product
    real(wp), intent(inout) :: product(:)
    real(wp) :: parts(k)
    integer :: pass

    do pass = 1, 2
      parts = matmul(space%weight*product, space%forces(:, :k))
      call model%communicator%sum(parts)
      product = product - matmul(space%forces(:, :k), parts)
      space%coefficients(:k, k) = space%coefficients(:k, k) + parts
    end do
  end subroutine orthogonalize

  !> Size of forces, the same on every rank.
  real(wp) function norm_of(model, weight, forces)
    type(model_t), intent(in) :: model
    !> Weight of each force
    real(wp), intent(in) :: weight(:)
    !> The forces
    real(wp), intent(in) :: forces(:)

    norm_of = sum(weight*forces**2)
    call model%communicator%sum(norm_of)
    norm_of = sqrt(norm_of)
  end function norm_of

  !> Combination that leaves least: || first e_1 - H y ||, by Givens' rotations of H, which has one row below its
  !> diagonal.
  pure subroutine least_squares(matrix, initial_norm, coefficients, remaining)
    !> H, (k + 1, k)
    real(wp), intent(in) :: matrix(:, :)
    !> Size of the forces
    real(wp), intent(in) :: initial_norm
    !> y, (k)
    real(wp), allocatable, intent(out) :: coefficients(:)
    !> What is left
    real(wp), intent(out) :: remaining
    real(wp) :: h(size(matrix, 1), size(matrix, 2)), right(size(matrix, 1)), rotation(2, 2), length
    integer :: k, n

    n = size(matrix, 2)
    h = matrix
    right = 0
    right(1) = initial_norm
    do k = 1, n
      length = max(norm2(h(k:k + 1, k)), tiny(length))
      rotation(1, :) = h(k:k + 1, k)/length
      rotation(2, :) = [-rotation(1, 2), rotation(1, 1)]
      h(k:k + 1, k:) = matmul(rotation, h(k:k + 1, k:))
      right(k:k + 1) = matmul(rotation, right(k:k + 1))
    end do
    remaining = abs(right(n + 1))
    allocate (coefficients(n))
    do k = n, 1, -1
      coefficients(k) = (right(k) - dot_product(h(k, k + 1:n), coefficients(k + 1:))) &
                  /sign(max(abs(h(k, k)), tiny(length)), h(k, k))
    end do
  end subroutine least_squares

  !> Looks for negative curvature in the space; where there is any the combination is one that descends.
  subroutine find_negative_curvature(model, space, initial_norm, coefficients, curved_down)
    type(model_t), intent(in) :: model
    !> The space
    type(krylov_space_t), intent(in) :: space
    !> Size of the forces
    real(wp), intent(in) :: initial_norm
    !> Shares of its motions
    real(wp), intent(inout) :: coefficients(:)
    !> True: there is negative curvature
    logical, intent(out) :: curved_down
    real(wp) :: works(space%directions, space%directions + 1)
    integer :: k

    associate (n => space%directions)
      do k = 1, n + 1
        works(:, k) = matmul(space%forces(:, k), space%motions(:, :n))
        call model%communicator%sum(works(:, k))
      end do
      call find_descent_direction(matmul(works, space%coefficients(:n + 1, :n)), works(:, :n), initial_norm*works(:, &
        1), coefficients, curved_down)
    end associate
  end subroutine find_negative_curvature
end module krylov_corrections
