!> Warnings of a run that exceeds limits of the model. Each is given once, in the log at that time and in the summary at
!> the end.
module run_warnings
  use failed_plies_areas, only: failed_areas
  use deck_contents, only: deck_t
  use delamination_parameters, only: delamination_t
  use energy_checks, only: energy_check_t, energy_created, energy_taken, energy_unaccounted, energy_tolerance
  use errors, only: error_t, exit_convergence, fail
  use kinds, only: wp
  use layer_extents, only: cells_ahead, cells_at_once, thicknesses_ahead
  use line_loads, only: line_ramp
  use logger, only: log_t
  use mesh_parameters, only: edge_clamped
  use models, only: model_t
  use ply_damage_parameters, only: failure_modes, fibre_failure
  use run_records, only: run_record_t, warning_border, warning_core, warning_energy, warning_hole, &
                         warning_indentation, warning_kinetic, warning_ledger, warning_loss, warning_scaled, &
                         warning_slopes, &
                         warning_steps, warning_torn
  use run_moments, only: moment
  use short_numbers, only: short_text
  use states, only: state_t
  use stepping_parameters, only: is_explicit
  use text, only: line_t, append, rounded_text, to_text
  use time_stepping, only: time_stepper_t
  implicit none
  private
  public :: give_warnings, warnings_given

  !> Largest rotation with a cosine of about 1, as assumed by von Karman's strains: the error is 2 %.
  real(wp), parameter :: steepest = 0.2_wp
  !> Deflection over thickness beyond which membrane forces carry a clamped plate: in a circular one they carry
  !> 0.47 (w/h)**2 times what bending does, four times at 3 (S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and
  !> Shells, 1959, art. 100).
  real(wp), parameter :: deepest = 3
  !> Relative round-off of an area: below it are sums of 1e6 elements with a precision of 2e-16.
  real(wp), parameter :: rounded_off = 1.0e-9_wp

  !> Permitted ratio of kinetic energy to work in slow motion, 5 % (Getting Started with Abaqus, chapter on quasi-static
  !> analysis: 5 to 10 %), and fraction of the run after which it is checked: the default rise of a travel, after which
  !> the velocity is constant.
  real(wp), parameter :: max_kinetic = 0.05_wp, slow_start = 0.25_wp
  !> Permitted fraction of kinetic energy of motions with scaled inertia. Forces and velocities are proportional to the
  !> root of energies: 2 % of energy is 1 % of force, the error permitted for the default factor. On decks of input/ it
  !> is .02 to 1 % (input/peanut.nml to input/small/breaking_bursts.nml).
  real(wp), parameter :: max_scaled = 0.02_wp

