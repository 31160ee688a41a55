!> Hertz' contact of a sphere with a plate, F = k alpha**1.5, and Sun's formula for k on a laminate, theory (F8).
module hertz_contact
  use kinds, only: wp
  implicit none
  private
  public :: hertz_force, hertz_stiffness, mean_power, relative_radius, sun_stiffness

  !> Exponent of the law
  real(wp), parameter, public :: hertz_exponent = 1.5_wp

contains

  !> Contact force.
  elemental real(wp) function hertz_force(k, alpha) result(force)
    !> Contact stiffness, force per length**1.5
    real(wp), intent(in) :: k
    real(wp), intent(in) :: alpha

    force = k*alpha**hertz_exponent
  end function hertz_force

  !> Derivative of the contact force by the indentation.
  elemental real(wp) function hertz_stiffness(k, alpha) result(stiffness)
    !> Contact stiffness, force per length**1.5
    real(wp), intent(in) :: k
    real(wp), intent(in) :: alpha

    stiffness = hertz_exponent*k*sqrt(alpha)
  end function hertz_stiffness

  !> Radius of the sphere that touches a flat face as a sphere touches a curved one: the geometric mean of the radii of
  !> relative curvature (K. L. Johnson, Contact Mechanics, 1985, eq. 4.28). The contact ellipse is taken as a circle of
  !> the same area; where the radii of relative curvature differ by 10 %, this changes k by less than .1 %. 0:
  !> the nose does not fit into a concave face.
  pure real(wp) function relative_radius(radius, curvature) result(relative)
    !> Radius of the nose
    real(wp), intent(in) :: radius
    !> Curvatures of the face in two normal directions, positive if it is convex
    real(wp), intent(in) :: curvature(2)

    relative = radius
    if (any(1 + radius*curvature <= 0)) then
      relative = 0
    else if (any(abs(curvature) > 0)) then
      relative = radius/sqrt(product(1 + radius*curvature))
    end if
  end function relative_radius

  !> Contact stiffness k of a sphere on a plate, force per length**1.5: (4/3) sqrt(R) / ((1 - nu**2)/E + c) (Sun and
  !> Yang).
  pure real(wp) function sun_stiffness(radius, struck_compliance, impactor_e, impactor_nu) result(k)
    !> Radius of the nose, or of its relative curvature on a curved face
    real(wp), intent(in) :: radius
    !> Compliance c of the struck ply: 1/E2 of its transverse modulus; on an isotropic plate Hertz' (1 - nu**2)/E
    real(wp), intent(in) :: struck_compliance
    !> Young's modulus of the impactor; absent: rigid
    real(wp), intent(in), optional :: impactor_e
    !> Poisson's ratio of the impactor; absent: 0
    real(wp), intent(in), optional :: impactor_nu
    real(wp) :: compliance, nu

    compliance = struck_compliance
    nu = 0
    if (present(impactor_nu)) nu = impactor_nu
    if (present(impactor_e)) compliance = compliance + (1 - nu**2)/impactor_e
    k = 4*sqrt(radius)/(3*compliance)
  end function sun_stiffness

  !> Mean of x**exponent over an interval of positive numbers. Short intervals are summed as a
  !> binomial series about the middle, since the difference of powers would cancel.
  pure real(wp) function mean_power(lower, upper, exponent) result(mean)
    !> Start of the interval, at least 0
    real(wp), intent(in) :: lower
    !> End of the interval, larger than `lower` or equal
    real(wp), intent(in) :: upper
    !> Exponent
    real(wp), intent(in) :: exponent
    real(wp) :: middle, ratio, term, total
    integer :: order

    middle = 0.5_wp*(lower + upper)
    ratio = 0.5_wp*(upper - lower)/middle
    if (ratio > 0.25_wp) then
      mean = (upper**(exponent + 1) - lower**(exponent + 1))/((exponent + 1)*(upper - lower))
      return
    end if
    term = 1
    total = 1
    order = 0
    do while (abs(term) > epsilon(term))
      term = term*ratio**2*(exponent - order)*(exponent - order - 1)/real((order + 1)*(order + 2), wp)
      order = order + 2
      total = total + term/(order + 1)
    end do
    mean = middle**exponent*total
  end function mean_power
end module hertz_contact
