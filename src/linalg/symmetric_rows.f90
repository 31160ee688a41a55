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
    !> First of the rows that end in the same columns as a row from its diagonal on, as those of a node do
    integer, allocatable, private :: first_alike(:)
    !> False once an entry outside the pattern was added, which spoils the values
    logical :: complete = .true.
  contains
    !> Takes the upper triangle of a pattern.
    procedure :: define
    !> Adds an element's matrix.
    procedure :: add
    !> The pattern of both triangles.
    procedure :: both_triangles
    !> Frees the lists.
    procedure :: release
    procedure, private :: find_alike
    procedure, private :: locate
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
    call self%find_alike()
    self%complete = .true.
  end subroutine define

  !> Finds the rows that hold what the row before them holds right of its diagonal.
  pure subroutine find_alike(self)
    class(symmetric_rows_t), intent(inout) :: self
    integer :: row

    allocate (self%first_alike(size(self%start) - 1))
    do row = 1, size(self%first_alike)
      self%first_alike(row) = row
      if (row == 1) cycle
      associate (before => self%columns(self%start(row - 1) + 2:self%start(row)), &
                 mine => self%columns(self%start(row) + 1:self%start(row + 1)))
        if (size(before) /= size(mine)) cycle
        if (all(before == mine)) self%first_alike(row) = self%first_alike(row - 1)
      end associate
    end do
  end subroutine find_alike

  !> Adds an element's matrix. Where its columns stand is looked up once for all rows that are alike.
  pure subroutine add(self, equations, matrix)
    class(symmetric_rows_t), intent(inout) :: self
    !> Equation of each row of the element's matrix, from 0; -1 for a row left out
    integer, intent(in) :: equations(:)
    !> The symmetric matrix, shape (equations, equations)
    real(wp), intent(in) :: matrix(:, :)
    integer :: order(size(equations)), from_end(size(equations)), n, a, b, k, row, alike

    call sort_present(equations, order, n)
    alike = 0
    do a = 1, n
      row = equations(order(a)) + 1
      if (self%first_alike(row) /= alike) call self%locate(row, equations(order(a:n)), from_end(a:n))
      alike = self%first_alike(row)
      do b = a, n
        k = self%start(row + 1) - from_end(b)
        self%values(k) = self%values(k) + matrix(order(b), order(a))
      end do
      ! Two rows of the element in the same equation: both triangles fall on the diagonal.
      do b = a + 1, n
        if (equations(order(b)) /= row - 1) exit
        k = self%start(row + 1) - from_end(b)
        self%values(k) = self%values(k) + matrix(order(a), order(b))
      end do
    end do
  end subroutine add

  !> Finds columns in a row by walking along it once.
  pure subroutine locate(self, row, columns, from_end)
    class(symmetric_rows_t), intent(inout) :: self
    !> The row, from 1
    integer, intent(in) :: row
    !> The columns, from 0, ascending
    integer, intent(in) :: columns(:)
    !> How many entries of the row follow each of them; 0 for one outside the pattern
    integer, intent(out) :: from_end(:)
    integer :: b, k, last

    k = self%start(row) + 1
    last = self%start(row + 1)
    do b = 1, size(columns)
      do while (k < last .and. self%columns(k) < columns(b))
        k = k + 1
      end do
      from_end(b) = 0
      if (self%columns(k) == columns(b)) then
        from_end(b) = last - k
      else
        self%complete = .false.
      end if
    end do
  end subroutine locate

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

  !> The pattern of both triangles, as `define` takes it.
  pure subroutine both_triangles(self, row_start, columns)
    class(symmetric_rows_t), intent(in) :: self
    !> Where the columns of each row begin, from 1, shape (rows + 1)
    integer, allocatable, intent(out) :: row_start(:)
    !> Columns in both triangles, from 0, ascending within a row
    integer, allocatable, intent(out) :: columns(:)
    integer, allocatable :: next(:)
    integer :: row, rows, k

    rows = size(self%start) - 1
    allocate (row_start(rows + 1))
    row_start = [1, (self%start(row + 1) - self%start(row), row=1, rows)]
    do row = 1, rows
      do k = self%start(row) + 2, self%start(row + 1)
        row_start(self%columns(k) + 2) = row_start(self%columns(k) + 2) + 1
      end do
    end do
    do row = 1, rows
      row_start(row + 1) = row_start(row) + row_start(row + 1)
    end do
    allocate (columns(row_start(rows + 1) - 1))
    next = row_start(:rows)
    do row = 1, rows
      ! What stands left of the diagonal has come by now, in ascending order.
      associate (mine => self%columns(self%start(row) + 1:self%start(row + 1)))
        columns(next(row):next(row) + size(mine) - 1) = mine
        do k = 2, size(mine)
          columns(next(mine(k) + 1)) = row - 1
          next(mine(k) + 1) = next(mine(k) + 1) + 1
        end do
      end associate
    end do
  end subroutine both_triangles

  !> Frees the lists.
  subroutine release(self)
    class(symmetric_rows_t), intent(inout) :: self

    if (.not. associated(self%start)) return
    deallocate (self%start, self%columns, self%values, self%first_alike)
  end subroutine release
end module symmetric_rows
