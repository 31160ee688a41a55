!> The table of the deck, joined from the rows of each folder, in the order of the manual. It is the source of scan,
!> checks, list of keys, `implam explain` and the manual.
module deck_table
  use adapt_deck, only: adapt_group_row, adapt_rows
  use case_deck, only: case_group_row, case_rows
  use controls_deck, only: controls_group_row, controls_rows
  use deck_vocabulary, only: vocabulary_t, load_vocabulary, group_row_length, key_row_length
  use delamination_deck, only: delamination_group_row, delamination_rows
  use element_deck, only: element_rows, kinematics_rows
  use gauge_deck, only: gauge_group_row, gauge_rows
  use impactor_deck, only: impactor_group_row, impactor_rows
  use indentation_deck, only: indentation_group_row, indentation_rows
  use initial_state_deck, only: initial_state_group_row, initial_state_rows
  use laminate_deck, only: laminate_group_row, laminate_rows
  use line_deck, only: line_group_row, line_rows
  use stringer_deck, only: stringer_group_row, stringer_rows
  use solver_deck, only: solver_group_row, solver_rows
  use material_deck, only: material_group_row, material_rows
  use mesh_deck, only: mesh_group_row, mesh_rows
  use output_deck, only: output_group_row, output_rows
  use plate_deck, only: plate_group_row, plate_rows
  use ply_damage_deck, only: ply_damage_group_row, ply_damage_rows
  use pressure_deck, only: pressure_group_row, pressure_rows
  use static_deck, only: static_group_row, static_rows
  use support_deck, only: support_group_row, support_rows
  use thermal_deck, only: thermal_group_row, thermal_rows
  use time_deck, only: time_group_row, time_rows
  use zone_deck, only: zone_group_rows, zone_rows
  implicit none
  private
  public :: load_deck_table

  !> Groups.
  character(len=*), parameter :: group_rows(*) = [character(len=group_row_length) :: &
    case_group_row, plate_group_row, support_group_row, mesh_group_row, material_group_row, laminate_group_row, &
    zone_group_rows, stringer_group_row, impactor_group_row, indentation_group_row, pressure_group_row, &
    line_group_row, thermal_group_row, &
    initial_state_group_row, static_group_row, ply_damage_group_row, &
    delamination_group_row, time_group_row, adapt_group_row, solver_group_row, gauge_group_row, output_group_row, &
    controls_group_row]

  !> Keys, those of a group together.
  character(len=*), parameter :: key_rows(*) = [character(len=key_row_length) :: &
    case_rows, kinematics_rows, plate_rows, support_rows, mesh_rows, element_rows, material_rows, laminate_rows, &
    zone_rows, stringer_rows, impactor_rows, indentation_rows, pressure_rows, line_rows, thermal_rows, &
    initial_state_rows, static_rows, &
    ply_damage_rows, &
    delamination_rows, time_rows, &
    adapt_rows, solver_rows, gauge_rows, output_rows, controls_rows]

contains

  !> Parses the table.
  pure subroutine load_deck_table(vocabulary)
    !> Groups and keys
    type(vocabulary_t), intent(out) :: vocabulary

    call load_vocabulary(group_rows, key_rows, vocabulary)
  end subroutine load_deck_table
end module deck_table
