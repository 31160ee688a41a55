!> Ply damage and delamination, from the deck into their parameters.
module deck_damage
  use kinds, only: wp
  use text, only: to_text
  use deck_contents, only: deck_t
  use deck_filling, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: tell, remark
  use ply_damage_parameters, only: criteria_hou, stress_at_middle, stress_at_faces
  use delamination_parameters, only: law_front, law_cohesive, delamination_t, &
                                     delamination_objection, default_starter, release_two_state, &
                                     release_vcct, growth_equilibrium, growth_one_per_step, tie_eliminate, &
                                     tie_penalty, contact_augmented_lagrangian, contact_continuous_penalty, &
                                     contact_none, unloading_contact, unloading_glued, account_debts, &
                                     account_balance
  use hou_criteria, only: missing_strengths
  implicit none
  private
  public :: fill_damage

contains

  !> Ply damage and delaminations, as far as the deck has them.
  subroutine fill_damage(deck, problems)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: place

    associate (s => deck%settings, damage => deck%ply_damage)
      deck%has_ply_damage = s%has_group('ply_damage')
      damage%d = s%real_of('ply_damage', 'd')
      damage%e = s%real_of('ply_damage', 'e')
      damage%fade = s%real_of('ply_damage', 'fade')
      damage%average = s%real_of('ply_damage', 'average')
      damage%criteria = code_of(s%text_of('ply_damage', 'criteria'), 'hou', [criteria_hou])
      damage%stress = code_of(s%text_of('ply_damage', 'stress'), 'middle faces', [stress_at_middle, stress_at_faces])
      if (deck%has_ply_damage) call check_strengths(deck, problems)
      allocate (deck%delaminations(s%groups_named('delamination')))
    end associate
    do place = 1, size(deck%delaminations)
      call fill_delamination(deck, place)
    end do
    call check_delaminations(deck, problems)
  end subroutine fill_damage

  !> Strengths that the criteria need must be there.
  subroutine check_strengths(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: i

    do i = 1, size(deck%materials)
      if (missing_strengths(deck%materials(i)) == '') cycle
      call tell(deck%settings, problems, 'material', '', 'ply damage needs the strengths '// &
                missing_strengths(deck%materials(i))//'; give them or leave &ply_damage out.', i)
    end do
  end subroutine check_strengths

  !> One interface.
  subroutine fill_delamination(deck, place)
    !> Receives it
    type(deck_t), intent(inout) :: deck
    !> Which of the groups
    integer, intent(in) :: place
    character(len=*), parameter :: group = 'delamination'
    real(wp) :: starter

    call fill_law(deck, place, deck%delaminations(place))
    starter = default_starter(deck%plate%length)
    if (deck%delaminations(place)%law == law_cohesive) starter = 0
    if (.not. deck%settings%is_given(group, 'starter', place)) &
      call deck%settings%derive(group, 'starter', to_text(starter), .false., place)
    associate (s => deck%settings, d => deck%delaminations(place))
      d%below_ply = s%integer_of(group, 'below_ply', place)
      d%toughness = s%real_of(group, 'G_c', place)
      d%toughness_opening = s%real_of(group, 'G_Ic', place)
      d%toughness_shear = s%real_of(group, 'G_IIc', place)
      d%mixing_exponent = s%real_of(group, 'eta', place)
      if (s%is_known(group, 'zone', place)) d%zone = s%reals_of(group, 'zone', place)
      d%starter = starter
      if (s%is_given(group, 'starter', place)) d%starter = s%real_of(group, 'starter', place)
      d%penalty_stiffness = s%real_of(group, 'penalty', place)
      d%contact_exponent = s%real_of(group, 'contact_exponent', place)
      call fill_choices(deck, place, d)
    end associate
  end subroutine fill_delamination

  !> The law of one interface: cohesive unless a starter is given.
  subroutine fill_law(deck, place, delamination)
    !> The deck
    type(deck_t), intent(inout) :: deck
    !> Which of the groups
    integer, intent(in) :: place
    !> Receives it
    type(delamination_t), intent(inout) :: delamination
    character(len=*), parameter :: group = 'delamination'
    real(wp) :: strengths(2)
    integer :: below

    associate (s => deck%settings, d => delamination)
      if (.not. s%is_given(group, 'law', place)) &
        call s%derive(group, 'law', trim(merge('front   ', 'cohesive', s%is_given(group, 'starter', place))), .true., place)
      d%law = code_of(s%text_of(group, 'law', place), 'front cohesive', [law_front, law_cohesive])
      if (d%law /= law_cohesive) return
      d%stiffness = s%real_of(group, 'stiffness', place)
      d%pressure_strengthening = s%real_of(group, 'pressure_strengthening', place)
      strengths = 0
      below = s%integer_of(group, 'below_ply', place)
      if (allocated(deck%laminate%material)) then
        if (below >= 1 .and. below < size(deck%laminate%material)) then
          associate (beside => deck%materials(deck%laminate%material(below:below + 1)))
            strengths = [minval(beside%yt), minval(beside%s12)]
          end associate
        end if
      end if
      call fill_strength('strength_opening', strengths(1), d%strength_opening)
      call fill_strength('strength_shear', strengths(2), d%strength_shear)
    end associate

  contains

    !> One strength: the key, or that of the plies.
    subroutine fill_strength(key, of_plies, strength)
      !> The key
      character(len=*), intent(in) :: key
      !> Strength of the weaker ply; 0: none given
      real(wp), intent(in) :: of_plies
      !> Receives it
      real(wp), intent(out) :: strength

      if (.not. deck%settings%is_given(group, key, place) .and. of_plies > 0) &
        call deck%settings%derive(group, key, to_text(of_plies), .false., place)
      strength = of_plies
      if (deck%settings%is_given(group, key, place)) strength = deck%settings%real_of(group, key, place)
    end subroutine fill_strength
  end subroutine fill_law

  !> The choices of one interface.
  subroutine fill_choices(deck, place, delamination)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Which of the groups
    integer, intent(in) :: place
    !> Receives them
    type(delamination_t), intent(inout) :: delamination
    character(len=*), parameter :: group = 'delamination'

    associate (s => deck%settings, d => delamination)
      d%energy_release = code_of(s%text_of(group, 'energy_release', place), 'two_state vcct', &
                                 [release_two_state, release_vcct])
      d%growth = code_of(s%text_of(group, 'growth', place), 'equilibrium one_per_step', &
                         [growth_equilibrium, growth_one_per_step])
      d%tie = code_of(s%text_of(group, 'tie', place), 'eliminate penalty', [tie_eliminate, tie_penalty])
      d%contact = code_of(s%text_of(group, 'contact', place), 'augmented_lagrangian continuous_penalty none', &
                          [contact_augmented_lagrangian, contact_continuous_penalty, contact_none])
      d%unloading = code_of(s%text_of(group, 'unloading', place), 'contact glued', [unloading_contact, unloading_glued])
      d%account = code_of(s%text_of(group, 'account', place), 'debts balance', [account_debts, account_balance])
    end associate
  end subroutine fill_choices

  !> Checks all interfaces, unless faults of their keys would bring others along.
  subroutine check_delaminations(deck, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (problems%concern('delamination') .or. problems%concern('plate', 'length') .or. &
        .not. allocated(deck%laminate%angle)) return
    do i = 1, size(deck%delaminations)
      call check_delamination(deck, i, problems)
    end do
    do i = 2, size(deck%delaminations)
      if (deck%delaminations(i)%below_ply > deck%delaminations(i - 1)%below_ply) cycle
      call tell(deck%settings, problems, 'delamination', 'below_ply', 'is not below the interface of the group before; give '// &
                'each interface once, in order from the struck face.', i)
    end do
  end subroutine check_delaminations

  !> Checks one interface.
  subroutine check_delamination(deck, place, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Which of the groups
    integer, intent(in) :: place
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: group = 'delamination'
    character(len=:), allocatable :: objection

    associate (d => deck%delaminations(place))
      objection = delamination_objection(d, size(deck%laminate%angle))
      if (objection /= '') then
        call tell(deck%settings, problems, group, '', objection//'.', place)
      else if (any(d%zone > deck%plate%length)) then
        call tell(deck%settings, problems, group, 'zone', 'the zone must not be larger than the plate.', place)
      else if (d%energy_release == release_two_state .and. d%toughness <= 0) then
        call tell(deck%settings, problems, group, 'energy_release', 'Eq. 11 does not part the modes; give G_c, or take '// &
                  '''vcct''.', place)
      else if (d%law == law_cohesive .and. .not. d%strength_opening > 0) then
        call tell(deck%settings, problems, group, 'strength_opening', 'is missing; give it, or YT of the materials.', place)
      else if (d%law == law_cohesive .and. .not. d%strength_shear > 0) then
        call tell(deck%settings, problems, group, 'strength_shear', 'is missing; give it, or S12 of the materials.', place)
      else if (deck%has_impactor .and. d%law == law_front .and. d%starter < 1.5_wp*deck%mesh%patch) then
        call remark(deck%settings, problems, group, 'starter', 'the starter is hardly larger than the loaded patch: most of '// &
                    'the shear then passes inside it, and growth may never start.', place)
      end if
      call remark_idle_keys(deck, place, problems)
    end associate
  end subroutine check_delamination

  !> What an interface asks for but has no effect.
  subroutine remark_idle_keys(deck, place, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Which of the groups
    integer, intent(in) :: place
    !> Remarks are added
    type(problems_t), intent(inout) :: problems

    if (deck%has_static .and. place == 1) call remark(deck%settings, problems, 'delamination', '', &
                                                      'in a static analysis the starter does not grow.')
    associate (d => deck%delaminations(place))
      if (d%toughness > 0) call idle('eta', 'as G_c is given')
      if (d%tie /= tie_penalty) call idle('penalty', 'without tie = ''penalty''')
      if (d%contact /= contact_continuous_penalty) &
        call idle('contact_exponent', 'without contact = ''continuous_penalty''')
      if (d%growth /= growth_equilibrium) call idle('account', 'without growth = ''equilibrium''')
    end associate

  contains

    !> Remarks on one key.
    subroutine idle(key, reason)
      !> The key
      character(len=*), intent(in) :: key
      !> Why it changes nothing
      character(len=*), intent(in) :: reason

      if (deck%settings%is_given('delamination', key, place)) &
        call remark(deck%settings, problems, 'delamination', key, 'has no effect '//reason//'.', place)
    end subroutine idle
  end subroutine remark_idle_keys
end module deck_damage
