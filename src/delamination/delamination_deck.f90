!> Interfaces of the deck that may delaminate: rows of its table, filling and checks.
module delamination_deck
  use cohesive_laws, only: cohesive_objection, create_cohesive_law
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use doubler_bonds, only: check_bonds, is_bond, new_bond, weaker_beside
  use delamination_parameters, only: delamination_t, law_front, law_cohesive, default_starter, toughnesses, &
                                     toughness_objection, release_two_state, release_vcct, growth_equilibrium, &
                                     growth_one_per_step, growth_by_strength, &
                                     growth_by_energy, tie_eliminate, tie_penalty, &
                                     contact_augmented_lagrangian, contact_continuous_penalty, contact_none, &
                                     unloading_contact, unloading_glued
  use interface_places, only: delamination_group, key_below_ply, plies_above
  use kinds, only: wp
  use laminate_deck, only: laminate_group
  use ply_zones, only: ply_zones_t
  use text, only: line_t, to_text, words_of
  implicit none
  private
  public :: fill_delaminations, check_delaminations

  !> Names that checks across groups use.
  character(len=*), parameter, public :: key_zone = 'zone', key_starter = 'starter', key_law = 'law', &
    key_toughness = 'G_c', key_toughness_opening = 'G_Ic', key_toughness_shear = 'G_IIc', key_smoothing = 'smoothing', &
    key_strip = 'starter_strip', key_starter_at = 'starter_at', &
    key_flaws = 'cracks_as_flaws', key_shear_cracks = 'shear_cracks', key_strength_shear = 'strength_shear', &
    key_growth_control = 'growth_control', key_stiffness = 'stiffness'
  character(len=*), parameter :: group = delamination_group
  character(len=group_row_length), parameter, public :: delamination_group_row = &
    'delamination | several | Interfaces that may delaminate; one group for all that have equal properties.'
  character(len=key_row_length), parameter, public :: delamination_rows(*) = [character(len=key_row_length) :: &
    'delamination | below_ply | integer | 1 or more | - | none | >= 1, <= 1000, or ''all'', &
      &or ''between_angles'' | Plies above the interfaces, counted from the struck face, or a word for those &
      &where the angle changes. | not doubler', &
    'delamination | doubler | text | 1 or more | - | none | names of &doubler groups | &
      &Instead of below_ply: doublers whose bond to the laminate may delaminate.', &
    'delamination | G_c | real | 1 | energy/area | none | > 0 | &
      &Critical energy release rate of every mode; given instead of G_Ic and G_IIc. | | toughness', &
    'delamination | G_Ic | real | 1 | energy/area | none | > 0 | Critical energy release rate of pure opening.', &
    'delamination | G_IIc | real | 1 | energy/area | none | > 0 | &
      &Critical energy release rate of pure shear. | | toughness', &
    'delamination | eta | real | 1 | - | 1.75 | > 0, <= 10 | &
      &Exponent of Benzeggagh and Kenane''s mixed-mode law. | not G_c', &
    'delamination | zone | real | 2 | length | = adaptive, with law = cohesive | > 0 | &
      &Full extents along x and y of the rectangle with separate layers, centred on the struck point. | not doubler', &
    'delamination | starter | real | 1 | length | = square of 0.05 % of the plate, with law = cohesive none | > 0 | &
      &Side of the square starter delamination, or diameter of the round one.', &
    'delamination | starter_shape | choice | 1 | - | ''square'' | square round | &
      &Outline of the starter, in whole cells. | starter', &
    'delamination | starter_at | real | 2 | length | = the struck point | any | &
      &Centre of the starter, from the struck point. | starter', &
    'delamination | starter_strip | real | 2 | length | none | any | &
      &First and last x of a starter across the whole width of the zone, from the struck point; instead of starter.', &
    'delamination | law | choice | 1 | - | = cohesive; front with a starter or without strengths | front cohesive | &
      &front: ties are released by the energy release rate; cohesive: tractions soften with the separation.', &
    'delamination | strength_opening | real | 1 | pressure | = YT of the weaker ply beside it | > 0 | &
      &Strength of the cohesive law in pure opening. | law = cohesive', &
    'delamination | strength_shear | real | 1 | pressure | = S12 of the weaker ply beside it | > 0 | &
      &Strength of the cohesive law in pure shear. | law = cohesive | strength', &
    'delamination | stiffness | real | 1 | pressure/length | = 5 n E2/h of the thinner side | > 0 | &
      &Stiffness of the undamaged cohesive law in opening; h: thickness of the laminate on the &
      &thinner side; n: number of interfaces. | law = cohesive', &
    'delamination | friction | real | 1 | - | 0 | >= 0, <= 10 | &
      &Coulomb''s coefficient of friction of damaged surfaces that are closed. | law = cohesive, not contact = none', &
    'delamination | cracks_as_flaws | logical | 1 | - | .false. | .true. .false. | &
      &Beside matrix cracks of adjacent plies damage starts at the strengths whose process zone the cells resolve. | &
      &law = cohesive, &ply_damage', &
    'delamination | shear_cracks | logical | 1 | - | .false. | .true. .false. | &
      &Beside transverse shear cracks of adjacent plies damage starts at the shear strength of these plies. | &
      &law = cohesive, &ply_damage', &
    'delamination | growth_control | choice | 1 | - | ''energy'' | energy strength | &
      &Damage beside delaminated points starts by the energy release rate or the strengths, or by strengths alone. | &
      &law = cohesive, &time integrator = central_difference', &
    'delamination | energy_release | choice | 1 | - | ''vcct'' | two_state vcct | &
      &Energy release rate: Eq. 11 of Li et al. with its sign corrected, or virtual crack closure. | law = front', &
    'delamination | growth | choice | 1 | - | ''equilibrium'' | equilibrium one_per_step | &
      &equilibrium: growth at fixed time until G <= G_c on all fronts; one_per_step: one cell per step. | &
      &law = front', &
    'delamination | tie | choice | 1 | - | ''eliminate'' | eliminate penalty | &
      &Connection of intact surfaces: exact elimination, or penalty springs as by Li et al. | law = front', &
    'delamination | penalty | real | 1 | pressure/length | = from E2 | > 0 | &
      &Stiffness of penalty ties; left out: a million times E2 over the thickness of the thinner side. | &
      &law = front, tie = penalty', &
    'delamination | contact | choice | 1 | - | ''augmented_lagrangian'' | &
      &augmented_lagrangian continuous_penalty none | Contact of separated surfaces.', &
    'delamination | contact_exponent | real | 1 | - | 1 | >= 1, <= 2 | &
      &Exponent q of the continuous penalty (Li et al., Eq. 12). | law = front, contact = continuous_penalty', &
    'delamination | unloading | choice | 1 | - | ''contact'' | contact glued | &
      &During rebound: contact, or relative displacements of separated surfaces held constant (Li et al., Eq. 13b). | &
      &law = front', &
    'delamination | smoothing | real | 1 | length | = 5 cells of the zone, at least the thickness | > 0 | &
      &Distance along a front over which tie forces and openings are averaged for the energy release rate. | &
      &law = front, energy_release = vcct or growth = equilibrium']

contains

  !> All interfaces from the struck face down: the bond of doublers on it, those between plies in the order of the deck,
  !> the bond of doublers on the back.
  subroutine fill_delaminations(settings, length, strengths, of_doublers, between, zones, delaminations)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    !> Lengths of the plate, for the default starter
    real(wp), intent(in) :: length(2)
    !> Strengths YT and S12 of each ply of the laminate and of the doublers, 0 where not given, (2, plies)
    real(wp), intent(in) :: strengths(:, :), of_doublers(:, :)
    !> Plies below which the angle changes; empty: not known
    integer, intent(in) :: between(:)
    !> Doublers of the plate; receive which of them are bonded by a cohesive interface
    type(ply_zones_t), intent(inout) :: zones
    type(delamination_t), allocatable, intent(out) :: delaminations(:)
    type(delamination_t) :: next
    integer, allocatable :: below(:)
    integer :: place, i

    allocate (delaminations(0))
    call add_bonds(on_front=.true.)
    do place = 1, settings%groups_named(group)
      if (is_bond(settings, place)) cycle
      below = plies_above(settings, place, between)
      do i = 1, size(below)
        next = delamination_t()
        next%group = place
        next%below_ply = below(i)
        call add(next)
      end do
    end do
    call add_bonds(on_front=.false.)

  contains

    !> Adds the bonds of doublers on a face.
    subroutine add_bonds(on_front)
      !> True for the struck face
      logical, intent(in) :: on_front
      integer :: place

      do place = 1, settings%groups_named(group)
        if (.not. is_bond(settings, place)) cycle
        call new_bond(settings, place, size(strengths, 2), zones, next)
        if (next%is_on_front() .eqv. on_front) call add(next)
      end do
    end subroutine add_bonds

    !> Adds an interface with its properties.
    subroutine add(next)
      !> Group and position are known
      type(delamination_t), intent(inout) :: next

      call fill_law(settings, next%group, size(strengths, 2), weaker_beside(next, strengths, of_doublers), next)
      call fill_delamination(settings, next%group, default_starter(length), next)
      delaminations = [delaminations, next]
    end subroutine add
  end subroutine fill_delaminations

  !> One interface.
  subroutine fill_delamination(settings, place, starter, delamination)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    integer, intent(in) :: place
    !> Default side of the starter of a front
    real(wp), intent(in) :: starter
    !> Receives it; its law is set
    type(delamination_t), intent(inout) :: delamination

    delamination%starter = merge(starter, 0.0_wp, delamination%law == law_front .and. &
                                 .not. settings%is_given(group, key_strip, place))
    if (.not. settings%is_given(group, key_starter, place)) &
      call settings%derive(group, key_starter, to_text(delamination%starter), .false., place)
    associate (s => settings, d => delamination)
      d%toughness = s%real_of(group, 'G_c', place)
      d%toughness_opening = s%real_of(group, key_toughness_opening, place)
      d%toughness_shear = s%real_of(group, key_toughness_shear, place)
      d%mixing_exponent = s%real_of(group, 'eta', place)
      d%friction = s%real_of(group, 'friction', place)
      d%cracks_as_flaws = s%logical_of(group, key_flaws, place)
      d%shear_cracks = s%logical_of(group, key_shear_cracks, place)
      d%growth_control = code_of(s%text_of(group, key_growth_control, place), 'strength energy', &
                                 [growth_by_strength, growth_by_energy])
      if (s%is_known(group, key_zone, place) .and. .not. d%bonds_doublers()) d%zone = s%reals_of(group, key_zone, place)
      d%is_adaptive = d%law == law_cohesive .and. .not. (s%is_given(group, key_zone, place) .or. d%bonds_doublers())
      if (s%is_given(group, key_starter, place)) d%starter = s%real_of(group, key_starter, place)
      if (s%is_given(group, key_strip, place)) d%starter_strip = s%reals_of(group, key_strip, place)
      d%starter_round = s%text_of(group, 'starter_shape', place) == 'round'
      if (s%is_given(group, key_starter_at, place)) d%starter_at = s%reals_of(group, key_starter_at, place)
      d%penalty_stiffness = s%real_of(group, 'penalty', place)
      d%contact_exponent = s%real_of(group, 'contact_exponent', place)
      d%smoothing = s%real_of(group, key_smoothing, place)
      d%energy_release = code_of(s%text_of(group, 'energy_release', place), 'two_state vcct', &
                                 [release_two_state, release_vcct])
      d%growth = code_of(s%text_of(group, 'growth', place), 'equilibrium one_per_step', &
                         [growth_equilibrium, growth_one_per_step])
      d%tie = code_of(s%text_of(group, 'tie', place), 'eliminate penalty', [tie_eliminate, tie_penalty])
      d%contact = code_of(s%text_of(group, 'contact', place), 'augmented_lagrangian continuous_penalty none', &
                          [contact_augmented_lagrangian, contact_continuous_penalty, contact_none])
      d%unloading = code_of(s%text_of(group, 'unloading', place), 'contact glued', [unloading_contact, unloading_glued])
    end associate
  end subroutine fill_delamination

  !> The law of one interface, by default cohesive if no key of a front is given and the strengths are known, and its
  !> strengths.
  subroutine fill_law(settings, place, plies, weaker, delamination)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    !> Index of the group, and number of plies of the laminate
    integer, intent(in) :: place, plies
    !> Strengths YT and S12 of the weaker ply; 0: not given
    real(wp), intent(in) :: weaker(2)
    type(delamination_t), intent(inout) :: delamination
    logical :: is_cohesive

    ! By default it is one where no key of a front is given, and the strengths are known.
    ! Without plies, as their group has errors, only the key of a front decides.
    is_cohesive = .not. needs_front(settings, place) .and. (plies == 0 .or. &
                  (weaker(1) > 0 .or. settings%is_given(group, 'strength_opening', place)) .and. &
                  (weaker(2) > 0 .or. settings%is_given(group, key_strength_shear, place)))
    is_cohesive = is_cohesive .or. delamination%bonds_doublers()
    if (.not. settings%is_given(group, key_law, place)) call settings%derive(group, key_law, &
      trim(merge('cohesive', 'front   ', is_cohesive)), .true., place)
    delamination%law = code_of(settings%text_of(group, key_law, place), 'front cohesive', [law_front, law_cohesive])
    if (delamination%bonds_doublers()) delamination%law = law_cohesive  ! a front is refused
    if (delamination%law /= law_cohesive) return
    delamination%stiffness = settings%real_of(group, key_stiffness, place)
    call fill_strength(settings, place, 'strength_opening', weaker(1), delamination%strength_opening)
    call fill_strength(settings, place, key_strength_shear, weaker(2), delamination%strength_shear)
  end subroutine fill_law

  !> True if the deck gives a key that only a front has.
  pure logical function needs_front(settings, place)
    type(settings_t), intent(in) :: settings
    integer, intent(in) :: place
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(key_starter//' energy_release growth tie penalty unloading smoothing contact_exponent', ' ')
    needs_front = any([(settings%is_given(group, names(i)%text, place), i=1, size(names))])
  end function needs_front

  !> One strength: that of the key, or by default that of the plies.
  subroutine fill_strength(settings, place, key, of_plies, strength)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    integer, intent(in) :: place
    character(len=*), intent(in) :: key
    !> Strength of the weaker ply; 0: not given
    real(wp), intent(in) :: of_plies
    !> Receives it
    real(wp), intent(out) :: strength

    if (.not. settings%is_given(group, key, place) .and. of_plies > 0) &
      call settings%derive(group, key, to_text(of_plies), .false., place)
    strength = of_plies
    if (settings%is_given(group, key, place)) strength = settings%real_of(group, key, place)
  end subroutine fill_strength

  !> Checks each interface, and their order.
  subroutine check_delaminations(settings, zones, delaminations, problems)
    type(settings_t), intent(in) :: settings
    !> Doublers of the plate
    type(ply_zones_t), intent(in) :: zones
    type(delamination_t), intent(in) :: delaminations(:)
    type(problems_t), intent(inout) :: problems
    integer :: place, before, i

    place = 0
    do i = 1, size(delaminations)
      before = place
      place = delaminations(i)%group
      call check_strengths(settings, delaminations(i), place, problems)
      if (place == before) cycle
      call check_toughness(settings, delaminations(i), place, problems)
      call check_strip(settings, delaminations(i), place, problems)
      if (delaminations(i)%bonds_doublers()) cycle
      if (delaminations(i)%starter > 0 .and. settings%is_given(group, key_zone, place) .and. &
          any(delaminations(i)%starter + 2*abs(delaminations(i)%starter_at) >= delaminations(i)%zone) .and. &
          are_clear(settings, problems, group, key_zone//' '//key_starter//' '//key_starter_at, place)) &
        call report(settings, problems, group, '', 'the starter must be smaller than its zone and inside it.', place)
    end do
    call check_bonds(settings, zones, delaminations, problems)
    do i = 2, size(delaminations)
      if (delaminations(i)%bonds_doublers() .or. delaminations(i - 1)%bonds_doublers()) cycle
      if (delaminations(i)%below_ply <= delaminations(i - 1)%below_ply .and. &
          are_clear(settings, problems, group, key_below_ply, delaminations(i)%group) .and. &
          are_clear(settings, problems, group, key_below_ply, delaminations(i - 1)%group)) &
        call report(settings, problems, group, key_below_ply, 'is not below the preceding interface; give each '// &
                  'interface once, in order from the struck face.', delaminations(i)%group)
    end do
  end subroutine check_delaminations

  !> Checks that a strip has ascending ends, and that no square starter is given too.
  subroutine check_strip(settings, delamination, place, problems)
    type(settings_t), intent(in) :: settings
    type(delamination_t), intent(in) :: delamination
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    if (.not. settings%is_given(group, key_strip, place)) return
    if (.not. are_clear(settings, problems, group, key_strip//' '//key_starter, place)) return
    if (settings%is_given(group, key_starter, place)) then
      call report(settings, problems, group, key_strip, 'a starter is a square or a strip; give one of them.', place)
    else if (.not. delamination%has_strip()) then
      call report(settings, problems, group, key_strip, 'the first x must be smaller than the second.', place)
    end if
  end subroutine check_strip

  !> Checks that toughnesses are consistent, and suffice for the energy release rate.
  subroutine check_toughness(settings, delamination, place, problems)
    type(settings_t), intent(in) :: settings
    type(delamination_t), intent(in) :: delamination
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    if (.not. are_clear(settings, problems, group, 'G_c G_Ic G_IIc', place)) return
    if (toughness_objection(delamination) /= '') then
      call report(settings, problems, group, '', toughness_objection(delamination)//'.', place)
    else if (delamination%energy_release == release_two_state .and. delamination%toughness <= 0) then
      call report(settings, problems, group, 'energy_release', &
                  'Eq. 11 of the paper does not separate the modes; give G_c, or energy_release = ''vcct''.', place)
    end if
  end subroutine check_toughness

  !> Checks the strengths of a cohesive law, whose defaults may differ between interfaces; warns of a front by default.
  subroutine check_strengths(settings, delamination, place, problems)
    type(settings_t), intent(in) :: settings
    type(delamination_t), intent(in) :: delamination
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    if (delamination%law /= law_cohesive) then
      if (.not. (settings%is_given(group, key_law, place) .or. needs_front(settings, place))) &
        call remark(settings, problems, group, '', 'law = ''front'' with a default starter is used, as a '// &
                    'cohesive law needs strength_opening and strength_shear, or YT and S12 of the materials.', place)
      return
    end if
    call check_law(settings, delamination, place, problems)
    ! Without a position of the interface, or without the laminate, its adjacent plies are not known, and their
    ! strengths are the defaults.
    if (problems%concern(laminate_group)) return
    if (delamination%below_ply < 1 .and. .not. delamination%bonds_doublers()) return
    if (.not. delamination%strength_opening > 0) call require('strength_opening', 'or YT of the materials.')
    if (.not. delamination%strength_shear > 0) call require(key_strength_shear, 'or S12 of the materials.')

  contains

    !> Reports a missing strength, unless its key already has an error.
    subroutine require(key, other)
      !> The key, and its alternative
      character(len=*), intent(in) :: key, other

      if (are_clear(settings, problems, group, key, place)) call report(settings, problems, group, key, &
        'is missing; a cohesive law needs it, '//other, place)
    end subroutine require
  end subroutine check_strengths

  !> Checks the stiffness of the law.
  subroutine check_law(settings, delamination, place, problems)
    type(settings_t), intent(in) :: settings
    type(delamination_t), intent(in) :: delamination
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: objection

    if (.not. settings%is_given(group, key_stiffness, place) .or. problems%concern(group, key_stiffness, place)) return
    if (.not. are_clear(settings, problems, group, &
                        'G_c G_Ic G_IIc eta strength_opening strength_shear stiffness', place)) return
    associate (d => delamination)
      if (.not. (d%strength_opening > 0 .and. d%strength_shear > 0) .or. toughness_objection(d) /= '') return
      objection = cohesive_objection(create_cohesive_law(toughnesses(d), d%mixing_exponent, [d%strength_opening, &
                                                         d%strength_shear], d%stiffness, 0.0_wp, 0.0_wp))
    end associate
    if (objection /= '') call report(settings, problems, group, key_stiffness, objection//'.', place)
  end subroutine check_law
end module delamination_deck
