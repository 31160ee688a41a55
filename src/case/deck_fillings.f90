!> Parameters of a deck from its keys in effect, group by group.
module deck_fillings
  use adapt_deck, only: adapt_group, fill_adapt
  use case_deck, only: has_accuracy, fill_case
  use controls_deck, only: fill_controls
  use deck_accuracy, only: choose_by_accuracy
  use deck_central_differences, only: choose_for_central_differences
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_struck_faces, only: struck_face_of
  use delamination_deck, only: fill_delaminations
  use delamination_parameters, only: law_cohesive, law_front
  use element_deck, only: fill_kinematics, fill_element
  use gauge_deck, only: fill_gauges
  use impactor_deck, only: impactor_group, fill_impactor, impactor_key_rise => key_rise
  use indentation_deck, only: indentation_group, fill_indentation
  use initial_state_deck, only: initial_state_group, fill_initial_state
  use interface_places, only: interfaces_between
  use kinds, only: wp
  use laminate_deck, only: fill_laminate
  use line_deck, only: fill_lines
  use material_deck, only: fill_materials
  use material_parameters, only: first_alike
  use mesh_deck, only: fill_mesh
  use output_deck, only: fill_output
  use plate_deck, only: fill_plate
  use ply_damage_deck, only: ply_damage_group, fill_ply_damage
  use ply_zones, only: ply_zones_t
  use pressure_deck, only: pressure_group, fill_pressure
  use solver_deck, only: fill_equilibrium, fill_linear_solver
  use static_deck, only: static_group, fill_static
  use stepping_parameters, only: is_explicit, is_error_controlled
  use stringer_deck, only: fill_stringers
  use support_deck, only: fill_supports
  use thermal_deck, only: thermal_group, fill_thermal
  use time_deck, only: time_group, fill_time
  use unit_systems, only: units_in_metre
  use zone_deck, only: check_zones, doubler_group, fill_zones, ply_drop_group
  implicit none
  private
  public :: changes_of_angle, fill_loads, fill_model, fill_steps, note_groups

  !> Default rise of a travel, relative to the run. The velocity rises smoothly, by half of it in the mean, and is then
  !> constant at 1/(1 - .25/2) = 8/7 of the mean velocity.
  real(wp), parameter :: usual_rise = 0.25_wp

