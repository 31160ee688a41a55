!> Slow motions, in which prescribed displacements load the plate as in a quasi-static test: kinetic energy over the
!> work of the load. The work is counted from the end of `settle`: while a plate is damped to rest its supports move,
!> and their work may be negative.
module slow_motions
  use archives, only: archive_t
  use deck_contents, only: deck_t
  use energy_ledgers, only: ledger_t
  use kinds, only: wp
  use line_loads, only: line_ramp
  implicit none
  private
  public :: slow_motion_t, is_slow_motion, has_developed

  !> Fraction of the loading after which its kinetic energy is checked: the default rise of a travel, after which the
  !> velocity is constant.
  real(wp), parameter :: slow_start = 0.25_wp

  !> Work and kinetic energy of a slow motion.
  type :: slow_motion_t
    !> External work before the load begins
    real(wp), private :: before = 0
    !> Largest work of the load in magnitude
    real(wp), private :: work = 0
    !> Largest ratio of kinetic energy to that work
    real(wp) :: share = 0
  contains
    procedure :: observe
    procedure :: visit
  end type slow_motion_t

contains

  !> Updates work and ratio with a complete state. The work may return to zero, so the largest one is the reference.
  pure subroutine observe(self, deck, time, ledger, counts)
    class(slow_motion_t), intent(inout) :: self
    type(deck_t), intent(in) :: deck
    !> Time of the state
    real(wp), intent(in) :: time
    !> Its ledger
    type(ledger_t), intent(in) :: ledger
    !> False: the state does not belong to the test, as the plate has failed
    logical, intent(in) :: counts

    if (.not. is_slow_motion(deck)) return
    if (time <= deck%setup%loading%start) then
      self%before = ledger%external_work
      return
    end if
    self%work = max(self%work, abs(ledger%external_work - self%before))
    if (counts .and. has_developed(deck, time) .and. self%work > 0) &
      self%share = max(self%share, ledger%kinetic/self%work)
  end subroutine observe

  !> True: only prescribed motions in time load the plate, as in a quasi-static test.
  pure logical function is_slow_motion(deck)
    type(deck_t), intent(in) :: deck

    is_slow_motion = .false.
    if (deck%setup%is_static() .or. deck%setup%pressure%is_present .or. deck%setup%is_impact()) return
    is_slow_motion = deck%setup%impactor%travel > 0
    if (allocated(deck%setup%lines)) is_slow_motion = is_slow_motion .or. &
      any(deck%setup%lines%prescribed .and. (deck%setup%lines%history == line_ramp .or. &
                                             deck%setup%lines%rise > 0) .and. abs(deck%setup%lines%value) > 0)
  end function is_slow_motion

  !> True once a part of the loading has passed, after which kinetic energies are checked.
  pure logical function has_developed(deck, time)
    type(deck_t), intent(in) :: deck
    real(wp), intent(in) :: time

    has_developed = time - deck%setup%loading%start > slow_start*(deck%stepping%time%end - deck%setup%loading%start)
  end function has_developed

  !> Saves or loads.
  subroutine visit(self, archive)
    class(slow_motion_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive

    call archive%item('slow_motion/before', self%before)
    call archive%item('slow_motion/work', self%work)
    call archive%item('slow_motion/share', self%share)
  end subroutine visit
end module slow_motions
