!> State inherited from another run: displacement and velocity of the plate, history variables of plies, interfaces and
!> indentation.
!> Loads, impactor and steps start from zero.
module inherited_states
  use archives, only: archive_t
  use cohesive_sliding, only: visit_friction
  use field_mappings, only: motion_field
  use interface_flaws, only: visit_flaws
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: visit_inheritance

contains

  !> Saves or loads the inherited state, by its names in a checkpoint.
  subroutine visit_inheritance(state, archive, model)
    type(state_t), intent(inout) :: state
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    integer :: points

    points = model%mesh%points()
    associate (owned => model%distribution%points(:model%distribution%owned), motion => state%motion)
      call archive%field('motion/displacement', owned, points, motion%displacement, motion_field)
      call archive%field('motion/velocity', owned, points, motion%velocity, motion_field)
      if (archive%loading) call model%halo%update(motion%displacement)
      if (archive%loading) call model%halo%update(motion%velocity)
    end associate
    call state%plies%visit(archive, model)
    call state%interfaces%cohesive%visit(archive, model)
    call visit_friction(state%interfaces%cohesive, archive, model)
    call visit_flaws(state%interfaces%cohesive, archive, model)
    call state%impact%indentation%visit(archive)
    call archive%item('ledger/ply_damage', state%ledger%ply_damage)
  end subroutine visit_inheritance
end module inherited_states
