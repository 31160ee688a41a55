!> Checks of a deck that starts from the end of another run: whether it can, and whether the plate is the same.
module deck_initial_states
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use deck_comparisons, only: both, differ, list_objection, material_objection, short_list
  use deck_contents, only: deck_t
  use deck_plate_cuts, only: cut_objection, has_same_length, moved_centre
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, report
  use deck_zones, only: zones_objection => zone_objection
  use delamination_deck, only: key_starter, key_zone
  use delamination_parameters, only: delamination_t, law_names, law_of
  use initial_state_deck, only: initial_state_group
  use interface_places, only: delamination_group
  use kinds, only: wp
  use laminate_parameters, only: shear_energy
  use line_deck, only: line_group, key_rise
  use mesh_parameters, only: is_halved, symmetry_none
  use plate_deck, only: key_symmetry, plate_group
  use plate_options, only: kinematics_linear
  use ply_damage_deck, only: key_seed, ply_damage_group
  use ply_damage_parameters, only: damage_names, numbers_of
  use roundings, only: rounding
  use static_deck, only: static_group
  use stepping_parameters, only: is_explicit
  use support_deck, only: support_group, key_unilateral
  use stringers, only: differ_at
  use text, only: to_text
  use time_deck, only: key_settle, time_group
  implicit none
  private
  public :: check_initial_state, has_same_contact, inheritance_objection, is_mapped

