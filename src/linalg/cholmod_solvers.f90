!> Direct solution of symmetric positive definite equations by CHOLMOD (Chen et al., ACM Trans. Math. Softw. 35, 2008).
!> Solves with one right-hand side, which most of a run consists of, take half the time of MUMPS'.
module cholmod_solvers
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use blas_settings, only: settle_blas
  use cholmod_library, only: cholmod_done, cholmod_not_positive
  use cholmod_parts, only: cholmod_part_t
  use communicators, only: communicator_t
  use errors, only: error_t, fail, exit_convergence, exit_internal, exit_usage
  use free_mechanisms, only: mechanism_t
  use freed_memory, only: give_back_freed, keep_freed
  use kinds, only: wp
  use linear_solvers, only: linear_solver_t
  use petsc_library, only: new_petsc_solver
  use text, only: to_text
  implicit none
  private
  public :: cholmod_solver_t

  !> What is wrong with a solve that comes too early
  character(len=*), parameter :: no_factor = 'The linear equations were to be solved before they were factored.'
  !> What is wrong with a matrix that has no factor
  character(len=*), parameter :: singular = 'The stiffness matrix is singular: a part of the plate can move freely.', &
                                 indefinite = 'The stiffness matrix is singular or not positive definite.', &
                                 trouble = 'CHOLMOD could not factor the stiffness matrix, probably for lack of memory.'

  !> A symmetric matrix and its factor. It has many components because a second solver may stand in.
  type, extends(linear_solver_t) :: cholmod_solver_t
    !> True: a matrix that CHOLMOD can't factor is factored by MUMPS. Set before `define`.
    logical :: falls_back = .false.
    !> Factorizations that MUMPS did
    integer, private :: fallen_back = 0
    !> This rank's part of the matrix and of the factor
    type(cholmod_part_t), private :: part
    !> The pattern of the rows that this rank owns, on several ranks, for a solver that stands in
    integer, allocatable, private :: row_start(:), columns(:)
    !> First row that this rank owns, and rows of all
    integer, private :: first_row = 0, total = 0
    !> True while there is a factor
    logical, private :: factored = .false.
    !> Finds parts of the structure that can move freely
    type(mechanism_t), private :: mechanism
    !> MUMPS with the present factor, if CHOLMOD could not make it
    class(linear_solver_t), allocatable, private :: other
  contains
    procedure :: define
    procedure :: clear
    procedure :: add
    procedure :: finish_assembly
    procedure :: factorize
    procedure :: solve
    procedure :: solve_many
    procedure :: statistics
    procedure :: package_used
    procedure :: release
    procedure, private :: find_mechanism
    procedure, private :: fall_back
    procedure, private :: apply
  end type cholmod_solver_t

