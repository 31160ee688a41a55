!> Watches over a run whether its ledger accounts for the energy, by one rule for all of it: what integrators or load
!> steps create or take, and what no entry accounts for, is to stay below 1 % of the energy.
module energy_watches
  use kinds, only: wp
  use archives, only: archive_t
  use energy_ledgers, only: ledger_t
  implicit none
  private
  public :: energy_watch_t

  !> Part of the energy that must not have been created, taken or lost sight of.
  real(wp), parameter, public :: energy_tolerance = 0.01_wp
  !> Part of the energy of residual stresses below which energies are not judged. The equilibrium that they start from
  !> leaves 1e-6 of the forces (`tolerance` of &solver), whose work is up to 1e-6 of this energy: 1 % of what is judged.
  real(wp), parameter :: fine = 1.0e-4_wp
  !> What may be wrong: energy created, energy taken, energy that no entry accounts for.
  integer, parameter, public :: energy_created = 1, energy_taken = 2, energy_unaccounted = 3

  !> What was seen so far.
  type :: energy_watch_t
    !> Largest energy so far that came with the impactor, was put in, or is in the plate, residual stresses left out:
    !> these may hold far more than what loads the plate.
    real(wp) :: largest = 0
    !> Too much had been created after the step before
    logical, private :: doubtful = .false.
  contains
    procedure :: check
    !> Saves or loads what was seen.
    procedure :: visit
  end type energy_watch_t

contains

  !> What is more than 1 % of the energy: created by the integrators or by the indentation, whose work can't be
  !> negative; taken; not accounted for. What an integrator creates in the first step of a load that is there at once it
  !> takes out in the next: of steps in time two in a row must say that energy was created.
  function check(self, ledger, deficit, amplitude, static) result(alarms)
    !> The watch
    class(energy_watch_t), intent(inout) :: self
    !> The ledger after an accepted step
    type(ledger_t), intent(in) :: ledger
    !> Energy booked as fracture that the fronts have not released yet: no integrator made it
    real(wp), intent(in) :: deficit
    !> Load over its full value: the energies to come are larger by its square, which small ones are judged by
    real(wp), intent(in) :: amplitude
    !> True: load steps
    logical, intent(in) :: static
    !> Which of them are
    logical :: alarms(3)
    logical :: before
    real(wp) :: most

    before = self%doubtful .or. static
    self%largest = max(self%largest, ledger%initial - ledger%residual, &
                       ledger%kinetic + ledger%strain - ledger%residual, ledger%external_work, fine*ledger%residual)
    most = energy_tolerance*self%largest
    self%doubtful = (-ledger%algorithmic - deficit)*amplitude**2 > most .or. -ledger%indentation > most
    alarms(energy_created) = self%doubtful .and. before
    alarms(energy_taken) = ledger%algorithmic*amplitude**2 > most
    alarms(energy_unaccounted) = abs(ledger%error())*amplitude**2 > most
  end function check

  !> Saves or loads what was seen.
  subroutine visit(self, archive)
    !> The watch
    class(energy_watch_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call archive%item('energy_watch/largest', self%largest)
    call archive%item('energy_watch/doubtful', self%doubtful)
  end subroutine visit
end module energy_watches
