!> Modes of a beam with clamped ends that are symmetric about its middle, for Rayleigh's and Ritz's method (S.
!> Timoshenko, Vibration Problems in Engineering, 1937, art. 53). With x from the middle over the length and tan(q/2) =
!> -tanh(q/2) they are cos(q x)/cos(q/2) - cosh(q x)/cosh(q/2); the mean of their squares is 1, that of the squares of
!> their second derivatives q**4.
module beam_modes
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: clamped_beam_number, clamped_beam_mean, clamped_beam_slope, propped_beam_slope

  !> First wave number of a beam with one clamped and one simply supported end, times its length: tan(q) = tanh(q)
  real(wp), parameter, public :: propped_beam_number = 3.926602312_wp
  !> Steps of Newton's method for a wave number: its first guess is within 4e-3 of the first, closer to all others.
  integer, parameter :: iterations = 4

contains

  !> Wave number of a symmetric mode, times the length.
  elemental real(wp) function clamped_beam_number(mode) result(q)
    !> Its number, 1 for the first
    integer, intent(in) :: mode
    integer :: i

    q = (2*mode - 0.5_wp)*pi
    do i = 1, iterations
      q = q - 2*(tan(q/2) + tanh(q/2))/(2 + tan(q/2)**2 - tanh(q/2)**2)
    end do
  end function clamped_beam_number

  !> Mean of a mode over a part of the beam in its middle.
  elemental real(wp) function clamped_beam_mean(q, part) result(mean)
    !> Wave number times length
    real(wp), intent(in) :: q
    !> Length of the part over that of the beam
    real(wp), intent(in) :: part
    real(wp) :: half

    half = q*part/2
    ! Hyperbolic functions of large numbers by their exponentials.
    mean = 1/cos(q/2) - 2*exp(-q/2)/(1 + exp(-q))
    if (half > 0) mean = sin(half)/half/cos(q/2) - exp(half - q/2)*(1 - exp(-2*half))/(half*(1 + exp(-q)))
  end function clamped_beam_mean

  !> Mean square of the derivative of a mode over the square of its wave number.
  elemental real(wp) function clamped_beam_slope(q) result(slope)
    !> Wave number times length
    real(wp), intent(in) :: q

    slope = tanh(q/2)*(tanh(q/2) - 2/q)
  end function clamped_beam_slope

  !> The same for a beam with one clamped and one simply supported end.
  elemental real(wp) function propped_beam_slope(q) result(slope)
    !> Wave number times length
    real(wp), intent(in) :: q

    slope = (1/tanh(q) - 1/q)/tanh(q)
  end function propped_beam_slope
end module beam_modes
