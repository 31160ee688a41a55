!> Estimated discretization errors of the results in a summary, and their source.
module run_errors
  use coarse_runs, only: coarse_run_t
  use deck_contents, only: deck_t
  use kinds, only: wp
  use run_records, only: run_record_t
  implicit none
  private
  public :: run_errors_t, errors_by_elastic_impact, errors_by_coarse_run

  !> Errors of results, in their units; negative: not known.
  type :: run_errors_t
    !> Their source: none, elastic or coarse_run
    character(len=10) :: source = 'none'
    !> Of the largest force and its time
    real(wp) :: peak_force = -1, peak_time = -1
    !> Of the duration of contact
    real(wp) :: contact_duration = -1
    !> Of the largest deflection
    real(wp) :: deflection = -1
    !> Of the impactor's velocity at the end
    real(wp) :: velocity = -1
    !> Of the area delaminated
    real(wp) :: area = -1
  end type run_errors_t

  !> Relative difference of the peak forces of run and elastic impact up to which the estimate applies: the errors of
  !> two histories that differ by a tenth differ by about as much. It affects a line of the log only.
  real(wp), parameter :: same_setup = 0.1_wp

contains

  !> Errors by the preliminary elastic impact, for a run without damage or large deflection: its peak force must be that
  !> of the elastic impact. Where damage grows it has errors of its own, by cells in process zones and crack bands.
  pure function errors_by_elastic_impact(deck, record, has_damage) result(errors)
    type(deck_t), intent(in) :: deck
    type(run_record_t), intent(in) :: record
    !> True: plies have failed or delaminations have grown in the run
    logical, intent(in) :: has_damage
    type(run_errors_t) :: errors

    if (has_damage .or. abs(record%peak_force - deck%expected%force) > same_setup*deck%expected%force) return
    errors = elastic_errors(deck)
    if (errors%peak_force >= 0) errors%source = 'elastic'
  end function errors_by_elastic_impact

  !> Errors of step and mesh for the linear, undamaged plate, by the preliminary elastic impact of the deck's check:
  !> with half the step, and with the natural frequencies of the discrete plate.
  pure function elastic_errors(deck) result(errors)
    type(deck_t), intent(in) :: deck
    type(run_errors_t) :: errors

    associate (o => deck%expected)
      if (.not. o%of_impact .or. any(o%figure_error < 0) .or. deck%stepping%adapt%on) return
      errors%peak_force = o%figure_error(1)
      errors%peak_time = max(o%figure_error(2), deck%stepping%time%step/2)
      errors%contact_duration = max(o%figure_error(3), deck%stepping%time%step)
      errors%deflection = o%figure_error(4)
      errors%velocity = o%figure_error(5)
    end associate
  end function elastic_errors

  !> Errors by a run of the same setup with half the elements and twice the step. The error of that run due to the step
  !> is four times as large, that due to the mesh larger, so that a third of the difference is the estimate. Both may
  !> cancel in a difference, and the difference of unresolved peaks is arbitrary: the relative error of the elastic
  !> impact on the same mesh is a lower bound.
  pure function errors_by_coarse_run(deck, record, velocity, area, coarse_run) result(errors)
    type(deck_t), intent(in) :: deck
    type(run_record_t), intent(in) :: record
    !> Velocity of the impactor and delaminated area at its end
    real(wp), intent(in) :: velocity, area
    !> Results of the coarse run
    type(coarse_run_t), intent(in) :: coarse_run
    type(run_errors_t) :: errors

    errors = elastic_errors(deck)
    if (errors%peak_force >= 0) errors%peak_force = errors%peak_force*record%peak_force/deck%expected%force
    errors%source = 'coarse_run'
    errors%peak_force = max(errors%peak_force, abs(record%peak_force - coarse_run%record%peak_force)/3)
    errors%peak_time = max(errors%peak_time, abs(record%peak_time - coarse_run%record%peak_time)/3, &
                           deck%stepping%time%step/2)
    errors%contact_duration = max(errors%contact_duration, deck%stepping%time%step, &
                                  abs(record%contact_duration - coarse_run%record%contact_duration)/3)
    errors%deflection = max(errors%deflection, abs(record%deflection - coarse_run%record%deflection)/3)
    errors%velocity = max(errors%velocity, abs(velocity - coarse_run%velocity)/3)
    ! A delamination grows by entire elements: the error of its area is of first order in their side.
    errors%area = abs(area - coarse_run%area)
  end function errors_by_coarse_run
end module run_errors