contains

  !> Sets the pattern of the matrix, anew if there was one.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, positive_definite, error, seen)
    class(cholmod_solver_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> First row that this rank owns, from 0
    integer, intent(in) :: first_row
    !> Number of rows
    integer, intent(in) :: total_rows
    !> Where the columns of each owned row begin, from 1, shape (owned rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns of the owned rows in both triangles, from 0, ascending within a row, diagonal included
    integer, intent(in) :: columns(:)
    !> Must be true
    logical, intent(in) :: positive_definite
    !> Raised where CHOLMOD doesn't suit, or memory is short
    type(error_t), allocatable, intent(inout) :: error
    !> Rows of other ranks to which this rank adds, from 0; left out: none
    integer, intent(in), optional :: seen(:)
    logical :: lacks_memory

    call self%release()
    call give_back_freed()
    if (.not. positive_definite) then
      call fail(error, exit_usage, 'CHOLMOD works on positive definite matrices only: choose MUMPS.')
      return
    end if
    call settle_blas()
    self%first_row = first_row
    self%total = total_rows
    if (present(seen)) then
      call self%part%define(communicator, first_row, total_rows, row_start, columns, seen, lacks_memory)
    else
      call self%part%define(communicator, first_row, total_rows, row_start, columns, [integer ::], lacks_memory)
    end if
    if (lacks_memory) call fail(error, exit_internal, trouble)
    call communicator%agree(error)
    if (communicator%size == 1 .or. .not. self%falls_back) return
    self%row_start = row_start
    self%columns = columns
  end subroutine define

  !> Zeroes the values of the matrix.
  subroutine clear(self)
    class(cholmod_solver_t), intent(inout) :: self

    self%part%matrix%values = 0
    self%part%matrix%complete = .true.
  end subroutine clear

  !> Adds an element's matrix.
  subroutine add(self, equations, values)
    class(cholmod_solver_t), intent(inout) :: self
    !> Equation of each row of the element's matrix; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)

    call self%part%add(equations, values)
  end subroutine add

  !> Looks whether all entries had their places.
  subroutine finish_assembly(self, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> Raised when an entry falls outside the pattern
    type(error_t), allocatable, intent(inout) :: error

    if (.not. self%part%matrix%complete) &
      call fail(error, exit_internal, 'An element couples unknowns that the pattern of the matrix does not couple.')
    call self%part%communicator%agree(error)
  end subroutine finish_assembly

  !> Factors the matrix as it was assembled last. Which package does it follows from the matrix alone, so that a run
  !> taken up again has the same factor.
  subroutine factorize(self, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> Raised when the matrix is singular, or has no factor and no other solver stands in
    type(error_t), allocatable, intent(inout) :: error
    integer :: outcome
    logical :: found

    if (allocated(self%other)) then
      call self%other%release()
      deallocate (self%other)
    end if
    self%factorizations = self%factorizations + 1
    call self%part%factorize(outcome)
    self%factored = outcome == cholmod_done
    found = .false.
    if (self%factored) call self%find_mechanism(found)
    if (outcome /= cholmod_done .and. self%falls_back) then
      call self%fall_back(error)
    else if (outcome == cholmod_not_positive) then
      call fail(error, exit_convergence, indefinite)
    else if (found) then
      call fail(error, exit_convergence, singular)
    else if (outcome /= cholmod_done) then
      call fail(error, exit_convergence, trouble)
    end if
    self%factored = .not. allocated(error)
    ! Ordering and pattern are done: the same blocks are needed from now on.
    if (self%factored) call keep_freed()
  end subroutine factorize

  !> Finds out whether a part of the structure can move freely.
  subroutine find_mechanism(self, found)
    class(cholmod_solver_t), intent(inout) :: self
    !> Whether it can
    logical, intent(out) :: found
    real(wp), allocatable :: values(:)
    integer :: pass, outcome

    call self%part%diagonal(values)
    call self%mechanism%begin(values)
    do pass = 1, self%mechanism%passes
      call self%part%solve(1, self%mechanism%right_hand_side(), values, outcome)
      ! Judging asks all ranks, so they must agree that there is something to judge.
      found = self%part%communicator%any(outcome /= cholmod_done)
      if (.not. found) call self%mechanism%judge(self%part%communicator, values, found)
      if (found) exit
    end do
  end subroutine find_mechanism

  !> Factors the matrix by MUMPS.
  subroutine fall_back(self, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> Raised when that fails, too
    type(error_t), allocatable, intent(inout) :: error
    integer, allocatable :: row_start(:), columns(:), equation(:)
    integer :: row, k

    call new_petsc_solver(self%part%communicator, self%other, error)
    if (allocated(error)) return
    if (self%part%communicator%size == 1) then
      call self%part%matrix%both_triangles(row_start, columns)
      call self%other%define(self%part%communicator, 0, self%total, row_start, columns, .false., error)
      equation = [(row, row=0, self%total - 1)]
    else
      call self%other%define(self%part%communicator, self%first_row, self%total, self%row_start, self%columns, &
                             .false., error)
      equation = self%part%rows%equation
    end if
    if (allocated(error)) return
    call self%other%clear()
    associate (matrix => self%part%matrix)
      do row = 1, size(equation)
        do k = matrix%start(row) + 1, matrix%start(row + 1)
          associate (column => matrix%columns(k) + 1, value => matrix%values(k))
            if (column == row) then
              call self%other%add([equation(column)], reshape([value], [1, 1]))
            else if (abs(value) > 0) then
              call self%other%add(equation([row, column]), reshape([0.0_wp, value, value, 0.0_wp], [2, 2]))
            end if
          end associate
        end do
      end do
    end associate
    call self%other%finish_assembly(error)
    if (.not. allocated(error)) call self%other%factorize(error)
    self%fallen_back = self%fallen_back + 1
  end subroutine fall_back

  !> Solves for one right-hand side with the factor.
  subroutine solve(self, right_hand_side, solution, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> The right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> The solution
    real(wp), intent(out) :: solution(:)
    !> Raised when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(self%other)) then
      call self%other%solve(right_hand_side, solution, error)
      self%solves = self%solves + 1
    else
      call self%apply(1, right_hand_side, solution, error)
    end if
  end subroutine solve

  !> Solves for several right-hand sides with the factor.
  subroutine solve_many(self, right_hand_sides, solutions, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> The right-hand sides, shape (rows, right-hand sides)
    real(wp), intent(in) :: right_hand_sides(:, :)
    !> The solutions, shape (rows, right-hand sides)
    real(wp), intent(out) :: solutions(:, :)
    !> Raised when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error

    if (allocated(self%other)) then
      call self%other%solve_many(right_hand_sides, solutions, error)
      self%solves = self%solves + size(solutions, 2)
    else
      call self%apply(size(solutions, 2), right_hand_sides, solutions, error)
    end if
  end subroutine solve_many

  !> Applies CHOLMOD's factor.
  subroutine apply(self, number, right_hand_sides, solutions, error)
    class(cholmod_solver_t), intent(inout) :: self
    !> Number of right-hand sides
    integer, intent(in) :: number
    !> The right-hand sides one behind the other
    real(wp), intent(in) :: right_hand_sides(*)
    !> The solutions likewise
    real(wp), intent(inout) :: solutions(*)
    !> Raised when there is no finite solution
    type(error_t), allocatable, intent(inout) :: error
    integer :: numbers, outcome

    numbers = number*self%part%owned
    if (.not. self%factored) then
      solutions(:numbers) = 0
      call fail(error, exit_internal, no_factor)
      return
    end if
    call self%part%solve(number, right_hand_sides, solutions, outcome)
    self%solves = self%solves + number
    if (.not. self%part%communicator%all(outcome == cholmod_done .and. &
                                         all(ieee_is_finite(solutions(:numbers))))) &
      call fail(error, exit_convergence, 'The linear equations have no finite solution.')
  end subroutine apply

  !> Size of the factor.
  subroutine statistics(self, factor_entries, megabytes)
    class(cholmod_solver_t), intent(in) :: self
    !> Numbers stored in the factor
    real(wp), intent(out) :: factor_entries
    !> Most memory that the package used, in MB
    real(wp), intent(out) :: megabytes

    if (allocated(self%other)) then
      call self%other%statistics(factor_entries, megabytes)
    else
      call self%part%measure(factor_entries, megabytes)
    end if
  end subroutine statistics

  !> What factors the matrix.
  function package_used(self) result(name)
    class(cholmod_solver_t), intent(in) :: self
    !> Its name
    character(len=:), allocatable :: name

    name = 'CHOLMOD'
    if (self%fallen_back > 0) name = name//' ('//to_text(self%fallen_back)//' of '//to_text(self%factorizations)// &
                                     ' factorizations by MUMPS, where CHOLMOD found none)'
  end function package_used

  !> Frees matrix and factor.
  subroutine release(self)
    class(cholmod_solver_t), intent(inout) :: self

    if (allocated(self%other)) then
      call self%other%release()
      deallocate (self%other)
    end if
    call self%part%release()
    call self%mechanism%forget()
    self%factored = .false.
  end subroutine release
end module cholmod_solvers
