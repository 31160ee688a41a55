!> The columns of the history, joined from the rows that each folder brings, and the values of an accepted step. The
!> last rows come again for each interface that may delaminate.
module result_rows
  use delamination_parameters, only: delamination_t
  use interface_columns, only: area_rows, area_values, border_rows, border_values, interface_rows, interface_values, &
                               release_rows, release_values, rig_rows, rig_values
  use kinds, only: wp
  use models, only: model_t
  use operator_columns, only: operator_rows, operator_values
  use output_clocks, only: shown_time
  use ply_columns, only: ply_rows, ply_values
  use result_tables, only: cell, column_name, column_type, name_with_number, result_name_length, result_row_length
  use step_columns, only: iteration_rows, iteration_values, ledger_rows, ledger_values, motion_rows, motion_values, &
                          step_rows, step_values
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: column_names, column_whole, row_of

  !> Columns that every history has, of which the first seventeen are the public interface.
  character(len=*), parameter :: plate_rows(*) = [character(len=result_row_length) :: &
    motion_rows, area_rows, ledger_rows, step_rows, release_rows, iteration_rows, operator_rows, ply_rows, &
    border_rows, rig_rows]
  !> The table of columns in their order.
  character(len=*), parameter, public :: column_rows(*) = [character(len=result_row_length) :: &
    plate_rows, interface_rows]

contains

  !> Names of the columns.
  pure function column_names(delaminations) result(names)
    !> Interfaces that may delaminate
    type(delamination_t), intent(in) :: delaminations(:)
    !> In the order of the table
    character(len=result_name_length) :: names(size(plate_rows) + size(delaminations)*size(interface_rows))
    integer :: i, zone, place

    do i = 1, size(plate_rows)
      names(i) = cell(plate_rows(i), column_name)
    end do
    place = size(plate_rows)
    do zone = 1, size(delaminations)
      do i = 1, size(interface_rows)
        place = place + 1
        names(place) = name_with_number(cell(interface_rows(i), column_name), delaminations(zone)%below_ply)
      end do
    end do
  end function column_names

  !> Which columns hold whole numbers.
  pure function column_whole(interfaces) result(whole)
    !> Number of interfaces that may delaminate
    integer, intent(in) :: interfaces
    !> In the order of the table
    logical :: whole(size(plate_rows) + interfaces*size(interface_rows))
    logical :: of_interface(size(interface_rows))
    integer :: i, zone

    do i = 1, size(plate_rows)
      whole(i) = cell(plate_rows(i), column_type) /= 'real'
    end do
    do i = 1, size(interface_rows)
      of_interface(i) = cell(interface_rows(i), column_type) /= 'real'
    end do
    whole(size(plate_rows) + 1:) = [(of_interface, zone=1, interfaces)]
  end function column_whole

  !> Row of the state reached. Collective.
  function row_of(model, stepper) result(row)
    type(model_t), intent(in) :: model
    !> The time stepper
    type(time_stepper_t), intent(in) :: stepper
    !> Values in the order of the columns
    real(wp), allocatable :: row(:)
    real(wp) :: load

    associate (now => stepper%now)
      load = now%time
      if (.not. model%scene%has_static) load = model%scene%pressure%amplitude(now%time)
      row = [motion_values(now), area_values(model, now%interfaces), ledger_values(now%ledger), &
             step_values(now, stepper%controller%last), &
             release_values(model, now%interfaces, now%motion%displacement), iteration_values(now, stepper%rejected), &
             operator_values(stepper%operator), ply_values(model, now%plies), border_values(model, now%interfaces), &
             rig_values(model, now%interfaces, now%motion, load), interface_values(model, now%interfaces)]
    end associate
    row(1) = shown_time(row(1))
  end function row_of
end module result_rows
