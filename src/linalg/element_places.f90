!> Positions of the entries of element matrices among the values of PETSc's symmetric matrix. Assembly with stored
!> positions takes a third of the time of MatSetValues, which searches for each entry.
module element_places
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_int, c_intptr_t, c_ptr
  use petscksp, only: tMat, MatGetDiagonalBlock
  use kinds, only: wp
  implicit none
  private
  public :: element_places_t

  !> Positions of the entries of the upper triangle of an element's matrix.
  type :: places_t
    !> Column by column, 0 for constrained rows; empty if the element has equations of other ranks
    integer, allocatable :: of_entries(:)
  end type places_t

  !> Positions for all elements of a rank.
  type :: element_places_t
    !> First row that this rank owns
    integer, private :: first_row = 0
    !> Number of positions before each row of the upper triangle of this rank's diagonal block, (owned rows + 1), and
    !> the column of each position
    integer, allocatable, private :: row_start(:), columns(:)
    !> Positions for each element assembled so far
    type(places_t), allocatable, private :: elements(:)
    !> Number of assemblies so far
    integer, private :: assemblies = 0
    !> The values, during assembly
    real(wp), pointer, contiguous, private :: values(:) => null()
  contains
    procedure :: define, begin, add
    procedure, private :: find
  end type element_places_t

  interface
    !> Values of a matrix of one rank, row by row.
    integer(c_int) function get_values(matrix, values) bind(c, name='MatSeqSBAIJGetArray')
      import :: c_int, c_intptr_t, c_ptr
      integer(c_intptr_t), value :: matrix
      !> Their address
      type(c_ptr), intent(out) :: values
    end function get_values
  end interface

contains

  !> Stores the pattern.
  subroutine define(self, first_row, row_start, columns, is_stored)
    class(element_places_t), intent(out) :: self
    !> First row that this rank owns, index of the first column of each row, and all columns, as for a matrix
    integer, intent(in) :: first_row, row_start(:), columns(:)
    !> True for columns of the upper triangle that are this rank's rows
    logical, intent(in) :: is_stored(:)
    integer :: row

    self%first_row = first_row
    self%columns = pack(columns, is_stored)
    allocate (self%row_start(size(row_start)), source=0)
    do row = 1, size(row_start) - 1
      self%row_start(row + 1) = self%row_start(row) + count(is_stored(row_start(row):row_start(row + 1) - 1))
    end do
  end subroutine define

  !> Starts an assembly.
  subroutine begin(self, matrix, elements, ierr)
    class(element_places_t), intent(inout) :: self
    type(tMat), intent(in) :: matrix
    !> Number of elements of this rank
    integer, intent(in) :: elements
    integer, intent(out) :: ierr
    type(tMat) :: block
    type(c_ptr) :: address

    if (.not. allocated(self%elements)) allocate (self%elements(elements))
    self%assemblies = self%assemblies + 1
    call MatGetDiagonalBlock(matrix, block, ierr)
    if (ierr == 0) ierr = int(get_values(int(block%v, c_intptr_t), address))
    if (ierr == 0) call c_f_pointer(address, self%values, shape(self%columns))
  end subroutine begin

  !> Adds an element's matrix. In the first assembly PETSc adds it, and checks it against the pattern.
  subroutine add(self, element, equations, matrix, added)
    class(element_places_t), intent(inout) :: self
    integer, intent(in) :: element
    !> Equation of each row, -1 for a constrained row
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: matrix(:, :)
    !> True: it has been added
    logical, intent(out) :: added
    integer :: a, b, k

    added = self%assemblies > 1
    if (.not. added) return
    call self%find(element, equations)
    associate (places => self%elements(element)%of_entries)
      added = size(places) > 0
      k = 0
      do b = 1, merge(size(equations), 0, added)
        do a = 1, b
          k = k + 1
          ! The entry that PETSc would use: the two triangles may differ by round-off.
          if (places(k) > 0) self%values(places(k)) = self%values(places(k)) &
                                                      + merge(matrix(b, a), matrix(a, b), equations(a) < equations(b))
        end do
      end do
    end associate
  end subroutine add

  !> Finds the positions for an element in its first assembly.
  pure subroutine find(self, element, equations)
    class(element_places_t), intent(inout) :: self
    integer, intent(in) :: element
    !> Equation of each row, -1 for a constrained row
    integer, intent(in) :: equations(:)
    integer :: a, b, k, row

    if (allocated(self%elements(element)%of_entries)) return
    associate (rows => equations - self%first_row + 1, n => size(equations))
      k = n*(n + 1)/2
      if (any(equations >= 0 .and. (rows < 1 .or. rows >= size(self%row_start)))) k = 0
      allocate (self%elements(element)%of_entries(k), source=0)
      if (k == 0) return
      k = 0
      do b = 1, n
        do a = 1, b
          k = k + 1
          if (min(equations(a), equations(b)) < 0) cycle
          row = min(rows(a), rows(b))
          associate (first => self%row_start(row) + 1, last => self%row_start(row + 1))
            self%elements(element)%of_entries(k) = &
              first - 1 + findloc(self%columns(first:last), max(equations(a), equations(b)), 1)
          end associate
        end do
      end do
    end associate
  end subroutine find
end module element_places
