!> Checks of combinations of groups. Checks within a group are next to its rows, those of sizes in `deck_extents`. A
!> check with invalid keys is omitted, so that an error is reported once.
module deck_cross_checks
  use adapt_deck, only: adapt_group
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_integrators, only: softening_part
  use deck_line_supports, only: check_in_plane_balance, check_line_strains, check_line_supports, check_moved_lines
  use deck_symmetries, only: check_symmetry
  use deck_remarks, only: report, remark, are_clear
  use deck_bonds, only: check_bonds_across_groups
  use deck_zones, only: check_zones_across_groups
  use interface_places, only: delamination_group, key_below_ply
  use delamination_parameters, only: interface_objection, law_front
  use failure_criteria, only: needed_strengths
  use larc_criteria, only: larc_objection
  use impactor_deck, only: impactor_group, key_velocity, key_radius, key_at, key_gravity, key_travel, &
                           impactor_key_rise => key_rise, keys_of_motion
  use impact_parameters, only: law_hertz
  use indentation_deck, only: indentation_group, key_k, key_alpha_critical
  use kinds, only: wp
  use laminate_deck, only: laminate_group
  use line_columns, only: has_ends
  use line_deck, only: line_group
  use line_loads, only: line_load_t
  use material_deck, only: key_compressive, material_group, require_densities
  use mesh_deck, only: mesh_group, key_patch
  use output_deck, only: check_intervals, remark_idle_fields
  use plate_deck, only: plate_group, check_edges, key_curvature_radius
  use pressure_deck, only: pressure_group
  use stepping_parameters, only: is_explicit
  use support_deck, only: check_static_rigs, support_group
  use short_numbers, only: short_text
  use static_deck, only: static_group
  use text, only: line_t, append, joined, words_of
  use time_deck, only: key_until, time_group
  implicit none
  private
  public :: check_across_groups

