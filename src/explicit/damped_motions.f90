!> Damping that brings the plate to rest: all velocities lose the same share in each step, as by a force in proportion
!> to mass and velocity. Motions that vibrate lose amplitude by half that share, whatever their frequency.
module damped_motions
  use central_difference_energies, only: kinetic_energy
  use central_differences, only: central_difference_t
  use kinds, only: wp
  use models, only: model_t
  use states, only: state_t
  implicit none
  private
  public :: damp_motion

  !> What is left of an amplitude at the end: of energies a ten-millionth, below the usual tolerance of 1e-6.
  real(wp), parameter :: left_over = 3.0e-4_wp

contains

  !> Takes a step's share of the velocities at its start. Energies of the step are those of the slower motion: forces
  !> that act over half of the last change of a coordinate (central_difference_energies) find that change reduced alike.
  !> Collective.
  subroutine damp_motion(method, model, now, duration)
    !> Central differences, after a step
    type(central_difference_t), intent(inout) :: method
    type(model_t), intent(in) :: model
    !> The state; its ledger receives the energy
    type(state_t), intent(inout) :: now
    !> Time in which motions are damped down to what is left over, unless they are slower than that
    real(wp), intent(in) :: duration
    real(wp) :: share, before

    if (.not. method%steps%now > 0) return
    share = exp(2*log(left_over)*method%steps%now/duration)
    before = kinetic_energy(method, model, now)
    now%motion%velocity = share*now%motion%velocity
    method%stacks%change = share*method%stacks%change
    method%rigs%approach = share*method%rigs%approach
    method%lines%pins%change = share*method%lines%pins%change
    now%ledger%damping = now%ledger%damping + before - kinetic_energy(method, model, now)
  end subroutine damp_motion
end module damped_motions
