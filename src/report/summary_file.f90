!> NAME_summary.json: the summary in full precision. doc/manual/summary.md describes it.
module summary_file
  use compression_summary, only: put_collapse
  use summary_provenance, only: put_provenance
  use deck_contents, only: deck_t
  use errors, only: error_t, exit_files, fail
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
  use run_provenance, only: provenance_t
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
    if (deck%setup%moves_impactor() .and. record%filter%frequency > 0) call put_filtered(json, record)
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

  !> Largest filtered force.
  subroutine put_filtered(json, record)
    type(json_t), intent(inout) :: json
    type(run_record_t), intent(in) :: record

    call json%open_object(key_force_filter)
    call json%put('kind', filter_kind)
    call json%put('frequency', record%filter%frequency)
    call json%put('peak_force', record%peak_filtered)
    call json%put('peak_force_at', shown_time(record%peak_filtered_time))
    call json%close()
  end subroutine put_filtered

  !> Estimated errors.
  subroutine put_errors(json, errors)
    type(json_t), intent(inout) :: json
    type(run_errors_t), intent(in) :: errors

    call json%open_object('estimated_errors')
    call json%put('source', trim(errors%source))
    call put_known('peak_force', errors%peak_force)
    call put_known('peak_force_at', errors%peak_time)
    call put_known('contact_duration', errors%contact_duration)
    call put_known('largest_deflection', errors%deflection)
    call put_known('impactor_velocity', errors%velocity)
    call put_known('delaminated_area', errors%area)
    call json%close()

  contains

    !> Adds an error, or null.
    subroutine put_known(name, error)
      character(len=*), intent(in) :: name
      !> The error; negative: not known
      real(wp), intent(in) :: error

      if (error >= 0) call json%put(name, error)
      if (.not. error >= 0) call json%put_null(name)
    end subroutine put_known
  end subroutine put_errors

  !> The plate and its plies.
  subroutine put_plies(json, deck, figures)
    type(json_t), intent(inout) :: json
    type(deck_t), intent(in) :: deck
    type(run_figures_t), intent(in) :: figures
    type(laminate_t) :: list
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
        if (deck%setup%ply_damage%weibull_modulus > 0 .and. .not. deck%setup%ply_damage%scatters()) &
          call put_strength(json, deck, figures%stressed_volume(ply), deck%setup%materials(list%material(ply))%xt)
      end if
      call json%close()
    end do
    call json%close()
  end subroutine put_plies

  !> Tensile strength of the fibres of a ply, and the stressed volume it belongs to, at their first failure; null
  !> without.
  subroutine put_strength(json, deck, volume, strength)
    type(json_t), intent(inout) :: json
    type(deck_t), intent(in) :: deck
    !> The volume; 0: the fibres have not failed
    real(wp), intent(in) :: volume
    !> Tensile strength of the reference volume
    real(wp), intent(in) :: strength

    if (volume > 0) then
      call json%put('stressed_volume', volume)
      call json%put('fibre_strength', factor_of(deck%setup%ply_damage, volume)*strength)
    else
      call json%put_null('stressed_volume')
      call json%put_null('fibre_strength')
    end if
  end subroutine put_strength

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
    call json%put('rejected', stepper%rejected_steps())
    call json%put('total_iterations', stepper%now%all_iterations%equilibrium)
    call json%put('total_force_iterations', stepper%now%all_iterations%force)
    call json%put('refactorisations', stepper%operator%factorizations)
    call json%put('solves', stepper%operator%solves)
    call json%put('wall_seconds', seconds)
    call json%close()
  end subroutine put_costs

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
