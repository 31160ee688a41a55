!> Extents of an adaptive layered rectangle: full extents along x and y, centred on the struck point, so that a quarter
!> and the full plate have the same layers.
module layer_extents
  use delaminated_regions, only: cells_within
  use kinds, only: wp
  implicit none
  private
  public :: largest_extents, widened_extent

  !> Onset index from which a cell is layered, so that layers are inserted before the stress has doubled to the
  !> strength. With .25 the force of an impact changes by .09 to .16 % (doc/studies/interfaces.md).
  real(wp), parameter, public :: onset_of_layers = 0.5_wp
  !> Layered cells required ahead of damage, and additional cells of each extension, so that extensions are few. The
  !> effect of other numbers is given in doc/studies/interfaces.md.
  integer, parameter, public :: cells_ahead = 3, cells_at_once = 4
  !> Thicknesses of the laminate that the layers reach at least beyond damage, patch and starter: self-equilibrated
  !> shear decays within one (Saint-Venant's principle). More cells ahead change the force of an impact by .09 to .16 %
  !> (doc/studies/interfaces.md).
  real(wp), parameter, public :: thicknesses_ahead = 2
  !> Tolerance of round-off, in cells: far above 1e-16, and extents are compared in whole cells.
  real(wp), parameter :: rounding = 1.0e-6_wp

contains

  !> Largest extents of layers: the core, or without one the plate; a run reports if damage leaves the core.
  pure function largest_extents(extents, core, cell, length) result(largest)
    !> Present extents, those of the core, and the plate's lengths
    real(wp), intent(in) :: extents(2), core(2), length(2)
    !> Side of the core's cells; 0: no core
    real(wp), intent(in) :: cell
    !> Along x and y
    real(wp) :: largest(2)

    largest = merge(max(extents, core), length, cell > 0)
  end function largest_extents

  !> Extent widened on each side by a number of cells of the size of its outermost ones: by fewer cells where their size
  !> increases with the distance, but by at least one if there is one.
  pure real(wp) function widened_extent(edges, extent, cells, least) result(wider)
    !> Edges of the cells along one direction, the struck point at 0
    real(wp), intent(in) :: edges(:)
    !> The extent to be widened
    real(wp), intent(in) :: extent
    !> Cells on each side
    integer, intent(in) :: cells
    !> Smallest length of the extension, rounded up to cells
    real(wp), intent(in), optional :: least
    real(wp) :: reach, side
    integer :: range(2), last

    last = size(edges) - 1
    range = cells_within(edges, extent)
    side = edges(range(2) + 1) - edges(range(2))
    ! In a model that begins at the struck point, the first cell of the range is the innermost one.
    if (edges(1) < -rounding*edges(last + 1)) side = min(side, edges(range(1) + 1) - edges(range(1)))
    reach = extent/2 + (cells - rounding)*side
    if (present(least)) reach = max(reach, extent/2 + least*(1 - rounding))
    range = [max(1, range(1) - 1), min(last, range(2) + 1)]
    do while (range(1) > 1 .and. edges(range(1)) > -reach)
      range(1) = range(1) - 1
    end do
    do while (range(2) < last .and. edges(range(2) + 1) < reach)
      range(2) = range(2) + 1
    end do
    wider = 2*max(-edges(range(1)), edges(range(2) + 1))
  end function widened_extent
end module layer_extents
