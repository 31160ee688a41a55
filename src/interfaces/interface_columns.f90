!> What the history tells of the interfaces. A new column goes to the end of the border's rows, with its value in the
!> function beside them: all columns before it stay where they are.
module interface_columns
  use kinds, only: wp
  use interface_states, only: interface_state_t
  use models, only: model_t
  use result_tables, only: result_row_length
  implicit none
  private
  public :: area_values, release_values, border_values

  !> How much has come apart: a column of the public interface.
  character(len=result_row_length), parameter, public :: area_rows(*) = [character(len=result_row_length) :: &
    'delaminated_area | real | area | Delaminated area of all interfaces together, their starters included.']

  !> How near the fronts are to growth, what growth has set free, and how well faces meet.
  character(len=result_row_length), parameter, public :: release_rows(*) = [character(len=result_row_length) :: &
    'release_ratio | real | - | Largest energy release rate on all fronts over its critical value; 0 in a static &
      &analysis.', &
    'energy_released | real | energy | Work done against the fading forces of released ties so far; 0 if all &
      &interfaces have growth = ''one_per_step''.', &
    'penetration | real | length | Largest penetration of separated faces.', &
    'complementarity | real | - | Largest contact pressure that does not go with its gap, over the largest pressure &
      &so far.']

  !> Fronts at the border of their zone.
  character(len=result_row_length), parameter, public :: border_rows(*) = [character(len=result_row_length) :: &
    'border_reached | logical | - | 1 once a front has reached the border of its zone, where it cannot grow on; &
      &before that 0.']

contains

  !> How much has come apart.
  pure function area_values(model, interfaces) result(values)
    !> The model
    type(model_t), intent(in) :: model
    !> The interfaces
    type(interface_state_t), intent(in) :: interfaces
    !> A value a column, of the whole plate
    real(wp) :: values(size(area_rows))

    values = [interfaces%faces%area(model)]
  end function area_values

  !> How near the fronts are to growth, what growth has set free, and how well faces meet. Collective.
  function release_values(model, interfaces, displacement) result(values)
    !> The model
    type(model_t), intent(in) :: model
    !> The interfaces
    type(interface_state_t), intent(in) :: interfaces
    !> Unknowns, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> A value a column, the same on every rank
    real(wp) :: values(size(release_rows))

    values = [interfaces%release_ratio, sum(interfaces%ties%set_free), &
              interfaces%faces%penetration(model, displacement), &
              interfaces%faces%complementarity(model, displacement)]
  end function release_values

  !> Fronts at the border of their zone.
  pure function border_values(interfaces) result(values)
    !> The interfaces
    type(interface_state_t), intent(in) :: interfaces
    !> A value a column
    real(wp) :: values(size(border_rows))

    values = [merge(1.0_wp, 0.0_wp, interfaces%border_reached)]
  end function border_values
end module interface_columns
