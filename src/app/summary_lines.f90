!> The summary in the log: rounded, in the deck's units.
module summary_lines
  use compression_summary, only: collapse_text, compression_text
  use deck_contents, only: deck_t
  use energy_ledgers, only: ledger_t
  use impactors, only: impactor_energy, new_impactor
  use kinds, only: wp
  use projected_areas, only: area_dissipated, area_failed, area_softened
  use run_errors, only: run_errors_t
  use run_figures, only: run_figures_t
  use roundings, only: rounding
  use run_moments, only: moment
  use run_records, only: run_record_t
  use run_warnings, only: reported_warnings
  use states, only: state_t
  use text, only: line_t, append, counted, rounded_text, to_text
  implicit none
  private
  public :: lines_of_summary

  !> Characters before the figures.
  integer, parameter :: label_width = 20

contains

  !> The summary as lines of the log.
  function lines_of_summary(deck, now, record, figures, errors, unknown_because) result(lines)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The state reached
    type(state_t), intent(in) :: now
    !> Record of the run
    type(run_record_t), intent(in) :: record
    !> Figures of the state
    type(run_figures_t), intent(in) :: figures
    !> Estimated errors
    type(run_errors_t), intent(in) :: errors
    !> Reason why errors are not known; empty: known, or not to be reported
    character(len=*), intent(in) :: unknown_because
    !> The lines
    type(line_t), allocatable :: lines(:)
    logical :: struck

    struck = deck%moves_impactor() .and. .not. deck%impactor%travel > 0
    if (deck%units == '') call append(lines, 'Summary, in the units of the deck:')
    if (deck%units /= '') call append(lines, 'Summary, in the units of the deck, '//deck%units//':')
    if (struck) then
      call add_impact(lines, now, record, errors)
    else if (deck%has_impactor) then
      call add_figure(lines, 'peak force', rounded_text(record%peak_force)//' at '//moment(deck, record%peak_time))
    end if
    call add_figure(lines, 'largest deflection', rounded_text(record%deflection)// &
              within(errors%deflection, record%deflection)//' at '//moment(deck, record%deflection_time))
    if (record%compression%strength > 0) then
      call add_figure(lines, 'residual strength', compression_text(deck, record%compression))
      if (record%compression%failed) &
        call add_figure(lines, 'failure', collapse_text(record, figures, deck%delaminations%below_ply))
    end if
    if (struck .and. .not. now%force > 0) call add_dent(lines, deck, figures)
    if (struck) call add_impact_energy(lines, deck, now)
    call add_energies(lines, now%ledger)
    if (record%scaled_energy > 0) call add_figure(lines, 'scaled inertia', 'kinetic energy at most '// &
                                            rounded_text(100*record%scaled_share(), 2)//' % of the total')
    if (size(figures%interfaces) > 0) call add_interfaces(lines, deck, record, figures, errors)
    if (deck%has_ply_damage) call add_figure(lines, 'failed plies', 'fibres '//to_text(figures%failures(1))// &
      ', matrix cracked '//to_text(figures%failures(2))//', crushed '//to_text(figures%failures(3))// &
      ' (counted in each element)')
    if (len(unknown_because) > 0) call add_figure(lines, 'errors', unknown_because)
    call add_warnings(lines, deck, record)
  end function lines_of_summary

  !> Adds a line.
  subroutine add_figure(lines, label, figures)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The label; empty: the line continues the one before
    character(len=*), intent(in) :: label
    !> Its results
    character(len=*), intent(in) :: figures

    call append(lines, '  '//label//repeat(' ', max(1, label_width - len(label)))//figures)
  end subroutine add_figure

  !> Force, contact and rebound.
  subroutine add_impact(lines, now, record, errors)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The state reached
    type(state_t), intent(in) :: now
    !> Record of the run
    type(run_record_t), intent(in) :: record
    !> Estimated errors
    type(run_errors_t), intent(in) :: errors

    call add_figure(lines, 'peak force', rounded_text(record%peak_force)// &
                    within(errors%peak_force, record%peak_force)//' at time '// &
                    rounded_text(record%peak_time)//within(errors%peak_time))
    if (record%filter%frequency > 0) &
      call add_figure(lines, 'filtered', rounded_text(record%peak_filtered)//' at time '// &
                rounded_text(record%peak_filtered_time)//' after the low-pass filter of '// &
                rounded_text(record%filter%frequency))
    if (now%force > 0) then
      call add_figure(lines, 'time in contact', rounded_text(record%contact_duration)//repeated(record%contacts)// &
                ', and still at the end'//within(errors%contact_duration))
    else
      call add_figure(lines, 'time in contact', rounded_text(record%contact_duration)//repeated(record%contacts)// &
                ', until '//rounded_text(record%contact_end)//within(errors%contact_duration))
    end if
    if (now%force > 0) then
      call add_figure(lines, 'velocity at the end', rounded_text(now%impactor%velocity)//within(errors%velocity))
    else if (record%has_rebounded()) then
      call add_figure(lines, 'rebound velocity', rounded_text(record%rebound)//within(errors%velocity))
    end if
  end subroutine add_impact

  !> Depth of the dent. In a plate that has not been damped to rest it includes the deflection of the residual
  !> vibration.
  subroutine add_dent(lines, deck, figures)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Figures of the state
    type(run_figures_t), intent(in) :: figures
    character(len=:), allocatable :: depth

    if (figures%dent(1) > figures%dent(2)) then
      depth = rounded_text(figures%dent(1))//' below the surface around it, of which indentation '// &
              rounded_text(figures%dent(2))
      if (.not. deck%stepping%central%settle > 0) depth = depth//'; with residual vibration'
    else
      depth = rounded_text(figures%dent(2))//', permanent indentation only'
    end if
    call add_figure(lines, 'dent', depth)
  end subroutine add_dent

  !> Estimated error of a result.
  pure function within(error, figure) result(clause)
    !> Its error; negative: not known
    real(wp), intent(in) :: error
    !> The value that it is relative to; left out: it is printed in its unit
    real(wp), intent(in), optional :: figure
    !> Such as (+-0.4 %); empty if it is not known
    character(len=:), allocatable :: clause

    clause = ''
    if (error < 0) return
    clause = ' (+-'//rounded_text(error, 2)//')'
    if (.not. present(figure)) return
    clause = ''
    if (abs(figure) > 0) clause = ' (+-'//rounded_text(100*error/abs(figure), 2)//' %)'
  end function within

  !> Clause on the number of contacts.
  pure function repeated(contacts) result(clause)
    !> Number of contacts
    integer, intent(in) :: contacts
    !> Empty for one
    character(len=:), allocatable :: clause

    clause = ''
    if (contacts > 1) clause = ' in '//to_text(contacts)//' contacts'
  end function repeated

  !> Energy of the impactor and its loss, which is the absorbed energy once the contact has ended.
  subroutine add_impact_energy(lines, deck, now)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> The state reached
    type(state_t), intent(in) :: now
    character(len=:), allocatable :: clause
    real(wp) :: energy_input, lost

    energy_input = impactor_energy(deck%impactor, new_impactor(deck%impactor))
    lost = energy_input - now%ledger%impactor
    clause = ', absorbed '
    if (now%force > 0) clause = ', still in contact, transferred so far '
    clause = rounded_text(energy_input)//clause//rounded_text(lost)
    ! Of an impact with next to no energy the weight of the impactor may transfer more.
    if (energy_input > 0 .and. lost <= energy_input*(1 + rounding)) &
      clause = clause//' ('//rounded_text(100*lost/energy_input, 3)//' %)'
    call add_figure(lines, 'impact energy', clause)
  end subroutine add_impact_energy

  !> The energy ledger, with the names of the columns.
  subroutine add_energies(lines, ledger)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The ledger
    type(ledger_t), intent(in) :: ledger
    character(len=:), allocatable :: damping

    damping = ''
    if (ledger%damping > 0) damping = ', damping '//rounded_text(ledger%damping)
    if (ledger%external_work /= 0) call add_figure(lines, 'work of the load', rounded_text(ledger%external_work))
    call add_figure(lines, 'energies', 'kinetic '//rounded_text(ledger%kinetic)//', strain '// &
                    rounded_text(ledger%strain)// &
              ', indentation '//rounded_text(ledger%indentation)//', delamination '// &
              rounded_text(ledger%delamination)//', ply damage '//rounded_text(ledger%ply_damage))
    call add_figure(lines, '', 'contact '//rounded_text(ledger%contact)//', friction '// &
                    rounded_text(ledger%friction)// &
              ', layers '//rounded_text(ledger%layers)//damping//', algorithmic dissipation '// &
              rounded_text(ledger%algorithmic)//', energy error '//rounded_text(ledger%error(), 2))
  end subroutine add_energies

  !> Results of the interfaces.
  subroutine add_interfaces(lines, deck, record, figures, errors)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Record of the run
    type(run_record_t), intent(in) :: record
    !> Results of the state reached
    type(run_figures_t), intent(in) :: figures
    !> Estimated errors
    type(run_errors_t), intent(in) :: errors
    integer :: zone

    call add_figure(lines, 'delaminated area', rounded_text(sum(figures%interfaces%area))// &
              ' of all interfaces'//within(errors%area))
    call add_figure(lines, '  projected', rounded_text(figures%projected_areas(area_dissipated))// &
                    ' by dissipated fractions, as in a C-scan; failed points '// &
                    rounded_text(figures%projected_areas(area_failed))//', with process zones '// &
                    rounded_text(figures%projected_areas(area_softened)))
    do zone = 1, size(figures%interfaces)
      associate (figure => figures%interfaces(zone))
        call add_figure(lines, '  below ply '//to_text(deck%delaminations(zone)%below_ply), 'area '// &
                  rounded_text(figure%area)//', x '//range_of(figure%bounds(:, 1))//', y '// &
                  range_of(figure%bounds(:, 2))//', energy '//rounded_text(figure%energy))
        call add_event('onset', record%onset(:, zone))
        call add_event('first growth', record%growth(:, zone))
        if (deck%has_impactor) &
          call add_figure(lines, '', 'threshold force (closed form) '//rounded_text(figures%threshold(zone))// &
                          ' for '//counted(to_text(size(figures%interfaces)), 'equal circular delamination')// &
                          of_starter(figures%starter_threshold))
      end associate
    end do

  contains

    !> Time and force of an event, if it occurred.
    subroutine add_event(name, event)
      !> Its name
      character(len=*), intent(in) :: name
      !> Time, contact force, deflection; time 0: never, negative: before the run
      real(wp), intent(in) :: event(3)

      if (event(1) < 0) then
        call add_figure(lines, '', name//' before this run')
      else if (.not. event(1) > 0) then
        call add_figure(lines, '', 'no '//name)
      else if (deck%has_impactor) then
        call add_figure(lines, '', name//' at force '//rounded_text(event(2))//', '//moment(deck, event(1)))
      else
        call add_figure(lines, '', name//' at '//moment(deck, event(1)))
      end if
    end subroutine add_event
  end subroutine add_interfaces

  !> Least and greatest.
  pure function range_of(bounds) result(words)
    !> Both
    real(wp), intent(in) :: bounds(2)
    !> Such as -0.012 to 0.012
    character(len=:), allocatable :: words

    words = rounded_text(bounds(1))//' to '//rounded_text(bounds(2))
  end function range_of

  !> The closed form with the radius of the starter.
  pure function of_starter(force) result(clause)
    !> The force; 0: not defined
    real(wp), intent(in) :: force
    !> Empty without
    character(len=:), allocatable :: clause

    clause = ''
    if (force > 0) clause = ', '//rounded_text(force)//' with the starter under this patch'
  end function of_starter

  !> Warnings on the deck and those of the run.
  subroutine add_warnings(lines, deck, record)
    !> The lines
    type(line_t), allocatable, intent(inout) :: lines(:)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Record of the run
    type(run_record_t), intent(in) :: record
    type(line_t), allocatable :: given(:)
    integer :: i

    given = reported_warnings(record, deck)
    if (size(deck%remarks) + size(given) == 0) call add_figure(lines, 'warnings', 'none')
    do i = 1, size(deck%remarks)
      call add_figure(lines, 'warning', deck%remarks(i)%text)
    end do
    do i = 1, size(given)
      call add_figure(lines, 'warning', given(i)%text)
    end do
  end subroutine add_warnings
end module summary_lines
