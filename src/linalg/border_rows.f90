!> The rows of a matrix that a rank works on where each rank eliminates what only it knows: those inside, that only this
!> rank adds to, and after them its rows of the border, that several ranks add to.
module border_rows
  use communicators, only: communicator_t
  implicit none
  private
  public :: border_rows_t

  !> This rank's rows, and the border of all ranks.
  type :: border_rows_t
    !> Rows of this rank, and those of them that are inside; the rest is on the border
    integer :: rows = 0, inside = 0
    !> Equation (from 0) of each row of this rank, ascending inside and on the border, (rows)
    integer, allocatable :: equation(:)
    !> Row (from 0) of each equation; -1: other ranks', (0:equations - 1)
    integer, allocatable :: row_of(:)
    !> Row (from 1) of each equation that this rank owns, (owned equations)
    integer, allocatable :: owned(:)
    !> Rows of the border of all ranks
    integer :: border = 0
    !> Place on that border of each row that this rank has there, (rows - inside)
    integer, allocatable :: place(:)
  contains
    !> Finds them.
    procedure :: find
    !> The pattern of their matrix.
    procedure :: pattern
  end type border_rows_t

contains

  !> Finds the rows; called by all ranks together.
  subroutine find(self, communicator, first, owned, total, seen)
    class(border_rows_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> First equation that this rank owns (from 0), how many it owns, and those of all ranks
    integer, intent(in) :: first, owned, total
    !> Equations of other ranks that this rank adds to
    integer, intent(in) :: seen(:)
    integer, allocatable :: seen_by_any(:), place(:)
    logical, allocatable :: border(:), mine(:)
    integer :: i

    call communicator%allgather(seen, seen_by_any)
    allocate (border(0:total - 1), mine(0:total - 1), source=.false.)
    border(seen_by_any) = .true.
    mine(first:first + owned - 1) = .true.
    mine(seen) = .true.
    self%border = count(border)
    allocate (place(0:total - 1), source=0)
    place(pack([(i, i=0, total - 1)], border)) = [(i, i=1, self%border)]
    self%equation = [pack([(i, i=0, total - 1)], mine .and. .not. border), &
                     pack([(i, i=0, total - 1)], mine .and. border)]
    self%rows = size(self%equation)
    self%inside = count(mine .and. .not. border)
    self%place = place(self%equation(self%inside + 1:))
    if (allocated(self%row_of)) deallocate (self%row_of)
    allocate (self%row_of(0:total - 1), source=-1)
    self%row_of(self%equation) = [(i, i=0, self%rows - 1)]
    self%owned = self%row_of(first:first + owned - 1) + 1
  end subroutine find

  !> The pattern of this rank's matrix, from that of the rows that it owns. Rows inside couple as there; the border is
  !> full, which it becomes as what is inside is eliminated.
  pure subroutine pattern(self, row_start, columns, start, its_columns)
    class(border_rows_t), intent(in) :: self
    !> Where the columns of each owned row begin, from 1, (owned rows + 1)
    integer, intent(in) :: row_start(:)
    !> Columns of the owned rows in both triangles, from 0
    integer, intent(in) :: columns(:)
    !> Where those of each row of this rank begin, from 1, (rows + 1)
    integer, allocatable, intent(out) :: start(:)
    !> Columns of the rows, from 0, ascending: all of the upper triangle at least
    integer, allocatable, intent(out) :: its_columns(:)
    integer :: of_row(self%inside), i, k, row

    of_row = 0
    do i = 1, size(self%owned)
      if (self%owned(i) <= self%inside) of_row(self%owned(i)) = i
    end do
    allocate (start(self%rows + 1))
    start(1) = 1
    do row = 1, self%inside
      start(row + 1) = start(row) + row_start(of_row(row) + 1) - row_start(of_row(row))
    end do
    do row = self%inside + 1, self%rows
      start(row + 1) = start(row) + self%rows - row + 1
    end do
    allocate (its_columns(start(self%rows + 1) - 1))
    do row = 1, self%inside
      k = start(row)
      ! Inside first, then the border: ascending each, as the equations are.
      associate (mine => self%row_of(columns(row_start(of_row(row)):row_start(of_row(row) + 1) - 1)))
        its_columns(k:start(row + 1) - 1) = [pack(mine, mine < self%inside), pack(mine, mine >= self%inside)]
      end associate
    end do
    do row = self%inside + 1, self%rows
      its_columns(start(row):start(row + 1) - 1) = [(i, i=row - 1, self%rows - 1)]
    end do
  end subroutine pattern
end module border_rows