contains

  !> All checks of combinations of groups except for those of sizes.
  subroutine check_across_groups(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    call check_loads(deck, problems)
    if (deck%setup%is_static()) then
      call check_static(deck, problems)
    else
      call check_transient(deck, problems)
    end if
    if (.not. (problems%concern(line_group) .or. problems%concern(support_group) .or. problems%concern(plate_group))) &
      call check_moved_lines(deck, problems)
    call check_line_strains(deck, problems)
    call check_symmetry(deck, problems)
    call check_zones_across_groups(deck, problems)
    call check_bonds_across_groups(deck, problems)
    call check_impact(deck, problems)
    call check_interfaces(deck, problems)
    if (deck%setup%ply_damage%is_present) call check_strengths(deck, problems)
    call remark_idle_fields(deck%settings, deck%output, size(deck%setup%delaminations) > 0, &
                            deck%setup%ply_damage%is_present, problems)
  end subroutine check_across_groups

  !> Checks that there is a load, and no conflicting ones.
  subroutine check_loads(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (deck%setup%presses_impactor()) then
      call check_travel(deck, problems)
    else if (deck%setup%impactor%is_present .and. deck%settings%is_given(impactor_group, key_travel)) then
      call check_travel_in_time(deck, problems)
    else if (deck%setup%is_static() .and. &
             .not. (deck%setup%pressure%is_present .or. deck%setup%thermal%is_present .or. &
                    loads(deck%setup%lines) .or. &
                    problems%concern(pressure_group) .or. problems%concern(line_group))) then
      call report(deck%settings, problems, static_group, '', 'there is no load; give &pressure, or a &line with one.')
    else if (.not. (deck%setup%is_static() .or. deck%setup%impactor%is_present .or. &
                    deck%setup%pressure%is_present .or. deck%setup%thermal%is_present .or. &
                    deck%setup%initial%is_inherited .or. loads(deck%setup%lines) .or. &
                    problems%concern(line_group) .or. problems%concern(static_group) .or. &
                    problems%concern(impactor_group) .or. problems%concern(pressure_group))) then
      call problems%error(0, pressure_group, '', 'the plate has no load; give &impactor, &pressure or &line.')
    end if
  end subroutine check_loads

  !> Checks the travel of an impactor in load steps, which must be the only load.
  subroutine check_travel(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (.not. deck%settings%is_given(impactor_group, key_travel)) then
      if (.not. problems%concern(impactor_group, key_travel)) &
        call report(deck%settings, problems, static_group, '', &
                    'an impactor needs &time, or a travel; give &impactor travel, or leave out &static or &impactor.')
    else if (deck%setup%pressure%is_present .or. loads(deck%setup%lines)) then
      call report(deck%settings, problems, impactor_group, key_travel, &
                  'no other load is possible with a travel in a static analysis; leave out &pressure and lines '// &
                  'that move or load the plate.')
    end if
  end subroutine check_travel

  !> Checks an impactor with a travel prescribed in time.
  subroutine check_travel_in_time(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (.not. is_explicit(deck%stepping)) then
      call report(deck%settings, problems, impactor_group, key_travel, 'in time it requires &time integrator = '// &
                '''central_difference''; give that, &static for load steps, or the velocity instead.')
    else if (deck%setup%impactor%rise > deck%stepping%time%end .and. .not. problems%concern(time_group)) then
      call report(deck%settings, problems, impactor_group, impactor_key_rise, 'the rise lasts longer than the run.')
    end if
  end subroutine check_travel_in_time

  !> True if a line moves or loads the plate.
  pure logical function loads(lines)
    type(line_load_t), intent(in) :: lines(:)
    loads = any(abs(lines%value) > 0)
  end function loads

  !> Keys that a static analysis needs, and keys without effect in it.
  subroutine check_static(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (size(deck%setup%supports) > 0) then
      call check_static_rigs(deck%settings, deck%setup%plate%symmetry, &
                             any(deck%setup%lines%prescribed .and. deck%setup%lines%component >= 3), &
                             deck%setup%supports, problems)
    else if (size(deck%setup%lines) == 0) then
      call check_edges(deck%settings, deck%setup%plate, problems)
    else if (.not. problems%concern(line_group)) then
      call check_line_supports(deck, problems)
    end if
    if (size(deck%setup%lines) > 0 .and. .not. problems%concern(line_group)) call check_in_plane_balance(deck, problems)
    if (deck%has_time) call remark(deck%settings, problems, time_group, '', 'has no effect on a static analysis.')
    if (deck%settings%has_group(adapt_group)) &
      call remark(deck%settings, problems, adapt_group, '', 'has no effect on a static analysis.')
    if (.not. problems%concern(static_group)) &
      call check_intervals(deck%settings, 1.0_wp/deck%setup%loading%steps, 1.0_wp, problems)
    if (any(deck%setup%delaminations%law == law_front)) &
      call remark(deck%settings, problems, delamination_group, '', &
                  'in a static analysis the starter of a front does not grow.')
  end subroutine check_static

  !> Keys that a run in time needs, and keys without effect in it.
  subroutine check_transient(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (problems%concern(static_group)) return
    if (.not. (deck%has_time .or. problems%concern(time_group))) call problems%error(0, time_group, '', &
      '&time is missing; '//needed_of_time(deck)//', or &static for load steps in equilibrium.')
    call require_densities(deck%settings, problems)
    if (.not. deck%has_time) return
    if (.not. problems%concern(time_group)) &
      call check_intervals(deck%settings, deck%stepping%time%step, deck%stepping%time%end, problems)
    if (deck%stepping%time%ends_at_failure .and. .not. (has_ends(deck%setup%plate, deck%setup%lines) .or. &
                                                        problems%concern(line_group))) &
      call report(deck%settings, problems, time_group, key_until, &
                  'failure is that of a plate whose ends lines displace; give such a &line, or leave it out.')
  end subroutine check_transient

  !> Keys of &time to be given: central differences, the default where plies or interfaces soften, choose the step, and
  !> for an impact the end, too.
  function needed_of_time(deck) result(clause)
    type(deck_t), intent(in) :: deck
    !> Such as give end and step
    character(len=:), allocatable :: clause

    clause = 'give end and step'
    if (softening_part(deck) == '') return
    clause = 'give end'
    if (deck%setup%is_impact()) clause = 'give &'//time_group//' /, whose end and step follow from the impact'
  end function needed_of_time

  !> Impactor, its patch and its contact stiffness.
  subroutine check_impact(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    associate (s => deck%settings)
      if (.not. deck%setup%impactor%is_present) then
        if (deck%setup%impactor%indentation%is_given .and. .not. problems%concern(impactor_group)) &
          call remark(s, problems, indentation_group, '', 'has no effect without an impactor.')
        return
      end if
      if (deck%setup%mesh%patch <= 0 .and. s%has_group(mesh_group) .and. &
          are_clear(s, problems, mesh_group, key_patch)) &
        call report(s, problems, mesh_group, key_patch, 'an impactor needs a loaded patch; give its side > 0.')
      call check_dent(deck, problems)
      if (any([(deck%setup%supports(i)%carries(deck%setup%impactor%at), i=1, size(deck%setup%supports))]) .and. &
          are_clear(s, problems, impactor_group, key_at) .and. .not. problems%concern(support_group)) &
        call remark(s, problems, impactor_group, key_at, 'the struck point lies on the frame of &support, where '// &
                    'the plate does not deflect: the force is that of the contact alone.')
      if (.not. (s%is_given(indentation_group, key_k) .or. s%is_given(impactor_group, key_radius)) .and. &
          are_clear(s, problems, indentation_group, key_k) .and. are_clear(s, problems, impactor_group, key_radius)) &
        call report(s, problems, impactor_group, key_radius, &
                  'is missing; give it, or the contact stiffness &indentation k.')
      if (deck%setup%impactor%radius > 0 .and. .not. deck%setup%contact_radius() > 0 .and. &
          are_clear(s, problems, plate_group, key_curvature_radius)) &
        call report(s, problems, plate_group, key_curvature_radius, 'the nose of the impactor, radius '// &
                    short_text(deck%setup%impactor%radius)// &
                    ', does not fit into the concave side; allowed: a larger radius.')
      if (deck%setup%is_static() .or. s%is_given(impactor_group, key_travel)) return
      if (deck%setup%impactor%velocity <= 0 .and. deck%setup%impactor%gravity <= 0 .and. &
          .not. deck%setup%pressure%is_present .and. .not. problems%concern(pressure_group) .and. &
          are_clear(s, problems, impactor_group, keys_of_motion(s)//' '//key_gravity)) &
        call report(s, problems, impactor_group, key_velocity, &
                  'nothing moves the impactor towards the plate; give a velocity or gravity > 0.')
    end associate
  end subroutine check_impact

  !> Warns of a dent that begins beyond the range of the indentation law, which ends at the laminate's thickness. It is
  !> usually a length in another unit, with which the contact is elastic.
  subroutine check_dent(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems

    if (deck%setup%impactor%indentation%law == law_hertz .or. .not. allocated(deck%setup%laminate%thickness)) return
    associate (thickness => sum(deck%setup%laminate%thickness))
      if (thickness > 0 .and. deck%setup%impactor%indentation%alpha_critical > thickness) &
        call remark(deck%settings, problems, indentation_group, key_alpha_critical, 'is larger than the thickness '// &
                    'of the laminate, '//short_text(thickness)//': the contact is elastic and leaves no dent.')
    end associate
  end subroutine check_dent

  !> Checks that interfaces lie within the laminate.
  subroutine check_interfaces(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. allocated(deck%setup%laminate%angle)) return
    do i = 1, size(deck%setup%delaminations)
      associate (place => deck%setup%delaminations(i)%group)
        if (.not. are_clear(deck%settings, problems, delamination_group, key_below_ply, place)) cycle
        ! 'between_angles' and 'all' find no interface in a laminate with errors.
        if (deck%setup%delaminations(i)%below_ply < 1 .and. problems%concern(laminate_group)) cycle
        if (interface_objection(deck%setup%delaminations(i), size(deck%setup%laminate%angle)) /= '') &
          call report(deck%settings, problems, delamination_group, key_below_ply, &
                    interface_objection(deck%setup%delaminations(i), size(deck%setup%laminate%angle))//'.', place)
      end associate
    end do
  end subroutine check_interfaces

  !> Checks strengths required by the failure criteria, except those with another fault.
  subroutine check_strengths(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: needed(:), missing(:)
    character(len=:), allocatable :: names, instead
    integer :: i, j

    do i = 1, size(deck%setup%materials)
      names = needed_strengths(deck%setup%ply_damage%criteria, any(deck%setup%materials(i)%toughness > 0), &
                               deck%setup%materials(i))
      instead = ''
      if (names /= needed_strengths(deck%setup%ply_damage%criteria, .true., deck%setup%materials(i))) &
        instead = ', or fracture energies (G_ft, G_fc, G_mt, G_mc) in place of Sf and Sm23,'
      needed = words_of(names, ',')
      allocate (missing(0))
      do j = 1, size(needed)
        if (needed(j)%text == '') cycle
        if (are_clear(deck%settings, problems, material_group, needed(j)%text, i)) call append(missing, needed(j)%text)
      end do
      if (size(missing) > 0) call report(deck%settings, problems, material_group, '', 'ply damage needs the '// &
        'strengths '//joined(missing, ', ')//'; give them'//instead//' or leave &ply_damage out.', i)
      if (deck%setup%ply_damage%kinking .and. size(missing) == 0) call check_kinking(deck, i, problems)
      deallocate (missing)
    end do
  end subroutine check_strengths

  !> Checks the strengths of fibres that fail by kinking.
  subroutine check_kinking(deck, place, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the material, which has the strengths of the matrix
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    associate (material => deck%setup%materials(place))
      if (.not. material%xc > 0) then
        if (are_clear(deck%settings, problems, material_group, key_compressive, place)) &
          call report(deck%settings, problems, material_group, key_compressive, 'is missing; fibre_compression = '// &
                      '''kinking'' of &ply_damage derives the misalignment of the fibres from it.', place)
      else if (material%g12 > 0) then
        if (larc_objection(material) /= '') &
          call report(deck%settings, problems, material_group, key_compressive, larc_objection(material)//'.', place)
      end if
    end associate
  end subroutine check_kinking
end module deck_cross_checks
