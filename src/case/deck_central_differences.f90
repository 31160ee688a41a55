!> Defaults for central differences: end, factor of in-plane and rotary inertia, rows of the history, and the stable
!> step.
module deck_central_differences
  use central_difference_parameters, only: central_difference_parameters_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: report
  use element_steps, only: smallest_element_step
  use explicit_costs, only: expected_steps
  use impact_parameters, only: integrator_central
  use impactor_deck, only: impactor_group, key_integrator
  use kinds, only: wp
  use element_deck, only: key_mass
  use mesh_deck, only: mesh_group
  use output_deck, only: output_group, key_history_every
  use elastic_impacts, only: elastic_impact_t
  use plate_options, only: mass_lumped
  use scaled_impacts, only: largest_scaling, scaled_impact_t
  use setup_elastic_impacts, only: contact_end, start_elastic_impact
  use setup_scales, only: scales_of, setup_scales_t
  use short_numbers, only: short_text
  use shortest_cells, only: check_narrow_cells, shortest_cell_text
  use stepping_parameters, only: past_contact
  use text, only: append, counted, to_text
  use time_deck, only: key_end, key_mass_scaling, key_settle, key_step, max_steps, &
                       time_group
  implicit none
  private
  public :: choose_for_central_differences, choose_rows, find_stable_step

  !> Largest factor of in-plane and rotary inertia that is chosen. It also slows membrane waves by its root, which no
  !> estimate covers: with 10 they cross the plate in 3.2 times the time.
  real(wp), parameter :: max_scaling = 10
  !> Permitted relative change of bending wave speed and contact force history (L2 norm) in first contact by scaled
  !> inertia. Half of the 1 % permitted with `accuracy='reference'`; mesh and step have the other half.
  real(wp), parameter :: permitted_change = 0.005_wp
  !> Approximate number of rows of a history, enough for a plot. They are written at the ends of steps, which are not
  !> shortened for them.
  real(wp), parameter :: rows = 2000
  !> Longest step over the rise time of the force of first contact, with the default `step_factor`: 15 steps in a
  !> contact. The energy of a mass on Hertz' spring is then within 1 % in all steps, and its rebound velocity within .1
  !> %. The stable step alone allows 3 steps in a contact, in which the mass gains 12 % of energy (`ctest -R extremes`).
  real(wp), parameter :: part_of_rise = 2/15.0_wp

