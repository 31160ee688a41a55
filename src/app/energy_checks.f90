!> Checks the energy balance of a run by one rule: energy created or dissipated by integrators or load steps, and the
!> energy error, must stay below 1 % of the energy.
module energy_checks
  use kinds, only: wp
  use archives, only: archive_t
  use energy_ledgers, only: ledger_t
  implicit none
  private
  public :: energy_check_t

  !> Permitted fraction of energy created, dissipated or unaccounted for. Energies go by the square of forces: 1 % of
  !> energy is half the error of the force that accuracy='standard' permits.
  real(wp), parameter, public :: energy_tolerance = 0.01_wp
  !> Fraction of the energy of residual stresses below which energies are not checked. The initial equilibrium has a
  !> residual of 1e-6 of the forces (`tolerance` of &solver), whose work is up to 1e-6 of this energy: 1 % of the
  !> smallest energy that is checked.
  real(wp), parameter :: fine = 1.0e-4_wp
  !> Kinds of errors: energy created, energy dissipated, energy unaccounted for.
  integer, parameter, public :: energy_created = 1, energy_taken = 2, energy_unaccounted = 3

  !> State of the check.
  type :: energy_check_t
    !> Largest energy so far of the impactor, of external work, or of the plate without residual stresses, whose energy
    !> may be far larger than that of the loads. It begins with the energy of the impactor's weight.
    real(wp) :: largest = 0
    !> True: the previous step had created more than the tolerance
    logical, private :: created_before = .false.
  contains
    procedure :: check
    !> Saves or loads the check.
    procedure :: visit
  end type energy_check_t

contains

  !> Energies above 1 %: created by the integrators or by the indentation, whose work cannot be negative; dissipated;
  !> energy error. An integrator creates energy in the first step of a sudden load and removes it in the next, so that
  !> in time two consecutive steps must have created energy.
  function check(self, ledger, deficit, amplitude, static) result(exceeded)
    !> The check
    class(energy_check_t), intent(inout) :: self
    !> The ledger after an accepted step
    type(ledger_t), intent(in) :: ledger
    !> Energy booked as fracture energy but not yet released by fronts; it is not algorithmic
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
    exceeded(energy_taken) = ledger%algorithmic*amplitude**2 > most
    exceeded(energy_unaccounted) = abs(ledger%error())*amplitude**2 > most
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
