!> Lines of `implam check` and of the log on cells in the process zones of cohesive interfaces, and on the errors to
!> expect.
module zone_tables
  use deck_contents, only: deck_t
  use deck_process_zones, only: fewest_cells
  use delamination_parameters, only: growth_by_energy, law_cohesive
  use growth_errors, only: area_errors, load_errors
  use kinds, only: wp
  use process_zones, only: resolving_cells
  use scale_tables, only: table_line
  use short_numbers, only: short_text
  use stepping_parameters, only: is_explicit
  use text, only: line_t, append
  implicit none
  private
  public :: zone_lines

contains

  !> The lines for a checked deck; none without a cohesive interface. Errors are those of growth by energy, where the
  !> cells are too long for the process zone.
  function zone_lines(deck) result(lines)
    type(deck_t), intent(in) :: deck
    type(line_t), allocatable :: lines(:)
    real(wp) :: cells(2)

    allocate (lines(0))
    if (.not. any(deck%setup%delaminations%law == law_cohesive)) return
    cells = fewest_cells(deck)
    call append(lines, table_line('fewest cells in a process zone, of shear and of opening', short_text(cells(1))// &
                                  ', '//short_text(cells(2)), ''))
    if (.not. is_explicit(deck%stepping)) return
    if (.not. any(deck%setup%delaminations%law == law_cohesive .and. &
                  deck%setup%delaminations%growth_control == growth_by_energy)) return
    if (.not. deck%setup%impactor%is_present) cells(1) = minval(cells)
    if (cells(1) >= resolving_cells) return
    call add('error of the load at growth due to these cells (strips)', load_errors(cells(1)))
    if (deck%setup%impactor%is_present) &
      call add('error of the area due to these cells (impacts)', area_errors(cells(1)))

  contains

    !> Adds a range of errors, %, or that it is unknown.
    subroutine add(label, range)
      !> What it is an error of, and the range
      character(len=*), intent(in) :: label, range

      call append(lines, table_line(label, range, trim(merge(' ', '%', range == 'unknown'))))
    end subroutine add
  end function zone_lines
end module zone_tables
