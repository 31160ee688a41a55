!> The correction that a step's tangent asks for, by generalised minimal residuals (GMRES) with the factored operator as
!> their preconditioner on the right (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856-869; Y. Saad, SIAM
!> J. Sci. Comput. 14 (1993) 461-469).
!>
!> A factor that lags behind contacts, ties, cohesive points, cracked plies and von Karman's strains costs solves and
!> no accuracy. Forces are held against each other by the diagonal of the tangent, so that forces and moments, plate and
!> hard contacts compare. Where cohesive points soften, the directions found also tell of negative curvature.
module krylov_corrections
  use kinds, only: wp
  use descending_directions, only: find_descending
  use errors, only: error_t
  use models, only: model_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_krylov_correction, most_directions

  !> Directions of a correction at most: the solves take about as long as a factorization then.
  integer, parameter :: most_directions = 30

  !> The space of motions, in rows of this rank.
  type :: krylov_space_t
    !> Motions, (rows, directions), and orthonormal forces, (rows, directions + 1)
    real(wp), allocatable :: motions(:, :), forces(:, :)
    !> The tangent's forces of the motions in terms of these, (directions + 1, directions)
    real(wp) :: shares(most_directions + 1, most_directions) = 0
    !> Directions found
    integer :: kept = 0
    !> Weight of each force
    real(wp), allocatable :: weight(:)
  end type krylov_space_t

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(operator, model, tangent, diagonal, residual, tolerance, correction, error, &
                                    negative, &
                             satisfied)
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
    logical, intent(out), optional :: satisfied
    type(krylov_space_t) :: space
    real(wp) :: rows(operator%numbering%rows), solution(operator%numbering%rows), first, left
    real(wp), allocatable :: shares(:)
    logical :: falls

    call operator%numbering%gather(residual, rows)
    if (present(negative)) negative = .false.
    if (present(satisfied)) satisfied = .true.
    if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
      call operator%solve_rows(rows, solution, error)
      operator%solves = operator%solves + 1
    else
      space%weight = 1/abs(operator%rows_of(diagonal))
      call span_space(operator, model, tangent, rows, tolerance, space, first, shares, left, error)
      if (allocated(error)) return
      if (present(negative) .and. tangent%softens) then
        call look_for_falls(model, space, first, shares, falls)
        negative = falls
      end if
      if (present(satisfied)) satisfied = left <= tolerance*first
      solution = matmul(space%motions(:, :space%kept), shares)
    end if
    if (allocated(error)) return
    call operator%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine find_krylov_correction

  !> Spans the space until a combination of its motions leaves little enough of the forces.
  subroutine span_space(operator, model, tangent, rows, tolerance, space, first, shares, left, error)
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
    real(wp), intent(out) :: first, left
    !> Shares of the motions in the best combination
    real(wp), allocatable, intent(out) :: shares(:)
    !> Set if a solve fails
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: product(size(rows)), size_of_product
    integer :: k

    allocate (space%motions(size(rows), most_directions), space%forces(size(rows), most_directions + 1))
    first = size_of(model, space%weight, rows)
    left = first
    allocate (shares(0))
    if (.not. first > 0) return
    space%forces(:, 1) = rows/first
    do k = 1, most_directions
      call precondition(operator, tangent, space%forces(:, k), space%motions(:, k), error)
      if (allocated(error)) return
      call tangent%multiply(space%motions(:, k), known_product(tangent, space%forces(:, k), space%motions(:, k)), &
                            product)
      call make_orthogonal(model, space, k, product)
      size_of_product = size_of(model, space%weight, product)
      space%shares(k + 1, k) = size_of_product
      space%kept = k
      space%forces(:, k + 1) = product/max(size_of_product, tiny(first))
      call least_squares(space%shares(:k + 1, :k), first, shares, left)
      if (left <= tolerance*first .or. .not. size_of_product > epsilon(first)*norm2(space%shares(:k, k))) exit
    end do
  end subroutine span_space

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
  function known_product(tangent, forces, motion) result(product)
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
  end function known_product

  !> Frees a product from the forces of the space, twice, as digits are lost (L. Giraud, J. Langou, M. Rozloznik,
  !> Comput. Math. Appl. 50 (2005) 1069-1075), and notes their shares.
  subroutine make_orthogonal(model, space, k, product)
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
      space%shares(:k, k) = space%shares(:k, k) + parts
    end do
  end subroutine make_orthogonal

  !> Size of forces, the same on every rank.
  real(wp) function size_of(model, weight, forces)
    type(model_t), intent(in) :: model
    !> Weight of each force
    real(wp), intent(in) :: weight(:)
    !> The forces
    real(wp), intent(in) :: forces(:)

    size_of = sum(weight*forces**2)
    call model%communicator%sum(size_of)
    size_of = sqrt(size_of)
  end function size_of

  !> Combination that leaves least: || first e_1 - H y ||, by Givens' rotations of H, which has one row below its
  !> diagonal.
  pure subroutine least_squares(matrix, first, shares, left)
    !> H, (k + 1, k)
    real(wp), intent(in) :: matrix(:, :)
    !> Size of the forces
    real(wp), intent(in) :: first
    !> y, (k)
    real(wp), allocatable, intent(out) :: shares(:)
    !> What is left
    real(wp), intent(out) :: left
    real(wp) :: h(size(matrix, 1), size(matrix, 2)), right(size(matrix, 1)), turn(2, 2), length
    integer :: k, n

    n = size(matrix, 2)
    h = matrix
    right = 0
    right(1) = first
    do k = 1, n
      length = max(norm2(h(k:k + 1, k)), tiny(length))
      turn(1, :) = h(k:k + 1, k)/length
      turn(2, :) = [-turn(1, 2), turn(1, 1)]
      h(k:k + 1, k:) = matmul(turn, h(k:k + 1, k:))
      right(k:k + 1) = matmul(turn, right(k:k + 1))
    end do
    left = abs(right(n + 1))
    allocate (shares(n))
    do k = n, 1, -1
      shares(k) = (right(k) - dot_product(h(k, k + 1:n), shares(k + 1:))) &
                  /sign(max(abs(h(k, k)), tiny(length)), h(k, k))
    end do
  end subroutine least_squares

  !> Looks for negative curvature in the space; where there is any the combination is one that descends.
  subroutine look_for_falls(model, space, first, shares, falls)
    type(model_t), intent(in) :: model
    !> The space
    type(krylov_space_t), intent(in) :: space
    !> Size of the forces
    real(wp), intent(in) :: first
    !> Shares of its motions
    real(wp), intent(inout) :: shares(:)
    !> True: there is negative curvature
    logical, intent(out) :: falls
    real(wp) :: works(space%kept, space%kept + 1)
    integer :: k

    associate (n => space%kept)
      do k = 1, n + 1
        works(:, k) = matmul(space%forces(:, k), space%motions(:, :n))
        call model%communicator%sum(works(:, k))
      end do
      call find_descending(matmul(works, space%shares(:n + 1, :n)), works(:, :n), first*works(:, 1), shares, falls)
    end associate
  end subroutine look_for_falls
end module krylov_corrections
