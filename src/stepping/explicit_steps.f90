!> Steps by central differences: failures of plies, flaws of interfaces, and the ledger when output or a check is due.
module explicit_steps
  use central_difference_energies, only: check_stability, damp_motion, record_energies
  use central_differences, only: central_difference_t
  use crack_flaws, only: update_flaws
  use errors, only: error_t
  use kinds, only: wp
  use models, only: model_t
  use states, only: state_t
  use struck_stresses, only: struck_stress
  implicit none
  private
  public :: advance_explicit, complete_step

  !> Number of steps between two updates of flaws at interfaces by matrix cracks. Cracks grow at most at the speed of
  !> shear waves, a third of that of waves along the fibres, which cross at most one cell in two steps; so a crack grows
  !> by at most two cells between updates.
  integer, parameter :: steps_between_flaws = 8

contains

  !> Takes one step. Collective.
  subroutine advance_explicit(method, model, event, now)
    type(central_difference_t), intent(inout) :: method
    type(model_t), intent(in) :: model
    real(wp), intent(in) :: event
    type(state_t), intent(inout) :: now
    real(wp) :: kept

    ! Damage grows again in a plate that has come to rest.
    if (now%holds_damage .and. .not. now%time < model%plate%setup%loading%start) then
      call now%hold_damage(.false.)
      if (model%plate%map%layered) call method%stacks%find_onsets(model, now%interfaces%cohesive)
    end if
    kept = 1
    if (is_damped(method, model, now)) call damp_motion(method, model%plate, now, method%parameters%settle, kept)
    call method%advance(model, event, kept, now)
    if (model%plate%setup%ply_damage%is_present .and. .not. (allocated(now%plies%bands) .or. now%holds_damage)) then
      call model%plate%profile%enter('ply criteria')
      call now%plies%grow(model%plate, now%motion%displacement)
      call model%plate%profile%leave()
      if (now%plies%softened) call method%record_failures(model, now)
    end if
    if (modulo(now%step, steps_between_flaws) > 0) return
    call model%plate%profile%enter('flaws')
    call update_flaws(model%plate, now%plies, now%motion%displacement, now%interfaces)
    if (model%plate%map%layered) call method%stacks%find_onsets(model, now%interfaces%cohesive)
    call model%plate%profile%leave()
  end subroutine advance_explicit

  !> True while damping brings the plate to rest: before lines or an impactor begin to load it, or once the impactor has
  !> left the plate and moves away.
  pure logical function is_damped(method, model, now)
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now

    is_damped = now%time < model%plate%setup%loading%start
    if (.not. (model%plate%setup%impactor%is_present .and. method%parameters%settle > 0)) return
    is_damped = is_damped .or. now%time > 0 .and. .not. now%impact%force > 0 .and. now%impact%impactor%velocity < 0
  end function is_damped

  !> Computes energies, reactions and stress, which are needed only when output or a check is due. Collective.
  subroutine complete_step(method, model, now, error)
    type(central_difference_t), intent(in) :: method
    type(model_t), intent(in) :: model
    type(state_t), intent(inout) :: now
    !> Set if the motion has become unstable
    type(error_t), allocatable, intent(out) :: error

    if (allocated(model%nose)) then
      associate (patch => method%impact%patch)
        call now%impact%patch%spread(patch%points%to_local(patch%weights, size(model%patch%weights)), &
                                     now%impact%patch%offset)
        now%impact%patch%area = patch%area
      end associate
    end if
    call record_energies(method, model, now)
    now%interfaces%rig%found = method%rigs%reactions_of(model, method%force, now%motion%displacement)
    if (size(model%loads%lines) > 0) now%line_reactions = method%lines%totals(model)
    now%impact%stress = struck_stress(model%plate, method%motion)
    now%impact%largest_stress = max(now%impact%largest_stress, now%impact%stress)
    call check_stability(model%plate, now, error)
  end subroutine complete_step
end module explicit_steps
