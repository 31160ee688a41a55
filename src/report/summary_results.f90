!> The results of a run, from its record and the state reached.
module summary_results
  use deck_contents, only: deck_t
  use energy_ledgers, only: ledger_t
  use impactors, only: impactor_energy, new_impactor
  use kinds, only: wp
  use output_clocks, only: shown_time
  use placed_gauges, only: back_to_back
  use projected_areas, only: area_dissipated, area_failed, area_softened
  use run_figures, only: run_figures_t
  use run_records, only: run_record_t
  use run_results, only: new_results, results_t
  use slow_motions, only: is_slow_motion
  use states, only: state_t
  implicit none
  private
  public :: results_of

contains

  !> All results.
  function results_of(deck, now, record, figures) result(results)
    type(deck_t), intent(in) :: deck
    type(state_t), intent(in) :: now
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    type(results_t) :: results

    results = new_results(deck%case%units, deck%setup%is_static())
    call results%add(trim(merge('load_factor_reached', 'time_reached       ', deck%setup%is_static())), &
                     shown_time(record%time))
    call results%add('accepted_steps', now%step)
    if (deck%setup%moves_impactor() .or. deck%setup%presses_impactor()) then
      call results%add('peak_force', record%peak_force)
      call results%add('peak_force_at', shown_time(record%peak_time))
    end if
    if (deck%setup%moves_impactor()) call add_impact(results, deck, now, record, figures)
    call results%add('largest_deflection', record%deflection)
    call results%add('largest_deflection_at', shown_time(record%deflection_time))
    if (is_slow_motion(deck)) call results%add('kinetic_share', record%slow_motion%share)
    if (record%scaled_energy > 0) call results%add('scaled_kinetic_share', record%scaled_share())
    call add_energies(results, now%ledger)
    if (size(figures%interfaces) > 0) call add_interfaces(results, deck, record, figures)
    if (deck%setup%ply_damage%is_present) then
      call results%add('fibre_failures', figures%failures(1))
      call results%add('matrix_cracks', figures%failures(2))
      call results%add('matrix_crushings', figures%failures(3))
      if (deck%setup%has_rates()) &
        call results%add('matrix_strengthening', figures%strengthening, figures%strengthening > 0)
    end if
    if (record%compression%strength > 0) call add_compression(results, deck, record, figures)
  end function results_of

  !> Contact and impactor.
  subroutine add_impact(results, deck, now, record, figures)
    type(results_t), intent(inout) :: results
    type(deck_t), intent(in) :: deck
    type(state_t), intent(in) :: now
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    real(wp) :: energy

    energy = impactor_energy(deck%setup%impactor, new_impactor(deck%setup%impactor))
    call results%add('contacts', record%contacts)
    call results%add('contact_duration', shown_time(record%contact_duration))
    call results%add('contact_until', shown_time(record%contact_end))
    call results%add('in_contact', now%impact%force > 0)
    call results%add('dent_depth', figures%dent(1))
    call results%add('dent_indentation', figures%dent(2))
    call results%add('impactor_displacement', now%impact%impactor%displacement)
    call results%add('impactor_velocity', now%impact%impactor%velocity)
    call results%add('rebound_velocity', record%rebound, record%has_rebounded())
    call results%add('energy_impact', energy)
    call results%add('energy_absorbed', energy - now%ledger%impactor, .not. now%impact%force > 0)
    call results%add('energy_impactor', now%ledger%impactor)
  end subroutine add_impact

  !> The ledger at the end.
  subroutine add_energies(results, ledger)
    type(results_t), intent(inout) :: results
    type(ledger_t), intent(in) :: ledger

    call results%add('work_external', ledger%external_work)
    call results%add('energy_kinetic', ledger%kinetic)
    call results%add('energy_strain', ledger%strain)
    call results%add('energy_indentation', ledger%indentation)
    call results%add('energy_delamination', ledger%delamination)
    call results%add('energy_ply_damage', ledger%ply_damage)
    call results%add('energy_contact', ledger%contact)
    call results%add('energy_friction', ledger%friction)
    call results%add('energy_layers', ledger%layers)
    call results%add('energy_damping', ledger%damping)
    call results%add('energy_algorithmic', ledger%algorithmic)
    call results%add('energy_error', ledger%error())
  end subroutine add_energies

  !> All interfaces together.
  subroutine add_interfaces(results, deck, record, figures)
    type(results_t), intent(inout) :: results
    type(deck_t), intent(in) :: deck
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures

    call results%add('delaminated_area', sum(figures%interfaces%area))
    call results%add('projected_area', figures%projected_areas(area_dissipated))
    call results%add('projected_area_failed', figures%projected_areas(area_failed))
    call results%add('projected_area_softened', figures%projected_areas(area_softened))
    if (deck%setup%initial%is_inherited) then
      call results%add('delaminated_area_before', record%area_before(1))
      call results%add('projected_area_before', record%area_before(2))
    end if
    call add_first('onset', record%earliest(record%onset))
    call add_first('first_growth', record%earliest(record%growth))
    if (figures%starter_threshold > 0) call results%add('threshold_force_at_starter', figures%starter_threshold)

  contains

    !> Time and force of the first event of all interfaces.
    subroutine add_first(name, event)
      character(len=*), intent(in) :: name
      !> Time, contact force, deflection; time 0: never
      real(wp), intent(in) :: event(3)

      call results%add(name//'_at', event(1), event(1) > 0)
      if (deck%setup%impactor%is_present) call results%add(name//'_force', event(2), event(1) > 0)
    end subroutine add_first
  end subroutine add_interfaces

  !> Strength and modulus of a compression.
  subroutine add_compression(results, deck, record, figures)
    type(results_t), intent(inout) :: results
    type(deck_t), intent(in) :: deck
    type(run_record_t), intent(in) :: record
    !> Results of the state reached
    type(run_figures_t), intent(in) :: figures

    associate (of => record%compression)
      call results%add('residual_strength', of%strength)
      call results%add('residual_strength_at', of%at)
      call results%add('shortening_at_strength', of%shortening)
      if (size(deck%setup%stringers) > 0 .or. .not. deck%setup%zones%is_empty()) then
        call results%add('failure_load', of%strength*figures%skin_area)
        call results%add('skin_stress_at_strength', of%strength*figures%skin_share)
      end if
      call results%add('has_failed', of%failed)
      call results%add('effective_modulus', of%modulus(), of%modulus() > 0)
      if (.not. all(back_to_back(deck%setup%plate%gauges) > 0)) return
      call results%add('percent_bending', of%bending)
      call results%add('buckling_strain', of%buckling, of%buckling > 0)
    end associate
  end subroutine add_compression
end module summary_results
