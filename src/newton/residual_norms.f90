!> Norm of a residual relative to the reference force, theory (N4), separately for translations and rotations, as their
!> units differ.
module residual_norms
  use, intrinsic :: ieee_arithmetic, only: ieee_value, ieee_positive_inf
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use numberings, only: numbering_t
  use stepping_parameters, only: equilibrium_t
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: relative_residual, sums_of_squares

  !> Points whose squares are summed together
  integer, parameter :: block_length = 8

contains

  !> Residual over the largest reference force, the larger of translations and rotations; infinite if a number is not
  !> finite. The same on every rank.
  real(wp) function relative_residual(plate, operator, equilibrium, residual, references, displacement, may_end, &
                                      largest) result(norm)
    type(composite_plate_t), intent(in) :: plate
    !> The operator. Round-off of products of its diagonal and the unknowns is a lower bound of the residual: shear
    !> forces of a thin plate are small differences of large numbers
    type(tangent_operator_t), intent(in) :: operator
    !> Tolerance of the residual, and constants of Newton's method
    type(equilibrium_t), intent(in) :: equilibrium
    real(wp), contiguous, intent(in) :: residual(:, :)
    !> Sums of squares of the reference forces over this rank's points: translations and rotations, one column for each
    !> kind of forces
    real(wp), intent(in) :: references(:, :)
    real(wp), intent(in) :: displacement(:, :)
    !> False: the iteration continues for any residual, so that the bound by round-off is not needed
    logical, intent(in) :: may_end
    !> Largest forces of equilibria so far, translations and rotations: the reference once forces have become small
    real(wp), intent(inout) :: largest(2)
    real(wp) :: squares(2 + size(references)), limits(2), scale(2)

    squares = [sums_of_squares(operator%numbering, residual), references]
    call plate%communicator%sum(squares)
    norm = ieee_value(norm, ieee_positive_inf)
    if (.not. all(squares <= huge(norm))) return
    squares = sqrt(squares)
    scale = max(maxval(reshape(squares(3:), shape(references)), 2), equilibrium%controls%force_floor*largest)
    ! The thickness is the lever arm that converts forces to moments.
    scale(2) = max(scale(2), plate%layup%thickness*scale(1))
    norm = maxval(squares(:2)/max(scale, tiny(norm)))
    if (norm > equilibrium%tolerance .and. may_end) then
      limits = sums_of_squares(operator%numbering, round_off_forces(operator%diagonal, displacement))
      call plate%communicator%sum(limits)
      if (.not. all(limits <= huge(norm))) return
      limits = equilibrium%controls%last_digits*epsilon(norm)/equilibrium%tolerance*sqrt(limits)
      norm = maxval(squares(:2)/max(scale, limits, tiny(norm)))
    end if
    ! The forces of a trial state may be larger by orders of magnitude: with these as reference any later residual would
    ! be accepted.
    if (norm <= equilibrium%tolerance) largest = max(largest, scale)
  end function relative_residual

  !> Magnitude of the nodal forces whose round-off bounds the residual from below: diagonal times unknown. For moments
  !> the term of the deflection is added, with the largest coupling stiffness of a positive definite operator, the root
  !> of the product of both diagonal entries: moments in long elements of thin plates are small differences of such
  !> terms.
  pure function round_off_forces(diagonal, displacement) result(forces)
    !> Diagonal of the operator, (5, points)
    real(wp), intent(in) :: diagonal(:, :)
    real(wp), intent(in) :: displacement(:, :)
    !> The forces, (5, points)
    real(wp), allocatable :: forces(:, :)
    integer :: component

    forces = diagonal*displacement
    do component = 4, 5
      forces(component, :) = abs(forces(component, :)) &
                             + sqrt(abs(diagonal(component, :)*diagonal(3, :)))*abs(displacement(3, :))
    end do
  end function round_off_forces

  !> Sums of squares over this rank's unconstrained unknowns.
  pure function sums_of_squares(numbering, force) result(squares)
    !> Contains the constrained unknowns
    type(numbering_t), intent(in) :: numbering
    real(wp), contiguous, intent(in) :: force(:, :)
    !> Of u, v, w and of theta_x, theta_y
    real(wp) :: squares(2)
    real(wp), allocatable :: folded(:, :)

    if (any(numbering%master(:numbering%owned) > 0)) then
      folded = force(:, :numbering%owned)
      call numbering%fold(folded)
      squares = sums_without_masters(numbering, folded)
    else
      squares = sums_without_masters(numbering, force)
    end if
  end function sums_of_squares

  !> The same for points without dependent points, eight points at a time, so that the compiler vectorises the sums.
  pure function sums_without_masters(numbering, force) result(squares)
    !> Contains the constrained unknowns
    type(numbering_t), intent(in) :: numbering
    real(wp), contiguous, intent(in) :: force(:, :)
    !> Of u, v, w and of theta_x, theta_y
    real(wp) :: squares(2)
    real(wp) :: sums(5, block_length)

    sums = 0
    call add_squares(5*numbering%owned, numbering%equation, force, sums)
    squares = [sum(sums(1:3, :)), sum(sums(4:5, :))]
  end function sums_without_masters

  !> Adds the square of each number of a row to the sum of its column.
  pure subroutine add_squares(number, equation, values, sums)
    !> Number of values
    integer, intent(in) :: number
    !> Equation of each value; negative: constrained, not added
    integer, intent(in) :: equation(number)
    !> The numbers
    real(wp), intent(in) :: values(number)
    !> The sums
    real(wp), intent(inout) :: sums(5*block_length)
    integer :: start, i

    do start = 0, number - 5*block_length, 5*block_length
      do i = 1, 5*block_length
        sums(i) = sums(i) + merge(values(start + i)**2, 0.0_wp, equation(start + i) >= 0)
      end do
    end do
    do i = 1, number - start
      sums(i) = sums(i) + merge(values(start + i)**2, 0.0_wp, equation(start + i) >= 0)
    end do
  end subroutine add_squares
end module residual_norms
