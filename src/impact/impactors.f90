!> The rigid impactor, m w'' = m g - F with w positive towards the plate (Eq. 2 of the paper with this sign, theory
!> (F1)): state and energy.
module impactors
  use archives, only: archive_t
  use impact_parameters, only: impactor_parameters_t
  use kinds, only: wp
  implicit none
  private
  public :: impactor_t, new_impactor, impactor_energy

  !> Past points that Gear's method needs before the current one
  integer, parameter, public :: past_points = 3

  !> State of the impactor, changed only when a step is accepted.
  type :: impactor_t
    !> Displacement, positive towards the plate, 0 at first contact
    real(wp) :: displacement = 0
    !> Velocity
    real(wp) :: velocity = 0
    !> Contact force at the end of the last step
    real(wp) :: force = 0
    !> True once Gear's method has past states from the run; before, free flight is assumed
    logical :: has_history = .false.
    !> Lengths of the last steps, latest first
    real(wp) :: past_step(past_points) = 0
    !> Displacements before those steps
    real(wp) :: past_displacement(past_points) = 0
    !> Velocities before those steps
    real(wp) :: past_velocity(past_points) = 0
  contains
    procedure :: visit => visit_impactor
  end type impactor_t

contains

  !> The impactor at first contact.
  pure function new_impactor(parameters) result(impactor)
    !> Mass, velocity, gravity, integrator
    type(impactor_parameters_t), intent(in) :: parameters
    type(impactor_t) :: impactor

    impactor%velocity = parameters%velocity
  end function new_impactor

  !> Kinetic energy and potential of gravity; the latter is 0 at zero displacement.
  pure real(wp) function impactor_energy(parameters, impactor) result(energy)
    !> Mass, gravity
    type(impactor_parameters_t), intent(in) :: parameters
    !> State
    type(impactor_t), intent(in) :: impactor

    energy = parameters%mass*(0.5_wp*impactor%velocity**2 - parameters%gravity*impactor%displacement)
  end function impactor_energy

  !> Saves or loads the state.
  subroutine visit_impactor(self, archive)
    class(impactor_t), intent(inout) :: self
    !> Where the state is saved to or loaded from
    class(archive_t), intent(inout) :: archive
    integer :: i
    character :: number

    call archive%item('impactor/displacement', self%displacement)
    call archive%item('impactor/velocity', self%velocity)
    call archive%item('impactor/force', self%force)
    call archive%item('impactor/has_history', self%has_history)
    do i = 1, past_points
      write (number, '(i1)') i
      call archive%item('impactor/past_step_'//number, self%past_step(i))
      call archive%item('impactor/past_displacement_'//number, self%past_displacement(i))
      call archive%item('impactor/past_velocity_'//number, self%past_velocity(i))
    end do
  end subroutine visit_impactor
end module impactors
