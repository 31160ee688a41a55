!> What a solver of large symmetric linear equations offers. Rows are shared out among the ranks in
!> contiguous blocks; equations are numbered from 0 over all ranks.
module linear_solvers
  use communicators, only: communicator_t
  use errors, only: error_t
  use kinds, only: wp
  implicit none
  private
  public :: linear_solver_t

  !> A symmetric matrix and its factor. The factor stays what it was until `factorize` is called again,
  !> whatever values are assembled meanwhile.
  type, abstract :: linear_solver_t
    !> Number of factorizations so far
    integer :: factorizations = 0
    !> Number of right-hand sides solved so far
    integer :: solves = 0
  contains
    !> Sets the pattern of the matrix, anew if there was one; called by all ranks together.
    procedure(define), deferred :: define
    !> Zeroes the values of the matrix.
    procedure(act), deferred :: clear
    !> Adds an element's matrix; each element is added by one rank only.
    procedure(add), deferred :: add
    !> Brings the matrix together; called by all ranks after the last `add`.
    procedure(attempt), deferred :: finish_assembly
    !> Factors the matrix as it was assembled last; called by all ranks together. If it fails there is no factor.
    procedure(attempt), deferred :: factorize
    !> Solves for one right-hand side with the factor; called by all ranks together.
    procedure(solve), deferred :: solve
    !> Solves for several right-hand sides with the factor; called by all ranks together.
    procedure(solve_many), deferred :: solve_many
    !> Size of the factor, the same on every rank.
    procedure(statistics), deferred :: statistics
    !> Name of what factors the matrix, and how often something else had to.
    procedure(name_package), deferred :: package_used
    !> Frees matrix and factor.
    procedure(act), deferred :: release
  end type linear_solver_t

  abstract interface
    !> Sets the pattern of the matrix, anew if there was one; called by all ranks together.
    subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error, seen)
      import :: linear_solver_t, communicator_t, error_t
      class(linear_solver_t), intent(inout) :: self
      !> All ranks
      type(communicator_t), intent(in) :: communicator
      !> Number of the first row that this rank owns, from 0
      integer, intent(in) :: first_row
      !> Number of rows of all ranks
      integer, intent(in) :: total_rows
      !> Where the columns of each owned row begin, from 1, shape (owned rows + 1)
      integer, intent(in) :: row_start(:)
      !> Columns of the owned rows in both triangles, from 0, ascending within a row, diagonal included
      integer, intent(in) :: columns(:)
      !> A promise that saves work; a solver may refuse to factor a matrix that breaks it
      logical, intent(in) :: positive_definite
      !> Raised when the solver cannot be set up
      type(error_t), allocatable, intent(inout) :: error
      !> Rows of other ranks to which this rank adds, from 0; left out: none
      integer, intent(in), optional :: seen(:)
    end subroutine define

    !> Changes the matrix as a whole.
    subroutine act(self)
      import :: linear_solver_t
      class(linear_solver_t), intent(inout) :: self
    end subroutine act

    !> Adds an element's matrix; each element is added by one rank only.
    subroutine add(self, equations, values)
      import :: linear_solver_t, wp
      class(linear_solver_t), intent(inout) :: self
      !> Equation of each row of the element's matrix, owned by any rank; -1 for a row left out
      integer, intent(in) :: equations(:)
      !> The symmetric matrix, shape (equations, equations)
      real(wp), intent(in) :: values(:, :)
    end subroutine add

    !> Does a step that may fail.
    subroutine attempt(self, error)
      import :: linear_solver_t, error_t
      class(linear_solver_t), intent(inout) :: self
      !> Raised on all ranks when it fails
      type(error_t), allocatable, intent(inout) :: error
    end subroutine attempt

    !> Solves for one right-hand side with the factor; called by all ranks together.
    subroutine solve(self, right_hand_side, solution, error)
      import :: linear_solver_t, error_t, wp
      class(linear_solver_t), intent(inout) :: self
      !> Owned part of the right-hand side
      real(wp), intent(in) :: right_hand_side(:)
      !> Owned part of the solution
      real(wp), intent(out) :: solution(:)
      !> Raised on all ranks when there is no finite solution
      type(error_t), allocatable, intent(inout) :: error
    end subroutine solve

    !> Solves for several right-hand sides with the factor; called by all ranks together.
    subroutine solve_many(self, right_hand_sides, solutions, error)
      import :: linear_solver_t, error_t, wp
      class(linear_solver_t), intent(inout) :: self
      !> Owned parts of the right-hand sides, shape (owned rows, right-hand sides)
      real(wp), intent(in) :: right_hand_sides(:, :)
      !> Owned parts of the solutions, shape (owned rows, right-hand sides)
      real(wp), intent(out) :: solutions(:, :)
      !> Raised on all ranks when there is no finite solution
      type(error_t), allocatable, intent(inout) :: error
    end subroutine solve_many

    !> Size of the factor, the same on every rank.
    subroutine statistics(self, factor_entries, megabytes)
      import :: linear_solver_t, wp
      class(linear_solver_t), intent(in) :: self
      !> Numbers stored in the factor
      real(wp), intent(out) :: factor_entries
      !> Memory of the factorization on all ranks, in MB
      real(wp), intent(out) :: megabytes
    end subroutine statistics

    !> Name of what factors the matrix.
    function name_package(self) result(name)
      import :: linear_solver_t
      class(linear_solver_t), intent(in) :: self
      !> The name
      character(len=:), allocatable :: name
    end function name_package
  end interface
end module linear_solvers
