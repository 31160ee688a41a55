!> Tridiagonal systems of the interfaces of one node.
!>
!> A traction at one interface accelerates the layers above and below it, and so changes the jumps there and at the two
!> adjacent interfaces. With the force lambda = k s + g on the jump s at the end of a step, s = s* - H C lambda, where
!> s* is the jump without tractions and H the square of the step: (1 + k H C) lambda = k s* + g, theory (T7).
module tridiagonal_systems
  use kinds, only: wp
  implicit none
  private
  public :: factorize, solve_factored, solve_tractions

contains

  !> Factors of the symmetric system (1/k + H C), for stiffnesses that are not zero and g = 0.
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
  pure subroutine solve_factored(n, factors, jumps, forces)
    !> Interfaces
    integer, intent(in) :: n
    !> Factors, (2, 3, n)
    real(wp), intent(in) :: factors(2, 3, n)
    !> Jumps without tractions, (3, n)
    real(wp), intent(in) :: jumps(3, n)
    !> Forces on the jumps, (3, n)
    real(wp), intent(out) :: forces(3, n)
    integer :: j

    forces(:, 1) = jumps(:, 1)
    do j = 2, n
      forces(:, j) = jumps(:, j) - factors(2, :, j - 1)*forces(:, j - 1)
    end do
    forces(:, n) = factors(1, :, n)*forces(:, n)
    do j = n - 1, 1, -1
      forces(:, j) = factors(1, :, j)*forces(:, j) - factors(2, :, j)*forces(:, j + 1)
    end do
  end subroutine solve_factored

  !> Solves for any stiffnesses, including zero, and given parts of the forces.
  pure subroutine solve_tractions(n, stiffness, given, diagonal, off_diagonal, jumps, forces)
    !> Interfaces
    integer, intent(in) :: n
    !> k and g, (n)
    real(wp), intent(in) :: stiffness(n), given(n)
    !> H C: its diagonal, and the off-diagonal entries, (n)
    real(wp), intent(in) :: diagonal(n), off_diagonal(n)
    !> Jumps without tractions, (n)
    real(wp), intent(in) :: jumps(n)
    !> Forces on the jumps, (n)
    real(wp), intent(out) :: forces(n)
    real(wp) :: above(n), pivot
    integer :: j

    pivot = 1 + stiffness(1)*diagonal(1)
    forces(1) = (stiffness(1)*jumps(1) + given(1))/pivot
    do j = 2, n
      above(j - 1) = stiffness(j - 1)*off_diagonal(j - 1)/pivot
      pivot = 1 + stiffness(j)*(diagonal(j) - off_diagonal(j - 1)*above(j - 1))
      forces(j) = (stiffness(j)*(jumps(j) - off_diagonal(j - 1)*forces(j - 1)) + given(j))/pivot
    end do
    do j = n - 1, 1, -1
      forces(j) = forces(j) - above(j)*forces(j + 1)
    end do
  end subroutine solve_tractions
end module tridiagonal_systems
