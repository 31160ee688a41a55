!> Zones and starters as the mesh gives them: both are whole cells, so their sizes may differ from the deck's.
module deck_extents
  use cell_grids, only: cell_edges
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use delaminated_regions, only: extent_of_cells
  use delamination_parameters, only: delamination_t
  use kinds, only: wp
  use text, only: line_t, to_text
  implicit none
  private
  public :: check_extents, extent_lines

  !> Difference from the size asked for, relative to it, that a user is warned of.
  real(wp), parameter :: noticeable = 0.05_wp

contains

  !> Warns of zones and starters that the mesh makes noticeably larger or smaller than the deck asks.
  subroutine check_extents(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    !> Receives the warnings
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: x_edges(:), y_edges(:)
    real(wp) :: zone(2), starter(2)
    integer :: place

    if (problems%errors() > 0 .or. size(deck%delaminations) == 0) return
    x_edges = cell_edges(deck%plate, deck%mesh, 1)
    y_edges = cell_edges(deck%plate, deck%mesh, 2)
    do place = 1, size(deck%delaminations)
      associate (d => deck%delaminations(place))
        call extents_of(x_edges, y_edges, deck%delaminations(place), zone, starter)
        if (differs(zone, d%zone)) call remark(deck%settings, problems, 'delamination', 'zone', &
          'a zone is whole cells; this mesh makes it '//shown(zone)//'.', place)
        if (deck%settings%is_given('delamination', 'starter', place) .and. differs(starter, [d%starter, d%starter])) &
          call remark(deck%settings, problems, 'delamination', 'starter', &
                      'a starter is whole cells; this mesh makes it '//shown(starter)//'.', place)
      end associate
    end do
  end subroutine check_extents

  !> What zone and starter of each interface are, for the log.
  pure function extent_lines(deck) result(lines)
    !> The deck, checked
    type(deck_t), intent(in) :: deck
    !> One line an interface
    type(line_t), allocatable :: lines(:)
    real(wp), allocatable :: x_edges(:), y_edges(:)
    real(wp) :: zone(2), starter(2)
    integer :: place

    allocate (lines(size(deck%delaminations)))
    if (size(lines) == 0) return
    x_edges = cell_edges(deck%plate, deck%mesh, 1)
    y_edges = cell_edges(deck%plate, deck%mesh, 2)
    do place = 1, size(lines)
      call extents_of(x_edges, y_edges, deck%delaminations(place), zone, starter)
      lines(place)%text = 'Interface below ply '//to_text(deck%delaminations(place)%below_ply)//': the mesh makes '// &
                          'the zone '//shown(zone)//' and the starter '//shown(starter)//'.'
    end do
  end function extent_lines

  !> Sizes of zone and starter on the mesh.
  pure subroutine extents_of(x_edges, y_edges, delamination, zone, starter)
    !> Edges of the cells along x and y, the struck point at 0
    real(wp), intent(in) :: x_edges(:), y_edges(:)
    !> The interface as the deck gives it
    type(delamination_t), intent(in) :: delamination
    !> Extents along x and y on the whole plate
    real(wp), intent(out) :: zone(2), starter(2)

    zone = [extent_of_cells(x_edges, delamination%zone(1)), extent_of_cells(y_edges, delamination%zone(2))]
    starter = [extent_of_cells(x_edges, delamination%starter), extent_of_cells(y_edges, delamination%starter)]
    starter = min(starter, zone)
  end subroutine extents_of

  !> True if a size differs from what was asked for by more than a user would overlook.
  pure logical function differs(given, asked)
    !> Extents on the mesh and in the deck
    real(wp), intent(in) :: given(2), asked(2)

    differs = any(abs(given - asked) > noticeable*asked)
  end function differs

  !> Two extents for the reader, to four digits.
  pure function shown(extents) result(text)
    !> Along x and y
    real(wp), intent(in) :: extents(2)
    !> Such as `0.012 by 0.0125`
    character(len=:), allocatable :: text

    text = to_text(rounded(extents(1)))//' by '//to_text(rounded(extents(2)))
  end function shown

  !> A number to four digits.
  pure real(wp) function rounded(value)
    !> The number
    real(wp), intent(in) :: value
    character(len=12) :: digits

    write (digits, '(es12.3e3)') value
    read (digits, *) rounded
  end function rounded
end module deck_extents
