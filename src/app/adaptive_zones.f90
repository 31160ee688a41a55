!> Adaptive zones of layers: enlarged with the damage, reported in the log, saved in the checkpoint.
module adaptive_zones
  use archives, only: archive_t
  use deck_contents, only: deck_t
  use delamination_parameters, only: delamination_t
  use errors, only: error_t
  use kinds, only: wp
  use logger, only: log_t
  use models, only: model_t
  use plies, only: plies_text
  use run_moments, only: moment
  use text, only: append, line_t
  use steppers, only: stepper_t
  use usual_units, only: in_usual_unit, length_kind
  implicit none
  private
  public :: advance, visit_zones, zone_notes

contains

  !> Takes a step and adds layers after it if the damage requires them. Collective.
  subroutine advance(deck, model, stepper, event, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(inout) :: model
    !> The time stepper, with the state
    class(stepper_t), intent(inout) :: stepper
    real(wp), intent(in) :: event
    !> Receives a note of new layers
    type(log_t), intent(inout) :: log
    !> Set if the smallest step fails or the model cannot be built
    type(error_t), allocatable, intent(out) :: error
    type(line_t), allocatable :: notes(:)
    logical :: switched
    integer :: i

    call stepper%advance_with_layers(model, deck%linear_solver, event, switched, error)
    if (allocated(error) .or. .not. switched) return
    notes = zone_notes(model%plate%setup%delaminations, moment(deck, stepper%now%time), deck%case%units)
    do i = 1, size(notes)
      call log%note(notes(i)%text)
    end do
  end subroutine advance

  !> A note on each extent of the adaptive zones, with all plies above zones of that extent.
  pure function zone_notes(delaminations, since, units) result(notes)
    type(delamination_t), intent(in) :: delaminations(:)
    !> Since when, such as time 0.001, and the deck's system of units
    character(len=*), intent(in) :: since, units
    !> One line each
    type(line_t), allocatable :: notes(:)
    character(len=:), allocatable :: place
    logical, dimension(size(delaminations)) :: noted, alike
    integer :: first, zone

    allocate (notes(0))
    noted = .not. delaminations%is_adaptive
    do first = 1, size(delaminations)
      if (noted(first)) cycle
      associate (extent => delaminations(first)%zone, centre => delaminations(first)%zone_at)
        place = ''
        if (any(abs(centre) > 0)) place = ', centred '//in_usual_unit(centre(1), length_kind, units, 3)//', '// &
          in_usual_unit(centre(2), length_kind, units, 3)//' from the plate''s centre,'
        alike = [(all(abs(delaminations(zone)%zone - extent) <= 0), zone=1, size(delaminations))] .and. .not. noted
        call append(notes, 'Layers below '//plies_text(pack(delaminations%below_ply, alike))//': '// &
                    in_usual_unit(extent(1), length_kind, units, 3)//' x '// &
                    in_usual_unit(extent(2), length_kind, units, 3)//place//' from '//since//' on.')
      end associate
      noted = noted .or. alike
    end do
  end function zone_notes

  !> Saves the adaptive zones, or loads them: a model has to be built with them.
  subroutine visit_zones(delaminations, archive)
    type(delamination_t), intent(inout) :: delaminations(:)
    class(archive_t), intent(inout) :: archive
    real(wp), allocatable :: places(:)
    integer :: zone, zones

    if (.not. any(delaminations%is_adaptive)) return
    zones = size(delaminations)
    ! Extents, then centres if any is not the struck point.
    places = [(delaminations(zone)%zone, zone=1, zones)]
    if (any([(abs(delaminations(zone)%zone_at) > 0, zone=1, zones)])) &
      places = [places, [(delaminations(zone)%zone_at, zone=1, zones)]]
    call archive%item('layers/zones', places)
    if (.not. archive%loading .or. all(size(places) /= [2, 4]*zones)) return
    do zone = 1, zones
      delaminations(zone)%zone = places(2*zone - 1:2*zone)
      if (size(places) > 2*zones) delaminations(zone)%zone_at = places(2*(zones + zone) - 1:2*(zones + zone))
    end do
  end subroutine visit_zones
end module adaptive_zones
