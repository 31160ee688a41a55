!> A rank's part of a symmetric positive definite matrix and its factor by CHOLMOD: all of the matrix on one rank. On
!> several each rank eliminates what only it adds to, and all of them the border together (`border_systems`).
module cholmod_parts
  use, intrinsic :: iso_c_binding, only: c_associated, c_int, c_null_ptr, c_ptr
  use border_rows, only: border_rows_t
  use border_systems, only: border_system_t
  use cholmod_library, only: cholmod_new, cholmod_factorize, cholmod_solve, cholmod_forward, cholmod_backward, &
                             cholmod_eliminate, cholmod_size, cholmod_free, cholmod_done, cholmod_not_positive
  use communicators, only: communicator_t
  use kinds, only: wp
  use symmetric_rows, only: symmetric_rows_t
  implicit none
  private
  public :: cholmod_part_t

  !> The part of a rank.
  type :: cholmod_part_t
    !> All ranks
    type(communicator_t) :: communicator
    !> Rows that this rank owns
    integer :: owned = 0
    !> The matrix: all of it on one rank, else what this rank added
    type(symmetric_rows_t) :: matrix
    !> Which rows these are, on several ranks
    type(border_rows_t) :: rows
    !> Schur complement of this rank's part, on several ranks; kept for its memory
    real(wp), allocatable, private :: complement(:, :)
    !> The border's equations, on several ranks
    type(border_system_t), private :: border
    !> CHOLMOD's side
    type(c_ptr), private :: package = c_null_ptr
  contains
    !> Takes the pattern.
    procedure :: define
    !> Adds an element's matrix.
    procedure :: add
    !> Factors the matrix.
    procedure :: factorize
    !> Solves with the factor.
    procedure :: solve
    !> The matrix' diagonal, of the rows that this rank owns.
    procedure :: diagonal
    !> Size of the factors of all ranks.
    procedure :: measure
    !> Frees everything.
    procedure :: release
    procedure, private :: factorize_all
    procedure, private :: solve_all
  end type cholmod_part_t