contains

  !> Warns once of each condition that affects the validity; a strict run ends there. Collective.
  subroutine give_warnings(deck, model, stepper, record, energy_check, log, error)
    !> The deck
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    !> The stepper
    type(time_stepper_t), intent(in) :: stepper
    !> Receives the warnings
    type(run_record_t), intent(inout) :: record
    !> The check of energies
    type(energy_check_t), intent(inout) :: energy_check
    !> The log
    type(log_t), intent(inout) :: log
    !> Set if the run is strict and exceeds a limit of the model
    type(error_t), allocatable, intent(out) :: error
    type(line_t), allocatable :: warnings(:)
    integer :: i

    call find_warnings(deck, model, stepper%now, stepper%errs, record, energy_check, warnings)
    do i = 1, size(warnings)
      if (deck%strict) then
        call fail(error, exit_convergence, warnings(i)%text)
      else
        call log%warning(warnings(i)%text)
      end if
    end do
  end subroutine give_warnings

  !> Finds and stores new warnings of an accepted step. Collective.
  subroutine find_warnings(deck, model, now, step_errs, record, energy_check, warnings)
    !> The deck
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    !> The state reached
    type(state_t), intent(in) :: now
    !> True: the error of the step exceeds the tolerance of error control at the smallest length
    logical, intent(in) :: step_errs
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
      if (now%interfaces%border_reached(zone)) call add_warning(warning_border, zone)
      if (leaves_core(deck, model%setup%delaminations(zone))) call add_warning(warning_core, zone)
    end do
    if (now%indentation%alpha > thickness) call add_warning(warning_indentation, 0)
    if (step_errs) call add_warning(warning_steps, 0)
    if (.not. record%has_warned(warning_slopes, 0)) then
      if (is_steep(model, now)) call add_warning(warning_slopes, 0)
    end if
    if (.not. record%has_warned(warning_torn, 0) .and. abs(now%deflection) > deepest*thickness) then
      if (has_fibre_failure(deck, model, now)) call add_warning(warning_torn, 0)
    end if
    ! After the impactor has left, the check does not apply.
    if (.not. record%has_warned(warning_hole, 0) .and. deck%has_ply_damage .and. now%force > 0) then
      if (is_perforated(model, now)) call add_warning(warning_hole, 0)
    end if
    exceeded = energy_check%check(now%ledger, now%interfaces%unreleased(model), deck%load_level(now%time), &
                                  deck%is_static())
    call record%note_scaled(now%ledger%scaled, energy_check%largest)
    if (deck%is_impact() .or. now%time > slow_start*deck%stepping%time%end) then
      if (record%scaled_energy > max_scaled*energy_check%largest) call add_warning(warning_scaled, 0)
    end if
    if (is_slow_motion(deck) .and. now%time > slow_start*deck%stepping%time%end) then
      if (now%ledger%kinetic > max_kinetic*abs(now%ledger%external_work)) call add_warning(warning_kinetic, 0)
    end if
    if (exceeded(energy_created)) call add_warning(warning_energy, 0)
    if (exceeded(energy_taken)) call add_warning(warning_loss, 0)
    if (exceeded(energy_unaccounted)) call add_warning(warning_ledger, 0)

  contains

    !> Adds a warning at its first occurrence.
    subroutine add_warning(kind, zone)
      !> Its kind and zone
      integer, intent(in) :: kind, zone

      if (record%has_warned(kind, zone)) return
      call record%note_warning(kind, zone, now%time)
      call append(warnings, warning_text(kind, zone, moment(deck, now%time), deck))
    end subroutine add_warning
  end subroutine find_warnings

  !> True: only prescribed motions in time load the plate, as in a quasi-static test.
  pure logical function is_slow_motion(deck)
    !> The deck
    type(deck_t), intent(in) :: deck

    is_slow_motion = .false.
    if (deck%is_static() .or. deck%has_pressure .or. deck%is_impact()) return
    is_slow_motion = deck%impactor%travel > 0
    if (allocated(deck%lines)) is_slow_motion = is_slow_motion .or. &
      any(deck%lines%prescribed .and. deck%lines%history == line_ramp .and. abs(deck%lines%value) > 0)
  end function is_slow_motion

  !> True: adaptive layers extend so far beyond the core that damage does, too.
  pure logical function leaves_core(deck, interface) result(leaves)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The interface, with its present zone
    type(delamination_t), intent(in) :: interface

    leaves = interface%follows .and. deck%mesh%cell > 0 .and. &
             any(interface%zone > deck%mesh%core + 2*((cells_ahead + cells_at_once)*deck%mesh%cell + &
                                                      thicknesses_ahead*deck%expected%scales%thickness))
  end function leaves_core

  !> True: a rotation of the plate exceeds the limit of moderate rotations. Collective.
  logical function is_steep(model, now)
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now

    is_steep = model%communicator%any(maxval(abs(now%motion%displacement(4:5, :))) > steepest)
  end function is_steep

  !> True: the fibres of every ply have failed over an area as large as the contact, so that the contact force has no
  !> support. Collective.
  logical function is_perforated(model, now)
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)
    real(wp), allocatable :: areas(:, :)

    is_perforated = .false.
    counts = now%plies%counts(model)
    if (counts(fibre_failure) < size(model%setup%laminate%angle)) return
    areas = failed_areas(model, now%plies)
    is_perforated = all(areas(fibre_failure, :) >= model%pressed_area()*(1 - rounded_off))
  end function is_perforated

  !> True: fibres of a clamped plate have failed. Collective.
  logical function has_fibre_failure(deck, model, now)
    !> The deck
    type(deck_t), intent(in) :: deck
    type(model_t), intent(in) :: model
    !> The step reached
    type(state_t), intent(in) :: now
    integer :: counts(failure_modes)

    has_fibre_failure = .false.
    if (.not. (deck%has_ply_damage .and. any(deck%plate%edges == edge_clamped))) return
    counts = now%plies%counts(model)
    has_fibre_failure = counts(fibre_failure) > 0
  end function has_fibre_failure

  !> Sentence of a warning.
  pure function warning_text(kind, zone, at, deck) result(text)
    !> One of the kinds of warnings
    integer, intent(in) :: kind
    !> Its zone; 0: none
    integer, intent(in) :: zone
    !> Its time, such as time 0.001
    character(len=*), intent(in) :: at
    !> The deck
    type(deck_t), intent(in) :: deck
    !> One sentence
    character(len=:), allocatable :: text

    text = ''
    select case (kind)
    case (warning_border)
      text = 'The delamination below ply '//to_text(deck%delaminations(zone)%below_ply)// &
             ' has reached the border of its zone at '//at// &
             ' and cannot grow further: make the zone larger.'
    case (warning_core)
      text = 'The layers below ply '//to_text(deck%delaminations(zone)%below_ply)// &
             ' extend beyond the core of the mesh since '//at// &
             ', where cells are longer: make the core larger.'
    case (warning_energy)
      text = energy_text('created', 'take smaller steps, &impactor integrator=''conserving'', or more damping '// &
                         '(rho_inf) with delamination.', 'take a smaller step_factor.')
    case (warning_loss)
      text = energy_text('taken', 'take smaller steps, or less damping (rho_inf).', dissipation_remedy(deck))
    case (warning_ledger)
      text = 'More than '//short_text(100*energy_tolerance)//' % of the energy is not accounted for since '//at// &
             ' (energy_error): take a smaller '//trim(merge('step_factor.         ', 'tolerance of &solver.', &
                                                                          is_explicit(deck%stepping)))
    case (warning_kinetic)
      text = 'The plate''s kinetic energy is more than '//short_text(100*max_kinetic)//' % of the work since '// &
             at//': the motion is too fast for a quasi-static test; take a longer end or rise.'
    case (warning_scaled)
      text = 'Kinetic energy of motions with scaled inertia exceeds '//short_text(100*max_scaled)// &
             ' % of the energy since '//at//': take a smaller mass_scaling, or compare with 1.'
    case (warning_indentation)
      text = 'The indentation exceeds the thickness of the laminate since '//at// &
             ': no contact law is valid there; take less energy or a larger radius.'
    case (warning_slopes)
      text = 'The slope of the plate exceeds '//to_text(steepest)//' since '//at// &
             ': its strains assume small rotations; later results are not valid.'
    case (warning_steps)
      text = 'The error of steps exceeds the tolerance of &adapt since '//at// &
             ' at the smallest step, too long for the waves of failures: an eighth of that tolerance halves the &
               &steps and shows the effect.'
    case (warning_torn)
      text = 'The clamped plate deflects by more than '//to_text(deepest)// &
             ' thicknesses with failed fibres since '//at// &
             ': membrane forces carry it, and plies do not tear in the model; later results are not valid.'
    case (warning_hole)
      text = 'The fibres of every ply have failed over an area as large as the contact since '//at// &
             ': the impactor perforates the plate, and the model has no hole; later results are not valid.'
    end select

  contains

    !> Sentence on an energy above its limit, with a remedy.
    pure function energy_text(what, remedy, explicit_remedy) result(words)
      !> created or taken
      character(len=*), intent(in) :: what
      !> Remedies for implicit steps and for central differences
      character(len=*), intent(in) :: remedy, explicit_remedy
      !> The sentence
      character(len=:), allocatable :: words

      if (deck%is_static()) then
        words = 'Load steps have '//what//' more than '//short_text(100*energy_tolerance)//' % of the energy by '// &
          at// &
                ' (energy_algorithmic): take more steps, unless failures or snap-through release it as kinetic energy.'
      else if (is_explicit(deck%stepping)) then
        words = 'Central differences have '//what//' more than '//short_text(100*energy_tolerance)// &
          ' % of the energy by '//at &
                //' (energy_algorithmic): '//explicit_remedy
      else
        words = 'The time integrators have '//what//' more than '//short_text(100*energy_tolerance)// &
          ' % of the energy by '//at &
                //': '//remedy
      end if
    end function energy_text
  end function warning_text

  !> Remedy for energy dissipated by central differences. Layers inserted by a growing zone relax, and the energy
  !> released is damped.
  pure function dissipation_remedy(deck) result(remedy)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> End of a sentence
    character(len=:), allocatable :: remedy

    remedy = 'take a smaller step_factor.'
    if (any(deck%delaminations%follows)) &
      remedy = 'take a smaller step_factor or, as zones that grow release energy, a larger zone of &delamination.'
  end function dissipation_remedy

  !> All warnings of a run, with those before a restart.
  function warnings_given(record, deck) result(lines)
    !> Record of the run
    type(run_record_t), intent(in) :: record
    !> The deck
    type(deck_t), intent(in) :: deck
    !> One sentence each, in the order of time
    type(line_t), allocatable :: lines(:)
    integer :: i

    allocate (lines(0))
    do i = 1, size(record%warning_kinds)
      call append(lines, warning_text(record%warning_kinds(i), record%warning_zones(i), &
                                      moment(deck, record%warning_times(i)), deck))
    end do
  end function warnings_given
end module run_warnings
