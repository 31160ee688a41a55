!> CHOLMOD behind `cholmod_factors.c`: a matrix' pattern and values, its factor, and solves.
module cholmod_library
  use, intrinsic :: iso_c_binding, only: c_double, c_int, c_ptr
  implicit none
  private
  public :: cholmod_new, cholmod_factorize, cholmod_solve, cholmod_forward, cholmod_backward, &
            cholmod_eliminate, cholmod_size, cholmod_free

  !> Outcomes of a factorization or a solve
  integer, parameter, public :: cholmod_done = 0, cholmod_not_positive = 1

  interface
    !> Takes a matrix, whose lists stay the caller's; null without memory.
    function cholmod_new(rows, border, start, columns, values) result(package) bind(c, name='implam_cholmod_new')
      import :: c_int, c_double, c_ptr
      !> Number of rows, and of those at the end that are eliminated last
      integer(c_int), value :: rows, border
      !> Where rows begin, from 0, and the columns, of the upper triangle
      integer(c_int), intent(in) :: start(*), columns(*)
      !> Values there
      real(c_double), intent(in) :: values(*)
      !> CHOLMOD's side
      type(c_ptr) :: package
    end function cholmod_new

    !> Factors a matrix without border as its values are now.
    integer(c_int) function cholmod_factorize(package) bind(c, name='implam_cholmod_factorize')
      import :: c_int, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
    end function cholmod_factorize

    !> Solves for right-hand sides one behind the other; 0 for success.
    integer(c_int) function cholmod_solve(package, number, right_hand_sides, solutions) &
      bind(c, name='implam_cholmod_solve')
      import :: c_int, c_double, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
      !> Number of right-hand sides
      integer(c_int), value :: number
      !> The right-hand sides
      real(c_double), intent(in) :: right_hand_sides(*)
      !> The solutions
      real(c_double), intent(inout) :: solutions(*)
    end function cholmod_solve

    !> Eliminates all but the border from right-hand sides, and keeps that; 0 for success.
    integer(c_int) function cholmod_forward(package, number, right_hand_sides, left) &
      bind(c, name='implam_cholmod_forward')
      import :: c_int, c_double, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
      !> Number of right-hand sides
      integer(c_int), value :: number
      !> The right-hand sides, one behind the other
      real(c_double), intent(in) :: right_hand_sides(*)
      !> What is left of them on the border
      real(c_double), intent(inout) :: left(*)
    end function cholmod_forward

    !> Goes back from there.
    subroutine cholmod_backward(package, number, on_border, solutions) bind(c, name='implam_cholmod_backward')
      import :: c_int, c_double, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
      !> Number of right-hand sides, those that went forward last
      integer(c_int), value :: number
      !> Their solutions on the border
      real(c_double), intent(in) :: on_border(*)
      !> The solutions
      real(c_double), intent(inout) :: solutions(*)
    end subroutine cholmod_backward

    !> Eliminates all but the border from the matrix as its values are now.
    integer(c_int) function cholmod_eliminate(package, complement) bind(c, name='implam_cholmod_eliminate')
      import :: c_double, c_int, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
      !> What is left of the border's matrix, by columns, its lower triangle; the rest is left as it is
      real(c_double), intent(inout) :: complement(*)
    end function cholmod_eliminate

    !> Size of the factor.
    subroutine cholmod_size(package, entries, bytes) bind(c, name='implam_cholmod_size')
      import :: c_double, c_ptr
      !> CHOLMOD's side
      type(c_ptr), value :: package
      !> Entries stored, and most memory that was in use
      real(c_double), intent(out) :: entries, bytes
    end subroutine cholmod_size

    !> Frees all but the matrix.
    subroutine cholmod_free(package) bind(c, name='implam_cholmod_free')
      import :: c_ptr
      !> CHOLMOD's side; may be null
      type(c_ptr), value :: package
    end subroutine cholmod_free
  end interface
end module cholmod_library