contains

  !> Finds the groups of the deck that define physics or a kind of analysis.
  subroutine note_groups(deck)
    type(deck_t), intent(inout) :: deck

    deck%setup%impactor%is_present = deck%settings%has_group(impactor_group)
    deck%setup%impactor%indentation%is_given = deck%settings%has_group(indentation_group)
    deck%setup%pressure%is_present = deck%settings%has_group(pressure_group)
    deck%setup%thermal%is_present = deck%settings%has_group(thermal_group)
    deck%setup%loading%by_steps = deck%settings%has_group(static_group)
    deck%setup%initial%is_inherited = deck%settings%has_group(initial_state_group)
    deck%setup%ply_damage%is_present = deck%settings%has_group(ply_damage_group)
    deck%has_time = deck%settings%has_group(time_group) .or. &
                    has_accuracy(deck%settings) .and. .not. deck%setup%is_static()
    if (.not. deck%has_time) call deck%settings%set_aside(time_group)
    deck%has_adapt = deck%settings%has_group(adapt_group)
  end subroutine note_groups

  !> Case, plate, mesh, materials, plies and interfaces.
  subroutine fill_model(deck, problems)
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems

    call fill_case(deck%settings, deck%source, deck%case)
    call fill_kinematics(deck%settings, deck%setup%mesh%kinematics)
    call fill_plate(deck%settings, deck%setup%plate)
    call fill_supports(deck%settings, deck%setup%supports)
    call fill_stringers(deck%settings, deck%setup%plate%length, deck%setup%stringers)
    call fill_mesh(deck%settings, deck%setup%mesh)
    call fill_element(deck%settings, deck%setup%mesh%shear, deck%setup%mesh%mass)
    call fill_materials(deck%settings, deck%setup%materials, problems)
    call fill_laminate(deck%settings, deck%setup%materials, deck%setup%laminate, problems)
    call fill_zones(deck%settings, deck%setup%materials, deck%setup%zones, problems)
    call check_zones(deck%settings, deck%setup%zones, size(skin_materials(deck)), deck%setup%plate%length, problems)
    ! Checks that follow are those of the plate without invalid zones.
    if (problems%concern(doubler_group) .or. problems%concern(ply_drop_group)) deck%setup%zones = ply_zones_t()
    call fill_ply_damage(deck%settings, units_in_metre(deck%case%units), deck%setup%ply_damage)
    call fill_delaminations(deck%settings, deck%setup%plate%length, ply_strengths(deck, skin_materials(deck)), &
                            ply_strengths(deck, deck%setup%zones%material()), changes_of_angle(deck), &
                              deck%setup%zones, deck%setup%delaminations)
  end subroutine fill_model

  !> Plies below which the angle or the material changes.
  pure function changes_of_angle(deck) result(between)
    !> The deck with its plies; without, the list is empty
    type(deck_t), intent(in) :: deck
    !> Plies, ascending
    integer, allocatable :: between(:)
    integer :: ply

    allocate (between(0))
    if (allocated(deck%setup%laminate%angle) .and. allocated(deck%setup%laminate%material)) &
      between = interfaces_between(deck%setup%laminate%angle, &
                                   [(first_alike(deck%setup%materials, deck%setup%laminate%material(ply)), &
                                     ply=1, size(deck%setup%laminate%material))])
  end function changes_of_angle

  !> Materials of the plies of the laminate; none if it is not valid.
  pure function skin_materials(deck) result(material)
    type(deck_t), intent(in) :: deck
    integer, allocatable :: material(:)

    allocate (material(0))
    if (allocated(deck%setup%laminate%material)) material = deck%setup%laminate%material
  end function skin_materials

  !> Strengths of the plies that are defaults of their interfaces.
  pure function ply_strengths(deck, material) result(strengths)
    type(deck_t), intent(in) :: deck
    !> Materials of the plies
    integer, intent(in) :: material(:)
    !> Strengths YT and S12 of each ply, 0 where not given, (2, plies)
    real(wp), allocatable :: strengths(:, :)
    integer :: ply

    strengths = reshape([([deck%setup%materials(material(ply))%yt, deck%setup%materials(material(ply))%s12], &
                          ply=1, size(material))], [2, size(material)])
  end function ply_strengths

  !> Impactor, indentation, time, pressure and load steps of the deck; values by `accuracy` are chosen before others
  !> that depend on them.
  subroutine fill_loads(deck, problems)
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    real(wp) :: rho_infinity

    call fill_impactor(deck%settings, deck%setup%impactor, problems)
    if (deck%setup%impactor%is_present) deck%setup%mesh%struck = deck%setup%impactor%at
    if (deck%setup%impactor%is_present) &
      call fill_indentation(deck%settings, deck%setup%contact_radius(), struck_face_of(deck), &
                            deck%setup%impactor%indentation)
    if (deck%case%accuracy > 0) call choose_by_accuracy(deck, problems)
    if (deck%has_time .and. is_explicit(deck%stepping)) call choose_for_central_differences(deck, problems)
    call fill_adapt(deck%settings, deck%stepping%adapt)
    ! Released ties excite the highest frequencies of the mesh, softening laws excite them less. With these spectral
    ! radii at high frequency the area in doc/studies/accuracy.md is the same at steps of 16, 8 and 4 us.
    rho_infinity = 1
    if (any(deck%setup%delaminations%law == law_cohesive)) rho_infinity = 0.5_wp
    if (any(deck%setup%delaminations%law == law_front)) rho_infinity = 0
    if (deck%has_time) call fill_time(deck%settings, rho_infinity, &
                                      is_error_controlled(deck%stepping%adapt), &
                                      deck%stepping%time, deck%stepping%central)
    ! Without &adapt every step has the same length.
    if (.not. deck%stepping%adapt%on) deck%stepping%time%step_max = deck%stepping%time%step
    if (deck%setup%impactor%travel > 0 .and. deck%has_time .and. &
        .not. deck%settings%is_given(impactor_group, impactor_key_rise)) &
      deck%setup%impactor%rise = usual_rise*deck%stepping%time%end
    call fill_pressure(deck%settings, deck%stepping%time%end, deck%setup%pressure)
    if (deck%setup%thermal%is_present) call fill_thermal(deck%settings, deck%setup%thermal%temperature_change)
    call fill_initial_state(deck%settings, deck%setup%initial)
    ! An impactor with a given travel does not leave the plate, so that the run is not extended until the contact ends.
    if (deck%setup%impactor%travel > 0) deck%stepping%central%settle = 0
    if (deck%setup%initial%is_inherited .or. .not. deck%setup%impactor%is_present) &
      deck%setup%loading%start = deck%stepping%central%settle
    if (deck%has_time) deck%setup%loading%ramp_time = deck%stepping%time%end - deck%setup%loading%start
    call fill_lines(deck%settings, merge(deck%setup%loading%ramp_time, 0.0_wp, deck%has_time), deck%setup%lines)
    if (deck%setup%is_static()) call fill_static(deck%settings, deck%setup%loading)
  end subroutine fill_loads

  !> Parameters of steps and output.
  subroutine fill_steps(deck)
    type(deck_t), intent(inout) :: deck

    call fill_equilibrium(deck%settings, deck%stepping%equilibrium)
    call fill_controls(deck%settings, deck%stepping)
    call fill_linear_solver(deck%settings, deck%linear_solver)
    call fill_output(deck%settings, deck%output)
    call fill_gauges(deck%settings, deck%setup%plate%gauges)
  end subroutine fill_steps
end module deck_fillings
