!> State inherited from another run: displacement and velocity of the plate, history variables of plies, interfaces and
!> indentation.
!> Loads, impactor and steps start from zero.
module inherited_states
  use archives, only: archive_t
  use cohesive_sliding, only: visit_friction
  use field_mappings, only: motion_field
  use interface_flaws, only: visit_flaws
  use composite_plates, only: composite_plate_t
  use states, only: state_t
  implicit none
  private
  public :: visit_inheritance

contains

  !> Saves or loads the inherited state, by its names in a checkpoint.
  subroutine visit_inheritance(state, archive, plate)
    type(state_t), intent(inout) :: state
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate

    call plate%visit_points(archive, 'motion/displacement', state%motion%displacement, motion_field)
    call plate%visit_points(archive, 'motion/velocity', state%motion%velocity, motion_field)
    if (archive%loading) call plate%halo%update(state%motion%displacement)
    if (archive%loading) call plate%halo%update(state%motion%velocity)
    call state%plies%visit(archive, plate)
    call state%interfaces%cohesive%visit(archive, plate)
    call visit_friction(state%interfaces%cohesive, archive, plate)
    call visit_flaws(state%interfaces%cohesive, archive, plate)
    call state%impact%indentation%visit(archive)
    call archive%item('ledger/ply_damage', state%ledger%ply_damage)
  end subroutine visit_inheritance
end module inherited_states
