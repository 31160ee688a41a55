!> What the history tells of lines that hold, move or press on the plate.
module line_columns
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: totals_of
  use result_tables, only: result_row_length
  use states, only: state_t
  implicit none
  private
  public :: line_values

  !> Columns that a deck with lines has, the latter two once a line: N is its number in the deck.
  character(len=result_row_length), parameter, public :: line_column_rows(*) = [character(len=result_row_length) :: &
    'load_factor | real | - | Ramps of lines, and the pressure of a static analysis, over their full values; only with &
      &&line.', &
    'line_force_N | real | force | Force on the plate of the N-th &line, of the whole line, along its component; of a &
      &rotation the moment.', &
    'line_displacement_N | real | length | Mean displacement or rotation of the N-th &line along its component.']

contains

  !> Load factor, then force and displacement of every line. Collective.
  function line_values(model, now) result(values)
    type(model_t), intent(in) :: model
    !> The state reached
    type(state_t), intent(in) :: now
    !> A value a column, the same on every rank; none without lines
    real(wp), allocatable :: values(:)
    integer :: i

    allocate (values(0))
    if (size(model%lines) == 0) return
    values = totals_of(model%communicator, [(model%lines(i)%totals(now%motion%displacement, now%load_factor), &
                                             i=1, size(model%lines))])
    if (allocated(now%line_reactions)) then
      do i = 1, size(model%lines)
        if (model%lines(i)%load%prescribed) values(2*i - 1) = now%line_reactions(i)
      end do
    end if
    values = [now%load_factor, values]
  end function line_values
end module line_columns
