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
  use models, only: model_t
  use plate_options, only: max_slope
  use ply_damage_parameters, only: failure_modes, fibre_failure
  use roundings, only: rounding
  use run_records, only: run_record_t, warning_border, warning_contact, warning_core, warning_energy, &
                         warning_perforation, warning_indentation, warning_kinetic, warning_ledger, warning_loss, &
                         warning_scaled, warning_slopes, warning_steps, warning_membrane, warning_below_nose, &
                         warning_mapping, warning_stringer
  use run_moments, only: moment
  use slow_motions, only: has_developed
  use states, only: state_t
  use stringer_columns, only: weakest_stringer
  use text, only: line_t, append
  use steppers, only: stepper_t
  use warning_texts, only: warning_text, max_contact, max_deflection_ratio, max_hollow, &
                           max_kinetic, max_scaled
  implicit none
  private
  public :: report_warnings, report_last_warnings, reported_warnings

contains

  !> Warns once of each condition that affects the validity; a strict run ends there. Collective.
  subroutine report_warnings(deck, model, stepper, record, energy_check, log, error)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    class(stepper_t), intent(in) :: stepper
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> The check of energies
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
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> The check of energies
    type(energy_check_t), intent(inout) :: energy_check
    type(log_t), intent(inout) :: log
    !> Set, unless it is already, if the run is strict and exceeds the limit
    type(error_t), allocatable, intent(inout) :: error
    type(line_t), allocatable :: warnings(:)

    if (deck%load_level(stepper%now%time) >= 1) return
    allocate (warnings(0))
    associate (now => stepper%now)
      call add_energy_warnings(deck, stepper, energy_check%check(now%ledger, now%interfaces%unreleased(model), 1.0_wp, &
                                                                 .true.), now%time, record, warnings)
    end associate
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
      if (deck%strict) then
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
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> The check of energies
    type(energy_check_t), intent(inout) :: energy_check
    !> One sentence each; empty: none
    type(line_t), allocatable, intent(out) :: warnings(:)
    real(wp) :: thickness
    integer :: zone
    logical :: exceeded(3)

    allocate (warnings(0))
    thickness = deck%expected%scales%thickness
    do zone = 1, size(now%interfaces%border_reached)
      if (now%interfaces%border_reached(zone)) call add(warning_border, zone)
      if (leaves_core(deck, model%setup%delaminations(zone))) call add(warning_core, 0)
    end do
    if (now%indentation%alpha > max_indentation(deck)) call add(warning_indentation, 0)
    if (now%force > 0 .and. now%depth_below_impactor(model) > max_hollow*thickness) call add(warning_below_nose, 0)
    if (stepper%exceeds_tolerance()) call add(warning_steps, 0)
    if (record%mapping%raises_strain()) call add(warning_mapping, 0)
    if (.not. record%has_warned(warning_slopes, 0)) then
      if (is_steep(model, now)) call add(warning_slopes, 0)
    end if
    if (.not. record%has_warned(warning_stringer, 0) .and. have_strengths(deck)) then
      if (weakest_stringer(model, now%motion%displacement) > 0) call add(warning_stringer, 0)
    end if
    if (.not. record%has_warned(warning_membrane, 0) .and. abs(now%deflection) > max_deflection_ratio*thickness) then
      if (has_fibre_failure(deck, model, now)) call add(warning_membrane, 0)
    end if
    ! The contact shrinks to nothing as the impactor rebounds, which it does not where it perforates.
    if (.not. record%has_warned(warning_perforation, 0) .and. deck%has_ply_damage .and. now%force > 0 .and. &
        now%impactor%velocity >= 0) then
      if (is_perforated(model, now)) call add(warning_perforation, 0)
    end if
    exceeded = energy_check%check(now%ledger, now%interfaces%unreleased(model), deck%load_level(now%time), &
                                  deck%is_static())
    call record%note_motion(deck, now)
    call add_motion_warnings(deck, stepper, now, record, warnings)
    call add_energy_warnings(deck, stepper, exceeded, now%time, record, warnings)

  contains

    !> Adds a warning at its first occurrence.
    subroutine add(kind, zone)
      !> Its kind and zone
      integer, intent(in) :: kind, zone

      call add_warning(deck, stepper, kind, zone, now%time, record, warnings)
    end subroutine add
  end subroutine find_warnings

  !> Adds warnings of kinetic energy: of motions with scaled inertia, lost as surfaces meet, and of a slow motion.
  subroutine add_motion_warnings(deck, stepper, now, record, warnings)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    type(state_t), intent(in) :: now
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> Receives their sentences
    type(line_t), allocatable, intent(inout) :: warnings(:)

    if (deck%is_impact() .or. has_developed(deck, now%time)) then
      if (record%scaled_energy > max_scaled*now%ledger%largest) &
        call add_warning(deck, stepper, warning_scaled, 0, now%time, record, warnings)
      if (stepper%dissipates_in_contact() .and. now%ledger%contact > max_contact*now%ledger%largest) &
        call add_warning(deck, stepper, warning_contact, 0, now%time, record, warnings)
    end if
    if (record%slow_motion%share > max_kinetic) &
      call add_warning(deck, stepper, warning_kinetic, 0, now%time, record, warnings)
  end subroutine add_motion_warnings

  !> Adds warnings of energies.
  subroutine add_energy_warnings(deck, stepper, exceeded, time, record, warnings)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> True for the kinds of errors found
    logical, intent(in) :: exceeded(3)
    !> Time or load factor
    real(wp), intent(in) :: time
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> Receives their sentences
    type(line_t), allocatable, intent(inout) :: warnings(:)

    if (exceeded(energy_created)) call add_warning(deck, stepper, warning_energy, 0, time, record, warnings)
    if (exceeded(energy_dissipated)) call add_warning(deck, stepper, warning_loss, 0, time, record, warnings)
    if (exceeded(energy_imbalance)) call add_warning(deck, stepper, warning_ledger, 0, time, record, warnings)
  end subroutine add_energy_warnings

  !> Adds a warning at its first occurrence.
  subroutine add_warning(deck, stepper, kind, zone, time, record, warnings)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    !> Its kind and zone
    integer, intent(in) :: kind, zone
    !> Time or load factor
    real(wp), intent(in) :: time
    !> Receives the warning
    type(run_record_t), intent(inout) :: record
    !> Receives its sentence
    type(line_t), allocatable, intent(inout) :: warnings(:)

    if (record%has_warned(kind, zone)) return
    call record%note_warning(kind, zone, time)
    call append(warnings, warning_text(kind, zone, moment(deck, time), deck, stepper))
  end subroutine add_warning

  !> Indentation up to which a contact law may hold: the thickness of the laminate, and the radius of the impactor,
  !> half of which is immersed there.
  pure real(wp) function max_indentation(deck) result(limit)
    type(deck_t), intent(in) :: deck

    limit = deck%expected%scales%thickness
    if (deck%impactor%radius > 0) limit = min(limit, deck%impactor%radius)
  end function max_indentation

  !> True: adaptive layers extend so far beyond the core that damage does, too.
  pure logical function leaves_core(deck, interface) result(leaves)
    type(deck_t), intent(in) :: deck
    !> The interface, with its present zone
    type(delamination_t), intent(in) :: interface

    leaves = interface%is_adaptive .and. deck%mesh%cell > 0 .and. &
             any(interface%zone > deck%mesh%core + 2*((cells_ahead + cells_at_once)*deck%mesh%cell + &
                                                      thicknesses_ahead*deck%expected%scales%thickness))
  end function leaves_core

  !> True: a rotation of the plate exceeds the limit of moderate rotations. Collective.
  logical function is_steep(model, now)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now

    is_steep = model%communicator%any(maxval(abs(now%motion%displacement(4:5, :))) > max_slope)
  end function is_steep

  !> True: the strength of a stringer is known.
  pure logical function have_strengths(deck)
    type(deck_t), intent(in) :: deck
    integer :: i

    have_strengths = any([(any(deck%stringers(i)%failure_strains > 0), i=1, size(deck%stringers))])
  end function have_strengths

  !> True: the fibres of every ply have failed over an area as large as patch and contact, so that the contact force has
  !> no support. Collective.
  logical function is_perforated(model, now)
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)
    real(wp), allocatable :: areas(:, :)

    is_perforated = .false.
    counts = failed_counts(model, now%plies)
    if (counts(fibre_failure) < model%plies) return
    areas = failed_areas(model, now%plies)
    is_perforated = all(areas(fibre_failure, :) >= &
      max(model%setup%mesh%patch**2, now%pressed_area(model))*(1 - rounding))
  end function is_perforated

  !> True: fibres of a clamped plate have failed. Collective.
  logical function has_fibre_failure(deck, model, now)
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)

    has_fibre_failure = .false.
    if (.not. (deck%has_ply_damage .and. any(deck%plate%edges == edge_clamped))) return
    counts = failed_counts(model, now%plies)
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
