!> Sizes of nodal forces, translations and rotations apart since their units differ.
module residual_norms
  use kinds, only: wp
  implicit none
  private
  public :: force_norms

contains

  !> Sums of squares over the unknowns that are not held, of this rank's points.
  pure function force_norms(equation, force, owned) result(squares)
    !> Equation of each unknown; negative: held, (5, points)
    integer, intent(in) :: equation(:, :)
    !> Nodal forces, (5, points)
    real(wp), intent(in) :: force(:, :)
    !> Points owned
    integer, intent(in) :: owned
    !> Of u, v, w and of theta_x, theta_y
    real(wp) :: squares(2)
    integer :: point, component

    squares = 0
    do point = 1, owned
      do component = 1, 3
        if (equation(component, point) >= 0) squares(1) = squares(1) + force(component, point)**2
      end do
      do component = 4, 5
        if (equation(component, point) >= 0) squares(2) = squares(2) + force(component, point)**2
      end do
    end do
  end function force_norms
end module residual_norms
