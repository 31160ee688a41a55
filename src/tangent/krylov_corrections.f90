!> Newton's correction by the generalised minimal residual method (flexible GMRES) with the factored operator as right
!> preconditioner (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869; Y. Saad, SIAM
!> J. Sci. Comput. 14 (1993) 461-469).
!>
!> A factorization older than the present contacts, ties, damage or deflection costs iterations, not accuracy. The norm
!> of a force is weighted by the inverse diagonal of the tangent, so that forces and moments, plate and stiff contacts
!> are comparable. Where cohesive points soften, the Krylov space is also searched for negative curvature.
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

  !> Largest dimension of the Krylov space: as many solves take about as long as a factorization.
  integer, parameter :: max_directions = 30

  !> The Krylov space, in the rows of this rank.
  type :: krylov_space_t
    !> Preconditioned basis vectors z, (rows, directions), and orthonormal basis v, (rows, directions + 1)
    real(wp), allocatable :: preconditioned(:,:),basis(:,:)
    !> Hessenberg matrix: the tangent times z in the basis v, (directions + 1, directions)
    real(wp) :: hessenberg(max_directions + 1, max_directions) = 0
    !> Dimension of the space
    integer :: directions = 0
    !> Weight of each row in the norm
    real(wp), allocatable :: weight(:)
  end type krylov_space_t

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(operator, model, tangent, diagonal, residual, tolerance, correction, error, &
                                    has_negative_curvature, converged)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> Its diagonal, (5, points); unallocated: the tangent is the factored operator
    real(wp), allocatable, intent(in) :: diagonal(:, :)
    !> Residual at the owned points, (5, points)
    real(wp), intent(in) :: residual(:, :)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> Correction, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    !> True: the tangent has negative curvature, and the correction descends
    logical, intent(out), optional :: has_negative_curvature
    !> False: the tolerance was not reached
    logical, intent(out), optional :: converged
    type(krylov_space_t) :: space
    real(wp) :: rows(operator%numbering%rows), solution(operator%numbering%rows), initial_norm, remaining
    real(wp), allocatable :: coefficients(:)
    logical :: negative_curvature

    call operator%numbering%gather(residual, rows)
    if (present(has_negative_curvature)) has_negative_curvature = .false.
    if (present(converged)) converged = .true.
    if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
      call operator%solve_rows(rows, solution, error)
      operator%solves = operator%solves + 1
    else
      space%weight = 1/abs(operator%rows_of(diagonal))
      call build_krylov_space(operator, model, tangent, rows, tolerance, space, initial_norm, coefficients, &
                              remaining, error)
      if (allocated(error)) return
      if (present(has_negative_curvature) .and. tangent%softens) then
        call find_negative_curvature(model, space, initial_norm, coefficients, negative_curvature)
        has_negative_curvature = negative_curvature
      end if
      if (present(converged)) converged = remaining <= tolerance*initial_norm
      solution = matmul(space%preconditioned(:, :space%directions), coefficients)
    end if
    if (allocated(error)) return
    call operator%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine find_krylov_correction

  !> Builds the Krylov space (Arnoldi) until the norm of the residual is within the tolerance.
  subroutine build_krylov_space(operator, model, tangent, rows, tolerance, space, initial_norm, coefficients, &
                                remaining, error)
    !> The factored operator
    type(tangent_operator_t), intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> Right-hand side
    real(wp), intent(in) :: rows(:)
    !> Norm of the residual at the end over that at the start
    real(wp), intent(in) :: tolerance
    !> The space
    type(krylov_space_t), intent(inout) :: space
    !> Norm of the right-hand side, and of the residual at the end
    real(wp), intent(out) :: initial_norm, remaining
    !> Coefficients of z in the solution
    real(wp), allocatable, intent(out) :: coefficients(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: product(size(rows)), norm_of_product
    integer :: k

    allocate (space%preconditioned(size(rows), max_directions), space%basis(size(rows), max_directions + 1))
    initial_norm = norm_of(model, space%weight, rows)
    remaining = initial_norm
    allocate (coefficients(0))
    if (.not. initial_norm > 0) return
    space%basis(:, 1) = rows/initial_norm
    do k = 1, max_directions
      call precondition(operator, tangent, space%basis(:, k), space%preconditioned(:, k), error)
      if (allocated(error)) return
      call tangent%multiply(space%preconditioned(:, k), factored_product(tangent, space%basis(:, k), &
                                                                         space%preconditioned(:, k)), &
                            product)
      call orthogonalize(model, space, k, product)
      norm_of_product = norm_of(model, space%weight, product)
      space%hessenberg(k + 1, k) = norm_of_product
      space%directions = k
      space%basis(:, k + 1) = product/max(norm_of_product, tiny(initial_norm))
      call least_squares(space%hessenberg(:k + 1, :k), initial_norm, coefficients, remaining)
      if (remaining <= tolerance*initial_norm &
          .or. .not. norm_of_product > epsilon(initial_norm)*norm2(space%hessenberg(:k, k))) exit
    end do
  end subroutine build_krylov_space

  !> Solution by the factored operator, with the rank-one term of the impactor's force (Sherman and Morrison).
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

  !> The factored operator times a vector that it was solved for: no product is needed.
  function factored_product(tangent, forces, motion) result(product)
    !> The tangent
    type(tangent_product_t), intent(in) :: tangent
    !> Right-hand side that it was solved for
    real(wp), intent(in) :: forces(:)
    !> The motion
    real(wp), intent(in) :: motion(:)
    !> The product
    real(wp) :: product(size(forces))

    product = forces
    if (tangent%force_slope > 0) product = product - tangent%force_slope*tangent%mean(motion)*tangent%pattern
  end function factored_product

  !> Orthogonalizes a vector against the basis, twice to keep it orthogonal in finite precision (L. Giraud, J. Langou,
  !> M. Rozloznik,
  !> Comput. Math. Appl. 50 (2005) 1069-1075), and stores the coefficients.
  subroutine orthogonalize(model, space, k, product)
    type(model_t), intent(in) :: model
    !> The space
    type(krylov_space_t), intent(inout) :: space
    !> Basis vectors in it
    integer, intent(in) :: k
    !> The product
    real(wp), intent(inout) :: product(:)
    real(wp) :: parts(k)
    integer :: pass

    do pass = 1, 2
      parts = matmul(space%weight*product, space%basis(:, :k))
      call model%communicator%sum(parts)
      product = product - matmul(space%basis(:, :k), parts)
      space%hessenberg(:k, k) = space%hessenberg(:k, k) + parts
    end do
  end subroutine orthogonalize

  !> Weighted norm of a vector, the same on every rank.
  real(wp) function norm_of(model, weight, forces)
    type(model_t), intent(in) :: model
    !> Weight of each row in the norm
    real(wp), intent(in) :: weight(:)
    !> The forces
    real(wp), intent(in) :: forces(:)

    norm_of = sum(weight*forces**2)
    call model%communicator%sum(norm_of)
    norm_of = sqrt(norm_of)
  end function norm_of

  !> Least-squares problem min || initial_norm e_1 - H y || of the Hessenberg matrix H, by Givens rotations.
  pure subroutine least_squares(matrix, initial_norm, coefficients, remaining)
    !> H, (k + 1, k)
    real(wp), intent(in) :: matrix(:, :)
    !> Norm of the right-hand side
    real(wp), intent(in) :: initial_norm
    !> y, (k)
    real(wp), allocatable, intent(out) :: coefficients(:)
    !> Norm of the residual
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

  !> Finds negative curvature in the space; if there is any, the coefficients become those of a descent direction.
  subroutine find_negative_curvature(model, space, initial_norm, coefficients, negative_curvature)
    type(model_t), intent(in) :: model
    !> The space
    type(krylov_space_t), intent(in) :: space
    !> Norm of the right-hand side
    real(wp), intent(in) :: initial_norm
    !> Coefficients of z
    real(wp), intent(inout) :: coefficients(:)
    !> True: there is negative curvature
    logical, intent(out) :: negative_curvature
    real(wp) :: projections(space%directions, space%directions + 1)
    integer :: k

    associate (n => space%directions)
      do k = 1, n + 1
        projections(:, k) = matmul(space%basis(:, k), space%preconditioned(:, :n))
        call model%communicator%sum(projections(:, k))
      end do
      call find_descent_direction(matmul(projections, space%hessenberg(:n + 1, :n)), projections(:, :n), &
                                  initial_norm*projections(:, &
        1), coefficients, negative_curvature)
    end associate
  end subroutine find_negative_curvature
end module krylov_corrections
