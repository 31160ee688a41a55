!> Modes of a beam with clamped ends, for Rayleigh's and Ritz's method (S. Timoshenko, Vibration Problems in
!> Engineering, 1937, art. 53). With x from the middle over the length, modes of odd number are symmetric: with tan(q/2)
!> = -tanh(q/2) they are cos(q x)/cos(q/2) - cosh(q x)/cosh(q/2). Those of even number have sines for cosines, and
!> tan(q/2) = tanh(q/2); a half of them is a mode of a beam with one clamped and one simply supported end. The mean of
!> the squares of modes is 1, that of their second derivatives q**4.
module beam_modes
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: clamped_beam_number, clamped_beam_mean, clamped_beam_slope

  !> Steps of Newton's method for a wave number: its first guess is within 4e-3 of the first, closer to all others.
  integer, parameter :: iterations = 4

contains

  !> Wave number of a mode, times the length.
  elemental real(wp) function clamped_beam_number(mode) result(q)
    !> Its number, 1 for the first
    integer, intent(in) :: mode
    real(wp) :: sign
    integer :: i

    sign = merge(1, -1, is_symmetric(mode))
    q = (mode + 0.5_wp)*pi
    do i = 1, iterations
      q = q - 2*(tan(q/2) + sign*tanh(q/2))/(1 + tan(q/2)**2 + sign*(1 - tanh(q/2)**2))
    end do
  end function clamped_beam_number

  !> True for modes of odd number.
  elemental logical function is_symmetric(mode)
    !> The number
    integer, intent(in) :: mode

    is_symmetric = modulo(mode, 2) == 1
  end function is_symmetric

  !> Mean of a mode over a part of the beam.
  elemental real(wp) function clamped_beam_mean(mode, part, place) result(mean)
    !> Its number
    integer, intent(in) :: mode
    !> Length of the part, and coordinate of its middle, over the length of the beam
    real(wp), intent(in) :: part, place
    real(wp) :: q, half, wave, growth, sign

    q = clamped_beam_number(mode)
    sign = merge(1, -1, is_symmetric(mode))
    half = q*part/2
    wave = cos(q*place)/cos(q/2)
    if (.not. is_symmetric(mode)) wave = sin(q*place)/sin(q/2)
    ! Hyperbolic functions of large numbers by their exponentials.
    growth = exp(abs(q*place) - q/2)*(1 + sign*exp(-2*abs(q*place)))/(1 + sign*exp(-q))
    if (.not. is_symmetric(mode) .and. place < 0) growth = -growth
    if (half > 0) then
      wave = wave*sin(half)/half
      growth = growth*exp(half)*(1 - exp(-2*half))/(2*half)
    end if
    mean = wave - growth
  end function clamped_beam_mean

  !> Mean square of the derivative of a mode over the square of its wave number.
  elemental real(wp) function clamped_beam_slope(mode) result(slope)
    !> Its number
    integer, intent(in) :: mode
    real(wp) :: ratio

    associate (q => clamped_beam_number(mode))
      ratio = tanh(q/2)
      if (.not. is_symmetric(mode)) ratio = 1/ratio
      slope = ratio*(ratio - 2/q)
    end associate
  end function clamped_beam_slope
end module beam_modes