contains

  !> Takes the pattern; called by all ranks together.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, seen, trouble)
    class(cholmod_part_t), intent(inout) :: self
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
    !> Rows of other ranks to which this rank adds, from 0
    integer, intent(in) :: seen(:)
    !> True: memory is short on this rank
    logical, intent(out) :: trouble
    integer, allocatable :: start(:), its_columns(:)

    self%communicator = communicator
    self%owned = size(row_start) - 1
    if (communicator%size == 1) then
      call self%matrix%define(row_start, columns)
    else
      call self%rows%find(communicator, first_row, self%owned, total_rows, seen)
      call self%rows%pattern(row_start, columns, start, its_columns)
      call self%matrix%define(start, its_columns)
      call self%border%define(communicator, self%rows%border, self%rows%place)
      if (allocated(self%complement)) deallocate (self%complement)
    end if
    self%package = cholmod_new(size(self%matrix%start, kind=c_int) - 1_c_int, &
                               int(self%rows%rows - self%rows%inside, c_int), self%matrix%start, &
                               self%matrix%columns, self%matrix%values)
    trouble = .not. c_associated(self%package)
  end subroutine define

  !> Adds an element's matrix.
  subroutine add(self, equations, values)
    class(cholmod_part_t), intent(inout) :: self
    !> Equation of each row of the element's matrix; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)
    integer :: rows(size(equations))

    if (self%communicator%size == 1) then
      call self%matrix%add(equations, values)
      return
    end if
    rows = merge(-1, self%rows%row_of(max(equations, 0)), equations < 0)
    call self%matrix%add(rows, values)
    ! An equation that this rank does not have must not pass for one left out.
    if (any(rows < 0 .and. equations >= 0)) self%matrix%complete = .false.
  end subroutine add

  !> Factors the matrix; called by all ranks together.
  subroutine factorize(self, outcome)
    class(cholmod_part_t), intent(inout) :: self
    !> One of the outcomes of `cholmod_library`, the worst of all ranks
    integer, intent(out) :: outcome

    if (self%communicator%size == 1) then
      outcome = cholmod_factorize(self%package)
    else
      call self%factorize_all(outcome)
    end if
  end subroutine factorize

  !> Factors the parts of several ranks and their border.
  subroutine factorize_all(self, outcome)
    class(cholmod_part_t), intent(inout) :: self
    !> The worst outcome of all ranks
    integer, intent(out) :: outcome
    logical :: positive

    if (.not. allocated(self%complement)) &
      allocate (self%complement(self%rows%rows - self%rows%inside, self%rows%rows - self%rows%inside))
    outcome = cholmod_eliminate(self%package, self%complement)
    call self%communicator%maximum(outcome)
    if (outcome /= cholmod_done) return
    call self%border%factorize(self%complement, positive)
    if (.not. positive) outcome = cholmod_not_positive
  end subroutine factorize_all

  !> Solves with the factor; called by all ranks together.
  subroutine solve(self, number, right_hand_sides, solutions, outcome)
    class(cholmod_part_t), intent(inout) :: self
    !> Number of right-hand sides
    integer, intent(in) :: number
    !> The right-hand sides, one behind the other: the rows that this rank owns
    real(wp), intent(in) :: right_hand_sides(*)
    !> The solutions likewise
    real(wp), intent(inout) :: solutions(*)
    !> 0 for success on this rank
    integer, intent(out) :: outcome

    if (self%communicator%size == 1) then
      outcome = cholmod_solve(self%package, int(number, c_int), right_hand_sides, solutions)
    else
      call self%solve_all(number, right_hand_sides, solutions, outcome)
    end if
  end subroutine solve

  !> Solves with the factors of the parts and of the border.
  subroutine solve_all(self, number, right_hand_sides, solutions, outcome)
    class(cholmod_part_t), intent(inout) :: self
    !> Number of right-hand sides
    integer, intent(in) :: number
    !> The right-hand sides: the rows that this rank owns
    real(wp), intent(in) :: right_hand_sides(self%owned, number)
    !> The solutions likewise
    real(wp), intent(inout) :: solutions(self%owned, number)
    !> 0 for success on this rank
    integer, intent(out) :: outcome
    real(wp), allocatable :: values(:, :), forces(:, :), left(:, :)

    associate (rows => self%rows)
      allocate (values(rows%rows, number), forces(rows%border, number), source=0.0_wp)
      allocate (left(rows%rows - rows%inside, number), source=0.0_wp)
      values(rows%owned, :) = right_hand_sides
      forces(rows%place, :) = values(rows%inside + 1:, :)
      values(rows%inside + 1:, :) = 0
      outcome = cholmod_forward(self%package, int(number, c_int), values, left)
      ! A rank without memory goes on with the others, which wait for it.
      call self%border%solve(forces, left)
      if (outcome == cholmod_done) call cholmod_backward(self%package, int(number, c_int), left, values)
      solutions = values(rows%owned, :)
    end associate
  end subroutine solve_all

  !> The matrix' diagonal, of the rows that this rank owns; called by all ranks together.
  subroutine diagonal(self, values)
    class(cholmod_part_t), intent(in) :: self
    !> The diagonal
    real(wp), allocatable, intent(out) :: values(:)
    real(wp) :: border(self%rows%border)

    values = self%matrix%values(self%matrix%start(:size(self%matrix%start) - 1) + 1)
    if (self%communicator%size == 1) return
    border = 0
    border(self%rows%place) = values(self%rows%inside + 1:)
    call self%communicator%sum(border)
    values(self%rows%inside + 1:) = border(self%rows%place)
    values = values(self%rows%owned)
  end subroutine diagonal

  !> Size of the factors of all ranks; called by all ranks together.
  subroutine measure(self, factor_entries, megabytes)
    class(cholmod_part_t), intent(in) :: self
    !> Numbers stored in the factors
    real(wp), intent(out) :: factor_entries
    !> Most memory that CHOLMOD used, in MB
    real(wp), intent(out) :: megabytes

    factor_entries = 0
    megabytes = 0
    if (c_associated(self%package)) call cholmod_size(self%package, factor_entries, megabytes)
    call self%communicator%sum(factor_entries)
    call self%communicator%sum(megabytes)
    megabytes = megabytes/2**20
  end subroutine measure

  !> Frees everything.
  subroutine release(self)
    class(cholmod_part_t), intent(inout) :: self

    if (c_associated(self%package)) call cholmod_free(self%package)
    self%package = c_null_ptr
    call self%matrix%release()
  end subroutine release
end module cholmod_parts
