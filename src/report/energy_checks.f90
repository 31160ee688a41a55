!> Checks the energy balance of a run by one rule: energy created or dissipated by integrators or load steps, and the
!> energy error, must stay below 1 % of the energy.
module energy_checks
  use archives, only: archive_t
  use energy_ledgers, only: ledger_t
  use kinds, only: wp
  implicit none
  private
  public :: energy_check_t

  !> Permitted fraction of energy created or dissipated, and of the energy error. Energies are proportional to squares
  !> of forces: 1 % of energy is half the error of the force that accuracy='standard' permits.
  real(wp), parameter, public :: energy_tolerance = 0.01_wp
  !> Kinds of errors: energy created, energy dissipated, energy error.
  integer, parameter, public :: energy_created = 1, energy_dissipated = 2, energy_imbalance = 3

  !> State of the check.
  type :: energy_check_t
    !> True: the previous step had created more than the tolerance
    logical, private :: created_before = .false.
  contains
    procedure :: check
    procedure :: visit
  end type energy_check_t

contains

  !> Energies above 1 %: created by the integrators or by the indentation, whose work cannot be negative; dissipated;
  !> energy error. An integrator creates energy in the first step of a sudden load and removes it in the next, so that
  !> in time two consecutive steps must have created energy.
  function check(self, ledger, deficit, amplitude, static) result(exceeded)
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
    most = energy_tolerance*ledger%largest
    self%created_before = (-ledger%algorithmic - deficit)*amplitude**2 > most .or. -ledger%indentation > most
    exceeded(energy_created) = self%created_before .and. before
    exceeded(energy_dissipated) = ledger%algorithmic*amplitude**2 > most
    exceeded(energy_imbalance) = abs(ledger%error())*amplitude**2 > most
  end function check

  !> Saves or loads the check.
  subroutine visit(self, archive)
    class(energy_check_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('energy_check/created_before', self%created_before)
  end subroutine visit
end module energy_checks
