!> The contact force of a step, the scalar unknown that couples impactor and plate, theory (F14).
module impact_force
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use errors, only: error_t, fail, exit_internal
  use impact_parameters, only: indentation_law_t
  use tan_sun_indentation, only: indentation_t, zero_force_indentation, indentation_force, indentation_stiffness, &
                                 mean_indentation_force, indentation_work
  use kinds, only: wp
  implicit none
  private
  public :: contact_step_t, solve_impact_force

  !> Largest number of iterations: the worst case found takes 154, at a compliance of 1e100; usual steps take 3 to 6.
  integer, parameter :: max_iterations = 500

  !> Contact of impactor and plate in a step.
  type :: contact_step_t
    type(indentation_law_t) :: law
    !> Committed state of the contact
    type(indentation_t) :: state
    !> Indentation at the start of the step, and at its end for a zero force
    real(wp) :: start = 0, free = 0
    !> Compliance of impactor and plate: decrease of the indentation at the end of the step per unit of force
    real(wp) :: compliance = 0
    !> True: the unknown is the mean force over the step; false: the force at its end
    logical :: is_mean = .false.
  end type contact_step_t

contains

  !> Finds the force x with alpha_end = free - compliance*x, where x is the contact force at alpha_end or its mean over
  !> the indentations from the start to alpha_end. Either is a non-decreasing function of alpha_end, so there is exactly
  !> one such force.
  subroutine solve_impact_force(step, x, alpha_end, force_end, iterations, error)
    type(contact_step_t), intent(in) :: step
    !> The unknown
    real(wp), intent(out) :: x
    !> Indentation at the end of the step
    real(wp), intent(out) :: alpha_end
    !> Contact force at the end of the step
    real(wp), intent(out) :: force_end
    !> Newton and bisection steps taken
    integer, intent(out) :: iterations
    !> Raised if the input is not finite or the compliance negative
    type(error_t), allocatable, intent(inout) :: error
    real(wp) :: zero_force

    x = 0
    force_end = 0
    alpha_end = step%free
    iterations = 0
    if (.not. (all(ieee_is_finite([step%start, step%free, step%compliance, step%law%k, step%state%alpha_max, &
                                   step%state%dent])) .and. step%compliance >= 0)) then
      call fail(error, exit_internal, 'The contact force is requested for a number that is not finite or negative.')
      return
    end if
    zero_force = zero_force_indentation(step%law, step%state)
    if (zero_force - step%free + step%compliance*force_of_step(step, zero_force) >= 0) then
      if (step%is_mean) call release(step, zero_force, x, alpha_end)
    else
      call solve_in_contact(step, zero_force, x, alpha_end, iterations)
      force_end = indentation_force(step%law, step%state, alpha_end)
    end if
  end subroutine solve_impact_force

  !> The step ends without contact: the work is that of unloading to zero force, which gives a quadratic equation for
  !> the displacement.
  pure subroutine release(step, zero_force, x, alpha_end)
    type(contact_step_t), intent(in) :: step
    !> Indentation of zero force
    real(wp), intent(in) :: zero_force
    !> Mean force
    real(wp), intent(out) :: x
    !> On entry the indentation for a zero force, on return that at the end of the step
    real(wp), intent(inout) :: alpha_end
    real(wp) :: work, way, root

    x = 0
    if (step%start <= zero_force) return
    work = indentation_work(step%law, step%state, zero_force, step%start)
    way = step%start - alpha_end
    root = hypot(way, 2*sqrt(step%compliance)*sqrt(work))
    if (way >= 0) then
      way = 0.5_wp*(way + root)
    else
      way = 2*step%compliance*work/(root - way)
    end if
    x = work/way
    alpha_end = alpha_end - step%compliance*x
  end subroutine release

  !> Newton's iteration on the indentation, safeguarded by a bracket of the solution.
  pure subroutine solve_in_contact(step, zero_force, x, alpha_end, iterations)
    type(contact_step_t), intent(in) :: step
    !> Indentation of zero force, below the solution
    real(wp), intent(in) :: zero_force
    !> The unknown
    real(wp), intent(out) :: x
    !> Indentation at the end of the step
    real(wp), intent(out) :: alpha_end
    !> Steps taken
    integer, intent(out) :: iterations
    real(wp) :: lower, upper, residual, next, newton, change, change_before

    lower = zero_force
    upper = step%free
    alpha_end = upper
    change_before = upper - lower
    change = change_before
    do iterations = 0, max_iterations
      x = force_of_step(step, alpha_end)
      residual = alpha_end - step%free + step%compliance*x
      if (abs(residual) <= 2*epsilon(residual)*(abs(alpha_end) + abs(step%free))) exit
      if (residual > 0) upper = alpha_end
      if (residual < 0) lower = alpha_end
      newton = alpha_end - residual/(1 + step%compliance*slope_of_step(step, alpha_end, x))
      next = 0.5_wp*(lower + upper)
      if (newton > lower .and. newton < upper .and. 2*abs(newton - alpha_end) <= change_before) next = newton
      if (abs(next - alpha_end) <= epsilon(next)*abs(next)) exit
      change_before = change
      change = abs(next - alpha_end)
      alpha_end = next
    end do
  end subroutine solve_in_contact

  !> Force of a step that ends at a given indentation.
  pure real(wp) function force_of_step(step, alpha_end) result(x)
    type(contact_step_t), intent(in) :: step
    !> Indentation at its end
    real(wp), intent(in) :: alpha_end

    if (step%is_mean) then
      x = mean_indentation_force(step%law, step%state, step%start, alpha_end)
    else
      x = indentation_force(step%law, step%state, alpha_end)
    end if
  end function force_of_step

  !> Derivative of `force_of_step` with respect to the indentation at the end. For small increments the derivative of
  !> the mean suffers from cancellation and is replaced by half the stiffness.
  pure real(wp) function slope_of_step(step, alpha_end, x) result(slope)
    type(contact_step_t), intent(in) :: step
    !> Indentation at its end
    real(wp), intent(in) :: alpha_end
    !> Force of the step
    real(wp), intent(in) :: x
    ! Relative change of the indentation below which the derivative is that at the end of the step: there the difference
    ! quotient loses six digits, and the derivative differs by a part of 1e-6.
    real(wp), parameter :: min_relative_change = 1e-6_wp

    slope = indentation_stiffness(step%law, step%state, alpha_end)
    if (.not. step%is_mean) return
    if (abs(alpha_end - step%start) > min_relative_change*abs(alpha_end)) then
      slope = (indentation_force(step%law, step%state, alpha_end) - x)/(alpha_end - step%start)
    else
      slope = 0.5_wp*slope
    end if
  end function slope_of_step
end module impact_force
