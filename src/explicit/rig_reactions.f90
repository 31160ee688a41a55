!> Forces of rigs on the plate in steps by central differences.
module rig_reactions
  use central_differences, only: central_difference_t
  use exact_sums, only: exact_sum_t
  use interface_stacks, only: last_layer
  use kinds, only: wp
  use models, only: model_t
  use rank_totals, only: totals_of
  use states, only: state_t
  use support_parameters, only: max_supports
  implicit none
  private
  public :: reactions_of

contains

  !> Reaction of each rig on the full plate, positive against the impact: forces at constrained deflections, reactions
  !> of frames, springs and clamps. Collective.
  function reactions_of(method, model, now) result(reactions)
    !> The method
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    !> 0 for rigs that the deck does not have
    real(wp) :: reactions(max_supports)
    type(exact_sum_t) :: sums(max_supports)
    integer :: i, layer

    reactions = 0
    if (.not. allocated(model%rig%constrained_by)) return
    do i = 1, model%distribution%owned
      associate (constrained_by => model%rig%constrained_by(i), on_frame => model%rig%frame(i), &
                 clamps => model%rig%clamps(i))
        if (constrained_by > 0) then
          do layer = i, last_layer(model%map%above, i)
            call sums(constrained_by)%add(method%force(3, layer))
          end do
        else
          if (on_frame > 0) call sums(on_frame)%add(method%rigs%reaction(i))
          if (clamps > 0) &
            call sums(clamps)%add(model%rig%springs(3, i)*now%motion%displacement(3, i) - model%rig%clamp_preload(i))
        end if
      end associate
    end do
    reactions = totals_of(model%communicator, sums)
    do i = 1, size(method%circles%rig)
      associate (rig => method%circles%rig(i))
        reactions(rig) = reactions(rig) + method%circles%forces(i)
      end associate
    end do
    reactions = reactions*model%mesh%multiplicity
  end function reactions_of
end module rig_reactions
