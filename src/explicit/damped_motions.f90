!> Mass-proportional damping that brings the plate to rest: all velocities are reduced by the same fraction in each
!> step. Amplitudes of vibrations are reduced by half of this fraction, independent of their frequency.
module damped_motions
  use central_difference_energies, only: kinetic_energy
  use central_differences, only: central_difference_t
  use kinds, only: wp
  use mathematical_constants, only: pi
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: damp_motion

  !> Ratio of the final to the initial amplitude. That of energies is 1e-7, below the usual tolerance of 1e-6.
  real(wp), parameter :: final_ratio = 3.0e-4_wp
  !> Smallest duration of the damping in periods of a vibration: in fewer periods the vibration is overdamped and
  !> returns more slowly.
  real(wp), parameter, public :: min_periods = -log(final_ratio)/(2*pi)

contains

  !> Reduces the velocities at the start of a step. The changes of coordinates in the last step, half of which enter the
  !> kinetic energy with the forces (central_difference_energies), are reduced by the same factor there. Collective.
  subroutine damp_motion(method, model, now, duration, kept)
    !> Central differences, after a step
    type(central_difference_t), intent(inout) :: method
    type(model_t), intent(in) :: model
    !> The state; its ledger receives the energy
    type(state_t), intent(inout) :: now
    !> Duration of the damping; motions with a longer period are damped less
    real(wp), intent(in) :: duration
    !> Factor by which the velocities have been multiplied, for the next step
    real(wp), intent(out) :: kept
    real(wp) :: before

    kept = 1
    if (.not. method%steps%now > 0) return
    kept = exp(2*log(final_ratio)*method%steps%now/duration)
    before = kinetic_energy(method, model, now, 1.0_wp)
    now%motion%velocity = kept*now%motion%velocity
    call method%stacks%history%damp(kept)
    method%rigs%approach = kept*method%rigs%approach
    method%lines%dofs%change = kept*method%lines%dofs%change
    now%ledger%damping = now%ledger%damping + before - kinetic_energy(method, model, now, kept)
  end subroutine damp_motion
end module damped_motions
