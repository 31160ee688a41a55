!> Cells in which interfaces that may delaminate have layers of their own.
module layered_zones
  use cell_grids, only: cells_along, cells_from_struck
  use cell_lines, only: cell_line_t
  use interface_zones, only: zone_t
  use plies, only: ply_t
  use setups, only: setup_t
  implicit none
  private
  public :: find_heights, zones_of

contains

  !> The cells of each interface's layered rectangle, or of its doublers.
  pure function zones_of(setup) result(zones)
    type(setup_t), intent(in) :: setup
    !> One zone an interface
    type(zone_t), allocatable :: zones(:)
    type(cell_line_t) :: lines(2), columns, rows
    integer :: i

    if (.not. allocated(setup%delaminations)) then
      allocate (zones(0))
      return
    end if
    lines = [cells_from_struck(setup%plate, setup%mesh, 1), cells_from_struck(setup%plate, setup%mesh, 2)]
    allocate (zones(size(setup%delaminations)))
    do i = 1, size(zones)
      associate (interface => setup%delaminations(i))
        zones(i)%below_ply = interface%below_ply
        if (interface%bonds_doublers()) then
          call find_bond(setup, interface%doublers, zones(i))
          cycle
        end if
        columns = lines(1)%from(interface%zone_at(1))
        rows = lines(2)%from(interface%zone_at(2))
        zones(i)%columns = columns%within(interface%zone(1))
        zones(i)%rows = rows%within(interface%zone(2))
      end associate
    end do
  end function zones_of

  !> Finds the height of each interface.
  pure subroutine find_heights(skin, zones)
    !> Plies of the laminate
    type(ply_t), intent(in) :: skin(:)
    type(zone_t), intent(inout) :: zones(:)
    integer :: i

    do i = 1, size(zones)
      zones(i)%height = skin(1)%z_top
      if (zones(i)%below_ply > 0) zones(i)%height = skin(zones(i)%below_ply)%z_bottom
    end do
  end subroutine find_heights

  !> The cells in which doublers are bonded.
  pure subroutine find_bond(setup, doublers, zone)
    type(setup_t), intent(in) :: setup
    !> Their indices; 0: an unknown name
    integer, intent(in) :: doublers(:)
    type(zone_t), intent(inout) :: zone
    type(cell_line_t) :: columns, rows
    logical, allocatable :: bonded(:, :)
    integer :: i, j, k

    columns = cells_along(setup%plate, setup%mesh, 1)
    rows = cells_along(setup%plate, setup%mesh, 2)
    associate (x => columns%middles(), y => rows%middles())
      allocate (bonded(size(x), size(y)), source=.false.)
      do k = 1, size(doublers)
        if (doublers(k) == 0) cycle
        associate (doubler => setup%zones%doublers(doublers(k)))
          zone%thickness = max(zone%thickness, sum(doubler%laminate%thickness))
          do j = 1, size(y)
            bonded(:, j) = bonded(:, j) .or. [(doubler%contains([x(i), y(j)]), i=1, size(x))]
          end do
        end associate
      end do
    end associate
    zone%columns = ends_of(any(bonded, 2))
    zone%rows = ends_of(any(bonded, 1))
    zone%bonded = reshape(bonded, [size(bonded)])
  end subroutine find_bond

  !> First and last true entry; without any an empty range.
  pure function ends_of(flags) result(ends)
    !> The entries
    logical, intent(in) :: flags(:)
    integer :: ends(2)

    ends = [findloc(flags, .true., dim=1), findloc(flags, .true., dim=1, back=.true.)]
    if (.not. any(flags)) ends = [1, 0]
  end function ends_of
end module layered_zones
