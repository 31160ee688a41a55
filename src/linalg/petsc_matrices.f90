!> A symmetric sparse matrix of PETSc, with vectors of its rows.
module petsc_matrices
  use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
  use petscksp, only: tMat, tVec, tKSP, PETSC_TRUE, ADD_VALUES, INSERT_VALUES, MAT_FINAL_ASSEMBLY, &
                      MAT_IGNORE_LOWER_TRIANGULAR, MAT_NEW_NONZERO_LOCATION_ERR, MatSetValues, VecGetArrayF90, &
                      VecRestoreArrayF90, VecGetArrayReadF90, VecRestoreArrayReadF90
  use communicators, only: communicator_t
  use element_places, only: element_places_t
  use errors, only: error_t, fail, exit_internal
  use kinds, only: wp
  use petsc_session, only: report_petsc
  implicit none
  private
  public :: petsc_matrix_t, put, take

  !> The matrix, stored by PETSc as upper triangle (SBAIJ); its rows are distributed over the ranks in contiguous
  !> blocks.
  type :: petsc_matrix_t
    !> The matrix
    type(tMat) :: object
    !> Vectors of its rows: right-hand side and solution
    type(tVec), private :: right, left
    !> All ranks
    type(communicator_t), private :: communicator
    !> True between `define` and `release`
    logical, private :: defined = .false.
    !> Rows that this rank owns
    integer, private :: rows = 0
    !> Places of the elements' matrices
    type(element_places_t), private :: places
    !> First code that PETSc returned for an added matrix, 0 for success
    integer, private :: first_error = 0
  contains
    procedure :: define
    procedure :: clear
    procedure :: add
    procedure :: finish_assembly
    procedure :: diagonal
    procedure :: multiply
    procedure :: solve
    procedure :: release
  end type petsc_matrix_t

