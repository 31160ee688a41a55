!> The indentation law of the deck: rows of its table, filling and checks.
module indentation_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark_idle, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use impact_parameters, only: indentation_law_t, law_tan_sun, law_hertz, law_thornton, dent_tan_sun, dent_yang_sun
  use kinds, only: wp
  use hertz_contact, only: sun_stiffness
  use text, only: line_t, append, to_text
  implicit none
  private
  public :: fill_indentation, check_indentation, echo_without_group

  !> Names that checks across groups use.
  character(len=*), parameter, public :: indentation_group = 'indentation', key_k = 'k', key_alpha_critical = 'alpha_cr'
  !> Row of the group.
  character(len=group_row_length), parameter, public :: indentation_group_row = &
    'indentation | optional | Law of contact force and indentation; left out: elastic Hertz, k by Sun''s formula.'
  !> Rows of the keys.
  character(len=key_row_length), parameter, public :: indentation_rows(*) = [character(len=key_row_length) :: &
    'indentation | law | choice | 1 | - | ''tan_sun'' | tan_sun hertz thornton | &
      &Tan and Sun''s law with a permanent dent, elastic law of Hertz, or elastic-plastic law of Thornton.', &
    'indentation | k | real | 1 | force/length^1.5 | = Sun''s formula | > 0 | &
      &Contact stiffness in F = k alpha^1.5.', &
    'indentation | impactor_E | real | 1 | pressure | = rigid | > 0 | &
      &Young''s modulus of the impactor in Sun''s formula for k.', &
    'indentation | impactor_nu | real | 1 | - | 0.3 | > -1, < 0.5 | &
      &Poisson''s ratio of the impactor in Sun''s formula for k.', &
    'indentation | q | real | 1 | - | 2.5 | >= 1.5, <= 10 | &
      &Exponent of unloading.', &
    'indentation | reload | real | 1 | - | 1.5 | >= 1.5, <= 10 | &
      &Exponent of reloading after separation.', &
    'indentation | beta | real | 1 | - | 0.094 | >= 0, < 1 | &
      &Slope of the permanent dent against the largest indentation, after Tan and Sun.', &
    'indentation | alpha_cr | real | 1 | length | none | > 0 | &
      &Indentation above which a dent remains; needed except with law = ''hertz''.', &
    'indentation | dent | choice | 1 | - | ''tan_sun'' | tan_sun yang_sun | &
      &Formula of the permanent dent.']

contains

  !> Indentation law and contact stiffness; without the group elastic Hertz.
  subroutine fill_indentation(settings, radius, struck_compliance, law)
    !> Keys in effect; receives a default of the contact stiffness
    type(settings_t), intent(inout) :: settings
    !> Radius of the impactor's nose
    real(wp), intent(in) :: radius
    !> Compliance of the struck ply for `sun_stiffness`; 0: not known
    real(wp), intent(in) :: struck_compliance
    !> Receives the law
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
    law%k = settings%real_of(indentation_group, key_k)
    if (settings%is_given(indentation_group, key_k) .or. struck_compliance <= 0) return
    if (settings%is_known(indentation_group, 'impactor_E')) then
      law%k = sun_stiffness(radius, struck_compliance, settings%real_of(indentation_group, 'impactor_E'), &
                            settings%real_of(indentation_group, 'impactor_nu'))
    else
      law%k = sun_stiffness(radius, struck_compliance)
    end if
    call settings%derive(indentation_group, key_k, to_text(law%k), .false.)
  end subroutine fill_indentation

  !> Default law without the group, for the list of keys in effect.
  subroutine echo_without_group(law, lines)
    !> The law
    type(indentation_law_t), intent(in) :: law
    !> Lines are added
    type(line_t), allocatable, intent(inout) :: lines(:)

    call append(lines, '&indentation law = ''hertz'' [default]')
    call append(lines, '&indentation k = '//to_text(law%k)//' [default]')
  end subroutine echo_without_group

  !> Checks keys required by the law, and keys without effect.
  subroutine check_indentation(settings, law, problems)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> The law
    type(indentation_law_t), intent(in) :: law
    !> Faults and remarks are added
    type(problems_t), intent(inout) :: problems

    if (.not. settings%is_known(indentation_group, 'law')) return
    if (law%law == law_hertz) then
      call idle('q reload beta alpha_cr dent', 'has no effect with law = ''hertz''.')
    else
      if (.not. (settings%is_given(indentation_group, key_alpha_critical) .or. &
                 problems%concern(indentation_group, key_alpha_critical))) &
        call report(settings, problems, indentation_group, key_alpha_critical, 'is missing; law = '''// &
                  settings%text_of(indentation_group, 'law')//''' needs the '// &
                  'indentation above which a dent remains (law = ''hertz'' leaves none).')
      if (law%law == law_tan_sun) call check_exponents(settings, law, problems)
    end if
    if (law%law == law_thornton) call idle('q reload beta dent', 'has no effect with law = ''thornton''.')
    if (law%law == law_tan_sun .and. law%dent == dent_yang_sun) &
      call idle('beta', 'has no effect with dent = ''yang_sun''.')
    if (settings%is_given(indentation_group, key_k)) then
      call idle('impactor_E impactor_nu', 'has no effect as k is given.')
    else if (.not. settings%is_given(indentation_group, 'impactor_E')) then
      call idle('impactor_nu', 'has no effect without impactor_E.')
    end if

  contains

    !> Remarks on keys of this group.
    subroutine idle(keys, message)
      !> Names of keys, separated by blanks
      character(len=*), intent(in) :: keys
      !> Reason why they have no effect
      character(len=*), intent(in) :: message

      call remark_idle(settings, problems, indentation_group, keys, message)
    end subroutine idle
  end subroutine check_indentation

  !> Checks the exponents of a law that creates no energy: 1.5 <= reload <= q; the rows have the lower bound.
  subroutine check_exponents(settings, law, problems)
    !> Keys in effect
    type(settings_t), intent(in) :: settings
    !> The law
    type(indentation_law_t), intent(in) :: law
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (.not. are_clear(settings, problems, indentation_group, 'q reload')) return
    if (law%reload > law%q) &
      call report(settings, problems, indentation_group, 'reload', &
                  'reloading would require less energy than unloading '// &
                'released; allowed: >= 1.5, <= q = '//to_text(law%q)//'.')
  end subroutine check_exponents
end module indentation_deck
