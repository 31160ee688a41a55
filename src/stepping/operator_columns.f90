!> Columns of the history on the factored operator.
module operator_columns
  use kinds, only: wp
  use result_tables, only: result_row_length
  use tangent_operators, only: tangent_operator_t
  implicit none
  private
  public :: operator_values

  !> Columns of its cost.
  character(len=result_row_length), parameter, public :: operator_rows(*) = [character(len=result_row_length) :: &
    'refactorisations | integer | - | Factorizations of the tangent operator so far, rejected steps included.', &
    'solves | integer | - | Corrections solved for with the factored operator so far, rejected steps included.']

contains

  !> Its cost.
  pure function operator_values(operator) result(values)
    type(tangent_operator_t), intent(in) :: operator
    !> One value per column
    real(wp) :: values(size(operator_rows))

    values = real([operator%factorizations, operator%solves], wp)
  end function operator_values
end module operator_columns
