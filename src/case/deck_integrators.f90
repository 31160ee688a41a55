!> Default integrator by the setup of the deck: with softening plies or interfaces implicit steps need many solves,
!> central differences none.
module deck_integrators
  use deck_contents, only: deck_t
  use delamination_parameters, only: law_cohesive, law_front
  use element_deck, only: key_mass
  use mesh_deck, only: mesh_group
  use text, only: append
  use time_deck, only: integrator_of, key_integrator, time_group
  implicit none
  private
  public :: choose_integrator

contains

  !> Chooses the integrator where the deck gives none.
  subroutine choose_integrator(deck)
    !> The deck, its bodies filled; receives the integrator
    type(deck_t), intent(inout) :: deck
    character(len=:), allocatable :: softening

    if (.not. deck%settings%is_given(time_group, key_integrator)) then
      softening = softening_part(deck)
      if (softening /= '') then
        call deck%settings%derive(time_group, key_integrator, 'central_difference', .true.)
        if (.not. allocated(deck%reasons)) allocate (deck%reasons(0))
        call append(deck%reasons, 'Integrator central_difference: '//softening//' soften; &time integrator='// &
                    '''generalized_alpha'' brings implicit steps.')
      else
        call deck%settings%derive(time_group, key_integrator, 'generalized_alpha', .true.)
      end if
    end if
    deck%stepping%time%integrator = integrator_of(deck%settings)
  end subroutine choose_integrator

  !> The softening part of a dynamic setup; empty: none, or the deck requires implicit steps.
  function softening_part(deck) result(softening)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Plies, interfaces, or nothing
    character(len=:), allocatable :: softening

    softening = ''
    if (deck%is_static() .or. .not. deck%has_time) return
    if (any(deck%delaminations%law == law_front)) return
    if (deck%settings%is_given(mesh_group, key_mass) .and. &
        deck%settings%text_of(mesh_group, key_mass) == 'consistent') return
    if (allocated(deck%laminate%material)) then
      if (deck%has_crack_bands()) softening = 'plies'
    end if
    if (any(deck%delaminations%law == law_cohesive)) softening = 'interfaces'
  end function softening_part
end module deck_integrators
