!> Checks across the groups of a deck: whether what it asks for can be modelled and makes sense together.
!> A check whose keys are already at fault is left out, so that one fault is told once.
module deck_checks
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: tell, remark
  use deck_run_checks, only: check_intervals, check_petsc_options
  use delamination_parameters, only: growth_one_per_step
  use stepping_parameters, only: integrator_newmark, integrator_generalized_alpha
  use impact_parameters, only: law_tan_sun, law_hertz, dent_yang_sun
  use kinds, only: wp
  use laminate_parameters, only: shear_five_sixths
  use gradings, only: core_elements
  use mesh_parameters, only: edge_free, edge_clamped, symmetry_quarter
  use plies, only: ply_t
  use stacking, only: stacked_plies, section_stiffness
  use text, only: line_t, to_text, words_of
  implicit none
  private
  public :: check_deck

  !> Most elements, and most steps of a run: more pass the range of default integers.
  real(wp), parameter :: most_elements = 1.0e6_wp, most_steps = 1.0e8_wp
  !> Length over thickness beyond which rounding spoils the answer, and below which plate theory does.
  real(wp), parameter :: most_slender = 1.0e5_wp, least_slender = 5
  !> Smallest patch, fraction of the plate's shorter side, and largest ratio of the plate's sides.
  real(wp), parameter :: least_patch = 1.0e-5_wp, most_oblong = 1.0e3_wp
  !> Coupling stiffness that counts as none, relative to the stiffness it couples.
  real(wp), parameter :: no_coupling = 1.0e-9_wp

