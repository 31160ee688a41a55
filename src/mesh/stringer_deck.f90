!> Stringers of the deck: rows of its table, filling and checks.
module stringer_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: are_clear, remark, report
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use roundings, only: rounding
  use stringer_sections, only: section_of_sizes, section_of_stiffness, stringer_section_t
  use stringers, only: face_back, face_front, stringer_t
  use text, only: line_t, lower_case, to_text, words_of
  implicit none
  private
  public :: fill_stringers, check_stringers

  !> Names that checks across groups use.
  character(len=*), parameter, public :: stringer_group = 'stringer', key_stringer_at = 'at', key_ends(2) = &
                                         [character(len=4) :: 'from', 'to'], key_along = 'along', &
                                         key_section = 'section'
  character(len=*), parameter :: group = stringer_group
  !> Sections, and the keys of their sizes and of their stiffness, those required first.
  character(len=*), parameter :: sections = 'blade t given'
  integer, parameter :: blade = 1, with_cap = 2, given = 3
  character(len=*), parameter :: sizes = 'height thickness E density', cap_sizes = 'cap_width cap_thickness', &
                                 stiffnesses = 'EA EI GJ mass_per_length', &
                                 other_stiffnesses = 'EI_lateral eccentricity'
  !> E/G of an isotropic material with Poisson's ratio .3.
  real(wp), parameter :: isotropic_ratio = 2*(1 + 0.3_wp)
  character(len=group_row_length), parameter, public :: stringer_group_row = &
    'stringer | several | A stiffener bonded to a face of the plate, a beam along a line of the mesh.'
  character(len=key_row_length), parameter, public :: stringer_rows(*) = [character(len=key_row_length) :: &
    'stringer | name | name | 1 | - | required | letters, digits, . _ - | &
      &Name, in messages.', &
    'stringer | along | choice | 1 | - | ''x'' | x y | &
      &Direction in which it runs.', &
    'stringer | at | real | 1 | length | 0 | any | &
      &Other coordinate from the plate''s centre: y along x, x along y; it becomes a line of the mesh.', &
    'stringer | from | real | 1 | length | = edge of the plate | any | &
      &Coordinate of its first end, along its direction, from the plate''s centre.', &
    'stringer | to | real | 1 | length | = edge of the plate | any | &
      &Coordinate of its other end.', &
    'stringer | face | choice | 1 | - | ''back'' | front back | &
      &Face that it is bonded to: the struck one (front) or the opposite one (back).', &
    'stringer | section | choice | 1 | - | ''blade'' | blade T given | &
      &blade: a web; T: a web with a cap on its free edge; given: stiffness and mass are given.', &
    'stringer | height | real | 1 | length | none | > 0 | &
      &Height of the web of a blade or T, from the face to its free edge or to the cap.', &
    'stringer | thickness | real | 1 | length | none | > 0 | &
      &Thickness of the web of a blade or T.', &
    'stringer | cap_width | real | 1 | length | none | > 0 | &
      &Width of the cap of a T.', &
    'stringer | cap_thickness | real | 1 | length | none | > 0 | &
      &Thickness of the cap of a T.', &
    'stringer | E | real | 1 | pressure | none | > 0 | &
      &Young''s modulus along the stringer; with section = ''given'' only E/G counts, against shear.', &
    'stringer | G | real | 1 | pressure | = E/2.6 | > 0 | &
      &Shear modulus; the default is that of an isotropic material with Poisson''s ratio .3.', &
    'stringer | XT | real | 1 | pressure | none | > 0 | &
      &Strength along the stringer in tension; the run warns where its free edge exceeds it. | E', &
    'stringer | XC | real | 1 | pressure | none | > 0 | &
      &Strength along it in compression. | E', &
    'stringer | density | real | 1 | mass/volume | none | > 0 | &
      &Density of a blade or T.', &
    'stringer | EA | real | 1 | force | none | > 0 | &
      &Axial stiffness of a given section.', &
    'stringer | EI | real | 1 | force*area | none | > 0 | &
      &Bending stiffness of a given section about its centroid, against bending out of the plate.', &
    'stringer | EI_lateral | real | 1 | force*area | 0 | >= 0 | &
      &Bending stiffness of a given section about the normal of the plate; it counts in the inertia of twist only.', &
    'stringer | GJ | real | 1 | force*area | none | > 0 | &
      &Torsional stiffness of a given section.', &
    'stringer | mass_per_length | real | 1 | mass/length | none | > 0 | &
      &Mass per length of a given section.', &
    'stringer | eccentricity | real | 1 | length | 0 | >= 0 | &
      &Distance of the centroid of a given section from the face that it is bonded to, outwards.']

contains

  !> All stringers, in the order of the deck.
  subroutine fill_stringers(settings, length, all)
    !> Keys in effect; receives the defaults of keys left out
    type(settings_t), intent(inout) :: settings
    real(wp), intent(in) :: length(2)
    type(stringer_t), allocatable, intent(out) :: all(:)
    real(wp) :: modulus
    integer :: place, i

    allocate (all(settings%groups_named(group)))
    do place = 1, size(all)
      associate (stringer => all(place), s => settings)
        stringer%name = trim(s%text_of(group, 'name', place))
        stringer%along = code_of(s%text_of(group, key_along, place), 'x y', [1, 2])
        stringer%face = code_of(s%text_of(group, 'face', place), 'front back', [face_front, face_back])
        stringer%at = s%real_of(group, key_stringer_at, place)
        stringer%ends = [-length(stringer%along), length(stringer%along)]/2
        do i = 1, 2
          if (s%is_given(group, trim(key_ends(i)), place)) then
            stringer%ends(i) = s%real_of(group, trim(key_ends(i)), place)
          else
            call s%derive(group, trim(key_ends(i)), to_text(stringer%ends(i)), .false., place)
          end if
        end do
        stringer%section = section_of_group(s, place)
        modulus = s%real_of(group, 'E', place)
        if (modulus > 0) &
          stringer%failure_strains = [s%real_of(group, 'XT', place), s%real_of(group, 'XC', place)]/modulus
      end associate
    end do
  end subroutine fill_stringers

  !> Section of a stringer, by its sizes or its stiffness.
  type(stringer_section_t) function section_of_group(settings, place) result(section)
    type(settings_t), intent(in) :: settings
    !> Index of its group
    integer, intent(in) :: place
    real(wp) :: shear_modulus, ratio, cap(2)

    shear_modulus = of('E')/isotropic_ratio
    if (settings%is_given(group, 'G', place)) shear_modulus = of('G')
    if (section_of(settings, place) == given) then
      ratio = 1/isotropic_ratio
      if (of('E') > 0) ratio = shear_modulus/of('E')
      section = section_of_stiffness(of('EA'), of('EI'), of('EI_lateral'), of('GJ'), ratio, of('mass_per_length'), &
                                     of('eccentricity'))
    else
      cap = 0
      if (section_of(settings, place) == with_cap) cap = [of('cap_width'), of('cap_thickness')]
      section = section_of_sizes([of('height'), of('thickness')], cap, of('E'), shear_modulus, of('density'))
    end if

  contains

    !> Value of one of its keys; 0: it is not given.
    real(wp) function of(key)
      character(len=*), intent(in) :: key

      of = settings%real_of(group, key, place)
    end function of
  end function section_of_group

  !> Kind of a section.
  integer function section_of(settings, place) result(section)
    type(settings_t), intent(in) :: settings
    !> Index among the stringers
    integer, intent(in) :: place

    section = code_of(settings%text_of(group, key_section, place), sections, [blade, with_cap, given])
  end function section_of

  !> Checks names, places and sections.
  subroutine check_stringers(settings, length, is_heated, all, problems)
    type(settings_t), intent(in) :: settings
    real(wp), intent(in) :: length(2)
    !> True: the plate expands with temperature
    logical, intent(in) :: is_heated
    type(stringer_t), intent(in) :: all(:)
    type(problems_t), intent(inout) :: problems
    integer :: place, other

    if (is_heated .and. size(all) > 0) &
      call remark(settings, problems, group, '', 'stringers do not expand with temperature and hold the plate.', 1)
    do place = 1, size(all)
      do other = 1, place - 1
        if (lower_case(all(other)%name) == lower_case(all(place)%name) .and. all(place)%name /= '') then
          call report(settings, problems, group, 'name', 'another stringer has this name; give each its own.', place)
          exit
        end if
        if (.not. overlap(all(other), all(place), rounding*maxval(length))) cycle
        call report(settings, problems, group, key_stringer_at, 'lies on stringer '''//all(other)%name//''', on '// &
                    'the same face; allowed: stringers side by side, or end to end.', place)
        exit
      end do
      call check_place(settings, length, all(place), place, problems)
      call check_section(settings, place, problems)
    end do
  end subroutine check_stringers

  !> True if two stringers lie on each other.
  pure logical function overlap(one, other, tolerance)
    !> The stringers
    type(stringer_t), intent(in) :: one, other
    !> Distance that is round-off
    real(wp), intent(in) :: tolerance

    overlap = one%along == other%along .and. one%face == other%face .and. abs(one%at - other%at) <= tolerance .and. &
              min(one%ends(2), other%ends(2)) - max(one%ends(1), other%ends(1)) > tolerance
  end function overlap

  !> Checks that a stringer lies on the plate.
  subroutine check_place(settings, length, stringer, place, problems)
    type(settings_t), intent(in) :: settings
    real(wp), intent(in) :: length(2)
    type(stringer_t), intent(in) :: stringer
    !> Its index
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    real(wp) :: half(2)
    integer :: i

    half = length/2*(1 + rounding)
    if (.not. are_clear(settings, problems, group, 'at from to along', place) .or. .not. all(length > 0)) return
    if (abs(stringer%at) > half(3 - stringer%along)) &
      call report(settings, problems, group, key_stringer_at, 'the stringer lies off the plate; allowed: from '// &
                  to_text(-length(3 - stringer%along)/2)//' to '//to_text(length(3 - stringer%along)/2)//'.', place)
    do i = 1, 2
      if (abs(stringer%ends(i)) > half(stringer%along)) &
        call report(settings, problems, group, trim(key_ends(i)), 'the stringer ends off the plate; allowed: from '// &
                    to_text(-length(stringer%along)/2)//' to '//to_text(length(stringer%along)/2)//'.', place)
    end do
    if (.not. stringer%ends(2) > stringer%ends(1)) &
      call report(settings, problems, group, trim(key_ends(2)), 'the stringer has no length; allowed: a coordinate '// &
                  'beyond from.', place)
  end subroutine check_place

  !> Checks that a section has the values that it requires, and not sizes and stiffness.
  subroutine check_section(settings, place, problems)
    type(settings_t), intent(in) :: settings
    !> Index of the stringer
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems

    select case (section_of(settings, place))
    case (given)
      call require(stiffnesses, 'section = ''given''')
      call refuse(sizes(:len('height thickness'))//' '//cap_sizes//' density', 'section = ''given'' has no sizes; '// &
                  'give EA, EI, GJ and mass_per_length, or a section by sizes.')
    case (with_cap)
      call require(sizes//' '//cap_sizes, 'section = ''T''')
      call refuse(stiffnesses//' '//other_stiffnesses, 'follows from the sizes of section = ''T''; give sizes, or '// &
                  'section = ''given''.')
    case default
      call require(sizes, 'section = ''blade''')
      call refuse(stiffnesses//' '//other_stiffnesses, 'follows from the sizes of section = ''blade''; give sizes, '// &
                  'or section = ''given''.')
      call refuse(cap_sizes, 'a blade has no cap; allowed: with section = ''T''.')
    end select

  contains

    !> Reports keys that are missing.
    subroutine require(keys, reason)
      !> Names, and the section
      character(len=*), intent(in) :: keys, reason
      type(line_t), allocatable :: names(:)
      integer :: i

      names = words_of(keys, ' ')
      do i = 1, size(names)
        if (settings%is_given(group, names(i)%text, place)) cycle
        if (.not. are_clear(settings, problems, group, names(i)%text, place)) cycle
        call report(settings, problems, group, names(i)%text, 'is missing; it is required with '//reason//'.', place)
      end do
    end subroutine require

    !> Reports keys that do not belong to the section.
    subroutine refuse(keys, reason)
      !> Names, and the reason
      character(len=*), intent(in) :: keys, reason
      type(line_t), allocatable :: names(:)
      integer :: i

      names = words_of(keys, ' ')
      do i = 1, size(names)
        if (settings%is_given(group, names(i)%text, place)) &
          call report(settings, problems, group, names(i)%text, reason, place)
      end do
    end subroutine refuse
  end subroutine check_section
end module stringer_deck
