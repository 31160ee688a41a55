!> Matrices of elements in a row, for tests of the linear solver, and their solutions by LAPACK.
module rows_of_elements
  use communicators, only: communicator_t
  use errors, only: error_t
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  implicit none
  private
  public :: order_of, equations_of, element_matrix, define, first_row, assemble, right_hand_side, dense_solution, &
            spring

  !> Each element has this many equations and shares this many with the next
  integer, parameter :: width = 7, shared = 3

  interface
    !> LAPACK: solves symmetric equations by Bunch and Kaufman's pivoting.
    subroutine dsysv(uplo, n, columns, a, lda, pivots, b, ldb, work, lwork, info)
      import :: wp
      !> 'L': the lower triangle is given
      character, intent(in) :: uplo
      !> Order, right-hand sides, leading dimensions, size of the workspace
      integer, intent(in) :: n, columns, lda, ldb, lwork
      !> Matrix, overwritten by its factor; right-hand side, by the solution; workspace
      real(wp), intent(inout) :: a(lda, *), b(ldb, *), work(*)
      !> Row exchanges
      integer, intent(out) :: pivots(*)
      !> 0 for success
      integer, intent(out) :: info
    end subroutine dsysv
  end interface

contains

  !> Number of equations of elements in a row.
  pure integer function order_of(elements)
    integer, intent(in) :: elements

    order_of = elements*(width - shared) + shared
  end function order_of

  !> Equations of an element, not in ascending order.
  pure function equations_of(element) result(equations)
    integer, intent(in) :: element
    integer :: equations(width)
    integer :: i

    equations = [((element - 1)*(width - shared) + mod(3*i, width), i=1, width)]
  end function equations_of

  !> A symmetric matrix of an element, of sines; positive definite for a shift above 4.
  pure function element_matrix(element, shift) result(matrix)
    integer, intent(in) :: element
    real(wp), intent(in) :: shift
    real(wp) :: matrix(width, width)
    integer :: i, j

    do j = 1, width
      do i = 1, width
        matrix(i, j) = sin(real(7*element + 3*i*j + i + j, wp))
      end do
      matrix(j, j) = matrix(j, j) + shift
    end do
  end function element_matrix

  !> Defines a solver for the rows of one rank.
  subroutine define(solver, communicator, elements, positive_definite, error)
    type(linear_solver_t), intent(inout) :: solver
    type(communicator_t), intent(in) :: communicator
    integer, intent(in) :: elements
    logical, intent(in) :: positive_definite
    type(error_t), allocatable, intent(inout) :: error
    logical :: coupled(0:order_of(elements) - 1, 0:order_of(elements) - 1)
    integer, allocatable :: row_start(:), columns(:)
    integer :: first, last, row, e, i

    coupled = .false.
    do e = 1, elements
      coupled(equations_of(e), equations_of(e)) = .true.
    end do
    first = first_row(communicator%rank, communicator%size, elements)
    last = first_row(communicator%rank + 1, communicator%size, elements) - 1
    row_start = [1, (1 + count(coupled(:, first:row)), row=first, last)]
    columns = [(pack([(i, i=0, order_of(elements) - 1)], coupled(:, row)), row=first, last)]
    call solver%define(communicator, first, order_of(elements), row_start, columns, positive_definite, error)
  end subroutine define

  !> First row of a rank.
  pure integer function first_row(rank, ranks, elements)
    integer, intent(in) :: rank, ranks, elements

    first_row = rank*order_of(elements)/ranks
  end function first_row

  !> Assembles the elements, distributed cyclically over the ranks.
  subroutine assemble(solver, communicator, elements, shift, scale, error)
    type(linear_solver_t), intent(inout) :: solver
    type(communicator_t), intent(in) :: communicator
    integer, intent(in) :: elements
    real(wp), intent(in) :: shift, scale
    type(error_t), allocatable, intent(inout) :: error
    integer :: e

    call solver%matrix%clear(elements)
    do e = 1 + communicator%rank, elements, communicator%size
      call solver%matrix%add(equations_of(e), scale*element_matrix(e, shift), element=e)
    end do
    call solver%matrix%finish_assembly(error)
  end subroutine assemble

  !> This rank's part of a right-hand side.
  pure function right_hand_side(communicator, elements, number) result(part)
    type(communicator_t), intent(in) :: communicator
    integer, intent(in) :: elements, number
    real(wp), allocatable :: part(:)
    integer :: i

    part = [(cos(real(number*i, wp)), i=first_row(communicator%rank, communicator%size, elements) + 1, &
             first_row(communicator%rank + 1, communicator%size, elements))]
  end function right_hand_side

  !> Solution by LAPACK, for all rows.
  subroutine dense_solution(elements, shift, number, solution)
    integer, intent(in) :: elements, number
    real(wp), intent(in) :: shift
    real(wp), allocatable, intent(out) :: solution(:)
    type(communicator_t) :: alone
    real(wp) :: matrix(0:order_of(elements) - 1, 0:order_of(elements) - 1), work(64*order_of(elements))
    integer :: pivots(order_of(elements)), e, info

    matrix = 0
    do e = 1, elements
      matrix(equations_of(e), equations_of(e)) = matrix(equations_of(e), equations_of(e)) + element_matrix(e, shift)
    end do
    solution = right_hand_side(alone, elements, number)
    call dsysv('L', size(solution), 1, matrix, size(solution), pivots, solution, size(solution), work, size(work), info)
    if (info /= 0) error stop 'LAPACK found no solution.'
  end subroutine dense_solution

  !> Matrix of a spring.
  pure function spring(stiffness) result(matrix)
    real(wp), intent(in) :: stiffness
    real(wp) :: matrix(2, 2)

    matrix = stiffness*reshape([1.0_wp, -1.0_wp, -1.0_wp, 1.0_wp], [2, 2])
  end function spring
end module rows_of_elements
