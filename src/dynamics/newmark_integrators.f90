!> One-step time integration of the plate, theory (T2): Newmark's method and the generalised-alpha method are one family
!> with four coefficients (J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375).
module newmark_integrators
  use kinds, only: wp
  use motions, only: motion_t
  use stepping_parameters, only: time_t, integrator_generalized_alpha
  implicit none
  private
  public :: plate_integrator_t, plate_integrator

  !> Coefficients of the family. Inertia is taken at 1 - alpha_m and forces at 1 - alpha_f of the step.
  type :: plate_integrator_t
    !> Weights of the old state in inertia and in the other forces
    real(wp) :: alpha_m = 0, alpha_f = 0
    !> Newmark's parameters
    real(wp) :: beta = 0.25_wp, gamma = 0.5_wp
  contains
    procedure :: complete
    procedure :: mass_factor
    procedure :: stiffness_factor
  end type plate_integrator_t

contains

  !> The integrator chosen in the deck.
  pure function plate_integrator(time) result(self)
    !> Parameters of the deck
    type(time_t), intent(in) :: time
    type(plate_integrator_t) :: self
    real(wp) :: rho

    if (time%integrator == integrator_generalized_alpha) then
      rho = time%rho_infinity
      self%alpha_m = (2*rho - 1)/(rho + 1)
      self%alpha_f = rho/(rho + 1)
      self%gamma = 0.5_wp - self%alpha_m + self%alpha_f
      self%beta = (1 - self%alpha_m + self%alpha_f)**2/4
    else
      self%beta = time%beta
      self%gamma = time%gamma
    end if
  end function plate_integrator

  !> Velocity and acceleration at the end of a step from the displacement there (Newmark's formulas).
  pure subroutine complete(self, step, old, displacement, velocity, acceleration)
    class(plate_integrator_t), intent(in) :: self
    real(wp), intent(in) :: step
    !> Motion at the start
    type(motion_t), intent(in) :: old
    !> Displacement at the end, (5, points)
    real(wp), intent(in), contiguous :: displacement(:, :)
    !> Velocity and acceleration at the end, (5, points)
    real(wp), intent(inout), contiguous :: velocity(:, :), acceleration(:, :)

    call complete_all(self, step, size(displacement), old%displacement, old%velocity, old%acceleration, displacement, &
                      velocity, acceleration)
  end subroutine complete

  !> The same with all unknowns in one array, so that the compiler vectorises the loop.
  pure subroutine complete_all(self, step, number, displacement, velocity, acceleration, new_displacement, &
                               new_velocity, new_acceleration)
    class(plate_integrator_t), intent(in) :: self
    real(wp), intent(in) :: step
    !> Number of unknowns
    integer, intent(in) :: number
    !> Motion at the start
    real(wp), intent(in) :: displacement(number), velocity(number), acceleration(number)
    !> Displacement at the end
    real(wp), intent(in) :: new_displacement(number)
    !> Velocity and acceleration at the end
    real(wp), intent(inout) :: new_velocity(number), new_acceleration(number)
    real(wp) :: per_square, per_step, kept, gamma, rest
    integer :: i

    per_square = 1/(self%beta*step**2)
    per_step = 1/(self%beta*step)
    kept = 0.5_wp/self%beta - 1
    gamma = self%gamma
    rest = 1 - gamma
    do i = 1, number
      new_acceleration(i) = per_square*(new_displacement(i) - displacement(i)) - per_step*velocity(i) &
                            - kept*acceleration(i)
      new_velocity(i) = velocity(i) + step*(rest*acceleration(i) + gamma*new_acceleration(i))
    end do
  end subroutine complete_all

  !> Factor of the mass, 1/time**2, in the operator that maps a residual to a correction of the displacement.
  elemental real(wp) function mass_factor(self, step) result(factor)
    class(plate_integrator_t), intent(in) :: self
    real(wp), intent(in) :: step

    factor = (1 - self%alpha_m)/(self%beta*step**2)
  end function mass_factor

  !> Factor of the tangent stiffness in the effective operator.
  elemental real(wp) function stiffness_factor(self) result(factor)
    class(plate_integrator_t), intent(in) :: self

    factor = 1 - self%alpha_f
  end function stiffness_factor
end module newmark_integrators
