!> Low-pass filter of the contact force, as in amplifiers of test rigs: Butterworth of 4th order. It is causal, so that
!> the filtered force lags by 2.6 divided by the angular corner frequency.
!>
!> Two sections x'' + 2 zeta omega x' + omega**2 x = omega**2 f in series, with zeta = cos(pi/8) and cos(3 pi/8) (S.
!> Butterworth, Experimental Wireless 7 (1930) 536). Each is integrated by the trapezoidal rule, which is stable for any
!> step and exact for a constant force.
module force_filters
  use archives, only: archive_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: force_filter_t

  !> Name of the filter in results.
  character(len=*), parameter, public :: filter_kind = 'Butterworth low pass of 4th order, causal'
  !> Damping of the two sections of a Butterworth filter of fourth order: its poles lie at odd multiples of pi/8 on a
  !> circle.
  real(wp), parameter :: damping(2) = [cos(pi/8), cos(3*pi/8)]

  !> A filter and its state.
  type :: force_filter_t
    !> Corner frequency (half power); 0: no filter
    real(wp) :: frequency = 0
    !> Filtered force
    real(wp) :: force = 0
    !> Input at the end of the last step
    real(wp), private :: input = 0
    !> Output of each section, and its rate over omega, (2, sections)
    real(wp), private :: state(2, 2) = 0
  contains
    procedure :: advance
    procedure :: visit
  end type force_filter_t

contains

  !> Advances the filter by a step.
  pure subroutine advance(self, step, force)
    class(force_filter_t), intent(inout) :: self
    !> Length of the step, and the force at its end
    real(wp), intent(in) :: step, force
    real(wp) :: half, before, input(2), rate
    integer :: section

    if (.not. self%frequency > 0) then
      self%force = force
      return
    end if
    half = pi*self%frequency*step
    input = [self%input, force]
    do section = 1, 2
      associate (x => self%state(1, section), v => self%state(2, section), zeta => damping(section))
        ! v' = omega (f - x - 2 zeta v), x' = omega v by the trapezoidal rule.
        before = x
        rate = (v*(1 - 2*zeta*half - half**2) + half*(sum(input) - 2*x))/(1 + 2*zeta*half + half**2)
        x = x + half*(v + rate)
        v = rate
        input = [before, x]
      end associate
    end do
    self%input = force
    self%force = self%state(1, 2)
  end subroutine advance

  !> Saves or loads.
  subroutine visit(self, archive)
    class(force_filter_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    real(wp), allocatable :: numbers(:)

    if (.not. self%frequency > 0) return
    numbers = [self%force, self%input, self%state]
    call archive%item('filter/state', numbers)
    self%force = numbers(1)
    self%input = numbers(2)
    self%state = reshape(numbers(3:6), [2, 2])
  end subroutine visit
end module force_filters
