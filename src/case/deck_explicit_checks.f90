!> Features that central differences do not have, and keys without effect on them. Messages name the key and an
!> alternative.
module deck_explicit_checks
  use adapt_deck, only: adapt_group
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, remark, report
  use delamination_deck, only: key_law
  use delamination_parameters, only: law_front
  use solver_deck, only: solver_group
  use interface_places, only: delamination_group
  use element_deck, only: key_mass
  use mesh_deck, only: mesh_group
  implicit none
  private
  public :: check_central_differences

  !> Reason why keys of implicit integrators have no effect.
  character(len=*), parameter :: no_effect = 'has no effect with &time integrator = ''central_difference''.'

contains

  !> Refuses features that the method does not have, and reports keys without effect.
  subroutine check_central_differences(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i, before

    associate (s => deck%settings)
      before = 0
      do i = 1, size(deck%setup%delaminations)
        associate (place => deck%setup%delaminations(i)%group)
          if (place == before .or. deck%setup%delaminations(i)%law /= law_front) cycle
          before = place
          ! The release of fronts requires equilibrium at a frozen time.
          if (are_clear(s, problems, delamination_group, key_law, place)) &
            call report(s, problems, delamination_group, key_law, 'central differences cannot be used with a '// &
                        'front; write &time integrator = ''generalized_alpha'', or law = ''cohesive'' with '// &
                        'strengths.', place)
        end associate
      end do
      if (s%text_of(mesh_group, key_mass) == 'consistent' .and. are_clear(s, problems, mesh_group, key_mass)) &
        call report(s, problems, mesh_group, key_mass, 'central differences need a lumped mass; leave it out, or '// &
                  'write &time integrator = ''generalized_alpha''.')
      if (s%has_group(adapt_group)) call remark(s, problems, adapt_group, '', no_effect)
      ! Equilibrium with residual stresses or fixed lines is found before the first step.
      if (s%has_group(solver_group) .and. .not. (deck%setup%thermal%is_present .or. any(deck%setup%lines%precedes()))) &
        call remark(s, problems, solver_group, '', no_effect)
    end associate
  end subroutine check_central_differences
end module deck_explicit_checks
