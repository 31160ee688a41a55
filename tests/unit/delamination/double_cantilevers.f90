!> The double cantilever beam as a strip of three-node Mindlin cells, for the test of energy release rates.
module double_cantilevers
  use kinds, only: wp
  implicit none
  private
  public :: solve_double_cantilever

  !> Moduli, thickness of an arm, width, crack length and load (N, mm).
  real(wp), parameter :: e1 = 120e3_wp, g13 = 5e3_wp, t = 1.5_wp
  real(wp), parameter, public :: width = 25, crack = 50, load = 50
  !> Bending and shear stiffness of an arm.
  real(wp), parameter, public :: bending = e1*width*t**3/12, shear = 5*g13*width*t/6

contains

  !> One arm from its loaded end at edges(1) = 0 to the tied part, which begins where x = crack; the other arm is its
  !> mirror image. Force is the tie force, jump is twice the deflection of the arm.
  subroutine solve_double_cantilever(edges, force, jump)
    real(wp), intent(in) :: edges(:)
    real(wp), allocatable, intent(out) :: force(:), jump(:)
    real(wp), allocatable :: stiffness(:, :), system(:, :), solution(:)
    integer :: cells, nodes, cell, node, place

    cells = size(edges) - 1
    nodes = 2*cells + 1
    allocate (stiffness(2*nodes, 2*nodes), solution(2*nodes), source=0.0_wp)
    do cell = 1, cells
      place = 4*(cell - 1)
      stiffness(place + 1:place + 6, place + 1:place + 6) = stiffness(place + 1:place + 6, place + 1:place + 6) + &
                                                            cell_stiffness(edges(cell + 1) - edges(cell))
    end do
    system = stiffness
    solution(1) = load
    do node = 1, nodes
      if (edges((node + 1)/2) < crack - 1e-9_wp) cycle
      system(2*node - 1, :) = 0
      system(:, 2*node - 1) = 0
      system(2*node - 1, 2*node - 1) = 1
    end do
    call eliminate(system, solution)
    force = -matmul(stiffness(1::2, :), solution)
    jump = 2*solution(1::2)
    where (jump > 0) force = 0
  end subroutine solve_double_cantilever

  !> Stiffness of a cell for w and theta at its three nodes, two Gauss points.
  pure function cell_stiffness(length) result(stiffness)
    real(wp), intent(in) :: length
    real(wp) :: stiffness(6, 6), s, shape(3), slope(3), curvature(6), angle(6)
    integer :: point, i

    stiffness = 0
    do point = -1, 1, 2
      s = point/sqrt(3.0_wp)
      shape = [s*(s - 1)/2, 1 - s**2, s*(s + 1)/2]
      slope = [s - 0.5_wp, -2*s, s + 0.5_wp]*2/length
      curvature = 0
      curvature(2::2) = slope
      angle(1::2) = slope
      angle(2::2) = shape
      do i = 1, 6
        stiffness(:, i) = stiffness(:, i) + (bending*curvature*curvature(i) + shear*angle*angle(i))*length/2
      end do
    end do
  end function cell_stiffness

  !> Solves a symmetric positive definite system.
  pure subroutine eliminate(matrix, solution)
    real(wp), intent(inout) :: matrix(:, :), solution(:)
    real(wp) :: factor
    integer :: i, j

    do i = 1, size(solution)
      do j = i + 1, size(solution)
        if (matrix(j, i) == 0) cycle
        factor = matrix(j, i)/matrix(i, i)
        matrix(j, i:) = matrix(j, i:) - factor*matrix(i, i:)
        solution(j) = solution(j) - factor*solution(i)
      end do
    end do
    do i = size(solution), 1, -1
      solution(i) = (solution(i) - dot_product(matrix(i, i + 1:), solution(i + 1:)))/matrix(i, i)
    end do
  end subroutine eliminate
end module double_cantilevers
