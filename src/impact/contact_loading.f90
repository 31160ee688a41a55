!> Contact force in first loading, theory (F5) and (F7): Hertz, or Hertz up to yield of the struck face and linear
!> beyond, where the pressure at the centre is constant (C. Thornton, Journal of Applied Mechanics 64 (1997) 383-386;
!> for laminates A. S. Yigit, A. P. Christoforou, Composites Engineering 4 (1994) 1143-1152).
module contact_loading
  use hertz_contact, only: hertz_exponent, hertz_force, hertz_stiffness, mean_power
  use impact_parameters, only: indentation_law_t, law_thornton
  use kinds, only: wp
  implicit none
  private
  public :: loading_force, loading_stiffness, loading_indentation, mean_loading_force

contains

  !> Contact force.
  pure real(wp) function loading_force(law, alpha) result(force)
    type(indentation_law_t), intent(in) :: law
    real(wp), intent(in) :: alpha

    if (alpha <= yield(law)) then
      force = hertz_force(law%k, alpha)
    else
      force = hertz_force(law%k, yield(law)) + hertz_stiffness(law%k, yield(law))*(alpha - yield(law))
    end if
  end function loading_force

  !> Derivative of the contact force by the indentation.
  pure real(wp) function loading_stiffness(law, alpha) result(stiffness)
    type(indentation_law_t), intent(in) :: law
    real(wp), intent(in) :: alpha

    stiffness = hertz_stiffness(law%k, min(alpha, yield(law)))
  end function loading_stiffness

  !> Indentation at which the contact force has a value.
  pure real(wp) function loading_indentation(law, force) result(alpha)
    type(indentation_law_t), intent(in) :: law
    !> The force, at least 0
    real(wp), intent(in) :: force

    alpha = (force/law%k)**(1/hertz_exponent)
    if (alpha > yield(law)) &
      alpha = yield(law) + (force - hertz_force(law%k, yield(law)))/hertz_stiffness(law%k, yield(law))
  end function loading_indentation

  !> Mean of the contact force between two indentations, without cancellation.
  pure real(wp) function mean_loading_force(law, lower, upper) result(mean)
    type(indentation_law_t), intent(in) :: law
    !> Indentations, from 0 up; the second is the larger one
    real(wp), intent(in) :: lower, upper
    real(wp) :: middle

    middle = max(lower, min(upper, yield(law)))
    mean = 0
    if (middle > lower) mean = law%k*mean_power(lower, middle, hertz_exponent)*(middle - lower)/(upper - lower)
    if (upper > middle) &
      mean = mean + (loading_force(law, middle) + loading_force(law, upper))/2*(upper - middle)/(upper - lower)
  end function mean_loading_force

  !> Indentation at the start of the linear branch.
  pure real(wp) function yield(law)
    type(indentation_law_t), intent(in) :: law

    yield = huge(yield)
    if (law%law == law_thornton) yield = law%alpha_critical
  end function yield
end module contact_loading