contains

  !> Chooses end and scaling from the setup, then the values that depend on the step.
  subroutine choose_for_central_differences(deck, problems)
    !> The deck, its bodies and loads filled
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    type(setup_scales_t) :: scales

    if (.not. deck%settings%is_given(mesh_group, key_mass)) &
      call deck%settings%derive(mesh_group, key_mass, 'lumped', .true.)
    deck%setup%mesh%mass = mass_lumped
    if (.not. deck%settings%is_given(impactor_group, key_integrator)) then
      call deck%settings%derive(impactor_group, key_integrator, 'central', .true.)
      deck%setup%impactor%integrator = integrator_central
    end if
    if (problems%errors() > 0) return
    scales = scales_of(deck%setup)
    if (.not. deck%settings%is_given(time_group, key_end)) call choose_end(deck, scales, problems)
    if (.not. deck%settings%is_given(time_group, key_mass_scaling)) call choose_scaling(deck, scales)
  end subroutine choose_for_central_differences

  !> End of the run: that of the contact of an undamaged plate, and a margin. The contact of a damaged plate lasts
  !> longer by an unknown time; the run continues until the impactor has left.
  subroutine choose_end(deck, scales, problems)
    type(deck_t), intent(inout) :: deck
    type(setup_scales_t), intent(in) :: scales
    type(problems_t), intent(inout) :: problems
    type(elastic_impact_t) :: elastic
    real(wp) :: end

    deck%stepping%time%extends_to_contact_end = .true.
    if (deck%settings%is_known(time_group, key_end)) return
    if (.not. (deck%setup%is_impact() .and. scales%area_mass > 0)) then
      if (.not. problems%concern(time_group, key_end)) &
        call problems%error(deck%settings%line_of_group(time_group), time_group, key_end, '&'//time_group//' '// &
                            key_end//' is missing; it follows from the contact only where an impactor comes with a '// &
                            'velocity.', 1)
      return
    end if
    elastic = contact_end(start_elastic_impact(deck%setup, scales), 0.0_wp)
    end = past_contact*elastic%last_contact
    ! A plate from another run comes to rest before it is struck.
    if (deck%setup%initial%is_inherited) end = end + deck%settings%real_of(time_group, key_settle)
    call deck%settings%derive(time_group, key_end, short_text(end), .false.)
    call append(deck%reasons, 'End '//short_text(end)//': the contact of an '// &
                'undamaged plate ends at '//short_text(elastic%last_contact)//' in a preliminary elastic impact; '// &
                'the run continues while it lasts longer.')
  end subroutine choose_end

  !> Factor of in-plane and rotary inertia permitted by the waves of first contact.
  subroutine choose_scaling(deck, scales)
    type(deck_t), intent(inout) :: deck
    type(setup_scales_t), intent(in) :: scales
    type(scaled_impact_t) :: chosen

    if (scales%wave_length > 0) then
      chosen = largest_scaling(deck%setup, scales, max_scaling, permitted_change)
      call append(deck%reasons, 'Mass scaling '//short_text(chosen%scaling)//': it slows the bending waves of '// &
                  'first contact, '//short_text(scales%wave_length)//' long, by '//short_text(100*chosen%slowed)// &
                  ' %, and changes the force history of a preliminary elastic impact by '// &
                  short_text(100*chosen%change)//' %.')
    else
      call append(deck%reasons, 'Mass scaling 1: without an impact the length of the waves is not known.')
    end if
    call deck%settings%derive(time_group, key_mass_scaling, short_text(chosen%scaling), .false.)
  end subroutine choose_scaling

  !> Finds the stable step for preliminary elastic impacts and costs; the run computes its own.
  subroutine find_stable_step(deck, problems)
    !> The deck, its mesh checked; receives the step
    type(deck_t), intent(inout) :: deck
    !> Faults so far; one is added if there are too many steps
    type(problems_t), intent(inout) :: problems
    real(wp) :: step

    if (problems%errors() > 0) return
    step = deck%stepping%central%step_factor*smallest_element_step(deck)
    if (.not. step > 0) return
    call limit_by_contact(deck, step)
    if (deck%stepping%time%end > max_steps*step) then
      call report(deck%settings, problems, time_group, key_end, 'takes more than '//to_text(max_steps)//' stable '// &
                  'steps of '//short_text(step)//'; allowed: up to '//short_text(max_steps*step)// &
                  ', or longer cells than '//shortest_cell_text(deck)//'.')
      return
    end if
    associate (time => deck%stepping%time)
      if (time%step > step) call append(deck%reasons, 'Steps of '//short_text(step)//' instead of '// &
                                        short_text(time%step)//': longer steps are not stable.')
      if (.not. time%step > 0 .or. time%step > step) time%step = min(step, time%end)
    end associate
    if (.not. deck%settings%is_given(time_group, key_step)) &
      call deck%settings%derive(time_group, key_step, short_text(step), .false.)
    call check_narrow_cells(deck, problems)
  end subroutine find_stable_step

  !> Chooses the number of steps between rows of the history by the steps that are expected in the run.
  subroutine choose_rows(deck)
    !> The deck, its expected results known
    type(deck_t), intent(inout) :: deck

    if (deck%settings%is_given(output_group, key_history_every) .or. .not. deck%stepping%time%step > 0) return
    deck%output%steps_between_rows = max(1, nint(expected_steps(deck)/rows))
    call append(deck%reasons, 'A row of the history every '// &
                counted(to_text(deck%output%steps_between_rows), 'step')//'; peaks are found from every step.')
  end subroutine choose_rows

  !> Shortens the step for the contact of an impactor so light that the force rises faster than the waves of the plate.
  !> The stable step allows for the contact stiffness so far, which is zero before the first step by Hertz' law.
  !> `step_factor` reduces this step as it does the stable one.
  subroutine limit_by_contact(deck, step)
    !> The deck; receives its longest step where the contact decides
    type(deck_t), intent(inout) :: deck
    !> Step of the plate; shortened where the contact decides
    real(wp), intent(inout) :: step
    type(setup_scales_t) :: scales
    type(central_difference_parameters_t) :: usual
    real(wp) :: longest

    scales = scales_of(deck%setup)
    longest = part_of_rise*scales%contact_time*(deck%stepping%central%step_factor/usual%step_factor)
    if (.not. (longest > 0 .and. longest < step)) return
    step = longest
    if (deck%stepping%central%longest > 0) step = min(step, deck%stepping%central%longest)
    deck%stepping%central%longest = step
    call append(deck%reasons, 'Steps of '//short_text(step)//': the force of first contact rises within '// &
                short_text(scales%contact_time)//'.')
  end subroutine limit_by_contact
end module deck_central_differences
