!> The indentation law of the deck: rows of its table, filling and checks.
module indentation_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use impact_parameters, only: indentation_law_t, law_tan_sun, law_hertz, law_thornton, dent_tan_sun, dent_yang_sun
  use kinds, only: wp
  use mathematical_constants, only: pi
  use hertz_contact, only: sun_stiffness
  use text, only: line_t, append, to_text
  implicit none
  private
  public :: fill_indentation, check_indentation, echo_without_group, struck_face_t, takes_laminate

  !> Names that checks across groups use.
  character(len=*), parameter, public :: indentation_group = 'indentation', key_k = 'k', &
                                         key_alpha_critical = 'alpha_cr', &
                                         key_face = 'face', key_e3 = 'E3', key_yield = 'yield_pressure'
  character(len=group_row_length), parameter, public :: indentation_group_row = &
    'indentation | optional | Law of contact force and indentation; left out: elastic Hertz, k by Sun''s formula.'
  character(len=key_row_length), parameter, public :: indentation_rows(*) = [character(len=key_row_length) :: &
    'indentation | law | choice | 1 | - | ''tan_sun'' | tan_sun hertz thornton | &
      &Tan and Sun''s law with a permanent dent, elastic law of Hertz, or elastic-plastic law of Thornton.', &
    'indentation | k | real | 1 | force/length^1.5 | = Sun''s formula | > 0 | &
      &Contact stiffness in F = k alpha^1.5.', &
    'indentation | impactor_E | real | 1 | pressure | = rigid | > 0 | &
      &Young''s modulus of the impactor in Sun''s formula for k. | not k', &
    'indentation | impactor_nu | real | 1 | - | 0.3 | > -1, < 0.5 | &
      &Poisson''s ratio of the impactor in Sun''s formula for k. | not k, impactor_E', &
    'indentation | face | choice | 1 | - | ''ply'' | ply laminate | &
      &Struck face: stiffness of a free ply, or stiffness and strength with held strains in its plane.', &
    'indentation | E3 | real | 1 | pressure | = E2, or by face | > 0 | &
      &Modulus of the struck face through the thickness in Sun''s formula for k. | not k', &
    'indentation | yield_pressure | real | 1 | pressure | = by face | > 0 | &
      &Largest contact pressure of law = ''thornton'', instead of alpha_cr. | law = thornton, not alpha_cr', &
    'indentation | q | real | 1 | - | 2.5 | >= 1.5, <= 10 | &
      &Exponent of unloading. | law = tan_sun', &
    'indentation | reload | real | 1 | - | 1.5 | >= 1.5, <= 10 | &
      &Exponent of reloading after separation. | law = tan_sun', &
    'indentation | beta | real | 1 | - | 0.094 | >= 0, < 1 | &
      &Slope of the permanent dent against the largest indentation, after Tan and Sun. | &
      &law = tan_sun, not dent = yang_sun', &
    'indentation | alpha_cr | real | 1 | length | none | > 0 | &
      &Indentation above which a dent remains; needed except with law = ''hertz'' or a yield pressure. | &
      &not law = hertz', &
    'indentation | dent | choice | 1 | - | ''tan_sun'' | tan_sun yang_sun | &
      &Formula of the permanent dent. | law = tan_sun']

  !> The struck face as the laminate has it; 0: not known.
  type :: struck_face_t
    !> Compliance of the struck ply for `sun_stiffness`
    real(wp) :: compliance = 0
    !> Modulus through the thickness, and pressure at which it yields, with held in-plane strains
    real(wp) :: modulus = 0, strength = 0
  end type struck_face_t

contains

  !> Indentation law and contact stiffness; without the group elastic Hertz.
  subroutine fill_indentation(settings, radius, face, law)
    !> Keys in effect; receives a default of the contact stiffness
    type(settings_t), intent(inout) :: settings
    !> Radius of the impactor's nose, or of its relative curvature on a curved plate
    real(wp), intent(in) :: radius
    type(struck_face_t), intent(in) :: face
    type(indentation_law_t), intent(inout) :: law

    law%law = law_hertz
    if (settings%has_group(indentation_group)) then
      law%law = code_of(settings%text_of(indentation_group, 'law'), 'tan_sun hertz thornton', &
                        [law_tan_sun, law_hertz, law_thornton])
      law%dent = code_of(settings%text_of(indentation_group, 'dent'), 'tan_sun yang_sun', [dent_tan_sun, dent_yang_sun])
      law%q = settings%real_of(indentation_group, 'q')
      law%reload = settings%real_of(indentation_group, 'reload')
      law%beta = settings%real_of(indentation_group, 'beta')
      law%alpha_critical = settings%real_of(indentation_group, key_alpha_critical)
    end if
    call fill_stiffness(settings, radius, face, law)
    if (law%law == law_thornton) call fill_yield(settings, radius, face, law)
  end subroutine fill_indentation

  !> Contact stiffness, by default that of Sun's formula.
  subroutine fill_stiffness(settings, radius, face, law)
    !> Keys in effect; receives a default of the contact stiffness
    type(settings_t), intent(inout) :: settings
    !> Radius of the impactor's nose, or of its relative curvature on a curved plate
    real(wp), intent(in) :: radius
    type(struck_face_t), intent(in) :: face
    type(indentation_law_t), intent(inout) :: law
    real(wp) :: compliance

    law%k = settings%real_of(indentation_group, key_k)
    if (settings%is_given(indentation_group, key_k)) return
    compliance = face%compliance
    if (takes_laminate(settings) .and. face%modulus > 0 .and. .not. settings%is_given(indentation_group, key_e3)) &
      call settings%derive_numbers(indentation_group, key_e3, [face%modulus])
    if (settings%is_known(indentation_group, key_e3)) compliance = 1/settings%real_of(indentation_group, key_e3)
    if (compliance <= 0) return
    if (settings%is_known(indentation_group, 'impactor_E')) then
      law%k = sun_stiffness(radius, compliance, settings%real_of(indentation_group, 'impactor_E'), &
                            settings%real_of(indentation_group, 'impactor_nu'))
    else
      law%k = sun_stiffness(radius, compliance)
    end if
    call settings%derive(indentation_group, key_k, to_text(law%k), .false.)
  end subroutine fill_stiffness

  !> Indentation at which the pressure at the centre of a Hertzian contact, (3/2) k sqrt(alpha)/(pi R), reaches the
  !> yield pressure.
  subroutine fill_yield(settings, radius, face, law)
    !> Keys in effect; receives the yield pressure and the indentation
    type(settings_t), intent(inout) :: settings
    !> Radius of the impactor's nose, or of its relative curvature on a curved plate
    real(wp), intent(in) :: radius
    type(struck_face_t), intent(in) :: face
    type(indentation_law_t), intent(inout) :: law

    if (settings%is_given(indentation_group, key_alpha_critical)) return
    if (.not. (radius > 0 .and. law%k > 0)) return
    if (takes_laminate(settings) .and. face%strength > 0 .and. .not. &
        settings%is_given(indentation_group, key_yield)) &
      call settings%derive_numbers(indentation_group, key_yield, [face%strength])
    if (.not. settings%is_known(indentation_group, key_yield)) return
    law%alpha_critical = (2*pi*radius*settings%real_of(indentation_group, key_yield)/(3*law%k))**2
    call settings%derive_numbers(indentation_group, key_alpha_critical, [law%alpha_critical])
  end subroutine fill_yield

  !> True: the struck face has the properties of the laminate.
  logical function takes_laminate(settings)
    type(settings_t), intent(in) :: settings

    takes_laminate = .false.
    if (settings%is_known(indentation_group, key_face)) &
      takes_laminate = settings%text_of(indentation_group, key_face) == 'laminate'
  end function takes_laminate

  !> Default law without the group, for the list of keys in effect.
  subroutine echo_without_group(law, lines)
    type(indentation_law_t), intent(in) :: law
    type(line_t), allocatable, intent(inout) :: lines(:)

    call append(lines, '&indentation law = ''hertz'' [default]')
    call append(lines, '&indentation k = '//to_text(law%k)//' [default]')
  end subroutine echo_without_group

  !> Checks keys required by the law, and keys without effect.
  subroutine check_indentation(settings, law, problems)
    type(settings_t), intent(in) :: settings
    type(indentation_law_t), intent(in) :: law
    type(problems_t), intent(inout) :: problems

    if (.not. settings%is_known(indentation_group, 'law')) return
    if (law%law == law_hertz) return
    if (.not. (law%alpha_critical > 0 .or. problems%concern(indentation_group, key_alpha_critical) .or. &
               problems%concern(indentation_group, key_face))) &
      call report(settings, problems, indentation_group, key_alpha_critical, 'is missing; law = '''// &
                  settings%text_of(indentation_group, 'law')//''' needs the indentation above which a dent remains'// &
                  trim(merge(', or a yield_pressure', '                     ', law%law == law_thornton))// &
                  ' (law = ''hertz'' leaves none).')
    ! A law that creates no energy has 1.5 <= reload <= q; the rows have the lower bound.
    if (law%law == law_tan_sun .and. law%reload > law%q .and. &
        are_clear(settings, problems, indentation_group, 'q reload')) &
      call report(settings, problems, indentation_group, 'reload', 'reloading would require less energy than '// &
                  'unloading released; allowed: >= 1.5, <= q = '//to_text(law%q)//'.')
  end subroutine check_indentation
end module indentation_deck
