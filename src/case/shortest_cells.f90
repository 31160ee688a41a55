!> The shortest cells of the mesh, which limit the stable step of central differences, and their cause.
module shortest_cells
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark
  use element_steps, only: smallest_element_step
  use kinds, only: wp
  use mesh_deck, only: key_core, key_lines, key_patch, mesh_group
  use roundings, only: rounding
  use scale_tables, only: length_text
  use support_deck, only: key_window, support_group
  use support_parameters, only: window_rectangle
  use text, only: counted, rounded_text
  use zone_deck, only: doubler_group, key_zone_size, ply_drop_group
  implicit none
  private
  public :: check_narrow_cells, shortest_cell_text

  !> Ratio of the number of steps to that without required lines above which a line is reported. It affects a warning
  !> only.
  real(wp), parameter :: max_price = 1.5_wp

  !> A row of cells.
  type :: row_t
    !> 1: the cells are short along x, 2: along y
    integer :: direction = 1
    !> Coordinates of their sides
    real(wp) :: sides(2) = 0
  end type row_t

contains

  !> Warns of a required line beside which narrow cells multiply the number of steps.
  subroutine check_narrow_cells(deck, problems)
    !> The deck, checked, with its step
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(deck_t) :: free
    type(row_t) :: row
    character(len=:), allocatable :: group, key, steps, fewer
    real(wp) :: price, number
    integer :: place

    row = shortest_row(deck)
    call find_line(deck, row, group, key, place)
    if (group == '') return
    free = deck
    free%setup%mesh%x_lines = [real(wp) ::]
    free%setup%mesh%y_lines = [real(wp) ::]
    price = smallest_element_step(free)/smallest_element_step(deck)
    if (.not. price > max_price) return
    number = deck%stepping%time%end/deck%stepping%time%step
    steps = counted(rounded_text(max(1.0_wp, anint(number))), 'step')
    fewer = rounded_text(max(1.0_wp, anint(number/price)))
    call remark(deck%settings, problems, group, key, 'a line of the mesh beside another one makes cells of '// &
                extent_text(deck, row)//', which take '//steps//' instead of '//fewer// &
                '; move one of them, or give a `core` and `cell` with which they are lines of the mesh.', place)
  end subroutine check_narrow_cells

  !> Length, place and cause of the shortest cells.
  function shortest_cell_text(deck) result(words)
    !> The deck, its mesh checked
    type(deck_t), intent(in) :: deck
    !> Such as 0.5 mm along x, from 2 mm to 2.5 mm, beside a line of &support window
    character(len=:), allocatable :: words
    character(len=:), allocatable :: group, key
    type(row_t) :: row
    integer :: place

    row = shortest_row(deck)
    words = extent_text(deck, row)
    call find_line(deck, row, group, key, place)
    if (group /= '') then
      words = words//', beside a line of &'//group//' '//key
    else if (lies_within(deck%setup%mesh%patch)) then
      words = words//', in the loaded patch (&'//mesh_group//' '//key_patch//')'
    else if (lies_within(deck%setup%mesh%core(row%direction))) then
      words = words//', in the core (&'//mesh_group//' '//key_core//')'
    end if

  contains

    !> True if the cells are in a region around the struck point.
    pure logical function lies_within(extent)
      !> Extent of the region
      real(wp), intent(in) :: extent

      lies_within = all(abs(row%sides - deck%setup%mesh%struck(row%direction)) <= extent/2*(1 + rounding)) .and. &
                    extent > 0
    end function lies_within
  end function shortest_cell_text

  !> Extent of a row of cells.
  pure function extent_text(deck, row) result(words)
    type(deck_t), intent(in) :: deck
    type(row_t), intent(in) :: row
    !> Such as 0.5 mm along x, from 2 mm to 2.5 mm
    character(len=:), allocatable :: words

    words = length_text(deck, row%sides(2) - row%sides(1))//' along '//merge('x', 'y', row%direction == 1)// &
            ', from '//length_text(deck, row%sides(1))//' to '//length_text(deck, row%sides(2))
  end function extent_text

  !> The row of the shortest cells; of equal ones that closest to the struck point.
  pure function shortest_row(deck) result(row)
    type(deck_t), intent(in) :: deck
    type(row_t) :: row
    type(cell_line_t) :: line
    real(wp), allocatable :: lengths(:), distances(:)
    real(wp) :: shortest
    integer :: direction, cell

    shortest = huge(shortest)
    do direction = 1, 2
      line = cells_along(deck%setup%plate, deck%setup%mesh, direction)
      lengths = line%sides()
      if (minval(lengths) >= shortest*(1 - rounding)) cycle
      shortest = minval(lengths)
      distances = abs(line%middles() - deck%setup%mesh%struck(direction))
      cell = minloc(distances, dim=1, mask=lengths <= shortest*(1 + rounding))
      row = row_t(direction, line%ends(cell))
    end do
  end function shortest_row

  !> Group and key that require a line at a side of a row.
  pure subroutine find_line(deck, row, group, key, place)
    type(deck_t), intent(in) :: deck
    type(row_t), intent(in) :: row
    !> Group and key; empty: no line is required there
    character(len=:), allocatable, intent(out) :: group, key
    integer, intent(out) :: place
    integer :: i

    group = ''
    key = ''
    place = 1
    do i = 1, size(deck%setup%supports)
      if (deck%setup%supports(i)%shape /= window_rectangle) cycle
      if (.not. has_side(deck%setup%supports(i)%window(row%direction)/2)) cycle
      group = support_group
      key = key_window
      place = i
      return
    end do
    call find_zone(deck, row, group, place)
    if (group /= '') key = key_zone_size
    if (group /= '') return
    if (row%direction == 1) then
      if (.not. any([(has_side(deck%setup%mesh%x_lines(i)), i=1, size(deck%setup%mesh%x_lines))])) return
    else
      if (.not. any([(has_side(deck%setup%mesh%y_lines(i)), i=1, size(deck%setup%mesh%y_lines))])) return
    end if
    group = mesh_group
    key = key_lines(row%direction)

  contains

    !> True if the row has a side at this distance from the centre.
    pure logical function has_side(distance)
      real(wp), intent(in) :: distance

      has_side = any(abs(abs(row%sides) - abs(distance)) <= rounding*deck%setup%plate%length(row%direction))
    end function has_side

  end subroutine find_line

  !> Group of the zone with an edge at a side of a row, within the plate.
  pure subroutine find_zone(deck, row, group, place)
    type(deck_t), intent(in) :: deck
    type(row_t), intent(in) :: row
    !> The group; empty: there is none
    character(len=:), allocatable, intent(out) :: group
    integer, intent(out) :: place
    integer :: i

    group = ''
    place = 0
    if (allocated(deck%setup%zones%doublers)) &
      place = findloc([(any(is_side(deck%setup%zones%doublers(i)%edges(row%direction))), &
                        i=1, size(deck%setup%zones%doublers))], .true., dim=1)
    if (place > 0) group = doubler_group
    if (group == '' .and. allocated(deck%setup%zones%drops)) then
      place = findloc([(any(is_side(deck%setup%zones%drops(i)%edges(row%direction))), i=1, &
                        size(deck%setup%zones%drops))], .true., dim=1)
      if (place > 0) group = ply_drop_group
    end if
    place = max(place, 1)

  contains

    !> True if the row has a side at this coordinate within the plate.
    elemental logical function is_side(at)
      real(wp), intent(in) :: at

      associate (length => deck%setup%plate%length(row%direction))
        is_side = any(abs(row%sides - at) <= rounding*length) .and. abs(at) < length/2*(1 - rounding)
      end associate
    end function is_side
  end subroutine find_zone
end module shortest_cells
