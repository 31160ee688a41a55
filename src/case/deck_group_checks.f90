!> Checks of the groups of a deck, each by the folder of its physics.
module deck_group_checks
  use deck_contents, only: deck_t
  use deck_fillings, only: changes_of_angle
  use deck_problems, only: problems_t
  use deck_struck_faces, only: check_struck_face
  use delamination_deck, only: check_delaminations
  use gauge_deck, only: check_gauges
  use indentation_deck, only: check_indentation
  use interface_places, only: remark_left_out
  use line_deck, only: check_lines
  use mesh_deck, only: check_mesh
  use plate_deck, only: check_plate
  use pressure_deck, only: check_pressure
  use solver_deck, only: check_petsc_options
  use stringer_deck, only: check_stringers
  use support_deck, only: check_rigs
  use thermal_deck, only: check_thermal
  use time_deck, only: check_time
  implicit none
  private
  public :: check_groups

contains

  !> Checks of each group.
  subroutine check_groups(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    call check_plate(deck%settings, deck%setup%plate, problems)
    call check_rigs(deck%settings, deck%setup%plate, deck%setup%supports, problems)
    call check_mesh(deck%settings, deck%setup%mesh, problems)
    call check_stringers(deck%settings, deck%setup%plate%length, deck%setup%thermal%is_present, deck%setup%stringers, &
                         problems)
    call check_delaminations(deck%settings, deck%setup%zones, deck%setup%delaminations, problems)
    if (allocated(deck%setup%laminate%angle)) &
      call remark_left_out(deck%settings, size(deck%setup%laminate%angle), changes_of_angle(deck), problems)
    call check_struck_face(deck, problems)
    if (deck%setup%impactor%is_present .and. deck%setup%impactor%indentation%is_given) &
      call check_indentation(deck%settings, deck%setup%impactor%indentation, problems)
    if (deck%setup%pressure%is_present) call check_pressure(deck%settings, deck%setup%pressure, problems)
    if (deck%setup%thermal%is_present) call check_thermal(deck%settings, deck%setup%materials, problems)
    call check_lines(deck%settings, deck%setup%lines, problems)
    call check_gauges(deck%settings, deck%setup%plate%length, deck%setup%plate%gauges, problems)
    if (deck%has_time) call check_time(deck%settings, deck%stepping%time, problems)
    call check_petsc_options(deck%settings, deck%linear_solver, problems)
  end subroutine check_groups
end module deck_group_checks
