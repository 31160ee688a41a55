!> Cells in which the layers on both sides of an interface have unknowns of their own.
module interface_zones
  use kinds, only: wp
  implicit none
  private
  public :: zone_t

  !> A rectangle in which the plies above and below an interface have unknowns of their own, or the cells in which the
  !> bond of doublers has.
  type :: zone_t
    !> The interface lies below this ply; 0: doublers are bonded to the struck face
    integer :: below_ply = 0
    !> First and last column of cells, then of rows
    integer :: columns(2) = 0, rows(2) = 0
    !> Height z of the interface
    real(wp) :: height = 0
    !> True for the cells with doublers, (cells); unallocated: an interface between plies of the laminate. The edges of
    !> doublers are free: both layers have points there
    logical, allocatable :: bonded(:)
    !> Thickness of the doublers
    real(wp) :: thickness = 0
  contains
    procedure :: covers
  end type zone_t

contains

  !> True if a rectangle covers a cell.
  pure logical function covers(self, place)
    class(zone_t), intent(in) :: self
    !> Column and row of the cell
    integer, intent(in) :: place(2)

    covers = all(place >= [self%columns(1), self%rows(1)]) .and. all(place <= [self%columns(2), self%rows(2)])
  end function covers
end module interface_zones
