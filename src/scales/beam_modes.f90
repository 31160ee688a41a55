!> Modes of a beam with any supports of its ends, for Rayleigh's and Ritz's method (S. Timoshenko, Vibration Problems in
!> Engineering, 1937, art. 53). The length is 1, x is 0 in the middle, and the mean square of a mode is 1.
!>
!> Between clamped ends, between free ends, and with the end at x = -1/2 clamped and the other free a mode is a wave,
!> cos(q x)/cos(q/2) or sin(q x)/sin(q/2), plus or minus cosh(q x)/cosh(q/2) or sinh(q x)/sinh(q/2). Its second
!> derivative over q**2 is a mode of the beam with free for clamped ends. A half of an antisymmetric mode is a mode of a
!> beam with a simple support in place of the middle. Free beams also move rigidly.
module beam_modes
  use kinds, only: wp
  use mathematical_constants, only: pi
  use mesh_parameters, only: edge_clamped, edge_free, edge_simple
  implicit none
  private
  public :: beam_t, beam_of

  !> A beam by its supports.
  type :: beam_t
    private
    !> Supports of the full beam, which this is, or a half of
    integer :: ends(2) = edge_simple
    !> True: it is the half from the middle on
    logical :: is_half = .false.
    !> True: its ends are exchanged
    logical :: is_turned = .false.
  contains
    procedure :: wave_number
    procedure :: mean
    procedure :: derivative
    procedure :: mean_square_slope
    procedure :: slope_by_curvature
    procedure :: is_symmetric
    procedure, private :: full_number
    procedure, private :: place_in_full
  end type beam_t

  !> Steps of Newton's method for a wave number: its first guess is within .31 of the first of a cantilever, within 2e-2
  !> of all others; the fifth step changes none by more than round-off.
  integer, parameter :: iterations = 5

