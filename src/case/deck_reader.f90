!> Reads a deck: scan, rules, parameters, checks of combinations. All faults are reported, none stops the reading.
module deck_reader
  use adapt_deck, only: adapt_group, fill_adapt
  use case_deck, only: fill_case, fill_accuracy, has_accuracy
  use controls_deck, only: fill_controls
  use deck_accuracy, only: check_left_out, choose_by_accuracy
  use deck_contents, only: deck_t
  use deck_crack_bands, only: check_crack_bands
  use deck_cell_growth, only: check_cell_growth
  use deck_central_differences, only: choose_for_central_differences, find_stable_step
  use deck_cross_checks, only: check_across_groups
  use deck_integrators, only: choose_integrator, needs_lengths
  use deck_initial_states, only: check_initial_state
  use deck_interface_remarks, only: check_interfaces
  use deck_library, only: take_library
  use deck_process_zones, only: check_process_zones, set_flaws
  use deck_extents, only: check_sizes, check_extents
  use deck_force_filters, only: check_force_filter
  use deck_explicit_checks, only: check_central_differences
  use deck_first_zones, only: check_left_out_zones, set_first_zones
  use deck_idle_keys, only: check_idle_keys
  use deck_mesh_lines, only: place_mesh_lines
  use deck_problems, only: problems_t
  use deck_refinements, only: refine
  use deck_rules, only: resolve_settings
  use deck_scales, only: check_scales
  use deck_shear_remarks, only: check_correction
  use deck_slow_motion, only: check_softening_steps
  use deck_scanner, only: scan_t, scan_deck, max_bytes
  use deck_symmetries, only: note_symmetry
  use deck_table, only: load_deck_table
  use deck_units, only: check_units
  use deck_vocabulary, only: vocabulary_t
  use delamination_deck, only: fill_delaminations, check_delaminations
  use interface_places, only: interfaces_between, remark_left_out
  use element_deck, only: fill_kinematics, fill_element
  use errors, only: error_t
  use files, only: read_whole_file
  use gauge_deck, only: check_gauges, fill_gauges
  use impactor_deck, only: fill_impactor, impactor_group, impactor_key_rise => key_rise
  use indentation_deck, only: fill_indentation, check_indentation, indentation_group
  use initial_state_deck, only: fill_initial_state, initial_state_group
  use kinds, only: wp
  use laminate_deck, only: fill_laminate
  use load_cases, only: analysis_by_load_steps
  use line_deck, only: fill_lines, check_lines
  use delamination_parameters, only: law_cohesive, law_front
  use solver_deck, only: check_petsc_options, fill_equilibrium, fill_linear_solver
  use material_deck, only: fill_materials
  use material_parameters, only: first_alike
  use mesh_deck, only: fill_mesh, check_mesh
  use output_deck, only: fill_output
  use plate_deck, only: fill_plate, check_plate
  use ply_zones, only: ply_zones_t
  use ply_damage_deck, only: fill_ply_damage, ply_damage_group
  use pressure_deck, only: fill_pressure, check_pressure, pressure_group
  use static_deck, only: fill_static, static_group
  use stringer_deck, only: check_stringers, fill_stringers
  use stepping_parameters, only: is_error_controlled, is_explicit
  use support_deck, only: fill_supports, check_rigs
  use deck_struck_faces, only: check_struck_face, struck_face_of
  use thermal_deck, only: fill_thermal, check_thermal, thermal_group
  use time_deck, only: fill_time, check_time, time_group
  use unit_systems, only: units_in_metre
  use zone_deck, only: check_zones, doubler_group, fill_zones, ply_drop_group
  implicit none
  private
  public :: deck_t, problems_t, read_deck, read_deck_text

  !> Default rise of a travel, relative to the run, after which the velocity is constant: 8/7 of the mean velocity.
  real(wp), parameter :: usual_rise = 0.25_wp

