!> Errors of delaminations that grow by energy on cells longer than their process zone, as measured by central
!> differences: loads at growth of strips over their closed forms, areas and peak forces of impacts over those on the
!> finest cells. The rows are in tests/studies/growth, from which tests/studies/growth_table.py writes the table below.
module growth_errors
  use kinds, only: wp
  use text, only: append, line_t, to_text
  use text_tables, only: table_row
  implicit none
  private
  public :: area_errors, cells_for_area, growth_error_lines, load_errors

  !> Errors with at least a number of cells in the process zone: that of the mode for strips, of shear for impacts. Not
  !> known without a measurement below the number of the next row, as errors are larger with fewer cells.
  type :: growth_errors_t
    !> The number of cells
    real(wp) :: cells = 0
    !> Number of strips, 0: not known; least and largest error of their mean load at growth, %
    integer :: strips = 0, load(2) = 0
    !> The same of impacts, least and largest error of their area and peak force, %
    integer :: impacts = 0, area(2) = 0, peak(2) = 0
  end type growth_errors_t

  !> The measured errors.
  type(growth_errors_t), parameter :: measured_errors(*) = [ &
    ! Written by growth_table.py.
    growth_errors_t(0.0_wp, 22, [-6, 4], 0, [0, 0], [0, 0]), &
    growth_errors_t(0.25_wp, 17, [-6, 2], 0, [0, 0], [0, 0]), &
    growth_errors_t(0.4_wp, 14, [-6, 2], 10, [-2, 18], [-2, 5]), &
    growth_errors_t(0.5_wp, 12, [-6, 2], 8, [-2, 18], [-1, 4]), &
    growth_errors_t(1.0_wp, 5, [-1, 2], 3, [-2, 1], [0, 1]), &
    growth_errors_t(1.7_wp, 3, [0, 2], 1, [1, 1], [1, 1]), &
    growth_errors_t(2.5_wp, 1, [0, 0], 0, [0, 0], [0, 0])]
    ! End of the table.

contains

  !> Least and largest error of the load at growth, %.
  pure function load_errors(cells) result(words)
    !> Cells in the process zone of the mode
    real(wp), intent(in) :: cells
    !> Such as '-5 to 1', or 'unknown'
    character(len=:), allocatable :: words
    type(growth_errors_t) :: row

    row = measured_errors(class_of(cells))
    words = range_text(row%strips, row%load, 'unknown')
  end function load_errors

  !> Least and largest error of the area after an impact, %.
  pure function area_errors(cells) result(words)
    !> Fewest cells in a process zone of shear
    real(wp), intent(in) :: cells
    !> Such as '-2 to 1', or 'unknown'
    character(len=:), allocatable :: words
    type(growth_errors_t) :: row

    row = measured_errors(class_of(cells))
    words = range_text(row%impacts, row%area, 'unknown')
  end function area_errors

  !> Fewest cells in a process zone of shear with which errors of the area after an impact were within a bound; those of
  !> the last row if none were.
  pure real(wp) function cells_for_area(permitted) result(cells)
    !> The bound, %
    real(wp), intent(in) :: permitted
    integer :: i

    do i = 2, size(measured_errors)
      cells = measured_errors(i)%cells
      if (measured_errors(i)%impacts > 0 .and. maxval(abs(measured_errors(i)%area)) <= permitted) return
    end do
  end function cells_for_area

  !> Row of the table for a number of cells.
  pure integer function class_of(cells)
    !> In the process zone
    real(wp), intent(in) :: cells

    class_of = max(1, count(measured_errors%cells <= cells))
  end function class_of

  !> A range of errors.
  pure function range_text(number, bounds, unknown) result(words)
    !> Number of measurements
    integer, intent(in) :: number
    !> Their least and largest error, %
    integer, intent(in) :: bounds(2)
    !> Text without measurements
    character(len=*), intent(in) :: unknown
    !> Such as -5 to 1, or 1
    character(len=:), allocatable :: words

    words = unknown
    if (number == 0) return
    words = to_text(bounds(1))
    if (bounds(2) > bounds(1)) words = words//' to '//to_text(bounds(2))
  end function range_text

  !> The table.
  pure subroutine growth_error_lines(markdown, lines)
    !> True: as a table for the manual
    logical, intent(in) :: markdown
    type(line_t), allocatable, intent(out) :: lines(:)
    type(growth_errors_t) :: row
    type(line_t) :: words(6)
    integer, parameter :: widths(6) = 18
    integer :: i

    allocate (lines(0))
    call append(lines, table_row([line_t('cells, at least'), line_t('strips'), line_t('load at growth, %'), &
                                  line_t('impacts'), line_t('area, %'), line_t('peak force, %')], widths, markdown))
    if (markdown) call append(lines, '|---|---|---|---|---|---|')
    do i = 1, size(measured_errors)
      row = measured_errors(i)
      words(1)%text = to_text(row%cells)
      words(2)%text = number_text(row%strips)
      words(3)%text = range_text(row%strips, row%load, '-')
      words(4)%text = number_text(row%impacts)
      words(5)%text = range_text(row%impacts, row%area, '-')
      words(6)%text = range_text(row%impacts, row%peak, '-')
      call append(lines, table_row(words, widths, markdown))
    end do

  contains

    !> A number of measurements; a dash without any.
    pure function number_text(number) result(words)
      integer, intent(in) :: number
      character(len=:), allocatable :: words

      words = '-'
      if (number > 0) words = to_text(number)
    end function number_text
  end subroutine growth_error_lines
end module growth_errors
