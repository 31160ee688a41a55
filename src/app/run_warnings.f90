!> Warnings that a run gives once each, of what a user must not overlook.
module run_warnings
  use deck_contents, only: deck_t
  use delamination_parameters, only: delamination_t
  use energy_watches, only: energy_watch_t
  use kinds, only: wp
  use logger, only: log_t
  use run_records, only: run_record_t, warning_border, warning_energy
  use states, only: state_t
  use text, only: line_t, append, rounded_text, to_text
  implicit none
  private
  public :: give_warnings, warnings_given

contains

  !> Gives the warnings that an accepted step calls for.
  subroutine give_warnings(deck, now, record, watch, log)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The state reached
    type(state_t), intent(in) :: now
    !> Receives what was given
    type(run_record_t), intent(inout) :: record
    !> Looks after the energy that integrators create
    type(energy_watch_t), intent(inout) :: watch
    !> Where they are given
    type(log_t), intent(inout) :: log
    real(wp) :: amplitude
    integer :: zone

    do zone = 1, size(now%interfaces%border_reached)
      if (now%interfaces%border_reached(zone) .and. .not. record%has_warned(warning_border, zone)) &
        call give(warning_border, zone)
    end do
    if (deck%has_static) return
    amplitude = 1
    if (.not. deck%has_impactor) amplitude = deck%pressure%amplitude(now%time)
    if (watch%alarms(now%ledger, sum(now%interfaces%ties%deficit()), amplitude)) call give(warning_energy, 0)

  contains

    !> Gives one warning.
    subroutine give(kind, zone)
      !> Its kind, and the zone that it concerns
      integer, intent(in) :: kind, zone

      call record%note_warning(kind, zone, now%time)
      call log%warning(warning_text(kind, zone, now%time, deck%delaminations))
    end subroutine give
  end subroutine give_warnings

  !> What a warning says.
  pure function warning_text(kind, zone, time, delaminations) result(text)
    !> One of the kinds of warnings
    integer, intent(in) :: kind
    !> Zone that it concerns; 0: none
    integer, intent(in) :: zone
    !> When it was given
    real(wp), intent(in) :: time
    !> The interfaces
    type(delamination_t), intent(in) :: delaminations(:)
    !> One sentence
    character(len=:), allocatable :: text

    text = ''
    select case (kind)
    case (warning_border)
      text = 'The delamination below ply '//to_text(delaminations(zone)%below_ply)// &
             ' has reached the border of its zone at time '//rounded_text(time)// &
             ' and cannot grow on there: if it would, make the zone larger.'
    case (warning_energy)
      text = 'The time integrators have created more than 1 % of the energy by time '//rounded_text(time)// &
             ': take smaller steps, or more damping (rho_inf) with delamination.'
    end select
  end function warning_text

  !> All warnings given in a run, those of its part before a restart too.
  function warnings_given(record, delaminations) result(lines)
    !> What was given
    type(run_record_t), intent(in) :: record
    !> The interfaces
    type(delamination_t), intent(in) :: delaminations(:)
    !> One sentence each, in the order of time
    type(line_t), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(record%warning_kinds)
      call append(lines, warning_text(record%warning_kinds(i), record%warning_zones(i), record%warning_times(i), &
                                      delaminations))
    end do
  end function warnings_given
end module run_warnings
