!> Checks the energy balance of a run by one rule: energy created or dissipated by integrators or load steps, and the
!> energy error, must stay below 1 % of the energy.
module energy_checks
  use archives, only: archive_t
  use contact_loading, only: loading_indentation
  use deck_contents, only: deck_t
  use energy_ledgers, only: ledger_t
  use kinds, only: wp
  implicit none
  private
  public :: energy_check_t, new_energy_check

  !> Permitted fraction of energy created or dissipated, and of the energy error. Energies are proportional to squares
  !> of forces: 1 % of energy is half the error of the force that accuracy='standard' permits.
  real(wp), parameter, public :: energy_tolerance = 0.01_wp
  !> Fraction of the energy of residual stresses below which energies are not checked. The initial equilibrium has a
  !> residual of 1e-6 of the forces (`tolerance` of &solver), whose work is up to 1e-6 of this energy: 1 % of the
  !> smallest energy that is checked.
  real(wp), parameter :: fine = 1.0e-4_wp
  !> Kinds of errors: energy created, energy dissipated, energy error.
  integer, parameter, public :: energy_created = 1, energy_dissipated = 2, energy_imbalance = 3

  !> State of the check.
  type :: energy_check_t
    !> Largest energy so far of the impactor, of external work, or of the plate. That of residual stresses is excluded,
    !> as it may be far larger than that of the loads. It begins with the energy of the impactor's weight.
    real(wp) :: largest = 0
    !> True: the previous step had created more than the tolerance
    logical, private :: created_before = .false.
  contains
    procedure :: check
    !> Saves or loads the check.
    procedure :: visit
  end type energy_check_t

contains

  !> The check before the first step.
  pure function new_energy_check(deck) result(self)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The check
    type(energy_check_t) :: self

    self%largest = energy_of_weight(deck)
  end function new_energy_check

  !> Work of gravity until the contact carries the weight of the impactor, on a plate that does not deflect. The energy
  !> of an impactor placed on a plate at rest begins with zero, and its first steps are compared with this energy.
  pure real(wp) function energy_of_weight(deck) result(energy)
    !> The deck
    type(deck_t), intent(in) :: deck
    real(wp) :: weight

    energy = 0
    weight = deck%impactor%mass*deck%impactor%gravity
    if (deck%has_impactor .and. weight > 0) energy = weight*loading_indentation(deck%indentation, weight)
  end function energy_of_weight

  !> Energies above 1 %: created by the integrators or by the indentation, whose work cannot be negative; dissipated;
  !> energy error. An integrator creates energy in the first step of a sudden load and removes it in the next, so that
  !> in time two consecutive steps must have created energy.
  function check(self, ledger, deficit, amplitude, static) result(exceeded)
    !> The check
    class(energy_check_t), intent(inout) :: self
    !> The ledger after an accepted step
    type(ledger_t), intent(in) :: ledger
    !> Energy recorded as fracture energy but not yet released by fronts; it is not algorithmic
    real(wp), intent(in) :: deficit
    !> Load over its full value; small energies are compared with those of the full load, larger by its inverse square
    real(wp), intent(in) :: amplitude
    !> True: load steps
    logical, intent(in) :: static
    !> True for the kinds of errors found
    logical :: exceeded(3)
    logical :: before
    real(wp) :: most

    before = self%created_before .or. static
    self%largest = max(self%largest, ledger%initial - ledger%residual, &
                       ledger%kinetic + ledger%strain - ledger%residual, ledger%external_work, fine*ledger%residual)
    most = energy_tolerance*self%largest
    self%created_before = (-ledger%algorithmic - deficit)*amplitude**2 > most .or. -ledger%indentation > most
    exceeded(energy_created) = self%created_before .and. before
    exceeded(energy_dissipated) = ledger%algorithmic*amplitude**2 > most
    exceeded(energy_imbalance) = abs(ledger%error())*amplitude**2 > most
  end function check

  !> Saves or loads the check.
  subroutine visit(self, archive)
    !> The check
    class(energy_check_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call archive%item('energy_check/largest', self%largest)
    call archive%item('energy_check/created_before', self%created_before)
  end subroutine visit
end module energy_checks
