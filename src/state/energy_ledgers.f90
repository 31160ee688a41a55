!> The energy ledger, theory (E1). All entries are those of the full plate, also under symmetry.
module energy_ledgers
  use kinds, only: wp
  use archives, only: archive_t
  implicit none
  private
  public :: ledger_t

  !> Fraction of the energy of residual stresses below which energies are not checked. The initial equilibrium has a
  !> residual of 1e-6 of the forces (`tolerance` of &solver), whose work is up to 1e-6 of this energy: 1 % of the
  !> smallest energy that is checked.
  real(wp), parameter :: fine = 1.0e-4_wp

  !> The energy ledger. It has many components because each is an entry of the balance.
  type :: ledger_t
    !> Kinetic energy of the impactor and its potential of gravity
    real(wp) :: impactor = 0
    !> Kinetic and strain energy of the plate
    real(wp) :: kinetic = 0, strain = 0
    !> Work on the indentation, stored and dissipated
    real(wp) :: indentation = 0
    !> Energy dissipated by delamination, and by damage of plies
    real(wp) :: delamination = 0, ply_damage = 0
    !> Energy dissipated by contact, and stored in penalty ties; frictional heat
    real(wp) :: contact = 0, friction = 0
    !> Algorithmic dissipation
    real(wp) :: algorithmic = 0
    !> Energy dissipated by damping
    real(wp) :: damping = 0
    !> Strain and kinetic energy lost at insertions of layers
    real(wp) :: layers = 0
    !> Work of pressure and lines, and of the force that drives the impactor of a static analysis
    real(wp) :: external_work = 0
    !> Energy at the start, and its part of residual stresses
    real(wp) :: initial = 0, residual = 0
    !> Part of the kinetic energy in motions with scaled inertia
    real(wp) :: scaled = 0
    !> Largest energy so far, the reference of errors: the present energy may return to zero, as in free vibration
    real(wp) :: largest = 0
  contains
    procedure :: error
    procedure :: note_largest
    procedure :: visit
  end type ledger_t

contains

  !> Energy error: sum of the entries minus initial energy and external work.
  pure real(wp) function error(self)
    class(ledger_t), intent(in) :: self

    error = self%impactor + self%kinetic + self%strain + self%indentation + self%delamination &
            + self%ply_damage + self%contact + self%friction + self%algorithmic + self%layers + self%damping &
            - self%external_work - self%initial
  end function error

  !> Updates the largest energy so far: of the impactor, of the plate, or the work of the loads, which may be negative.
  !> The energy of residual stresses is excluded, as it may be far larger than that of the loads.
  pure subroutine note_largest(self)
    class(ledger_t), intent(inout) :: self

    self%largest = max(self%largest, self%initial - self%residual, self%kinetic + self%strain - self%residual, &
                       abs(self%external_work), fine*self%residual)
  end subroutine note_largest

  !> Saves or loads every entry.
  subroutine visit(self, archive)
    class(ledger_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('ledger/impactor', self%impactor)
    call archive%item('ledger/kinetic', self%kinetic)
    call archive%item('ledger/strain', self%strain)
    call archive%item('ledger/indentation', self%indentation)
    call archive%item('ledger/delamination', self%delamination)
    call archive%item('ledger/ply_damage', self%ply_damage)
    call archive%item('ledger/contact', self%contact)
    call archive%item('ledger/friction', self%friction)
    call archive%item('ledger/algorithmic', self%algorithmic)
    call archive%item('ledger/layers', self%layers)
    call archive%item('ledger/damping', self%damping)
    call archive%item('ledger/external_work', self%external_work)
    call archive%item('ledger/initial', self%initial)
    call archive%item('ledger/residual', self%residual)
    call archive%item('ledger/scaled', self%scaled)
    call archive%item('ledger/largest', self%largest)
  end subroutine visit
end module energy_ledgers
