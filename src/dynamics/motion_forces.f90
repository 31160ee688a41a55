!> Forces of the equation of motion (Eq. 1 of the paper, generalised alpha, theory (T1)), weighted between the start and
!> the end of a step; all unknowns in one array, so that the compiler vectorises the loops.
module motion_forces
  use kinds, only: wp
  implicit none
  private
  public :: weight_forces, weight_start_forces, find_internal_forces

contains

  !> Residual from the weighted forces at the start and the end of a step.
  pure subroutine weight_forces(number, weights, new_inertia, old_inertia, new_internal, old_internal, residual)
    !> Number of unknowns
    integer, intent(in) :: number
    !> Weights of the four forces
    real(wp), intent(in) :: weights(4)
    !> The forces at the end and at the start of the step
    real(wp), intent(in) :: new_inertia(number), old_inertia(number), new_internal(number), old_internal(number)
    !> Their negative sum
    real(wp), intent(inout) :: residual(number)
    integer :: i

    do i = 1, number
      residual(i) = -weights(1)*new_inertia(i) - weights(2)*old_inertia(i) - weights(3)*new_internal(i) &
                    - weights(4)*old_internal(i)
    end do
  end subroutine weight_forces

  !> Residual of the predictor of constant displacement, with Newmark's acceleration for it.
  pure subroutine weight_start_forces(number, weights, momentum, inertia, internal, residual)
    !> Number of unknowns
    integer, intent(in) :: number
    !> Weights of the first two
    real(wp), intent(in) :: weights(2)
    !> Mass times velocity and acceleration, and internal forces, at the start of the step
    real(wp), intent(in) :: momentum(number), inertia(number), internal(number)
    !> Their sum, with the sign of the residual
    real(wp), intent(inout) :: residual(number)
    integer :: i

    do i = 1, number
      residual(i) = weights(1)*momentum(i) + weights(2)*inertia(i) - internal(i)
    end do
  end subroutine weight_start_forces

  !> Internal forces at the end of a step from the equation of motion.
  pure subroutine find_internal_forces(number, weights, new_inertia, old_inertia, old_internal, new_internal)
    !> Number of unknowns
    integer, intent(in) :: number
    !> Weights of inertia and internal forces, at the end and at the start of the step
    real(wp), intent(in) :: weights(4)
    !> The other forces
    real(wp), intent(in) :: new_inertia(number), old_inertia(number), old_internal(number)
    !> Loads on entry, internal forces at the end of the step on return
    real(wp), intent(inout) :: new_internal(number)
    integer :: i

    do i = 1, number
      new_internal(i) = (new_internal(i) - weights(1)*new_inertia(i) - weights(2)*old_inertia(i) &
                         - weights(4)*old_internal(i))/weights(3)
    end do
  end subroutine find_internal_forces
end module motion_forces