contains

  !> Refuses features that are not possible in a run from the end of another run.
  subroutine check_initial_state(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: place

    associate (s => deck%settings)
      if (deck%setup%loading%start > 0 .and. .not. deck%setup%loading%start < deck%stepping%time%end .and. &
          are_clear(s, problems, time_group, key_settle//' end')) &
        call report(s, problems, time_group, key_settle, 'leaves no time for the load; allowed: less than end = '// &
                  to_text(deck%stepping%time%end)//'.')
      if (.not. deck%setup%initial%is_inherited) return
      if (deck%setup%is_static()) then
        call report(s, problems, static_group, '', &
                    'load steps cannot start from a state of another run; give &time '// &
                  'with integrator = ''central_difference'', or leave &initial_state out.')
      else if (deck%has_time .and. .not. is_explicit(deck%stepping)) then
        call report(s, problems, initial_state_group, '', 'requires &time integrator = ''central_difference''.')
      end if
      do place = 1, size(deck%setup%lines)
        if (deck%setup%lines(place)%precedes()) call report(s, problems, line_group, key_rise, &
                                                      'a line that has moved the '// &
          'plate before the run cannot be combined with &initial_state; give it a rise > 0.', place)
      end do
      do place = 1, size(deck%setup%supports)
        if (deck%setup%supports(place)%unilateral .and. .not. deck%setup%impactor%is_present) &
          call report(s, problems, support_group, key_unilateral, 'a frame closes on both faces of a plate from '// &
                    '&initial_state; allowed: .false., or an &impactor.', place)
      end do
    end associate
  end subroutine check_initial_state

  !> First contradiction between a deck and that of its initial state: one sentence with both values, or an empty text.
  function inheritance_objection(deck, old) result(objection)
    !> The deck, and that of the other run with the zones at its end
    type(deck_t), intent(in) :: deck, old
    character(len=:), allocatable :: objection

    objection = ''
    if (deck%setup%mesh%kinematics /= old%setup%mesh%kinematics) then
      associate (mine => deck%setup%mesh%kinematics, its => old%setup%mesh%kinematics)
        objection = both('&case kinematics', &
                         trim(merge('''linear''    ', '''von_karman''', mine == kinematics_linear)), &
                         trim(merge('''linear''    ', '''von_karman''', its == kinematics_linear)))
      end associate
    else if (.not. has_same_length(deck, old) .or. any(abs(deck%setup%initial%cut_at) > 0)) then
      objection = cut_objection(deck, old)
    end if
    if (objection /= '') return
    associate (mine => deck%setup%plate, its => old%setup%plate)
      if (differ(mine%imperfection, its%imperfection)) then
        objection = both('&plate imperfection', to_text(mine%imperfection), to_text(its%imperfection))
      else if (abs(mine%imperfection) > 0 .and. any(mine%half_waves /= its%half_waves)) then
        objection = both('&plate half_waves', short_list(real(mine%half_waves, wp)), &
                         short_list(real(its%half_waves, wp)))
      else if (any(differ(mine%curvature_radius, its%curvature_radius))) then
        objection = both('&plate curvature_radius', short_list(mine%curvature_radius), short_list(its%curvature_radius))
      else if (mine%symmetry /= its%symmetry .and. mine%symmetry /= symmetry_none) then
        objection = both(key_symmetry, value_in(deck, plate_group, key_symmetry, 0.0_wp), &
                         value_in(old, plate_group, key_symmetry, 0.0_wp))//'; allowed: the same, or ''none'''
      end if
    end associate
    if (objection /= '') return
    associate (mine => deck%setup%thermal%temperature_change, its => old%setup%thermal%temperature_change)
      if (differ(mine, its)) objection = both('&thermal delta_T', to_text(mine), to_text(its))
    end associate
    if (objection == '') objection = laminate_objection(deck, old)
    if (objection == '') objection = zones_objection(deck, old)
    if (objection == '') objection = stringer_objection(deck, old)
    if (objection == '') objection = damage_objection(deck, old)
    if (objection == '' .and. deck%setup%ply_damage%scatters() .and. any(abs(old%setup%initial%cut_at) > 0)) &
      objection = 'its plate was cut from another one off the centre, so that the places of strengths that scatter '// &
                  '(&ply_damage '//key_seed//') are not known'
    if (objection == '') objection = interface_objection(deck, old)
    if (objection == '' .and. is_mapped(deck, old) .and. deck%setup%ply_damage%is_present .and. &
        .not. deck%setup%has_crack_bands()) &
      objection = 'its mesh differs, and plies without fracture energies (&material G_ft, G_fc, G_mt, G_mc) fail '// &
                  'at once, so that their state cannot be averaged; give '// &
                  trim(merge('the same &mesh in both decks', 'these energies              ', &
                             has_same_length(deck, old)))
  end function inheritance_objection

  !> True if the meshes differ, so that the state is mapped.
  pure logical function is_mapped(deck, old)
    type(deck_t), intent(in) :: deck, old

    is_mapped = .not. (has_same_lines(deck, old, 1) .and. has_same_lines(deck, old, 2))
  end function is_mapped

  !> True if the impactor strikes where that of the other run did, with the same indentation law and nose, so that the
  !> dent is known.
  pure logical function has_same_contact(deck, old) result(same)
    type(deck_t), intent(in) :: deck, old

    same = deck%setup%impactor%is_present .and. old%setup%impactor%is_present
    if (.not. same) return
    associate (mine => deck%setup%impactor%indentation, its => old%setup%impactor%indentation)
      same = mine%law == its%law .and. mine%dent == its%dent .and. &
             .not. any(differ([mine%k, mine%q, mine%reload, mine%beta, mine%alpha_critical], &
                              [its%k, its%q, its%reload, its%beta, its%alpha_critical])) .and. &
             .not. differ(deck%setup%impactor%radius, old%setup%impactor%radius) .and. &
             all(moved_centre(deck, old) <= rounding*deck%setup%plate%length)
    end associate
  end function has_same_contact

  !> First difference of stringers. They are not cut.
  pure function stringer_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection
    integer :: first

    objection = ''
    if (size(deck%setup%stringers) + size(old%setup%stringers) == 0) return
    if (.not. has_same_length(deck, old)) then
      objection = 'the plates differ in size, and a plate with stringers is not cut; allowed: the same &plate length'
      return
    end if
    first = differ_at(deck%setup%stringers, old%setup%stringers)
    if (first == 0) return
    if (size(deck%setup%stringers) /= size(old%setup%stringers)) then
      objection = both('the number of &stringer', to_text(size(deck%setup%stringers)), &
                       to_text(size(old%setup%stringers)))
    else
      objection = 'stringer '//to_text(first)//' differs in place or section'
    end if
  end function stringer_objection

  !> First difference of plies and materials.
  function laminate_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection

    associate (mine => deck%setup%laminate, its => old%setup%laminate)
      objection = list_objection('&laminate angles', mine%angle, its%angle)
      if (objection == '') objection = list_objection('&laminate thicknesses', mine%thickness, its%thickness)
      if (objection == '') objection = material_objection(deck, old, mine%material, its%material, '')
      if (objection == '' .and. mine%shear_correction /= its%shear_correction) &
        objection = both('&laminate shear_correction', &
                         trim(merge('''energy''', '''5/6''   ', mine%shear_correction == shear_energy)), &
                         trim(merge('''energy''', '''5/6''   ', its%shear_correction == shear_energy)))
    end associate
  end function laminate_objection

  !> First difference of ply damage.
  function damage_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection
    real(wp) :: here(size(damage_names)), there(size(damage_names))
    integer :: i

    objection = ''
    if (deck%setup%ply_damage%is_present .neqv. old%setup%ply_damage%is_present) &
      objection = both('&ply_damage', trim(merge('given   ', 'left out', deck%setup%ply_damage%is_present)), &
                       trim(merge('given   ', 'left out', old%setup%ply_damage%is_present)))
    if (objection /= '' .or. .not. deck%setup%ply_damage%is_present) return
    here = numbers_of(deck%setup%ply_damage)
    there = numbers_of(old%setup%ply_damage)
    i = findloc(differ(here, there), .true., dim=1)
    if (i > 0) objection = both('&ply_damage '//trim(damage_names(i)), &
                                value_in(deck, ply_damage_group, trim(damage_names(i)), here(i)), &
                                value_in(old, ply_damage_group, trim(damage_names(i)), there(i)))
  end function damage_objection

  !> First difference of interfaces.
  function interface_objection(deck, old) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> One clause; empty: no difference
    character(len=:), allocatable :: objection
    real(wp) :: here(size(law_names)), there(size(law_names))
    integer :: i, k

    associate (mine => deck%setup%delaminations, its => old%setup%delaminations)
      objection = list_objection('interfaces below plies', real(mine%below_ply, wp), real(its%below_ply, wp))
      if (objection /= '') return
      do i = 1, size(mine)
        here = law_of(mine(i))
        there = law_of(its(i))
        k = findloc(differ(here, there), .true., dim=1)
        if (k > 0) then
          objection = both('&delamination '//trim(law_names(k))//' below ply '//to_text(mine(i)%below_ply), &
                           value_in(deck, delamination_group, trim(law_names(k)), here(k), mine(i)%group), &
                           value_in(old, delamination_group, trim(law_names(k)), there(k), its(i)%group))
        else if (has_other_starter(mine(i), its(i))) then
          objection = both('&delamination '//key_starter//' below ply '//to_text(mine(i)%below_ply), &
                           starter_list(mine(i)), starter_list(its(i)))//'; allowed: the same, or none'
        else if (.not. (mine(i)%is_adaptive .or. mine(i)%bonds_doublers())) then
          objection = zone_objection(deck, old, mine(i), its(i))
        end if
        if (objection /= '') return
      end do
    end associate
  end function interface_objection

  !> Objection to a fixed zone that does not contain that of the other run; each zone is centred on the point that is
  !> struck in its own run.
  function zone_objection(deck, old, mine, its) result(objection)
    type(deck_t), intent(in) :: deck, old
    !> The interface, and that of the other run
    type(delamination_t), intent(in) :: mine, its
    !> One clause; empty: none
    character(len=:), allocatable :: objection
    real(wp) :: needed(2)

    objection = ''
    needed = min(its%zone + 2*moved_centre(deck, old), max(its%zone, old%setup%plate%length))
    if (.not. has_same_length(deck, old)) needed = min(needed, deck%setup%plate%length)
    if (.not. any(mine%zone < needed*(1 - rounding))) return
    objection = both('&delamination '//key_zone//' below ply '//to_text(mine%below_ply), short_list(mine%zone), &
                     short_list(its%zone))
    if (any(differ(deck%setup%initial%cut_at + deck%setup%mesh%struck, old%setup%mesh%struck))) &
      objection = objection//', centred on '//short_list(deck%setup%initial%cut_at + deck%setup%mesh%struck)// &
                  ' and '// short_list(old%setup%mesh%struck)
    objection = objection//'; allowed: '//short_list(needed)//' or larger'
  end function zone_objection

  !> True for a starter that the other run did not have: damage is inherited, so that it would have no effect.
  pure logical function has_other_starter(mine, its)
    !> The interface, and that of the other run
    type(delamination_t), intent(in) :: mine, its

    has_other_starter = .false.
    if (.not. (mine%starter > 0 .or. mine%has_strip())) return
    has_other_starter = (mine%starter_round .neqv. its%starter_round) .or. &
                        any(differ([mine%starter, mine%starter_at, mine%starter_strip], &
                                   [its%starter, its%starter_at, its%starter_strip]))
  end function has_other_starter

  !> A starter as text.
  pure function starter_list(delamination) result(list)
    type(delamination_t), intent(in) :: delamination
    !> Its numbers and shape, or none
    character(len=:), allocatable :: list

    list = 'none'
    if (delamination%has_strip()) then
      list = short_list(delamination%starter_strip)
    else if (delamination%starter > 0) then
      list = short_list([delamination%starter])//trim(merge(' round ', ' square', delamination%starter_round))// &
             ' at '//short_list(delamination%starter_at)
    end if
  end function starter_list

  !> True if the mesh has the same lines along one direction.
  pure logical function has_same_lines(deck, old, direction) result(same)
    type(deck_t), intent(in) :: deck, old
    !> 1: along x, 2: along y
    integer, intent(in) :: direction
    type(cell_line_t) :: here, there
    logical :: halved(2), halved_before(2)

    here = cells_along(deck%setup%plate, deck%setup%mesh, direction)
    there = cells_along(old%setup%plate, old%setup%mesh, direction)
    halved = is_halved(deck%setup%plate%symmetry)
    halved_before = is_halved(old%setup%plate%symmetry)
    if (halved_before(direction) .and. .not. halved(direction)) there = there%with_image()
    same = here%is_equal(there, rounding*deck%setup%plate%length(direction))
  end function has_same_lines

  !> A value as a deck has it: a word of a choice, a logical value, or a number.
  function value_in(deck, group, key, number, place) result(shown)
    type(deck_t), intent(in) :: deck
    !> Group and key
    character(len=*), intent(in) :: group, key
    !> The number that stands for it
    real(wp), intent(in) :: number
    integer, intent(in), optional :: place
    !> As text
    character(len=:), allocatable :: shown

    shown = deck%settings%text_of(group, key, place)
    if (scan(shown, 'abcfghijklmnopqrstuvwxyz') == 0) shown = to_text(number)
    if (scan(shown(1:1), 'abcdefghijklmnopqrstuvwxyz') == 1) shown = ''''//shown//''''
  end function value_in
end module deck_initial_states
