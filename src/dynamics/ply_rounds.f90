!> Plies that soften follow a step in rounds: the plate comes near equilibrium with the damage held, then the damage
!> follows the strains found (alternate minimisation: B. Bourdin, G. A. Francfort, J.-J. Marigo, J. Mech. Phys. Solids
!> 48 (2000) 797-826).
!>
!> Each half of a round has one answer, whatever the law, where damage and motion together may have many or none nearby:
!> a brittle crack snaps. What has not settled after a few rounds waits for the next step, and cracks run on in that.
module ply_rounds
  use cohesive_energies, only: stored_beyond_work
  use kinds, only: wp
  use models, only: model_t
  use ply_failures, only: ply_failure_t
  use rank_totals, only: totals_of
  use states, only: state_t
  use stepping_parameters, only: equilibrium_t
  implicit none
  private
  public :: ply_rounds_t

  ! What each of these numbers does to two scenes is measured by tests/bench/ply_constants.py; figures stand in
  ! doc/manual/accuracy.md.
  !> Rounds of a step at most. A few suffice where fibres crack one after the other; it takes tens where they snap.
  integer, parameter :: most_rounds = 30
  !> Energy over all energy that plies lose in a round which is not worth another one.
  real(wp), parameter :: noticed = 1.0e-4_wp
  !> Energy over all energy that may go beyond what is dissipated as damage follows the end of a step: a step that
  !> loses more is too long.
  real(wp), parameter :: most_lost = 1.0e-3_wp

  !> What a step has missed in its rounds so far, over the most that it may miss, from which on a shorter one is tried
  !> at once. Tries came back to the most from 1.25 on a coarse 25 J panel, and from less than 3 in crack_bands.nml.
  real(wp), parameter :: most_missed = 4.0_wp

  !> How plies have followed a step.
  type :: ply_rounds_t
    !> Rounds taken
    integer, private :: taken = 0
    !> True once a round took enough of them for another one
    logical :: breaks = .false.
    !> What they lose at the end of the step, over the most that a step may lose
    real(wp) :: haste = 0
    !> True: the step has missed too much to be worth another round
    logical :: hopeless = .false.
  contains
    procedure :: go_on
  end type ply_rounds_t

contains

  !> Lets plies follow a trial state, if it is near equilibrium. Once they rest, an equilibrium is judged by what they
  !> will lose at it. Collective.
  subroutine go_on(self, model, equilibrium, norm, part, old, new, softened)
    !> The rounds
    class(ply_rounds_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Convergence asked for
    type(equilibrium_t), intent(in) :: equilibrium
    !> Residual over the forces in play
    real(wp), intent(in) :: norm
    !> Strain energy of this rank's elements
    real(wp), intent(in) :: part
    !> State at the start of the step
    type(state_t), intent(in) :: old
    !> The trial state
    type(state_t), intent(inout) :: new
    !> True: plies have changed
    logical, intent(out) :: softened
    type(ply_failure_t) :: later
    real(wp) :: lost, excess, energy

    softened = .false.
    if (.not. new%plies%lagging .or. norm > equilibrium%tolerance) return
    energy = max(new%ledger%initial + new%ledger%external_work, new%ledger%strain)
    if (self%taken > 0 .and. self%taken < most_rounds) &
      self%hopeless = missed(model, part, energy, old, new) > most_missed
    if (self%taken < most_rounds) then
      call new%plies%follow(model, new%motion%displacement, lost, excess)
      softened = abs(lost) > 0
      self%taken = self%taken + 1
      self%breaks = self%breaks .or. lost > noticed*energy
      if (.not. lost > noticed*energy) self%taken = most_rounds
    else
      later = new%plies
      call later%follow(model, new%motion%displacement, lost, excess)
      self%haste = max(0.0_wp, excess)/(most_lost*max(energy, tiny(energy)**0.5_wp))
    end if
  end subroutine go_on

  !> What a step has missed, over the most that it may miss, if it ended with the round before. Collective.
  real(wp) function missed(model, part, energy, old, new)
    type(model_t), intent(in) :: model
    !> Strain energy of this rank's elements, and energy of the whole run so far
    real(wp), intent(in) :: part, energy
    !> State at the start of the step
    type(state_t), intent(in) :: old
    !> The trial state; judged
    type(state_t), intent(inout) :: new
    real(wp) :: energies(2)

    associate (before => old%motion, after => new%motion)
      energies = [0.0_wp, part &
        - model%product(after%displacement - before%displacement, after%internal + before%internal)/2 &
        - stored_beyond_work(new%interfaces%cohesive, model, old%interfaces%cohesive, before%displacement, &
                             after%displacement)]
    end associate
    call model%communicator%sum(energies)
    energies(1) = sum(totals_of(model%communicator, new%plies%bands%dissipation_sums()))
    energies = energies*model%mesh%multiplicity
    call new%plies%judge(energies(1), energies(2) - old%ledger%strain, energy)
    missed = new%plies%haste
  end function missed
end module ply_rounds
