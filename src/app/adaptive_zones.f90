!> Adaptive zones of layers: enlarged with the damage, reported in the log, saved in the checkpoint.
module adaptive_zones
  use archives, only: archive_t
  use deck_contents, only: deck_t
  use delamination_parameters, only: delamination_t
  use errors, only: error_t
  use kinds, only: wp
  use layer_switches, only: advance_with_layers
  use logger, only: log_t
  use models, only: model_t
  use run_moments, only: moment
  use short_numbers, only: short_text
  use text, only: to_text
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: advance, visit_evolving, visit_zones

contains

  !> Takes a step and adds layers after it if the damage requires them. Collective.
  subroutine advance(deck, model, stepper, event, log, error)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The model
    type(model_t), intent(inout) :: model
    !> The time stepper, with the state
    type(time_stepper_t), intent(inout) :: stepper
    !> Time, or load factor, not to be passed
    real(wp), intent(in) :: event
    !> Receives a note of new layers
    type(log_t), intent(inout) :: log
    !> Set if the smallest step fails or the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    logical :: switched
    integer :: zone

    call advance_with_layers(model, stepper, deck%linear_solver, event, switched, error)
    if (allocated(error) .or. .not. switched) return
    do zone = 1, size(model%mesh%zones)
      associate (interface => model%setup%delaminations(zone))
        if (interface%is_adaptive) call log%note('Layers below ply '//to_text(interface%below_ply)//': '// &
                                             short_text(interface%zone(1))//' x '//short_text(interface%zone(2))// &
                                             ' from '//moment(deck, stepper%now%time)//' on.')
      end associate
    end do
  end subroutine advance

  !> Saves or loads the state and the parts of the model that depend on it.
  subroutine visit_evolving(model, stepper, archive, error)
    !> The model with the zones of the archive
    type(model_t), intent(inout) :: model
    !> The time stepper, with the state
    type(time_stepper_t), intent(inout) :: stepper
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive
    !> Set if the operator cannot be factorized again
    type(error_t), allocatable, intent(out) :: error

    call visit_zones(model%setup%delaminations, archive)
    call stepper%visit(archive, model, error)
  end subroutine visit_evolving

  !> Saves the adaptive zones, or loads them: a model has to be built with them.
  subroutine visit_zones(delaminations, archive)
    !> The interfaces
    type(delamination_t), intent(inout) :: delaminations(:)
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive
    real(wp), allocatable :: extents(:)
    integer :: zone

    if (.not. any(delaminations%is_adaptive)) return
    allocate (extents(2*size(delaminations)))
    do zone = 1, size(delaminations)
      extents(2*zone - 1:2*zone) = delaminations(zone)%zone
    end do
    call archive%item('layers/zones', extents)
    if (.not. archive%loading .or. size(extents) /= 2*size(delaminations)) return
    do zone = 1, size(delaminations)
      delaminations(zone)%zone = extents(2*zone - 1:2*zone)
    end do
  end subroutine visit_zones
end module adaptive_zones
