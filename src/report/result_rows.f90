!> Columns of the history, joined from the rows of each folder, and the values of an accepted step. The last rows are
!> repeated for each interface and for each line.
module result_rows
  use deck_contents, only: deck_t
  use dent_depths, only: dent_depth, dent_rows
  use interface_columns, only: area_rows, area_values, border_rows, border_values, interface_rows, interface_values, &
                               release_rows, release_values, rig_rows, rig_values
  use kinds, only: wp
  use load_cases, only: load_case_t
  use line_columns, only: end_rows, end_values, has_ends, line_column_rows, line_values
  use models, only: model_t
  use operator_columns, only: operator_rows, operator_values
  use output_clocks, only: shown_time
  use placed_gauges, only: gauge_column_rows, gauge_strains
  use stringer_columns, only: stringer_column_rows, stringer_values
  use ply_columns, only: permanent_rows, permanent_values, ply_rows, ply_values
  use result_tables, only: cell, column_name, column_type, name_with_number, result_name_length, result_row_length
  use run_records, only: run_record_t
  use step_columns, only: contact_rows, damping_rows, heat_rows, iteration_rows, iteration_values, &
                          ledger_rows, ledger_values, motion_rows, motion_values, step_rows, step_values
  use steppers, only: stepper_t
  implicit none
  private
  public :: list_columns, row_of

  !> Warnings of the run.
  character(len=result_row_length), parameter :: limit_rows(*) = [character(len=result_row_length) :: &
    'limits_passed | integer | - | Number of limits of the model exceeded so far; log and summary name them with &
      &their times.']
  !> The low-pass filtered force.
  character(len=result_row_length), parameter :: filter_rows(*) = [character(len=result_row_length) :: &
    'force_filtered | real | force | Contact force after the low-pass filter force_filter of &output.']
  !> Columns of every history; the first seventeen are the public interface.
  character(len=*), parameter :: plate_rows(*) = [character(len=result_row_length) :: &
    motion_rows, area_rows, ledger_rows, step_rows, release_rows, iteration_rows, operator_rows, ply_rows, &
    border_rows, rig_rows, heat_rows, limit_rows, contact_rows, damping_rows, permanent_rows, dent_rows]
  !> The table of columns in their order.
  character(len=*), parameter, public :: column_rows(*) = [character(len=result_row_length) :: &
    plate_rows, interface_rows, line_column_rows, end_rows, gauge_column_rows, &
    stringer_column_rows, filter_rows]

contains

  !> Names of the columns, and which are of integers.
  subroutine list_columns(deck, names, whole)
    type(deck_t), intent(in) :: deck
    !> In the order of the table
    character(len=result_name_length), allocatable, intent(out) :: names(:)
    logical, allocatable, intent(out) :: whole(:)
    integer :: i

    allocate (names(0), whole(0))
    call add(pack(plate_rows, apply_to(deck%setup)), 0)
    do i = 1, size(deck%setup%delaminations)
      call add(interface_rows, deck%setup%delaminations(i)%below_ply)
    end do
    if (size(deck%setup%lines) > 0) call add(line_column_rows(:1), 0)
    do i = 1, size(deck%setup%lines)
      call add(line_column_rows(2:), i)
    end do
    if (has_ends(deck%setup%plate, deck%setup%lines)) call add(end_rows, 0)
    do i = 1, size(deck%setup%plate%gauges)
      call add(gauge_column_rows, i)
    end do
    do i = 1, size(deck%setup%stringers)
      call add(stringer_column_rows, i)
    end do
    if (deck%output%force_filter > 0) call add(filter_rows, 0)

  contains

    !> Adds the columns of some rows.
    subroutine add(rows, number)
      !> Rows of the table
      character(len=*), intent(in) :: rows(:)
      !> Number for the N in their names
      integer, intent(in) :: number
      character(len=result_name_length) :: name
      integer :: row

      do row = 1, size(rows)
        name = name_with_number(cell(rows(row), column_name), number)
        names = [names, name]
        whole = [whole, cell(rows(row), column_type) /= 'real']
      end do
    end subroutine add
  end subroutine list_columns

  !> Which columns of the plate have a meaning under a load: the bending stress around the struck point needs a load
  !> across the plate, the contact area an impactor.
  pure function apply_to(load) result(apply)
    class(load_case_t), intent(in) :: load
    !> One for each row
    logical :: apply(size(plate_rows))
    integer :: i

    apply = .true.
    if (load%impactor%is_present) return
    do i = 1, size(plate_rows)
      select case (cell(plate_rows(i), column_name))
      case ('contact_area')
        apply(i) = .false.
      case ('stress')
        apply(i) = load%pressure%is_present
      end select
    end do
  end function apply_to

  !> Row of the state reached. Collective.
  function row_of(model, stepper, record) result(row)
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(in) :: record
    !> Values in the order of the columns
    real(wp), allocatable :: row(:)
    real(wp), allocatable :: loads(:, :), lines(:)

    associate (now => stepper%now)
      allocate (loads, mold=now%motion%displacement)
      call model%loads%line_forces(now%motion%displacement, now%load_factor, loads)
      if (allocated(model%loads%pressure)) &
        loads = loads + model%plate%setup%pressure_factor(now%time, now%load_factor)*model%loads%pressure
      row = [motion_values(now), area_values(model%plate, now%interfaces), ledger_values(now%ledger), &
             step_values(now, stepper%last_step()), &
             release_values(model%plate, now%interfaces, now%motion%displacement), &
             iteration_values(now, stepper%rejected), operator_values(stepper%operator), &
             ply_values(model%plate, now%plies), border_values(model%plate, now%interfaces), &
             rig_values(model, now%interfaces, now%motion, loads), now%ledger%friction, now%ledger%layers, &
             real(size(record%warning_kinds), wp), now%impact%pressed_area(model), now%ledger%damping, &
             permanent_values(now%plies), &
             dent_depth(model%plate, now%motion%displacement) + now%impact%indentation%dent, &
             now%impact%indentation%dent]
      row = [pack(row, apply_to(model%plate%setup)), interface_values(model%plate, now%interfaces)]
      lines = line_values(model, now)
      row = [row, lines, end_values(model, lines), gauge_strains(model%plate, now%motion%displacement), &
             stringer_values(model%plate, now%motion%displacement)]
    end associate
    if (record%filter%frequency > 0) row = [row, record%filter%force]
    row(1) = shown_time(row(1))
  end function row_of
end module result_rows
