!> The upper triangle of a symmetric sparse matrix, row by row, all on one rank.
module symmetric_rows
  use kinds, only: wp
  implicit none
  private
  public :: symmetric_rows_t

  !> Upper triangle in compressed rows. The lists are pointers because a solver may share them.
  type :: symmetric_rows_t
    !> Where the entries of each row begin, from 0, shape (rows + 1)
    integer, pointer, contiguous :: start(:) => null()
    !> Columns, from 0, ascending within a row, the diagonal first
    integer, pointer, contiguous :: columns(:) => null()
    !> Values of the entries
    real(wp), pointer, contiguous :: values(:) => null()
    !> False once an entry outside the pattern was added
    logical :: complete = .true.
  contains
    !> Takes the upper triangle of a pattern.
    procedure :: define
    !> Adds an element's matrix.
    procedure :: add
    !> Frees the lists.
    procedure :: release
  end type symmetric_rows_t

contains

  !> Takes the upper triangle of a pattern, with zero values.
  subroutine define(self, row_start, columns)
    class(symmetric_rows_t), intent(inout) :: self
    !> Where the columns of each row begin, from 1, shape (rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns in both triangles, from 0, ascending within a row
    integer, intent(in) :: columns(:)
    integer :: row, rows, entries, k

    call self%release()
    rows = size(row_start) - 1
    allocate (self%start(rows + 1))
    entries = 0
    do row = 1, rows
      self%start(row) = entries
      entries = entries + count(columns(row_start(row):row_start(row + 1) - 1) >= row - 1)
    end do
    self%start(rows + 1) = entries
    allocate (self%columns(entries), self%values(entries))
    self%values = 0
    do row = 1, rows
      k = row_start(row + 1)
      self%columns(self%start(row) + 1:self%start(row + 1)) = columns(k - self%start(row + 1) + self%start(row):k - 1)
    end do
    self%complete = .true.
  end subroutine define

  !> Adds an element's matrix, walking along each of its rows once.
  pure subroutine add(self, equations, matrix)
    class(symmetric_rows_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, from 0; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: matrix(:, :)
    integer :: order(size(equations)), n, a, b, k, last, row, column

    call sort_present(equations, order, n)
    do a = 1, n
      row = equations(order(a))
      k = self%start(row + 1) + 1
      last = self%start(row + 2)
      do b = a, n
        column = equations(order(b))
        do while (k < last .and. self%columns(k) < column)
          k = k + 1
        end do
        if (self%columns(k) /= column) then
          self%complete = .false.
          cycle
        end if
        self%values(k) = self%values(k) + matrix(order(b), order(a))
        ! Two rows of the element in the same equation: both triangles fall on the diagonal.
        if (column == row .and. b > a) self%values(k) = self%values(k) + matrix(order(a), order(b))
      end do
    end do
  end subroutine add

  !> Order in which the equations that are not left out ascend.
  pure subroutine sort_present(equations, order, n)
    !> Equations, -1 for one left out
    integer, intent(in) :: equations(:)
    !> Positions of the equations, ascending, in its first `n` places
    integer, intent(out) :: order(:)
    !> Number of equations not left out
    integer, intent(out) :: n
    integer :: i, j

    n = 0
    do i = 1, size(equations)
      if (equations(i) < 0) cycle
      do j = n, 1, -1
        if (equations(order(j)) <= equations(i)) exit
        order(j + 1) = order(j)
      end do
      order(j + 1) = i
      n = n + 1
    end do
  end subroutine sort_present

  !> Frees the lists.
  subroutine release(self)
    class(symmetric_rows_t), intent(inout) :: self

    if (.not. associated(self%start)) return
    deallocate (self%start, self%columns, self%values)
  end subroutine release
end module symmetric_rows
