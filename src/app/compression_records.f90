!> What a run remembers of a plate whose ends are pressed together: the largest stress that they bear, and the stress at
!> the strains between which a modulus is measured.
module compression_records
  use archives, only: archive_t
  use kinds, only: wp
  use output_clocks, only: shown_time
  implicit none
  private
  public :: compression_record_t

  !> Strains between which the effective modulus is the slope of the chord (ASTM D7137: 1000 and 3000 microstrain).
  real(wp), parameter :: strains(2) = [1.0e-3_wp, 3.0e-3_wp]
  !> Part of its largest value below which the stress has to come for the plate to have failed: a test ends when the
  !> force has dropped by about 30 % (ASTM D7137).
  real(wp), parameter :: failure_ratio = 0.7_wp

  !> The record.
  type :: compression_record_t
    !> Largest stress, its time, and the shortening then
    real(wp) :: strength = 0, at = 0, shortening = 0
    !> Percent bending then, by two gauges back to back
    real(wp) :: bending = 0
    !> True once the stress has fallen far below that
    logical :: failed = .false.
    !> Stress at the strains; 0: not reached
    real(wp), private :: stresses(2) = 0
    !> Strain and stress seen last
    real(wp), private :: strain = 0, stress = 0
  contains
    !> Looks at a state.
    procedure :: observe
    !> Effective modulus; 0: not known.
    procedure :: modulus
    !> Saves or loads.
    procedure :: visit
  end type compression_record_t

contains

  !> Looks at a state.
  pure subroutine observe(self, time, stress, shortening, strain, bending)
    !> The record
    class(compression_record_t), intent(inout) :: self
    !> Time, far-field stress, shortening, and that over the length of the plate
    real(wp), intent(in) :: time, stress, shortening, strain
    !> Percent bending
    real(wp), intent(in) :: bending
    integer :: i

    do i = 1, size(strains)
      if (self%strain < strains(i) .and. strain >= strains(i)) self%stresses(i) = self%stress &
        + (stress - self%stress)*(strains(i) - self%strain)/(strain - self%strain)
    end do
    self%strain = strain
    self%stress = stress
    if (stress > self%strength) then
      self%strength = stress
      self%at = shown_time(time)
      self%shortening = shortening
      self%bending = bending
      self%failed = .false.
    else if (stress < failure_ratio*self%strength) then
      self%failed = .true.
    end if
  end subroutine observe

  !> Slope of the chord between both strains, if both were reached before the largest stress; 0: not known.
  pure real(wp) function modulus(self)
    !> The record
    class(compression_record_t), intent(in) :: self

    modulus = 0
    if (all(self%stresses > 0)) modulus = (self%stresses(2) - self%stresses(1))/(strains(2) - strains(1))
  end function modulus

  !> Saves or loads the record.
  subroutine visit(self, archive)
    !> The record
    class(compression_record_t), intent(inout) :: self
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive

    call archive%item('compression/strength', self%strength)
    call archive%item('compression/at', self%at)
    call archive%item('compression/shortening', self%shortening)
    call archive%item('compression/bending', self%bending)
    call archive%item('compression/failed', self%failed)
    call archive%item('compression/stresses_1', self%stresses(1))
    call archive%item('compression/stresses_2', self%stresses(2))
    call archive%item('compression/strain', self%strain)
    call archive%item('compression/stress', self%stress)
  end subroutine visit
end module compression_records
