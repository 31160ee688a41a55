!> A coarse run: the same setup with half the elements along each side and twice the step, about an eighth of
!> the work. The difference gives an estimate of the error.
module coarse_runs
  use cell_grids, only: has_enough_elements
  use communicators, only: communicator_t
  use deck_contents, only: deck_t
  use deck_mesh_lines, only: lacks_window_lines
  use errors, only: error_t
  use interface_figures, only: interface_figures_t, figures_of
  use kinds, only: wp
  use model_building, only: create_model
  use models, only: model_t
  use queue_signals, only: stop_signal
  use run_records, only: run_record_t, new_run_record
  use stepping_parameters, only: end_of_run
  use stepper_choice, only: choose_stepper
  use steppers, only: stepper_t
  implicit none
  private
  public :: coarse_run_t, run_coarse_model

  integer, parameter :: coarser = 2

  !> Results of a coarse run.
  type :: coarse_run_t
    !> True: complete; false: the mesh is too coarse, no step converged, or it was stopped by a signal
    logical :: done = .false.
    !> Its record
    type(run_record_t) :: record
    !> Velocity of the impactor and delaminated area at the end
    real(wp) :: velocity = 0, area = 0
  end type coarse_run_t

contains

  !> Runs the coarse run. Collective.
  subroutine run_coarse_model(deck, communicator, coarse_run)
    type(deck_t), intent(in) :: deck
    type(communicator_t), intent(in) :: communicator
    !> Its results
    type(coarse_run_t), intent(out) :: coarse_run
    type(deck_t) :: coarse
    type(model_t) :: model
    type(interface_figures_t), allocatable :: figures(:)
    class(stepper_t), allocatable :: stepper
    type(error_t), allocatable :: error
    integer :: checks
    logical :: switched

    coarse = coarser_deck(deck)
    if (lacks_window_lines(coarse)) return
    call create_model(coarse%setup, communicator, model, error)
    call choose_stepper(coarse%stepping, stepper)
    if (.not. allocated(error)) call stepper%start(model, coarse%stepping, coarse%linear_solver, .false., error)
    if (allocated(error)) return
    coarse_run%record = new_run_record(model%plate)
    checks = stepper%steps_between_checks(model%plate%mesh%elements())
    do while (stepper%now%time < end_of_run(coarse%stepping, coarse_run%record%contact_end))
      ! As the run itself: contact areas and adaptive layers follow the state.
      call stepper%advance_with_layers(model, coarse%linear_solver, &
                               end_of_run(coarse%stepping, coarse_run%record%contact_end), switched, error)
      if (allocated(error)) exit
      call coarse_run%record%observe(model%plate, stepper%now, stepper%steps_between_stages())
      if (modulo(stepper%now%step, checks) > 0) cycle
      if (communicator%any(stop_signal() /= 0)) exit
    end do
    coarse_run%done = .not. (stepper%now%time < end_of_run(coarse%stepping, coarse_run%record%contact_end))
    coarse_run%velocity = stepper%now%impact%impactor%velocity
    figures = figures_of(model%plate, stepper%now%interfaces)
    coarse_run%area = sum(figures%area)
    call stepper%operator%release()
  end subroutine run_coarse_model

  !> The deck of a coarse run.
  pure function coarser_deck(deck) result(coarse)
    type(deck_t), intent(in) :: deck
    !> The same setup, coarser
    type(deck_t) :: coarse
    integer :: direction, number

    coarse = deck
    coarse%setup%mesh%cell = coarser*deck%setup%mesh%cell
    do direction = 1, 2
      do number = max(2, (deck%setup%mesh%elements(direction) + 1)/coarser), deck%setup%mesh%elements(direction)
        coarse%setup%mesh%elements(direction) = number
        if (has_enough_elements(coarse%setup%plate, coarse%setup%mesh, direction)) exit
      end do
    end do
    associate (time => coarse%stepping%time)
      time%step = min(coarser*time%step, time%end)
      time%step_max = max(time%step, min(coarser*time%step_max, time%end))
    end associate
    coarse%stepping%central%longest = coarser*deck%stepping%central%longest
    coarse%stepping%adapt%tolerance = coarser**3*deck%stepping%adapt%tolerance
  end function coarser_deck
end module coarse_runs
