!> The summary in the log: rounded, with the usual units if the system of units of the deck is known.
module summary_lines
  use compression_summary, only: collapse_text, compression_text
  use deck_contents, only: deck_t
  use doubler_bonds, only: names_of_doublers
  use kinds, only: wp
  use run_errors, only: run_errors_t
  use run_figures, only: run_figures_t
  use roundings, only: rounding
  use run_moments, only: moment
  use run_records, only: run_record_t
  use run_results, only: results_t
  use summary_rows, only: label_of_result, unit_of_result
  use text, only: line_t, append, counted, rounded_text, to_text
  use usual_units, only: area_kind, energy_kind, force_kind, frequency_kind, length_kind, time_kind, velocity_kind
  implicit none
  private
  public :: lines_of_summary

  !> Characters before the figures.
  integer, parameter :: label_width = 20

contains

  !> The summary as lines of the log.
  function lines_of_summary(deck, results, record, figures, errors, unknown_because, given) result(lines)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    type(run_errors_t), intent(in) :: errors
    !> Reason why errors are not known; empty: known, or not to be reported
    character(len=*), intent(in) :: unknown_because
    !> Warnings of the run
    type(line_t), intent(in) :: given(:)
    type(line_t), allocatable :: lines(:)
    logical :: struck

    struck = deck%setup%moves_impactor() .and. .not. deck%setup%impactor%travel > 0
    if (deck%case%units == '') call append(lines, 'Summary, in the units of the deck:')
    if (deck%case%units /= '') call append(lines, 'Summary:')
    if (struck) then
      call add_impact(lines, deck, results, record, errors)
    else if (deck%setup%impactor%is_present) then
      call add_figure(lines, label_of_result('peak_force'), results%shown('peak_force')//' at '// &
                      moment(deck, results%value('peak_force_at')))
    end if
    call add_figure(lines, label_of_result('largest_deflection'), results%shown('largest_deflection')// &
                    within(results, 'largest_deflection', errors%deflection)//' at '// &
                    moment(deck, results%value('largest_deflection_at')))
    if (results%has('residual_strength')) then
      call add_figure(lines, label_of_result('residual_strength'), &
                      compression_text(results, moment(deck, results%value('residual_strength_at'))))
      if (record%compression%failed) &
        call add_figure(lines, 'failure', collapse_text(record, figures, deck%setup%delaminations%below_ply))
    end if
    if (struck .and. .not. results%value('in_contact') > 0) call add_dent(lines, deck, results)
    if (struck) call add_impact_energy(lines, results)
    call add_energies(lines, results)
    call add_share('kinetic_share', 'the work')
    call add_share('scaled_kinetic_share', 'the total')
    if (size(figures%interfaces) > 0) call add_interfaces(lines, deck, results, record, figures, errors)
    if (deck%setup%ply_damage%is_present) call add_failed_plies(lines, results)
    if (len(unknown_because) > 0) call add_figure(lines, 'errors', unknown_because)
    call add_warnings(lines, deck, given)

  contains

    !> Adds a share of the kinetic energy, if there is one.
    subroutine add_share(name, whole)
      !> Name of the result, and what it is a share of
      character(len=*), intent(in) :: name, whole

      if (results%has(name)) &
        call add_figure(lines, label_of_result(name), 'kinetic energy at most '// &
                        rounded_text(100*results%value(name), 2)//' % of '//whole)
    end subroutine add_share
  end function lines_of_summary

  !> Numbers of failed plies.
  subroutine add_failed_plies(lines, results)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(results_t), intent(in) :: results

    character(len=*), parameter :: names(*) = [character(len=16) :: 'fibre_failures', 'matrix_cracks', &
                                                                    'matrix_crushings']
    character(len=:), allocatable :: words
    integer :: i

    words = ''
    do i = 1, size(names)
      words = words//', '//label_of_result(trim(names(i)))//' '//to_text(nint(results%value(trim(names(i)))))
    end do
    call add_figure(lines, 'failed plies', words(3:)//' (counted in each element)')
  end subroutine add_failed_plies

  !> Adds a line.
  subroutine add_figure(lines, label, figures)
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The label; empty: the line continues the one before
    character(len=*), intent(in) :: label
    !> Its results
    character(len=*), intent(in) :: figures

    call append(lines, '  '//label//repeat(' ', max(1, label_width - len(label)))//figures)
  end subroutine add_figure

  !> Force, contact and rebound.
  subroutine add_impact(lines, deck, results, record, errors)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    type(run_record_t), intent(in) :: record
    type(run_errors_t), intent(in) :: errors
    character(len=:), allocatable :: until, repeated

    call add_figure(lines, label_of_result('peak_force'), results%shown('peak_force')// &
                    within(results, 'peak_force', errors%peak_force)//' at '// &
                    moment(deck, results%value('peak_force_at'))// &
                    within(results, 'peak_force_at', errors%peak_time))
    if (record%filter%frequency > 0) &
      call add_figure(lines, 'filtered', results%with_unit(record%peak_filtered, force_kind)//' at '// &
                      moment(deck, record%peak_filtered_time)//' after the low-pass filter of '// &
                      results%with_unit(record%filter%frequency, frequency_kind))
    repeated = ''
    if (record%contacts > 1) repeated = ' in '//to_text(record%contacts)//' contacts'
    until = ', until '//results%shown('contact_until')
    if (results%value('in_contact') > 0) until = ', and still at the end'
    call add_figure(lines, label_of_result('contact_duration'), results%shown('contact_duration')// &
                    repeated//until//within(results, 'contact_duration', errors%contact_duration))
    if (results%value('in_contact') > 0) then
      call add_figure(lines, label_of_result('impactor_velocity'), results%shown('impactor_velocity')// &
                      within(results, 'impactor_velocity', errors%velocity))
    else if (results%has('rebound_velocity')) then
      call add_figure(lines, label_of_result('rebound_velocity'), results%shown('rebound_velocity')// &
                      within(results, 'rebound_velocity', errors%velocity))
    end if
  end subroutine add_impact

  !> Depth of the dent. In a plate that has not been damped to rest it includes the deflection of the residual
  !> vibration.
  subroutine add_dent(lines, deck, results)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    character(len=:), allocatable :: depth

    if (results%value('dent_depth') > results%value('dent_indentation')) then
      depth = results%shown('dent_depth')//' below the surface around it, of which indentation '// &
              results%shown('dent_indentation')
      if (.not. deck%stepping%central%settle > 0) depth = depth//'; with residual vibration'
    else
      depth = results%shown('dent_indentation')//', permanent indentation only'
    end if
    call add_figure(lines, label_of_result('dent_depth'), depth)
  end subroutine add_dent

  !> Estimated error of a result: in per cent, of times in their unit.
  pure function within(results, name, error) result(clause)
    type(results_t), intent(in) :: results
    !> Name of the result
    character(len=*), intent(in) :: name
    !> Its error; negative: not known
    real(wp), intent(in) :: error
    !> Such as (+-0.4 %); empty if it is not known
    character(len=:), allocatable :: clause
    real(wp) :: value

    clause = ''
    if (error < 0) return
    value = abs(results%value(name))
    if (any(unit_of_result(name) == [character(len=11) :: time_kind, velocity_kind])) then
      clause = ' (+-'//results%with_unit(error, unit_of_result(name), 2)//')'
    else if (value > 0) then
      clause = ' (+-'//rounded_text(100*error/value, 2)//' %)'
    end if
  end function within

  !> Energy of the impactor and its loss, which is the absorbed energy once the contact has ended.
  subroutine add_impact_energy(lines, results)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(results_t), intent(in) :: results
    character(len=:), allocatable :: clause
    real(wp) :: energy_input, lost

    energy_input = results%value('energy_impact')
    lost = energy_input - results%value('energy_impactor')
    clause = ', absorbed '
    if (results%value('in_contact') > 0) clause = ', still in contact, transferred so far '
    clause = results%shown('energy_impact')//clause//results%with_unit(lost, energy_kind)
    ! Of an impact with next to no energy the weight of the impactor may transfer more.
    if (energy_input > 0 .and. lost <= energy_input*(1 + rounding)) &
      clause = clause//' ('//rounded_text(100*lost/energy_input, 3)//' %)'
    call add_figure(lines, label_of_result('energy_impact'), clause)
  end subroutine add_impact_energy

  !> The energy ledger, with the names of the columns.
  subroutine add_energies(lines, results)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(results_t), intent(in) :: results
    character(len=:), allocatable :: damping
    real(wp) :: round_off

    round_off = epsilon(round_off)*max(results%value('energy_impact'), results%value('energy_strain'))
    damping = ''
    if (results%value('energy_damping') > 0) damping = ', '//results%labelled('energy_damping')
    if (abs(results%value('work_external')) > 0) &
      call add_figure(lines, label_of_result('work_external'), results%shown('work_external'))
    call add_figure(lines, 'energies', results%labelled('energy_kinetic')//', '//results%labelled('energy_strain')// &
                    ', '//results%labelled('energy_indentation')//', '//results%labelled('energy_delamination')// &
                    ', '//results%labelled('energy_ply_damage'))
    call add_figure(lines, '', results%labelled('energy_contact')//', '//results%labelled('energy_friction')// &
                    ', '//results%labelled('energy_layers', round_off)//damping// &
                    ', '//results%labelled('energy_algorithmic')// &
                    ', '//label_of_result('energy_error')//' '//results%shown('energy_error', 2))
  end subroutine add_energies

  !> Results of the interfaces.
  subroutine add_interfaces(lines, deck, results, record, figures, errors)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    type(run_errors_t), intent(in) :: errors
    character(len=:), allocatable :: error_of_area
    integer :: zone

    error_of_area = ''
    if (errors%area >= 0) error_of_area = ' (+-'//results%with_unit(errors%area, area_kind, 2)//')'
    call add_figure(lines, label_of_result('delaminated_area'), results%shown('delaminated_area')// &
                    ' of all interfaces'//error_of_area)
    call add_figure(lines, '  projected', results%shown('projected_area')// &
                    ' by dissipated fractions, as in a C-scan; failed points '// &
                    results%shown('projected_area_failed')//', with process zones '// &
                    results%shown('projected_area_softened'))
    if (results%has('delaminated_area_before')) &
      call add_figure(lines, '  '//label_of_result('delaminated_area_before'), &
                      results%shown('delaminated_area_before')//' of all interfaces, '// &
                      results%shown('projected_area_before')//' projected')
    do zone = 1, size(figures%interfaces)
      call add_interface(lines, deck, results, record, figures, zone)
    end do
  end subroutine add_interfaces

  !> Results of an interface.
  subroutine add_interface(lines, deck, results, record, figures, zone)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    !> The interface
    integer, intent(in) :: zone
    character(len=:), allocatable :: of_starter

    of_starter = ''
    if (results%has('threshold_force_at_starter')) &
      of_starter = ', '//results%shown('threshold_force_at_starter')//' with the starter under this patch'
    associate (figure => figures%interfaces(zone))
      call add_figure(lines, '  below ply '//to_text(deck%setup%delaminations(zone)%below_ply), 'area '// &
                results%with_unit(figure%area, area_kind)//', x '//range_of(figure%bounds(:, 1))//', y '// &
                range_of(figure%bounds(:, 2))//', energy '//results%with_unit(figure%energy, energy_kind))
      if (deck%setup%delaminations(zone)%bonds_doublers()) &
        call add_figure(lines, '', 'bond of '//names_of_doublers(deck%setup%zones, deck%setup%delaminations(zone)))
      call add_event(lines, deck, results, 'onset', record%onset(:, zone))
      call add_event(lines, deck, results, 'first growth', record%growth(:, zone))
      if (deck%setup%impactor%is_present) &
        call add_figure(lines, '', 'threshold force (closed form) '// &
                        results%with_unit(figures%threshold(zone), force_kind)// &
                        ' for '//counted(to_text(size(figures%interfaces)), 'equal circular delamination')// &
                        of_starter)
    end associate

  contains

    !> Least and greatest.
    pure function range_of(bounds) result(words)
      !> Both
      real(wp), intent(in) :: bounds(2)
      !> Such as -12 mm to 12 mm
      character(len=:), allocatable :: words

      words = results%with_unit(bounds(1), length_kind)//' to '//results%with_unit(bounds(2), length_kind)
    end function range_of
  end subroutine add_interface

  !> Time and force of an event, if it occurred.
  subroutine add_event(lines, deck, results, name, event)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    type(results_t), intent(in) :: results
    character(len=*), intent(in) :: name
    !> Time, contact force, deflection; time 0: never, negative: before the run
    real(wp), intent(in) :: event(3)

    if (event(1) < 0) then
      call add_figure(lines, '', name//' before this run')
    else if (.not. event(1) > 0) then
      call add_figure(lines, '', 'no '//name)
    else if (deck%setup%impactor%is_present) then
      call add_figure(lines, '', name//' at force '//results%with_unit(event(2), force_kind)//', '// &
                      moment(deck, event(1)))
    else
      call add_figure(lines, '', name//' at '//moment(deck, event(1)))
    end if
  end subroutine add_event

  !> Warnings on the deck and those of the run.
  subroutine add_warnings(lines, deck, given)
    type(line_t), allocatable, intent(inout) :: lines(:)
    type(deck_t), intent(in) :: deck
    !> Those of the run
    type(line_t), intent(in) :: given(:)
    integer :: i

    if (size(deck%remarks) + size(given) == 0) call add_figure(lines, 'warnings', 'none')
    do i = 1, size(deck%remarks)
      call add_figure(lines, 'warning', deck%remarks(i)%text)
    end do
    do i = 1, size(given)
      call add_figure(lines, 'warning', given(i)%text)
    end do
  end subroutine add_warnings
end module summary_lines
