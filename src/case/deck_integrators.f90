!> Default integrator by the setup of the deck: with softening plies or interfaces implicit steps need many solves,
!> central differences none.
module deck_integrators
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use delamination_parameters, only: law_cohesive, law_front
  use element_deck, only: key_mass
  use interface_places, only: delamination_group
  use laminate_deck, only: laminate_group
  use material_deck, only: material_group
  use mesh_deck, only: mesh_group
  use ply_damage_deck, only: ply_damage_group
  use static_deck, only: static_group
  use stepping_parameters, only: is_explicit
  use text, only: append
  use time_deck, only: integrator_of, key_integrator, time_group
  implicit none
  private
  public :: choose_integrator, needs_lengths, softening_part

contains

  !> Chooses the integrator where the deck gives none.
  subroutine choose_integrator(deck)
    !> The deck, its bodies filled; receives the integrator
    type(deck_t), intent(inout) :: deck
    character(len=:), allocatable :: softening

    if (.not. deck%settings%is_given(time_group, key_integrator)) then
      softening = ''
      if (deck%has_time) softening = softening_part(deck)
      if (softening /= '') then
        call deck%settings%derive(time_group, key_integrator, 'central_difference', .true.)
        call append(deck%reasons, 'Integrator central_difference: '//softening//' soften; &time integrator='// &
                    '''generalized_alpha'' selects implicit steps.')
      else
        call deck%settings%derive(time_group, key_integrator, 'generalized_alpha', .true.)
      end if
    end if
    deck%stepping%time%integrator = integrator_of(deck%settings)
  end subroutine choose_integrator

  !> True: the deck has to give length and end of the steps. Central differences choose them and load steps have none.
  !> A deck with faults in the parts that decide on the integrator may not need them either.
  pure logical function needs_lengths(deck, problems)
    !> The deck, its integrator chosen
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(in) :: problems

    needs_lengths = .not. (deck%settings%has_group(static_group) .or. is_explicit(deck%stepping) .or. &
                           problems%concern(time_group, key_integrator))
    if (deck%settings%is_given(time_group, key_integrator)) return
    needs_lengths = needs_lengths .and. .not. (problems%concern(material_group) .or. &
                                               problems%concern(laminate_group) .or. &
                                               problems%concern(ply_damage_group) .or. &
                                               problems%concern(delamination_group))
  end function needs_lengths

  !> The softening part of a dynamic setup; empty: none, or the deck requires implicit steps. One of the fracture
  !> energies requests softening plies; the check of materials requires all.
  function softening_part(deck) result(softening)
    type(deck_t), intent(in) :: deck
    !> Plies, interfaces, or nothing
    character(len=:), allocatable :: softening
    integer :: ply

    softening = ''
    if (deck%setup%is_static()) return
    if (any(deck%setup%delaminations%law == law_front)) return
    if (deck%settings%is_given(mesh_group, key_mass) .and. &
        deck%settings%text_of(mesh_group, key_mass) == 'consistent') return
    if (deck%setup%ply_damage%is_present .and. allocated(deck%setup%laminate%material)) then
      associate (used => deck%setup%used_materials())
        if (any([(any(deck%setup%materials(used(ply))%toughness > 0), ply=1, size(used))])) softening = 'plies'
      end associate
    end if
    if (any(deck%setup%delaminations%law == law_cohesive)) softening = 'interfaces'
  end function softening_part
end module deck_integrators
