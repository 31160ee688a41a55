!> Watches over a run whether its time integrators create energy.
module energy_watches
  use kinds, only: wp
  use archives, only: archive_t
  use energy_ledgers, only: ledger_t
  implicit none
  private
  public :: energy_watch_t

  !> Part of the energy that must not have been created.
  real(wp), parameter :: much = 0.01_wp

  !> What was seen so far.
  type :: energy_watch_t
    private
    !> Largest energy of the plate and at the start, so far
    real(wp) :: largest = 0
    !> Too much had been created after the step before
    logical :: doubtful = .false.
    !> The user has been told
    logical :: told = .false.
  contains
    procedure :: alarms
    !> Saves or loads what was seen.
    procedure :: visit
  end type energy_watch_t

contains

  !> True, once, if more than 1 % of the energy has been created, by the integrators or by the indentation, whose work
  !> can't be negative. What an integrator creates in the first step of a load that is there at once it takes out in the
  !> next: two steps in a row must say so.
  logical function alarms(self, ledger, deficit, amplitude)
    !> The watch
    class(energy_watch_t), intent(inout) :: self
    !> The ledger after an accepted step
    type(ledger_t), intent(in) :: ledger
    !> Energy booked as fracture that the fronts have not set free yet: no integrator made it
    real(wp), intent(in) :: deficit
    !> Load over its full value: the energies to come are larger by its square, which small ones are judged by
    real(wp), intent(in) :: amplitude
    logical :: before

    before = self%doubtful
    self%largest = max(self%largest, ledger%initial, ledger%kinetic + ledger%strain)
    self%doubtful = (-ledger%algorithmic - deficit)*amplitude**2 > much*self%largest .or. &
                    -ledger%indentation > much*self%largest
    alarms = self%doubtful .and. before .and. .not. self%told
    self%told = self%told .or. alarms
  end function alarms

  !> Saves or loads what was seen.
  subroutine visit(self, archive)
    !> The watch
    class(energy_watch_t), intent(inout) :: self
    !> Where to or where from
    class(archive_t), intent(inout) :: archive

    call archive%item('energy_watch/largest', self%largest)
    call archive%item('energy_watch/doubtful', self%doubtful)
    call archive%item('energy_watch/told', self%told)
  end subroutine visit
end module energy_watches
