!> NAME_summary.json: the summary in full precision. doc/manual/summary.md describes it.
module summary_file
  use compression_summary, only: put_collapse
  use deck_contents, only: deck_t
  use force_filters, only: filter_kind
  use json_text, only: json_t
  use interface_summary, only: put_interfaces
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use output_clocks, only: shown_time
  use output_deck, only: key_force_filter
  use profiles, only: profile_row_t, profile_t
  use run_errors, only: run_errors_t
  use run_figures, only: ending_t, run_figures_t
  use run_provenance, only: citation_of, provenance_t
  use run_records, only: run_record_t
  use run_results, only: results_t
  use steppers, only: stepper_t
  use stressed_volumes, only: factor_of
  use text, only: line_t
  implicit none
  private
  public :: summary_text

  !> Ending of its name.
  character(len=*), parameter, public :: summary_ending = '_summary.json'

contains

  !> The summary as JSON.
  function summary_text(deck, stepper, record, results, figures, errors, given, ending, provenance, profile, seconds) &
    result(content)
    type(deck_t), intent(in) :: deck
    class(stepper_t), intent(in) :: stepper
    type(run_record_t), intent(in) :: record
    type(results_t), intent(in) :: results
    !> Further results of the state reached
    type(run_figures_t), intent(in) :: figures
    type(run_errors_t), intent(in) :: errors
    !> Warnings of the run
    type(line_t), intent(in) :: given(:)
    type(ending_t), intent(in) :: ending
    type(provenance_t), intent(in) :: provenance
    type(profile_t), intent(in) :: profile
    !> Wall-clock time since the start of this process
    real(wp), intent(in) :: seconds
    character(len=:), allocatable :: content
    type(json_t) :: json

    call json%begin()
    call json%put('case', deck%case%name)
    call json%put('title', deck%case%title)
    call json%open_object('exit')
    call json%put('kind', trim(ending%kind))
    call json%put('code', ending%code)
    call json%put('message', ending%message)
    call json%close()
    call results%put(json)
    if (deck%setup%moves_impactor() .and. record%filter%frequency > 0) then
      call json%open_object(key_force_filter)
      call json%put('kind', filter_kind)
      call json%put('frequency', record%filter%frequency)
      call json%put('peak_force', record%peak_filtered)
      call json%put('peak_force_at', shown_time(record%peak_filtered_time))
      call json%close()
    end if
    call record%mapping%put(json, deck%setup%delaminations%below_ply)
    if (record%compression%strength > 0) call put_collapse(json, record, figures, deck%setup%delaminations%below_ply)
    call put_errors(json, errors)
    if (size(figures%interfaces) > 0) call put_interfaces(json, deck, stepper%now, record, figures)
    call put_plies(json, deck, figures)
    call put_warnings(json, deck, record, given)
    call put_costs(json, stepper, seconds)
    call put_profile(json, profile%rows())
    call put_provenance(json, provenance)
    call json%finished(content)
  end function summary_text

  !> Estimated errors.
  subroutine put_errors(json, errors)
    type(json_t), intent(inout) :: json
    type(run_errors_t), intent(in) :: errors

    call json%open_object('estimated_errors')
    call json%put('source', trim(errors%source))
    call put_known(json, 'peak_force', errors%peak_force, errors%peak_force >= 0)
    call put_known(json, 'peak_force_at', errors%peak_time, errors%peak_time >= 0)
    call put_known(json, 'contact_duration', errors%contact_duration, errors%contact_duration >= 0)
    call put_known(json, 'largest_deflection', errors%deflection, errors%deflection >= 0)
    call put_known(json, 'impactor_velocity', errors%velocity, errors%velocity >= 0)
    call put_known(json, 'delaminated_area', errors%area, errors%area >= 0)
    call json%close()
  end subroutine put_errors

  !> Adds a number, or null.
  subroutine put_known(json, name, value, is_known)
    type(json_t), intent(inout) :: json
    character(len=*), intent(in) :: name
    real(wp), intent(in) :: value
    !> False: null
    logical, intent(in) :: is_known

    if (is_known) call json%put(name, value)
    if (.not. is_known) call json%put_null(name)
  end subroutine put_known

  !> The plate and its plies.
  subroutine put_plies(json, deck, figures)
    type(json_t), intent(inout) :: json
    type(deck_t), intent(in) :: deck
    type(run_figures_t), intent(in) :: figures
    type(laminate_t) :: list
    real(wp) :: volume
    integer :: ply

    list = deck%setup%all_plies()
    call json%put('plate_size', deck%setup%plate%length)
    call json%open_list('plies')
    do ply = 1, size(list%angle)
      call json%open_object('')
      call json%put('ply', ply)
      if (deck%setup%zones%doubler_of(ply - size(deck%setup%laminate%angle)) > 0) call json%put('doubler', &
        deck%setup%zones%doublers(deck%setup%zones%doubler_of(ply - size(deck%setup%laminate%angle)))%name)
      call json%put('made_of', deck%setup%materials(list%material(ply))%name)
      call json%put('angle', list%angle(ply))
      call json%put('thickness', list%thickness(ply))
      if (deck%setup%ply_damage%is_present) then
        call json%put('fibre_failure_area', figures%failed_area(1, ply))
        call json%put('matrix_crack_area', figures%failed_area(2, ply))
        call json%put('matrix_crushing_area', figures%failed_area(3, ply))
        if (deck%setup%ply_damage%weibull_modulus > 0 .and. .not. deck%setup%ply_damage%scatters()) then
          ! Strength at the first failure of fibres in tension, and the stressed volume that it belongs to.
          volume = figures%stressed_volume(ply)
          call put_known(json, 'stressed_volume', volume, volume > 0)
          call put_known(json, 'fibre_strength', deck%setup%materials(list%material(ply))%xt* &
                         factor_of(deck%setup%ply_damage, merge(volume, 1.0_wp, volume > 0)), volume > 0)
        end if
      end if
      call json%close()
    end do
    call json%close()
  end subroutine put_plies

  !> Warnings on the deck, which have no time, and those of the run.
  subroutine put_warnings(json, deck, record, given)
    type(json_t), intent(inout) :: json
    type(deck_t), intent(in) :: deck
    type(run_record_t), intent(in) :: record
    !> Those of the run
    type(line_t), intent(in) :: given(:)
    integer :: i

    call json%open_list('warnings')
    do i = 1, size(deck%remarks)
      call json%open_object('')
      call json%put_null('at')
      call json%put('text', deck%remarks(i)%text)
      call json%close()
    end do
    do i = 1, size(given)
      call json%open_object('')
      call json%put('at', record%warning_times(i))
      call json%put('text', given(i)%text)
      call json%close()
    end do
    call json%close()
  end subroutine put_warnings

  !> Cost of the run.
  subroutine put_costs(json, stepper, seconds)
    type(json_t), intent(inout) :: json
    class(stepper_t), intent(in) :: stepper
    !> Wall-clock time since the start of this process
    real(wp), intent(in) :: seconds

    call json%open_object('costs')
    call json%put('unknowns', stepper%unknowns)
    call json%put('rejected', stepper%rejected)
    call json%put('total_iterations', stepper%now%all_iterations%equilibrium)
    call json%put('total_force_iterations', stepper%now%all_iterations%force)
    call json%put('refactorisations', stepper%operator%factorizations)
    call json%put('solves', stepper%operator%solves)
    call json%put('wall_seconds', seconds)
    call json%close()
  end subroutine put_costs

  !> Provenance of the result.
  subroutine put_provenance(json, provenance)
    type(json_t), intent(inout) :: json
    type(provenance_t), intent(in) :: provenance

    call json%open_object('provenance')
    call json%put('version', provenance%version)
    call json%put('commit', provenance%commit)
    call json%put('compiler', provenance%compiler)
    call json%put('petsc_version', provenance%petsc_version)
    call json%put('citation', citation_of(provenance%version))
    call json%put('ranks', provenance%ranks)
    call json%put('started', provenance%started)
    call json%put('deck', provenance%deck)
    if (provenance%library /= '') call json%put('library', provenance%library)
    call json%close()
  end subroutine put_provenance

  !> Profile of time and memory, if requested.
  subroutine put_profile(json, rows)
    type(json_t), intent(inout) :: json
    !> The parts; none without a profile
    type(profile_row_t), intent(in) :: rows(:)
    integer :: i

    if (size(rows) == 0) return
    call json%open_list('profile')
    do i = 1, size(rows)
      call json%open_object('')
      call json%put('part', trim(rows(i)%name))
      call json%put('calls', rows(i)%calls)
      call json%put('wall_seconds', rows(i)%seconds)
      call json%put('peak_megabytes_added', rows(i)%megabytes)
      call json%close()
    end do
    call json%close()
  end subroutine put_profile
end module summary_file
