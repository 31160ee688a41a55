!> Warnings of a run that exceeds limits of the model. Each is given once, in the log at that time and in the summary at
!> the end.
module run_warnings
  use failed_plies_areas, only: failed_areas, failed_counts
  use deck_contents, only: deck_t
  use delamination_parameters, only: delamination_t
  use energy_checks, only: energy_check_t, energy_created, energy_dissipated, energy_imbalance
  use errors, only: error_t, exit_convergence, fail
  use kinds, only: wp
  use layer_extents, only: cells_ahead, cells_at_once, thicknesses_ahead
  use logger, only: log_t
  use mesh_parameters, only: edge_clamped
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use ply_damage_parameters, only: failure_modes, fibre_failure
  use roundings, only: rounding
  use run_records, only: run_record_t
  use run_moments, only: moment
  use slow_motions, only: has_developed
  use states, only: state_t
  use stringer_columns, only: weakest_stringer
  use text, only: line_t, append
  use steppers, only: stepper_t
  use warning_rows, only: kind_of, limit_of, warning_text
  implicit none
  private
  public :: report_warnings, report_last_warnings, reported_warnings

contains

  !> Warns once of each condition that affects the validity; a strict run ends there. Collective.
  subroutine report_warnings(deck, model, stepper, record, energy_check, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(inout) :: record
    type(energy_check_t), intent(inout) :: energy_check
    type(log_t), intent(inout) :: log
    !> Set if the run is strict and exceeds a limit of the model
    type(error_t), allocatable, intent(out) :: error
    type(line_t), allocatable :: warnings(:)

    call find_warnings(deck, model, stepper, stepper%now, record, energy_check, warnings)
    call give(deck, warnings, log, error)
  end subroutine report_warnings

  !> Warns of energies of the last state of a run. Those of a small load are compared with the energy of the full load,
  !> unless the run has ended at that load. Collective.
  subroutine report_last_warnings(deck, model, stepper, record, energy_check, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(inout) :: record
    type(energy_check_t), intent(inout) :: energy_check
    type(log_t), intent(inout) :: log
    !> Set, unless it is already, if the run is strict and exceeds the limit
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: warnings(:)

    if (deck%setup%load_level(stepper%now%time) >= 1) return
    allocate (warnings(0))
    call add_energy_warnings(energy_check%check(stepper%now%ledger, stepper%now%interfaces%unreleased(model), 1.0_wp, &
                                                .true.), deck, stepper, record, warnings)
    call give(deck, warnings, log, error)
  end subroutine report_last_warnings

  !> Prints warnings; a strict run ends with the first.
  subroutine give(deck, warnings, log, error)
    type(deck_t), intent(in) :: deck
    !> One sentence each
    type(line_t), intent(in) :: warnings(:)
    type(log_t), intent(inout) :: log
    !> Set if the run is strict
    type(error_t), allocatable, intent(inout) :: error
    integer :: i

    do i = 1, size(warnings)
      if (deck%case%strict) then
        if (.not. allocated(error)) call fail(error, exit_convergence, warnings(i)%text)
      else
        call log%warning(warnings(i)%text)
      end if
    end do
  end subroutine give

  !> Finds and stores new warnings of an accepted step. Collective.
  subroutine find_warnings(deck, model, stepper, now, record, energy_check, warnings)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    type(run_record_t), intent(inout) :: record
    type(energy_check_t), intent(inout) :: energy_check
    !> One sentence each; empty: none
    type(line_t), allocatable, intent(out) :: warnings(:)
    real(wp) :: thickness
    integer :: zone, i
    logical :: exceeded(3)

    allocate (warnings(0))
    thickness = deck%expected%scales%thickness
    do zone = 1, size(now%interfaces%border_reached)
      call add('border', now%interfaces%border_reached(zone), zone)
      call add('core', leaves_core(deck, model%plate%setup%delaminations(zone)))
    end do
    call add('indentation', now%impact%indentation%alpha > max_indentation(deck))
    if (now%impact%force > 0) &
      call add('below_nose', now%impact%depth_below_impactor(model) > limit_of('below_nose')*thickness)
    call add('steps', stepper%error_exceeded)
    call add('mapping', record%mapping%raises_strain())
    call add('plies_lost', record%mapping%loses_plies())
    if (is_new(record, 'slopes')) call add('slopes', model%plate%communicator%any( &
                                           maxval(abs(now%motion%displacement(4:5, :))) > limit_of('slopes')))
    if (is_new(record, 'stringer') .and. &
        any([(any(deck%setup%stringers(i)%failure_strains > 0), i=1, size(deck%setup%stringers))])) &
      call add('stringer', weakest_stringer(model%plate, now%motion%displacement) > 0)
    if (is_new(record, 'membrane') .and. abs(now%impact%deflection) > limit_of('membrane')*thickness) &
      call add('membrane', has_fibre_failure(deck, model%plate, now))
    ! The contact shrinks to nothing as the impactor rebounds, which it does not where it perforates.
    if (is_new(record, 'perforation') .and. deck%setup%ply_damage%is_present .and. now%impact%force > 0 .and. &
        now%impact%impactor%velocity >= 0) call add('perforation', is_perforated(model, now))
    exceeded = energy_check%check(now%ledger, now%interfaces%unreleased(model), deck%setup%load_level(now%time), &
                                  deck%setup%is_static())
    call record%note_motion(deck, now)
    if (deck%setup%is_impact() .or. has_developed(deck, now%time)) then
      call add('scaled', record%scaled_energy > limit_of('scaled')*now%ledger%largest)
      call add('contact', stepper%dissipates_in_contact .and. &
               now%ledger%contact > limit_of('contact')*now%ledger%largest)
    end if
    call add('kinetic', record%slow_motion%share > limit_of('kinetic'))
    call add_energy_warnings(exceeded, deck, stepper, record, warnings)

  contains

    !> Adds a warning at its first occurrence.
    subroutine add(name, occurs, at_zone)
      character(len=*), intent(in) :: name
      !> Whether its condition is met
      logical, intent(in) :: occurs
      !> The zone it concerns
      integer, intent(in), optional :: at_zone

      call add_warning(name, occurs, deck, stepper, record, warnings, at_zone)
    end subroutine add
  end subroutine find_warnings

  !> True: the warning, which concerns no zone, has not been given.
  pure logical function is_new(record, name)
    type(run_record_t), intent(in) :: record
    character(len=*), intent(in) :: name

    is_new = .not. record%has_warned(kind_of(name), 0)
  end function is_new

  !> Adds warnings of energies.
  subroutine add_energy_warnings(exceeded, deck, stepper, record, warnings)
    !> True for the kinds of errors found
    logical, intent(in) :: exceeded(3)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(inout) :: record
    !> Receives their sentences
    type(line_t), allocatable, intent(inout) :: warnings(:)

    call add_warning('created', exceeded(energy_created), deck, stepper, record, warnings)
    call add_warning('dissipated', exceeded(energy_dissipated), deck, stepper, record, warnings)
    call add_warning('ledger', exceeded(energy_imbalance), deck, stepper, record, warnings)
  end subroutine add_energy_warnings

  !> Adds a warning at its first occurrence.
  subroutine add_warning(name, occurs, deck, stepper, record, warnings, at_zone)
    character(len=*), intent(in) :: name
    !> Whether its condition is met
    logical, intent(in) :: occurs
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> Receives the warning
    type(run_record_t), intent(inout) :: record
    !> Receives its sentence
    type(line_t), allocatable, intent(inout) :: warnings(:)
    !> The zone it concerns
    integer, intent(in), optional :: at_zone
    integer :: zone

    zone = 0
    if (present(at_zone)) zone = at_zone
    if (.not. occurs) return
    if (record%has_warned(kind_of(name), zone)) return
    call record%note_warning(kind_of(name), zone, stepper%now%time)
    call append(warnings, warning_text(kind_of(name), zone, moment(deck, stepper%now%time), deck, stepper))
  end subroutine add_warning

  !> Indentation up to which a contact law may hold: the thickness of the laminate, and the radius of the impactor,
  !> half of which is immersed there.
  pure real(wp) function max_indentation(deck) result(limit)
    type(deck_t), intent(in) :: deck

    limit = deck%expected%scales%thickness
    if (deck%setup%impactor%radius > 0) limit = min(limit, deck%setup%impactor%radius)
  end function max_indentation

  !> True: adaptive layers extend so far beyond the core that damage does, too.
  pure logical function leaves_core(deck, interface) result(leaves)
    type(deck_t), intent(in) :: deck
    !> The interface, with its present zone
    type(delamination_t), intent(in) :: interface

    leaves = interface%is_adaptive .and. deck%setup%mesh%cell > 0 .and. &
             any(interface%zone + 2*abs(interface%zone_at) > deck%setup%mesh%core + &
                 2*((cells_ahead + cells_at_once)*deck%setup%mesh%cell + &
                    thicknesses_ahead*deck%expected%scales%thickness))
  end function leaves_core

  !> True: the fibres of every ply at the struck point have failed over an area as large as patch and contact, so that
  !> the contact force has no support. Collective.
  logical function is_perforated(model, now)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)
    real(wp), allocatable :: areas(:, :)

    is_perforated = .false.
    counts = failed_counts(model%plate, now%plies)
    if (counts(fibre_failure) < size(model%plate%layup%struck%number)) return
    areas = failed_areas(model%plate, now%plies)
    is_perforated = all(areas(fibre_failure, model%plate%layup%struck%number) >= &
      max(model%plate%setup%mesh%patch**2, now%impact%pressed_area(model))*(1 - rounding))
  end function is_perforated

  !> True: fibres of a clamped plate have failed. Collective.
  logical function has_fibre_failure(deck, plate, now)
    type(deck_t), intent(in) :: deck
    type(composite_plate_t), intent(in) :: plate
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)

    has_fibre_failure = .false.
    if (.not. (deck%setup%ply_damage%is_present .and. any(deck%setup%plate%edges == edge_clamped))) return
    counts = failed_counts(plate, now%plies)
    has_fibre_failure = counts(fibre_failure) > 0
  end function has_fibre_failure

  !> All warnings of a run, with those before a restart.
  function reported_warnings(record, deck, stepper) result(lines)
    type(run_record_t), intent(in) :: record
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> One sentence each, in the order of time
    type(line_t), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(record%warning_kinds)
      call append(lines, warning_text(record%warning_kinds(i), record%warning_zones(i), &
                                      moment(deck, record%warning_times(i)), deck, stepper))
    end do
  end function reported_warnings
end module run_warnings