contains

  !> The beam with these supports.
  pure type(beam_t) function beam_of(ends) result(beam)
    !> Supports at both ends
    integer, intent(in) :: ends(2)
    logical :: simple(2)

    simple = ends /= edge_clamped .and. ends /= edge_free
    if (any(simple) .and. .not. all(simple)) then
      beam = beam_t(ends=merge(ends(2), ends(1), simple(1)), is_half=.true., is_turned=simple(2))
    else if (.not. any(simple)) then
      beam = beam_t(ends=ends, is_turned=ends(1) == edge_free .and. ends(2) == edge_clamped)
      if (beam%is_turned) beam%ends = ends(2:1:-1)
    end if
  end function beam_of

  !> Wave number of a mode, 0 of a rigid motion.
  elemental real(wp) function wave_number(self, mode) result(q)
    class(beam_t), intent(in) :: self
    !> Its number, 1 for the first
    integer, intent(in) :: mode

    q = number_of(self%ends, self%full_number(mode))
    if (self%is_half) q = q/2
  end function wave_number

  !> Number of the mode of the full beam.
  elemental integer function full_number(self, mode) result(number)
    class(beam_t), intent(in) :: self
    !> Number of the mode of this one
    integer, intent(in) :: mode

    number = merge(2*mode, mode, self%is_half)
  end function full_number

  !> Coordinate in the full beam.
  elemental real(wp) function place_in_full(self, place) result(x)
    class(beam_t), intent(in) :: self
    !> Coordinate from the middle
    real(wp), intent(in) :: place

    x = merge(-place, place, self%is_turned)
    if (self%is_half) x = (0.5_wp + x)/2
  end function place_in_full

  !> True for modes that are symmetric about the middle.
  elemental logical function is_symmetric(self, mode)
    class(beam_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: mode

    is_symmetric = modulo(mode, 2) == 1 .and. .not. self%is_half .and. self%ends(1) == self%ends(2)
  end function is_symmetric

  !> Mean of a mode over a part of the beam.
  elemental real(wp) function mean(self, mode, part, place)
    class(beam_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: mode
    !> Length of the part, and coordinate of its middle
    real(wp), intent(in) :: part, place

    mean = mean_in_full(self%ends, self%full_number(mode), merge(part/2, part, self%is_half), &
                        self%place_in_full(place), 0)
  end function mean

  !> Derivative of a mode.
  elemental real(wp) function derivative(self, mode, place, order)
    class(beam_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: mode
    !> Coordinate
    real(wp), intent(in) :: place
    !> Order of the derivative
    integer, intent(in) :: order

    derivative = mean_in_full(self%ends, self%full_number(mode), 0.0_wp, self%place_in_full(place), order)
    if (self%is_half) derivative = derivative/2**order
    if (self%is_turned) derivative = (-1)**order*derivative
  end function derivative

  !> Mean square of the derivative of a mode.
  elemental real(wp) function mean_square_slope(self, mode) result(square)
    class(beam_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: mode
    integer :: number

    number = self%full_number(mode)
    associate (q => number_of(self%ends, number))
      if (is_rigid(self%ends, number)) then
        square = merge(12.0_wp, 0.0_wp, number == 2)
      else if (all(self%ends == edge_simple)) then
        square = q**2
      else
        square = ratio(q, number)*(q*ratio(q, number) + (4*count(self%ends == edge_free) - 2))*q
      end if
    end associate
    if (self%is_half) square = square/4
  end function mean_square_slope

  !> Mean product of a mode and its second derivative, with the opposite sign: by parts, the mean square slope less the
  !> product of deflection and slope at free ends.
  elemental real(wp) function slope_by_curvature(self, mode) result(product)
    class(beam_t), intent(in) :: self
    !> Its number
    integer, intent(in) :: mode

    product = self%mean_square_slope(mode) &
              - self%derivative(mode, 0.5_wp, 0)*self%derivative(mode, 0.5_wp, 1) &
              + self%derivative(mode, -0.5_wp, 0)*self%derivative(mode, -0.5_wp, 1)
  end function slope_by_curvature

  !> Hyperbolic tangent of half a wave number, for even modes its inverse.
  elemental real(wp) function ratio(q, number)
    !> The wave number
    real(wp), intent(in) :: q
    !> Number of the mode
    integer, intent(in) :: number

    ratio = tanh(q/2)
    if (modulo(number, 2) == 0) ratio = 1/ratio
  end function ratio

  !> True for the two rigid motions of a free beam.
  pure logical function is_rigid(ends, number)
    !> Supports
    integer, intent(in) :: ends(2)
    !> Number of the mode
    integer, intent(in) :: number

    is_rigid = all(ends == edge_free) .and. number <= 2
  end function is_rigid

  !> Wave number of a full beam: cos(q) cosh(q) is 1, and -1 if one end is free.
  pure real(wp) function number_of(ends, number) result(q)
    !> Supports
    integer, intent(in) :: ends(2)
    !> Number of the mode
    integer, intent(in) :: number
    real(wp) :: inverse
    integer :: i

    q = number*pi
    if (all(ends == edge_simple)) return
    q = 0
    if (is_rigid(ends, number)) return
    q = (number + 0.5_wp - count(ends == edge_free))*pi
    do i = 1, iterations
      ! 1/cosh(q) by its exponential, which is not large.
      inverse = merge(-1, 1, ends(1) /= ends(2))*2*exp(-q)/(1 + exp(-2*q))
      q = q + (cos(q) - inverse)/(sin(q) - inverse*tanh(q))
    end do
  end function number_of

  !> Mean of a derivative of a mode of a full beam over a part of it.
  pure real(wp) function mean_in_full(ends, number, part, place, order) result(mean)
    !> Supports
    integer, intent(in) :: ends(2)
    !> Number of the mode
    integer, intent(in) :: number
    !> Length of the part, and coordinate of its middle
    real(wp), intent(in) :: part, place
    !> Order of the derivative
    integer, intent(in) :: order
    real(wp) :: q, half

    if (is_rigid(ends, number)) then
      mean = merge(1, 0, order == number - 1)
      if (number == 2 .and. order == 0) mean = place
      if (number == 2) mean = sqrt(12.0_wp)*mean
      return
    end if
    q = number_of(ends, number)
    half = q*part/2
    if (all(ends == edge_simple)) then
      mean = sqrt(2.0_wp)*sin(q*(place + 0.5_wp) + order*pi/2)*sine_ratio(half)
    else
      mean = wave(q, place, order, modulo(number, 2) == 1 .eqv. ends(1) == ends(2))*sine_ratio(half) + &
             merge(-1, 1, all(ends == edge_clamped))*growth(q, place, order, half, modulo(number, 2) == 1)
    end if
    mean = q**order*mean
  end function mean_in_full

  !> sin(x)/x.
  pure real(wp) function sine_ratio(x)
    !> Angle, at least 0
    real(wp), intent(in) :: x

    sine_ratio = 1
    if (x > 0) sine_ratio = sin(x)/x
  end function sine_ratio

  !> Derivative of cos(q x)/cos(q/2) or sin(q x)/sin(q/2) over the power of q.
  pure real(wp) function wave(q, place, order, is_cosine)
    !> Wave number
    real(wp), intent(in) :: q
    !> x
    real(wp), intent(in) :: place
    !> Order of the derivative
    integer, intent(in) :: order
    !> True: of the cosine
    logical, intent(in) :: is_cosine

    if (is_cosine) then
      wave = cos(q*place + order*pi/2)/cos(q/2)
    else
      wave = sin(q*place + order*pi/2)/sin(q/2)
    end if
  end function wave

  !> Mean of a derivative of cosh(q x)/cosh(q/2) or sinh(q x)/sinh(q/2) over the power of q. Hyperbolic functions of
  !> large numbers are written by their exponentials.
  pure real(wp) function growth(q, place, order, half, is_cosine)
    !> Wave number
    real(wp), intent(in) :: q
    !> x
    real(wp), intent(in) :: place
    !> Order of the derivative
    integer, intent(in) :: order
    !> q times half the length over which the mean is taken
    real(wp), intent(in) :: half
    !> True: of the hyperbolic cosine
    logical, intent(in) :: is_cosine
    real(wp) :: sign

    sign = merge(1, -1, is_cosine .eqv. modulo(order, 2) == 0)
    growth = exp(abs(q*place) - q/2)*(1 + sign*exp(-2*abs(q*place)))/(1 + merge(1, -1, is_cosine)*exp(-q))
    if (sign < 0 .and. place < 0) growth = -growth
    if (half > 0) growth = growth*exp(half)*(1 - exp(-2*half))/(2*half)
  end function growth
end module beam_modes