contains

  !> Reads a deck from a file.
  subroutine read_deck(path, deck, problems)
    !> Path of the file
    character(len=*), intent(in) :: path
    !> The deck, valid if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    type(error_t), allocatable :: error
    character(len=:), allocatable :: content

    call read_whole_file(path, max_bytes, content, error)
    if (allocated(error)) then
      call problems%begin(path)
      call problems%cannot_read(error%message)
      deck%source = path
      deck%text = ''
    else
      call read_deck_text(content, path, deck, problems)
    end if
  end subroutine read_deck

  !> Reads a deck from a text.
  subroutine read_deck_text(content, source, deck, problems)
    !> Text of the deck
    character(len=*), intent(in) :: content
    !> Path or name that messages begin with
    character(len=*), intent(in) :: source
    !> The deck, valid if there are no errors among the problems
    type(deck_t), intent(out) :: deck
    type(problems_t), intent(out) :: problems
    type(vocabulary_t) :: vocabulary
    type(scan_t) :: scan

    deck%source = source
    deck%text = content
    call problems%begin(source)
    call load_deck_table(vocabulary)
    call scan_deck(content, scan, problems)
    if (size(scan%blocks) == 0 .or. problems%is_full()) return
    call resolve_settings(scan, vocabulary, deck%settings, problems)
    if (problems%is_full()) return
    call take_library(deck%settings, problems)
    call note_groups(deck)
    call fill_model(deck, problems)
    call choose_integrator(deck)
    call check_left_out(deck%settings, needs_lengths(deck, problems), problems)
    call fill_loads(deck, problems)
    call fill_steps(deck)
    call refine(deck)
    call place_mesh_lines(deck, problems)
    call check_groups(deck, problems)
    call check_sizes(deck, problems)
    call check_across_groups(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call check_central_differences(deck, problems)
    call check_initial_state(deck, problems)
    call check_idle_keys(deck, vocabulary, problems)
    call check_left_out_zones(deck, problems)
    call set_first_zones(deck, problems)
    call check_extents(deck, problems)
    if (problems%errors() == 0) call check_cell_growth(deck, problems)
    call check_interfaces(deck, problems)
    call check_correction(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call find_stable_step(deck, problems)
    call check_force_filter(deck, problems)
    if (deck%has_ply_damage) call check_crack_bands(deck, problems)
    call check_process_zones(deck, problems)
    call set_flaws(deck, problems)
    call check_scales(deck, problems)
    call check_softening_steps(deck, problems)
    call check_units(deck, problems)
    if (problems%errors() == 0) call note_symmetry(deck)
    deck%remarks = problems%remarks()
  end subroutine read_deck_text

  !> Finds the groups of the deck that define physics or a kind of analysis.
  subroutine note_groups(deck)
    type(deck_t), intent(inout) :: deck

    deck%has_impactor = deck%settings%has_group(impactor_group)
    deck%has_indentation = deck%settings%has_group(indentation_group)
    deck%has_pressure = deck%settings%has_group(pressure_group)
    deck%has_thermal = deck%settings%has_group(thermal_group)
    if (deck%settings%has_group(static_group)) deck%analysis = analysis_by_load_steps
    deck%initial%is_inherited = deck%settings%has_group(initial_state_group)
    deck%has_ply_damage = deck%settings%has_group(ply_damage_group)
    deck%has_time = deck%settings%has_group(time_group) .or. &
                    has_accuracy(deck%settings) .and. .not. deck%is_static()
    if (.not. deck%has_time) call deck%settings%set_aside(time_group)
    deck%has_adapt = deck%settings%has_group(adapt_group)
  end subroutine note_groups

  !> Case, plate, mesh, materials, plies and interfaces.
  subroutine fill_model(deck, problems)
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems

    call fill_case(deck%settings, deck%source, deck%name, deck%title)
    call fill_accuracy(deck%settings, deck%accuracy, deck%units, deck%strict, deck%refine)
    call fill_kinematics(deck%settings, deck%kinematics)
    call fill_plate(deck%settings, deck%plate)
    call fill_supports(deck%settings, deck%supports)
    call fill_stringers(deck%settings, deck%plate%length, deck%stringers)
    call fill_mesh(deck%settings, deck%mesh)
    call fill_element(deck%settings, deck%mesh%shear, deck%mesh%mass)
    call fill_materials(deck%settings, deck%materials, problems)
    call fill_laminate(deck%settings, deck%materials, deck%laminate, problems)
    call fill_zones(deck%settings, deck%materials, deck%zones, problems)
    call check_zones(deck%settings, deck%zones, plies_of_laminate(deck), deck%plate%length, problems)
    ! Checks that follow are those of the plate without invalid zones.
    if (problems%concern(doubler_group) .or. problems%concern(ply_drop_group)) deck%zones = ply_zones_t()
    call fill_ply_damage(deck%settings, units_in_metre(deck%units), deck%ply_damage)
    call fill_delaminations(deck%settings, deck%plate%length, ply_strengths(deck, skin_materials(deck)), &
                            ply_strengths(deck, deck%zones%material()), changes_of_angle(deck), deck%zones, &
                            deck%delaminations)
  end subroutine fill_model

  !> Plies below which the angle or the material changes.
  pure function changes_of_angle(deck) result(between)
    !> The deck with its plies; without, the list is empty
    type(deck_t), intent(in) :: deck
    !> Plies, ascending
    integer, allocatable :: between(:)
    integer :: ply

    allocate (between(0))
    if (allocated(deck%laminate%angle) .and. allocated(deck%laminate%material)) &
      between = interfaces_between(deck%laminate%angle, [(first_alike(deck%materials, deck%laminate%material(ply)), &
                                                          ply=1, size(deck%laminate%material))])
  end function changes_of_angle

  !> Number of plies of the laminate; 0: it is not valid.
  pure integer function plies_of_laminate(deck) result(plies)
    type(deck_t), intent(in) :: deck

    plies = 0
    if (allocated(deck%laminate%material)) plies = size(deck%laminate%material)
  end function plies_of_laminate

  !> Materials of the plies of the laminate; none if it is not valid.
  pure function skin_materials(deck) result(material)
    type(deck_t), intent(in) :: deck
    !> Their indices
    integer, allocatable :: material(:)

    allocate (material(0))
    if (allocated(deck%laminate%material)) material = deck%laminate%material
  end function skin_materials

  !> Strengths of the plies that are defaults of their interfaces.
  pure function ply_strengths(deck, material) result(strengths)
    type(deck_t), intent(in) :: deck
    !> Materials of the plies
    integer, intent(in) :: material(:)
    !> Strengths YT and S12 of each ply, 0 where not given, (2, plies)
    real(wp), allocatable :: strengths(:, :)
    integer :: ply

    strengths = reshape([([deck%materials(material(ply))%yt, deck%materials(material(ply))%s12], &
                          ply=1, size(material))], [2, size(material)])
  end function ply_strengths

  !> Impactor, indentation, time, pressure and load steps of the deck; values by `accuracy` are chosen before others
  !> that depend on them.
  subroutine fill_loads(deck, problems)
    type(deck_t), intent(inout) :: deck
    !> Faults so far; faults found are added
    type(problems_t), intent(inout) :: problems

    call fill_impactor(deck%settings, deck%impactor, problems)
    if (deck%has_impactor) deck%mesh%struck = deck%impactor%at
    if (deck%has_impactor) &
      call fill_indentation(deck%settings, deck%contact_radius(), struck_face_of(deck), deck%indentation)
    if (deck%accuracy > 0) call choose_by_accuracy(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call choose_for_central_differences(deck, problems)
    call fill_adapt(deck%settings, deck%stepping%adapt)
    if (deck%has_time) call fill_time(deck%settings, natural_rho_infinity(deck), &
                                      is_error_controlled(deck%stepping%adapt), &
                                      deck%stepping%time, deck%stepping%central)
    ! Without &adapt every step has the same length.
    if (.not. deck%stepping%adapt%on) deck%stepping%time%step_max = deck%stepping%time%step
    if (deck%impactor%travel > 0 .and. deck%has_time .and. &
        .not. deck%settings%is_given(impactor_group, impactor_key_rise)) &
      deck%impactor%rise = usual_rise*deck%stepping%time%end
    call fill_pressure(deck%settings, deck%stepping%time%end, deck%pressure)
    if (deck%has_thermal) call fill_thermal(deck%settings, deck%temperature_change)
    call fill_initial_state(deck%settings, deck%initial)
    ! An impactor with a given travel does not leave the plate, so that the run is not extended until the contact ends.
    if (deck%impactor%travel > 0) deck%stepping%central%settle = 0
    if (deck%initial%is_inherited .or. .not. deck%has_impactor) deck%load_start = deck%stepping%central%settle
    if (deck%has_time) deck%ramp_time = deck%stepping%time%end - deck%load_start
    call fill_lines(deck%settings, merge(deck%ramp_time, 0.0_wp, deck%has_time), deck%lines)
    if (deck%is_static()) call fill_static(deck%settings, deck%static)
  end subroutine fill_loads

  !> Default spectral radius at high frequency: released ties excite the highest frequencies of the mesh, softening laws
  !> excite them less. With these values the area in doc/studies/accuracy.md is the same at steps of 16, 8 and 4 us.
  pure real(wp) function natural_rho_infinity(deck) result(rho_infinity)
    !> The deck, its interfaces filled
    type(deck_t), intent(in) :: deck

    rho_infinity = 1
    if (any(deck%delaminations%law == law_cohesive)) rho_infinity = 0.5_wp
    if (any(deck%delaminations%law == law_front)) rho_infinity = 0
  end function natural_rho_infinity

  !> Parameters of steps and output.
  subroutine fill_steps(deck)
    type(deck_t), intent(inout) :: deck

    call fill_equilibrium(deck%settings, deck%stepping%equilibrium)
    call fill_controls(deck%settings, deck%stepping)
    call fill_linear_solver(deck%settings, deck%linear_solver)
    call fill_output(deck%settings, deck%output)
    call fill_gauges(deck%settings, deck%gauges)
  end subroutine fill_steps

  !> Checks of each group.
  subroutine check_groups(deck, problems)
    type(deck_t), intent(in) :: deck
    !> Faults and remarks are added
    type(problems_t), intent(inout) :: problems

    call check_plate(deck%settings, deck%plate, problems)
    call check_rigs(deck%settings, deck%plate, deck%supports, problems)
    call check_mesh(deck%settings, deck%mesh, problems)
    call check_stringers(deck%settings, deck%plate%length, deck%has_thermal, deck%stringers, problems)
    call check_delaminations(deck%settings, deck%zones, deck%delaminations, problems)
    if (allocated(deck%laminate%angle)) &
      call remark_left_out(deck%settings, size(deck%laminate%angle), changes_of_angle(deck), problems)
    call check_struck_face(deck, problems)
    if (deck%has_impactor .and. deck%has_indentation) call check_indentation(deck%settings, deck%indentation, problems)
    if (deck%has_pressure) call check_pressure(deck%settings, deck%pressure, problems)
    if (deck%has_thermal) call check_thermal(deck%settings, deck%materials, problems)
    call check_lines(deck%settings, deck%lines, problems)
    call check_gauges(deck%settings, deck%plate%length, deck%gauges, problems)
    if (deck%has_time) call check_time(deck%settings, deck%stepping%time, problems)
    call check_petsc_options(deck%settings, deck%linear_solver, problems)
  end subroutine check_groups
end module deck_reader
