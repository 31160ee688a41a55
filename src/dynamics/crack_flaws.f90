!> Cracks of plies next to an interface, and the flaws that they leave there.
module crack_flaws
  use delamination_parameters, only: law_cohesive
  use interface_flaws, only: weaken_beside
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use models, only: model_t
  use ply_blocks, only: block_thickness
  use ply_damage_parameters, only: matrix_cracking, matrix_crushing
  use ply_failures, only: ply_failure_t
  implicit none
  private
  public :: note_flaws

contains

  !> Weakens interfaces within a block's thickness of where the ply above or below has cracked across its fibres.
  !> Collective.
  subroutine note_flaws(model, plies, interfaces)
    type(model_t), intent(in) :: model
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    integer :: zone, ply

    if (.not. (model%map%layered .and. model%scene%has_ply_damage)) return
    do zone = 1, size(model%mesh%zones)
      associate (delamination => model%scene%delaminations(zone), below => model%mesh%zones(zone)%below_ply)
        if (delamination%law /= law_cohesive .or. .not. delamination%flaw_strength < 1) cycle
        do ply = below, below + 1
          call weaken_beside(interfaces%cohesive, model, zone, cracked_cells(model, plies, ply), &
                             block_thickness(model%plies, ply))
        end do
      end associate
    end do
  end subroutine note_flaws

  !> Cells in which a ply has cracked across its fibres, on any rank. Collective.
  function cracked_cells(model, plies, ply) result(cracked)
    type(model_t), intent(in) :: model
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> (cells of the mesh)
    logical, allocatable :: cracked(:)
    logical, allocatable :: failed(:, :)
    real(wp), allocatable :: found(:)
    integer :: i

    failed = plies%failed(ply)
    allocate (found(product(model%mesh%cells)), source=0.0_wp)
    do i = 1, size(failed, 2)
      if (failed(matrix_cracking, i) .or. failed(matrix_crushing, i)) &
        found(model%mesh%element_cell(model%distribution%elements(i))) = 1
    end do
    call model%communicator%maximum(found)
    cracked = found > 0
  end function cracked_cells
end module crack_flaws
