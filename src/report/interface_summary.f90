!> Results of the interfaces in the summary.
module interface_summary
  use deck_contents, only: deck_t
  use doubler_bonds, only: names_of_doublers
  use delamination_parameters, only: law_cohesive
  use json_text, only: json_t
  use kinds, only: wp
  use projected_areas, only: projected_rule
  use run_figures, only: run_figures_t
  use run_records, only: run_record_t
  use states, only: state_t
  implicit none
  private
  public :: put_interfaces

contains

  !> Results of the interfaces.
  subroutine put_interfaces(json, deck, now, record, figures)
    type(json_t), intent(inout) :: json
    type(deck_t), intent(in) :: deck
    type(state_t), intent(in) :: now
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    integer :: zone

    call json%put('projected_area_rule', projected_rule)
    call json%open_list('interfaces')
    do zone = 1, size(figures%interfaces)
      associate (figure => figures%interfaces(zone), interface => deck%setup%delaminations(zone))
        call json%open_object('')
        call json%put('ply_above', interface%below_ply)
        if (interface%bonds_doublers()) call json%put('doublers', names_of_doublers(deck%setup%zones, interface))
        call json%put('is_cohesive', interface%law == law_cohesive)
        call json%put('area', figure%area)
        call json%put('energy', figure%energy)
        call json%put('x', figure%bounds(:, 1))
        call json%put('y', figure%bounds(:, 2))
        call put_event(json, 'onset', record%onset(:, zone), deck)
        call put_event(json, 'first_growth', record%growth(:, zone), deck)
        call json%put('threshold_force', figures%threshold(zone))
        call json%put('border_reached', now%interfaces%border_reached(zone))
        call json%close()
      end associate
    end do
    call json%close()
  end subroutine put_interfaces

  !> Time, force and deflection of an event.
  subroutine put_event(json, name, event, deck)
    type(json_t), intent(inout) :: json
    character(len=*), intent(in) :: name
    !> Time, contact force, deflection; time 0: never, negative: before the run
    real(wp), intent(in) :: event(3)
    type(deck_t), intent(in) :: deck

    if (.not. event(1) > 0) then
      call json%put_null(name)
      call json%put(name//'_before_run', event(1) < 0)
      return
    end if
    call json%open_object(name)
    call json%put('at', event(1))
    if (deck%setup%impactor%is_present) call json%put('force', event(2))
    call json%put('deflection', event(3))
    call json%close()
  end subroutine put_event
end module interface_summary