contains

  !> All checks.
  subroutine check_deck(deck, problems)
    !> The deck, filled
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    call check_analysis(deck, problems)
    call check_size(deck, problems)
    if (deck%plate%symmetry == symmetry_quarter) call check_quarter(deck, problems)
    if (deck%has_impactor) call check_impact(deck, problems)
    if (deck%has_indentation) call check_indentation(deck, problems)
    if (deck%has_time .and. .not. problems%concern('time')) call check_time(deck, problems)
    call check_intervals(deck, problems)
    call check_petsc_options(deck, problems)
  end subroutine check_deck

  !> Loads, supports and time: is there a task, and which?
  subroutine check_analysis(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (deck%has_static .and. deck%has_impactor) then
      call tell(deck%settings, problems, 'static', '', 'an impactor needs time; leave out &static or &impactor.')
    else if (deck%has_static .and. .not. (deck%has_pressure .or. problems%concern('pressure'))) then
      call tell(deck%settings, problems, 'static', '', 'there is no load; give &pressure.')
    else if (.not. (deck%has_static .or. deck%has_impactor .or. deck%has_pressure .or. problems%concern('static') .or. &
                    problems%concern('impactor') .or. problems%concern('pressure'))) then
      call problems%error(0, 'pressure', '', 'nothing loads the plate; give &impactor or &pressure.')
    end if
    if (deck%has_static) then
      call check_supports(deck, problems)
      if (deck%has_time) call remark(deck%settings, problems, 'time', '', 'has no effect on a static analysis.')
      if (deck%settings%is_given('pressure', 'history')) call remark(deck%settings, problems, 'pressure', 'history', &
                                                                     'has no effect on a static analysis.')
    else
      call check_transient(deck, problems)
    end if
    if (deck%has_pressure .and. deck%pressure%value == 0 .and. deck%settings%is_known('pressure', 'value')) then
      call remark(deck%settings, problems, 'pressure', 'value', 'a pressure of 0 is no load.')
    end if
  end subroutine check_analysis

  !> Supports that hold the plate in equilibrium.
  subroutine check_supports(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (.not. deck%settings%is_known('plate', 'edges')) return
    if (all(deck%plate%edges == edge_free)) then
      call tell(deck%settings, problems, 'plate', 'edges', 'nothing holds the plate in a static analysis; support an edge.')
    else if (count(deck%plate%edges /= edge_free) == 1 .and. all(deck%plate%edges /= edge_clamped)) then
      call tell(deck%settings, problems, 'plate', 'edges', 'in a static analysis the plate turns about its one simply '// &
                'supported edge; clamp it or support another one.')
    end if
  end subroutine check_supports

  !> What a run in time needs.
  subroutine check_transient(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. (deck%has_time .or. problems%concern('time') .or. problems%concern('static'))) then
      call problems%error(0, 'time', '', '&time is missing; give end and step, or &static for load steps in '// &
                          'equilibrium.')
    end if
    if (problems%concern('static') .or. .not. allocated(deck%materials)) return
    do i = 1, size(deck%materials)
      if (deck%settings%is_given('material', 'density', i) .or. problems%concern('material', 'density')) cycle
      call tell(deck%settings, problems, 'material', 'density', 'is missing; a run in time needs a density > 0.', i)
    end do
  end subroutine check_transient

  !> Sizes of plate, mesh and laminate against each other.
  subroutine check_size(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    real(wp) :: thickness, shorter, longer

    if (product(real(deck%mesh%elements, wp)) > most_elements) call tell(deck%settings, problems, 'mesh', 'elements', &
      'more than '//to_text(most_elements)//' elements in all; give fewer.')
    if (.not. deck%settings%is_known('plate', 'length')) return
    shorter = minval(deck%plate%length)
    longer = maxval(deck%plate%length)
    if (longer > most_oblong*shorter) call tell(deck%settings, problems, 'plate', 'length', 'one side is more than '// &
      to_text(most_oblong)//' times the other; such a strip is no plate.')
    call check_patch(deck, problems)
    call check_core(deck, problems)
    if (.not. allocated(deck%laminate%thickness)) return
    thickness = sum(deck%laminate%thickness)
    if (thickness > shorter) then
      call tell(deck%settings, problems, 'laminate', 'thicknesses', 'the laminate is '//to_text(thickness)// &
                ' thick, more than the plate is wide; this is no plate.')
    else if (longer > most_slender*thickness) then
      call tell(deck%settings, problems, 'laminate', 'thicknesses', 'the laminate is '//to_text(thickness)// &
                ' thick, less than '//to_text(1/most_slender)//' of the plate''s length, where rounding spoils it.')
    else if (thickness*least_slender > shorter) then
      call remark(deck%settings, problems, 'laminate', 'thicknesses', 'the plate is less than '//to_text(least_slender)// &
                  ' thicknesses wide; plate theory is inaccurate there.')
    end if
  end subroutine check_size

  !> Loaded patch: not larger than the plate nor next to nothing, and with elements left for the rest.
  subroutine check_patch(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    real(wp) :: shorter

    shorter = minval(deck%plate%length)
    associate (patch => deck%mesh%patch)
      if (patch <= 0) return
      if (patch > shorter) then
        call tell(deck%settings, problems, 'mesh', 'patch', 'is larger than the plate; allowed: up to '//to_text(shorter)//'.')
      else if (patch < least_patch*shorter) then
        call tell(deck%settings, problems, 'mesh', 'patch', 'is too small for the plate; allowed: from '// &
                  to_text(least_patch*shorter)//'.')
      else if (deck%plate%symmetry /= symmetry_quarter .and. any(deck%mesh%elements == 2 .and. &
               patch < deck%plate%length) .and. .not. (problems%concern('mesh', 'elements') .or. &
                                                       problems%concern('plate', 'symmetry'))) then
        call tell(deck%settings, problems, 'mesh', 'elements', 'a loaded patch with plate around it takes at least 3 '// &
                  'elements each way.')
      end if
    end associate
  end subroutine check_patch

  !> Core of equal elements: in the plate, and with elements left for the rest.
  subroutine check_core(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: direction, parts, least

    associate (s => deck%settings, mesh => deck%mesh)
      if (s%is_given('mesh', 'core') .neqv. s%is_given('mesh', 'cell')) then
        call tell(deck%settings, problems, 'mesh', trim(merge('cell', 'core', s%is_given('mesh', 'core'))), &
                  'is missing; `core` and `cell` go together.')
      else if (mesh%cell > 0 .and. .not. problems%concern('mesh')) then
        parts = merge(1, 2, deck%plate%symmetry == symmetry_quarter)
        if (any(mesh%core >= deck%plate%length)) then
          call tell(deck%settings, problems, 'mesh', 'core', 'is as large as the plate; give it smaller or leave it out.')
          return
        else if (any(mesh%core/mesh%cell > most_elements)) then
          call tell(deck%settings, problems, 'mesh', 'cell', 'is too small for the core.')
          return
        end if
        do direction = 1, 2
          least = parts*(sum(core_elements(mesh%patch/2, mesh%core(direction)/2, mesh%cell)) + 1)
          if (mesh%elements(direction) < least .or. modulo(mesh%elements(direction), parts) > 0) then
            call tell(deck%settings, problems, 'mesh', 'elements', 'the core needs at least '//to_text(least)//' along '// &
                      merge('x', 'y', direction == 1)//trim(merge(', and an even number.', '.                    ', &
                                                                  parts == 2)))
            return
          end if
        end do
      end if
    end associate
  end subroutine check_core

  !> What must be symmetric if only a quarter is modelled.
  subroutine check_quarter(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (deck%plate%edges(1) /= deck%plate%edges(2) .or. deck%plate%edges(3) /= deck%plate%edges(4)) then
      call tell(deck%settings, problems, 'plate', 'edges', 'symmetry = ''quarter'' needs the same support at opposite edges.')
    end if
    if (problems%concern('material') .or. .not. allocated(deck%laminate%material)) return
    if (is_coupled(deck)) call tell(deck%settings, problems, 'plate', 'symmetry', 'the laminate couples bending or '// &
      'extension with shear or twist (A16, A26, B16, B26, D16, D26 or A45 isn''t 0), so a quarter can''t stand for '// &
      'the plate; use ''none''.')
  end subroutine check_quarter

  !> True: the laminate isn't symmetric about both axes of the plate.
  pure logical function is_coupled(deck)
    !> The deck with a sound laminate
    type(deck_t), intent(in) :: deck
    type(ply_t), allocatable :: plies(:)
    real(wp) :: stiffness(21), thickness, scales(7)

    plies = stacked_plies(deck%laminate, deck%materials)
    stiffness = section_stiffness(plies, plies%elasticity, shear_five_sixths)
    thickness = sum(deck%laminate%thickness)
    scales(1:2) = maxval(stiffness(1:6))
    scales(3:4) = scales(1)*thickness
    scales(5:6) = scales(1)*thickness**2
    scales(7) = maxval(stiffness(19:21))
    is_coupled = any(abs(stiffness([3, 5, 9, 11, 15, 17, 20])) > no_coupling*scales)
  end function is_coupled

  !> Impactor, its patch and its contact stiffness.
  subroutine check_impact(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    associate (s => deck%settings)
      if (deck%mesh%patch == 0 .and. s%is_known('mesh', 'patch') .and. .not. problems%concern('mesh', 'patch')) then
        call tell(deck%settings, problems, 'mesh', 'patch', 'an impactor needs a loaded patch; give its side > 0.')
      end if
      if (.not. (s%is_given('indentation', 'k') .or. s%is_given('impactor', 'radius') .or. &
                 problems%concern('impactor', 'radius') .or. problems%concern('indentation'))) then
        call tell(deck%settings, problems, 'impactor', 'radius', 'is missing; give it, or the contact stiffness &indentation k.')
      end if
      if (s%is_known('impactor', 'velocity') .and. s%is_known('impactor', 'gravity') .and. &
          deck%impactor%velocity == 0 .and. deck%impactor%gravity <= 0 .and. .not. deck%has_pressure) then
        call tell(deck%settings, problems, 'impactor', 'velocity', &
                  'nothing moves the impactor towards the plate; give a velocity or gravity > 0.')
      end if
    end associate
  end subroutine check_impact

  !> Indentation law.
  subroutine check_indentation(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (.not. deck%has_impactor) then
      if (.not. problems%concern('impactor')) call remark(deck%settings, problems, 'indentation', '', &
                                                          'has no effect without an impactor.')
      return
    end if
    if (.not. deck%settings%is_known('indentation', 'law')) return
    if (deck%indentation%law == law_hertz) then
      call remark_idle(deck, problems, 'indentation', 'q reload beta alpha_cr dent', &
                       'has no effect with law = ''hertz''.')
    else if (.not. (deck%settings%is_given('indentation', 'alpha_cr') .or. &
                    problems%concern('indentation', 'alpha_cr'))) then
      call tell(deck%settings, problems, 'indentation', 'alpha_cr', 'is missing; law = ''tan_sun'' needs the indentation '// &
                'above which a dent remains (law = ''hertz'' leaves none).')
    end if
    if (deck%indentation%law == law_tan_sun .and. deck%indentation%dent == dent_yang_sun) then
      call remark_idle(deck, problems, 'indentation', 'beta', 'has no effect with dent = ''yang_sun''.')
    end if
    if (deck%settings%is_given('indentation', 'k')) then
      call remark_idle(deck, problems, 'indentation', 'impactor_E impactor_nu', 'has no effect as k is given.')
    else if (.not. deck%settings%is_given('indentation', 'impactor_E')) then
      call remark_idle(deck, problems, 'indentation', 'impactor_nu', 'has no effect without impactor_E.')
    end if
  end subroutine check_indentation

  !> Keys that are given but change nothing.
  subroutine remark_idle(deck, problems, group, keys, message)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Remarks are added
    type(problems_t), intent(inout) :: problems
    !> Name of the group
    character(len=*), intent(in) :: group
    !> Names of keys, separated by blanks
    character(len=*), intent(in) :: keys
    !> Why
    character(len=*), intent(in) :: message
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    do i = 1, size(names)
      if (deck%settings%is_given(group, names(i)%text)) call remark(deck%settings, problems, group, names(i)%text, message)
    end do
  end subroutine remark_idle

  !> Time steps and integrator.
  subroutine check_time(deck, problems)
    !> The deck, whose &time has sound keys
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    associate (time => deck%stepping%time)
      if (time%step > time%end) then
        call tell(deck%settings, problems, 'time', 'step', 'is longer than the run; allowed: up to end = '// &
                  to_text(time%end)//'.')
      else if (time%end > most_steps*time%step) then
        call tell(deck%settings, problems, 'time', 'step', 'makes more than '//to_text(most_steps)//' steps; allowed: from '// &
                  to_text(time%end/most_steps)//'.')
      end if
      if (time%step_min > time%step) call tell(deck%settings, problems, 'time', 'step_min', &
        'is larger than the first step; allowed: up to step = '//to_text(time%step)//'.')
      if (time%step_max < time%step) call tell(deck%settings, problems, 'time', 'step_max', &
        'is smaller than the first step; allowed: from step = '//to_text(time%step)//'.')
      if (time%integrator == integrator_newmark) then
        if (2*time%beta < time%gamma) call tell(deck%settings, problems, 'time', 'beta', &
          'the plate''s motion would be unstable; allowed: from gamma/2 = '//to_text(time%gamma/2)//'.')
        call remark_idle(deck, problems, 'time', 'rho_inf', 'has no effect with integrator = ''newmark''.')
      else if (time%integrator == integrator_generalized_alpha) then
        call remark_idle(deck, problems, 'time', 'beta gamma', &
                         'has no effect with integrator = ''generalized_alpha''.')
      end if
    end associate
    if (size(deck%delaminations) > 0 .and. all(deck%delaminations%growth == growth_one_per_step)) return
    call remark_idle(deck, problems, 'adapt', 'growth_step', 'has no effect without growth = ''one_per_step''.')
  end subroutine check_time
end module deck_checks
