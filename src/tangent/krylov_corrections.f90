!> Newton's correction: the tangent's equations solved by flexible GMRES, with the factored operator as preconditioner.
!>
!> A factorization older than the present contacts, ties, damage or deflection costs iterations, not accuracy. The norm
!> of a force is weighted by the inverse diagonal of the tangent, so that forces and moments, plate and stiff contacts
!> are comparable.
module krylov_corrections
  use errors, only: error_t
  use kinds, only: wp
  use linear_maps, only: linear_map_t
  use models, only: model_t
  use tangent_operators, only: tangent_operator_t
  use tangent_products, only: tangent_product_t
  implicit none
  private
  public :: find_krylov_correction

  !> Solution by the factored operator, with the rank-one term of the impactor's force (Sherman and Morrison).
  type, extends(linear_map_t) :: factored_tangent_t
    !> The factored operator
    type(tangent_operator_t), pointer :: operator => null()
    !> The tangent, which knows the slope of the force
    type(tangent_product_t), pointer :: tangent => null()
  contains
    !> Motion under forces.
    procedure :: multiply
  end type factored_tangent_t

contains

  !> Correction of the displacement for a residual, ghosts included. Collective.
  subroutine find_krylov_correction(operator, model, tangent, diagonal, residual, tolerance, correction, error, &
                                    has_negative_curvature, converged)
    !> The factored operator
    type(tangent_operator_t), target, intent(inout) :: operator
    type(model_t), intent(in) :: model
    !> The tangent
    type(tangent_product_t), target, intent(inout) :: tangent
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
    !> True: the tangent has negative curvature along its solution, and the correction descends instead
    logical, intent(out), optional :: has_negative_curvature
    !> False: the tolerance was not reached
    logical, intent(out), optional :: converged
    type(factored_tangent_t) :: factored
    real(wp) :: rows(operator%numbering%rows), solution(operator%numbering%rows), work
    logical :: reached

    call operator%numbering%gather(residual, rows)
    if (present(has_negative_curvature)) has_negative_curvature = .false.
    factored%operator => operator
    factored%tangent => tangent
    reached = .true.
    if (tangent%is_factored() .and. .not. tangent%force_slope > 0) then
      call factored%multiply(rows, solution, error)
    else
      if (.not. operator%krylov%defined) call operator%krylov%define(model%communicator, size(rows), error)
      if (.not. allocated(error)) &
        call operator%krylov%solve(tangent, factored, 1/sqrt(abs(operator%rows_of(diagonal))), rows, tolerance, &
                                   solution, reached, error)
      if (allocated(error)) return
      if (present(has_negative_curvature) .and. tangent%softens) then
        ! The work of the residual is that of the tangent along its solution.
        work = dot_product(solution, rows)
        call model%communicator%sum(work)
        has_negative_curvature = work < 0
        if (has_negative_curvature) solution = -solution
      end if
    end if
    if (present(converged)) converged = reached
    if (allocated(error)) return
    call operator%numbering%scatter(solution, correction)
    call model%halo%update(correction)
  end subroutine find_krylov_correction

  !> Motion under forces.
  subroutine multiply(self, vector, product, error)
    !> The factored operator and the slope of the force
    class(factored_tangent_t), intent(inout) :: self
    !> Forces on this rank's rows
    real(wp), intent(in) :: vector(:)
    !> Their motion
    real(wp), intent(out) :: product(:)
    !> Set if the solve fails
    type(error_t), allocatable, intent(inout) :: error

    associate (operator => self%operator, slope => self%tangent%force_slope)
      call operator%solve_rows(vector, product, error)
      operator%solves = operator%solves + 1
      if (allocated(error) .or. .not. slope > 0) return
      product = product - slope*self%tangent%mean(product)/(1 + slope*operator%compliance)*operator%response_rows
    end associate
  end subroutine multiply
end module krylov_corrections
