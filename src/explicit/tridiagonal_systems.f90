!> Tridiagonal systems of the interfaces of nodes, over lanes of nodes with the same number of interfaces.
!>
!> A traction at one interface accelerates the layers above and below it, and so changes the jumps there and at the two
!> adjacent interfaces. With the force lambda = k s + g on the jump s at the end of a step, s = s* - H C lambda, where
!> s* is the jump without tractions and H the square of the step: (1 + k H C) lambda = k s* + g, theory (T7).
module tridiagonal_systems
  use element_batches, only: lanes
  use kinds, only: wp
  implicit none
  private
  public :: factorize, solve_factored, solve_tractions

contains

  !> Factors of the symmetric system (1/k + H C) of one node, for stiffnesses that are not zero and g = 0.
  pure subroutine factorize(stiffness, diagonal, off_diagonal, factors)
    !> k, (n)
    real(wp), intent(in) :: stiffness(:)
    !> H C: its diagonal (n), and the off-diagonal entries (n, the last without meaning)
    real(wp), intent(in) :: diagonal(:), off_diagonal(:)
    !> Inverse pivot, and multiplier to the row below, (2, n)
    real(wp), intent(out) :: factors(:, :)
    real(wp) :: carried
    integer :: j

    carried = 0
    do j = 1, size(stiffness)
      factors(1, j) = 1/(1/stiffness(j) + diagonal(j) - carried)
      factors(2, j) = 0
      if (j < size(stiffness)) factors(2, j) = factors(1, j)*off_diagonal(j)
      carried = factors(2, j)*off_diagonal(j)
    end do
  end subroutine factorize

  !> Solves with the factors along x, y and z.
  pure subroutine solve_factored(n, factors, forces)
    !> Interfaces
    integer, intent(in) :: n
    !> Factors
    real(wp), intent(in) :: factors(lanes, 2, 3, n)
    !> Jumps without tractions on entry, forces on the jumps on return
    real(wp), intent(inout) :: forces(lanes, 3, n)
    integer :: j

    do j = 2, n
      forces(:, :, j) = forces(:, :, j) - factors(:, 2, :, j - 1)*forces(:, :, j - 1)
    end do
    forces(:, :, n) = factors(:, 1, :, n)*forces(:, :, n)
    do j = n - 1, 1, -1
      forces(:, :, j) = factors(:, 1, :, j)*forces(:, :, j) - factors(:, 2, :, j)*forces(:, :, j + 1)
    end do
  end subroutine solve_factored

  !> Solves along one direction for any stiffnesses, including zero, and given parts of the forces.
  pure subroutine solve_tractions(n, k, stiffness, given, diagonal, off_diagonal, jumps, forces)
    !> Interfaces, and direction, 1 to 3
    integer, intent(in) :: n, k
    !> Force per jump in this direction
    real(wp), intent(in) :: stiffness(lanes, n)
    !> Given parts of the forces
    real(wp), intent(in) :: given(lanes, 3, n)
    !> H C: its diagonal, and the off-diagonal entries
    real(wp), intent(in) :: diagonal(lanes, 3, n), off_diagonal(lanes, 3, n)
    !> Jumps without tractions
    real(wp), intent(in) :: jumps(lanes, 3, n)
    !> Forces on the jumps; those of the direction are set
    real(wp), intent(inout) :: forces(lanes, 3, n)
    real(wp) :: above(lanes, n), pivot(lanes)
    integer :: j

    pivot = 1 + stiffness(:, 1)*diagonal(:, k, 1)
    forces(:, k, 1) = (stiffness(:, 1)*jumps(:, k, 1) + given(:, k, 1))/pivot
    do j = 2, n
      above(:, j - 1) = stiffness(:, j - 1)*off_diagonal(:, k, j - 1)/pivot
      pivot = 1 + stiffness(:, j)*(diagonal(:, k, j) - off_diagonal(:, k, j - 1)*above(:, j - 1))
      forces(:, k, j) = (stiffness(:, j)*(jumps(:, k, j) - off_diagonal(:, k, j - 1)*forces(:, k, j - 1)) &
                         + given(:, k, j))/pivot
    end do
    do j = n - 1, 1, -1
      forces(:, k, j) = forces(:, k, j) - above(:, j)*forces(:, k, j + 1)
    end do
  end subroutine solve_tractions
end module tridiagonal_systems
