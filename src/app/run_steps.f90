!> Steps between two evaluations of results: one if steps are implicit, many by central differences.
module run_steps
  use deck_contents, only: deck_t
  use deck_slow_motion, only: slow_motion_advice
  use errors, only: error_t, exit_convergence
  use kinds, only: wp
  use adaptive_zones, only: advance
  use logger, only: log_t
  use models, only: model_t
  use output_parameters, only: output_t
  use run_records, only: run_record_t
  use steppers, only: stepper_t
  implicit none
  private
  public :: advance_to_output, row_is_due

contains

  !> Takes steps up to the next one at which output or a check is due; a single step if steps are implicit. Collective.
  subroutine advance_to_output(deck, model, stepper, record, event, log, error)
    type(deck_t), intent(in) :: deck
    !> The model; layers may grow with the damage
    type(model_t), intent(inout) :: model
    !> The time stepper, with the state
    class(stepper_t), intent(inout) :: stepper
    !> The record, updated in each step
    type(run_record_t), intent(inout) :: record
    real(wp), intent(in) :: event
    !> Receives a note of new layers
    type(log_t), intent(inout) :: log
    !> Set if no step converges
    type(error_t), allocatable, intent(out) :: error
    integer :: steps

    steps = stepper%steps_between_checks(model%plate%mesh%elements())
    do
      call advance(deck, model, stepper, event, log, error)
      if (allocated(error)) then
        if (error%code == exit_convergence) error%message = error%message//slow_motion_advice(deck)
        ! The step was accepted, but its failed plies have found no equilibrium.
        if (stepper%now%time > record%time) &
          call record%observe(model%plate, stepper%now, stepper%steps_between_stages())
        return
      end if
      call record%observe(model%plate, stepper%now, stepper%steps_between_stages())
      if (check_is_due(deck%output, stepper%now%step, steps) .or. stepper%now%time >= event) return
      if (row_is_due(deck%output, stepper%now%step)) return
    end do
  end subroutine advance_to_output

  !> True: a check is due by the number of steps, and not before long by the next row, which is one, too.
  pure logical function check_is_due(output, step, between)
    type(output_t), intent(in) :: output
    !> Accepted steps, and steps between two checks
    integer, intent(in) :: step, between

    check_is_due = modulo(step, between) == 0
    if (.not. output%history_every > 0) check_is_due = check_is_due .and. output%steps_between_rows >= between
  end function check_is_due

  !> True: a row of the history is due by the number of steps.
  pure logical function row_is_due(output, step)
    type(output_t), intent(in) :: output
    !> Accepted steps
    integer, intent(in) :: step

    row_is_due = .not. output%history_every > 0
    if (row_is_due) row_is_due = modulo(step, output%steps_between_rows) == 0
  end function row_is_due
end module run_steps
