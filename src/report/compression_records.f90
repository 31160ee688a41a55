!> Record of a compression: the largest stress, and the stresses at the strains between which the modulus is measured.
module compression_records
  use archives, only: archive_t
  use kinds, only: wp
  use output_clocks, only: shown_time
  use text, only: to_text
  implicit none
  private
  public :: compression_record_t

  !> Strains between which the effective modulus is the slope of the chord (ASTM D7137: 1000 and 3000 microstrain).
  real(wp), parameter :: strains(2) = [1.0e-3_wp, 3.0e-3_wp]
  !> The plate has failed when the stress has dropped to this fraction of its maximum: a test ends when the force has
  !> dropped by about 30 % (ASTM D7137).
  real(wp), parameter :: failure_ratio = 0.7_wp
  !> The plate has buckled when a gauge has lost this fraction of its largest compression under a rising load (strain
  !> reversal, J. Singer, J. Arbocz, T. Weller, Buckling Experiments 1, 1998); a smaller loss may be vibration. On
  !> elastic panels in load steps any fraction up to .3 gives the same strain. After an impact, with vibrating gauges,
  !> .02 to .05 give the same strain on cells of 3 mm, and .1 gives none; on cells of 2 mm the strains differ by 15 %
  !> (doc/studies/residual_strength.md).
  real(wp), parameter :: reversed = 0.03_wp

  !> The record.
  type :: compression_record_t
    !> Largest stress, its time, and the shortening then
    real(wp) :: strength = 0, at = 0, shortening = 0
    !> Percent bending then, by two gauges back to back
    real(wp) :: bending = 0
    !> True once the stress has dropped below the fraction of failure
    logical :: failed = .false.
    !> Nominal strain at which the first of two gauges back to back reversed under a rising load; 0: none has
    real(wp) :: buckling = 0
    !> Largest compression of both gauges, with the nominal strain and the stress then
    real(wp), private :: pressed(3, 2) = 0
    !> Stress at the strains; 0: not reached
    real(wp), private :: stresses(2) = 0
    !> Last strain and stress
    real(wp), private :: strain = 0, stress = 0
    !> Strain at the largest stress
    real(wp), private :: strain_at_strength = 0
  contains
    procedure :: observe
    procedure :: observe_gauges
    procedure :: modulus
    procedure :: visit
  end type compression_record_t

contains

  !> Updates the record with a state.
  pure subroutine observe(self, time, stress, shortening, strain, bending)
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
    ! After failure the halves of the plate vibrate, and their force on the ends may exceed the strength.
    if (self%failed) return
    if (stress > self%strength) then
      self%strength = stress
      self%strain_at_strength = strain
      self%at = shown_time(time)
      self%shortening = shortening
      self%bending = bending
    else if (stress < failure_ratio*self%strength) then
      ! Residual vibration of an impact may cause drops as large, but at small strains.
      self%failed = strain > strains(1)
    end if
  end subroutine observe

  !> Updates the record with two gauges back to back, after the state.
  pure subroutine observe_gauges(self, gauges)
    class(compression_record_t), intent(inout) :: self
    !> Strains on the front and on the back
    real(wp), intent(in) :: gauges(2)
    integer :: i

    do i = 1, 2
      if (-gauges(i) > self%pressed(1, i)) then
        self%pressed(:, i) = [-gauges(i), self%strain, self%stress]
      else if (.not. self%buckling > 0 .and. self%strain > strains(1)) then
        if (-gauges(i) < (1 - reversed)*self%pressed(1, i) .and. self%stress > self%pressed(3, i)) &
          self%buckling = self%pressed(2, i)
      end if
    end do
  end subroutine observe_gauges

  !> Slope of the chord between both strains, if both were reached before the largest stress; 0: not known.
  pure real(wp) function modulus(self)
    class(compression_record_t), intent(in) :: self

    modulus = 0
    if (all(self%stresses > 0) .and. self%strain_at_strength >= strains(2)) &
      modulus = (self%stresses(2) - self%stresses(1))/(strains(2) - strains(1))
  end function modulus

  !> Saves or loads the record.
  subroutine visit(self, archive)
    class(compression_record_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    integer :: i

    call archive%item('compression/strength', self%strength)
    call archive%item('compression/at', self%at)
    call archive%item('compression/shortening', self%shortening)
    call archive%item('compression/bending', self%bending)
    call archive%item('compression/failed', self%failed)
    call archive%item('compression/buckling', self%buckling)
    do i = 1, 6
      associate (place => [1 + mod(i - 1, 3), 1 + (i - 1)/3])
        call archive%item('compression/pressed_'//to_text(i), self%pressed(place(1), place(2)))
      end associate
    end do
    call archive%item('compression/stresses_1', self%stresses(1))
    call archive%item('compression/stresses_2', self%stresses(2))
    call archive%item('compression/strain', self%strain)
    call archive%item('compression/stress', self%stress)
    call archive%item('compression/strain_at_strength', self%strain_at_strength)
  end subroutine visit
end module compression_records