contains

  !> Creates the matrix with all entries of the pattern.
  subroutine define(self, communicator, first_row, total_rows, row_start, columns, error)
    class(petsc_matrix_t), intent(inout) :: self
    type(communicator_t), intent(in) :: communicator
    !> First row that this rank owns, and number of rows of all ranks
    integer, intent(in) :: first_row, total_rows
    !> Index of the first column of each owned row, from 1, shape (owned rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns of the owned rows in both triangles, from 0, ascending within a row, diagonal included
    integer, intent(in) :: columns(:)
    type(error_t), allocatable, intent(inout) :: error
    integer :: rows, row, ierr(5), inner(size(row_start) - 1), outer(size(row_start) - 1)
    logical :: is_inner(size(columns))

    self%communicator = communicator
    self%defined = .true.
    rows = size(row_start) - 1
    self%rows = rows
    do row = 1, rows
      associate (first => row_start(row), last => row_start(row + 1) - 1)
        is_inner(first:last) = columns(first:last) >= first_row + row - 1 .and. columns(first:last) < first_row + rows
        inner(row) = count(is_inner(first:last))
        outer(row) = count(columns(first:last) >= first_row + rows)
      end associate
    end do
    call MatCreateSBAIJ(communicator%handle(), 1, rows, rows, total_rows, total_rows, 0, inner, 0, outer, &
                        self%object, ierr(1))
    call MatSetOption(self%object, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE, ierr(2))
    call fill_pattern(self%object, first_row, row_start, columns, ierr(3))
    call MatSetOption(self%object, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE, ierr(4))
    call MatCreateVecs(self%object, self%left, self%right, ierr(5))
    call self%places%define(first_row, row_start, columns, is_inner)
    call report_petsc(ierr, error)
  end subroutine define

  !> Sets all entries of the pattern to zero, as PETSc removes entries that the first assembly does not set.
  subroutine fill_pattern(matrix, first_row, row_start, columns, ierr)
    type(tMat), intent(inout) :: matrix
    !> First row that this rank owns
    integer, intent(in) :: first_row
    !> Pattern of the owned rows, as for `define`
    integer, intent(in) :: row_start(:), columns(:)
    !> First non-zero code of PETSc
    integer, intent(out) :: ierr
    real(wp), allocatable :: zeros(:)
    integer :: row, n

    allocate (zeros(size(columns)), source=0.0_wp)
    do row = 1, size(row_start) - 1
      n = row_start(row + 1) - row_start(row)
      call MatSetValues(matrix, 1, [first_row + row - 1], n, columns(row_start(row):row_start(row + 1) - 1), &
                        zeros(:n), INSERT_VALUES, ierr)
      if (ierr /= 0) return
    end do
    call MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY, ierr)
    call MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY, ierr)
  end subroutine fill_pattern

  !> Zeroes the values of the matrix.
  subroutine clear(self, elements)
    class(petsc_matrix_t), intent(inout) :: self
    !> Number of elements of this rank
    integer, intent(in) :: elements

    call MatZeroEntries(self%object, self%first_error)
    if (self%first_error == 0) call self%places%begin(self%object, elements, self%first_error)
  end subroutine clear

  !> Adds an element's matrix; each is added by one rank only.
  subroutine add(self, equations, values, element)
    class(petsc_matrix_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, owned by any rank; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: values(:, :)
    !> Number of the element whose matrix it is, with no equation twice
    integer, intent(in), optional :: element
    integer :: ierr
    logical :: added

    added = .false.
    if (present(element)) call self%places%add(element, equations, values, added)
    if (added) return
    call MatSetValues(self%object, size(equations), equations, size(equations), equations, values, ADD_VALUES, ierr)
    if (self%first_error == 0) self%first_error = ierr
  end subroutine add

  !> Completes the assembly.
  subroutine finish_assembly(self, error)
    class(petsc_matrix_t), intent(inout) :: self
    !> Set on all ranks if an entry is outside the pattern
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    ierr(1) = self%first_error
    call MatAssemblyBegin(self%object, MAT_FINAL_ASSEMBLY, ierr(2))
    call MatAssemblyEnd(self%object, MAT_FINAL_ASSEMBLY, ierr(3))
    if (any(ierr /= 0)) &
      call fail(error, exit_internal, 'An element couples unknowns that the pattern of the matrix does not couple.')
    call self%communicator%agree(error)
  end subroutine finish_assembly

  !> The diagonal, this rank's rows; not a number if PETSc fails. Collective.
  function diagonal(self) result(values)
    class(petsc_matrix_t), intent(inout) :: self
    !> (owned rows)
    real(wp), allocatable :: values(:)
    integer :: ierr(2)

    allocate (values(self%rows))
    call MatGetDiagonal(self%object, self%left, ierr(1))
    call take(self%left, values, ierr(2))
    if (any(ierr /= 0)) values = ieee_value(1.0_wp, ieee_quiet_nan)
  end function diagonal

  !> Product of the matrix as it was assembled last with a vector. Collective.
  subroutine multiply(self, vector, product, error)
    class(petsc_matrix_t), intent(inout) :: self
    real(wp), intent(in) :: vector(:)
    real(wp), intent(out) :: product(:)
    type(error_t), allocatable, intent(inout) :: error
    integer :: ierr(3)

    call put(self%right, vector, ierr(1))
    call MatMult(self%object, self%right, self%left, ierr(2))
    call take(self%left, product, ierr(3))
    call report_petsc(ierr, error)
  end subroutine multiply

  !> Solution of the matrix' equations by a solver of PETSc. Collective.
  subroutine solve(self, solver, right_hand_side, solution, ierr)
    class(petsc_matrix_t), intent(inout) :: self
    !> The solver
    type(tKSP), intent(in) :: solver
    !> Owned part of the right-hand side
    real(wp), intent(in) :: right_hand_side(:)
    !> Owned part of the solution
    real(wp), intent(out) :: solution(:)
    !> PETSc's codes
    integer, intent(out) :: ierr(3)

    call put(self%right, right_hand_side, ierr(1))
    call KSPSolve(solver, self%right, self%left, ierr(2))
    call take(self%left, solution, ierr(3))
  end subroutine solve

  !> Deallocates the matrix and its vectors.
  subroutine release(self)
    class(petsc_matrix_t), intent(inout) :: self
    integer :: ierr

    if (.not. self%defined) return
    self%defined = .false.
    call VecDestroy(self%right, ierr)
    call VecDestroy(self%left, ierr)
    call MatDestroy(self%object, ierr)
  end subroutine release

  !> Copies values into a vector.
  subroutine put(vector, values, ierr)
    !> The vector
    type(tVec), intent(inout) :: vector
    !> Its owned part
    real(wp), intent(in) :: values(:)
    integer, intent(out) :: ierr
    real(wp), pointer :: inside(:)

    call VecGetArrayF90(vector, inside, ierr)
    if (ierr /= 0) return
    inside(:) = values
    call VecRestoreArrayF90(vector, inside, ierr)
  end subroutine put

  !> Copies the values of a vector.
  subroutine take(vector, values, ierr)
    !> The vector
    type(tVec), intent(inout) :: vector
    !> Its owned part
    real(wp), intent(out) :: values(:)
    integer, intent(out) :: ierr
    real(wp), pointer :: inside(:)

    call VecGetArrayReadF90(vector, inside, ierr)
    if (ierr /= 0) return
    values = inside
    call VecRestoreArrayReadF90(vector, inside, ierr)
  end subroutine take
end module petsc_matrices
