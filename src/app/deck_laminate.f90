!> Fills materials and plies from the keys in effect, with the checks that decide what they are.
module deck_laminate
  use deck_contents, only: deck_t
  use deck_filling, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: tell
  use kinds, only: wp
  use laminate_parameters, only: shear_five_sixths, shear_energy
  use material_parameters, only: material_t
  use plies, only: material_objection
  use text, only: line_t, append, joined, nearest_name, to_text, words_of
  implicit none
  private
  public :: fill_materials, fill_laminate

  !> Keys of an orthotropic material that have to be there, and all of them.
  character(len=*), parameter :: needed_keys = 'E1 E2 G12 G23 nu12', orthotropic_keys = needed_keys//' G13 nu23'
  !> Largest ratio of two moduli of a material; rounding spoils the answer beyond.
  real(wp), parameter :: most_contrast = 1.0e6_wp
  !> Most plies of a laminate.
  integer, parameter :: most_plies = 1000

contains

  !> All materials.
  subroutine fill_materials(deck, problems)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    integer :: i, j

    allocate (deck%materials(deck%settings%groups_named('material')))
    do i = 1, size(deck%materials)
      call fill_material(deck, i, problems)
      do j = 1, i - 1
        if (deck%materials(i)%name /= deck%materials(j)%name .or. deck%materials(i)%name == '') cycle
        call tell(deck%settings, problems, 'material', 'name', 'another material has this name; give each its own.', i)
        exit
      end do
    end do
  end subroutine fill_materials

  !> One material.
  subroutine fill_material(deck, place, problems)
    !> Receives it
    type(deck_t), intent(inout) :: deck
    !> Its index
    integer, intent(in) :: place
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    logical :: complete

    associate (s => deck%settings, m => deck%materials(place))
      m%name = trim(s%text_of('material', 'name', place))
      m%density = s%real_of('material', 'density', place)
      m%xt = s%real_of('material', 'XT', place)
      m%xc = s%real_of('material', 'XC', place)
      m%yt = s%real_of('material', 'YT', place)
      m%yc = s%real_of('material', 'YC', place)
      m%s12 = s%real_of('material', 'S12', place)
      m%sf = s%real_of('material', 'Sf', place)
      m%sm23 = s%real_of('material', 'Sm23', place)
      call judge_completeness(deck, place, problems, complete)
      if (.not. complete) return
      if (s%is_given('material', 'E', place)) then
        call fill_isotropic(deck, place)
      else
        call fill_orthotropic(deck, place)
      end if
      if (material_objection(m) /= '') then
        call tell(deck%settings, problems, 'material', '', material_objection(m)//'.', place)
      else if (contrast(m) > most_contrast) then
        call tell(deck%settings, problems, 'material', '', 'its moduli differ by more than a factor of '// &
                  to_text(most_contrast)//', where rounding spoils the answer.', place)
      end if
    end associate
  end subroutine fill_material

  !> Largest over smallest modulus of a material.
  pure real(wp) function contrast(material)
    !> The material
    type(material_t), intent(in) :: material
    real(wp) :: moduli(5)

    moduli = [material%e1, material%e2, material%g12, material%g13, material%g23]
    contrast = maxval(moduli)/minval(moduli)
  end function contrast

  !> Whether the elastic constants are all there and sound; tells what is missing.
  subroutine judge_completeness(deck, place, problems, complete)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    !> True: they are
    logical, intent(out) :: complete
    type(line_t), allocatable :: given(:), missing(:)

    complete = .false.
    given = words_with(deck, place, orthotropic_keys, .true.)
    if (deck%settings%is_given('material', 'E', place) .or. deck%settings%is_given('material', 'nu', place)) then
      missing = words_with(deck, place, 'E nu', .false.)
      if (size(given) > 0) then
        call tell(deck%settings, problems, 'material', given(1)%text, 'the material has E or nu too; give either E and nu '// &
                  '(isotropic) or E1, E2, G12, G23, nu12 (orthotropic).', place)
        return
      end if
    else
      missing = words_with(deck, place, needed_keys, .false.)
      if (size(given) == 0) then
        deallocate (missing)
        call append(missing, 'E and nu (isotropic) or E1, E2, G12, G23, nu12 (orthotropic)')
      end if
    end if
    if (size(missing) > 0) then
      if (.not. is_misspelt(missing, problems)) call tell(deck%settings, problems, 'material', '', &
        joined(missing, ', ')//' must be given too.', place)
      return
    end if
    complete = all_known(deck, place)
  end subroutine judge_completeness

  !> Those of some keys that the deck gives, or those that it doesn't.
  function words_with(deck, place, keys, given) result(words)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> Names separated by blanks
    character(len=*), intent(in) :: keys
    !> True: those given
    logical, intent(in) :: given
    !> The names
    type(line_t), allocatable :: words(:)
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    allocate (words(0))
    do i = 1, size(names)
      if (deck%settings%is_given('material', names(i)%text, place) .eqv. given) call append(words, names(i)%text)
    end do
  end function words_with

  !> True: one of the missing keys is there under a wrong name, which was told already.
  logical function is_misspelt(missing, problems)
    !> Names of keys
    type(line_t), intent(in) :: missing(:)
    !> The faults so far
    type(problems_t), intent(in) :: problems
    integer :: i

    is_misspelt = any([(problems%concern('material', missing(i)%text), i=1, size(missing))])
  end function is_misspelt

  !> True: every key of a material that is given can be used.
  pure logical function all_known(deck, place)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    integer :: i

    all_known = .true.
    do i = 1, size(deck%settings%items)
      associate (item => deck%settings%items(i))
        if (item%group == 'material' .and. item%place == place) all_known = all_known .and. item%sound
      end associate
    end do
  end function all_known

  !> Constants of an isotropic material.
  subroutine fill_isotropic(deck, place)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Index of the material
    integer, intent(in) :: place

    associate (m => deck%materials(place))
      m%e1 = deck%settings%real_of('material', 'E', place)
      m%nu12 = deck%settings%real_of('material', 'nu', place)
      m%e2 = m%e1
      m%nu23 = m%nu12
      m%g12 = m%e1/(2*(1 + m%nu12))
      m%g13 = m%g12
      m%g23 = m%g12
    end associate
  end subroutine fill_isotropic

  !> Constants of an orthotropic material.
  subroutine fill_orthotropic(deck, place)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Index of the material
    integer, intent(in) :: place

    associate (s => deck%settings, m => deck%materials(place))
      m%e1 = s%real_of('material', 'E1', place)
      m%e2 = s%real_of('material', 'E2', place)
      m%g12 = s%real_of('material', 'G12', place)
      if (.not. s%is_given('material', 'G13', place)) call s%derive('material', 'G13', to_text(m%g12), .false., place)
      m%g13 = s%real_of('material', 'G13', place)
      m%g23 = s%real_of('material', 'G23', place)
      m%nu12 = s%real_of('material', 'nu12', place)
      m%nu23 = s%real_of('material', 'nu23', place)
    end associate
  end subroutine fill_orthotropic

  !> The plies; left unallocated if they aren't clear.
  subroutine fill_laminate(deck, problems)
    !> Receives them
    type(deck_t), intent(inout) :: deck
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: angles(:), thicknesses(:)
    type(line_t), allocatable :: names(:)
    integer, allocatable :: materials(:)
    integer :: plies, i

    associate (s => deck%settings)
      deck%laminate%shear_correction = code_of(s%text_of('laminate', 'shear_correction'), '5/6 energy', &
                                               [shear_five_sixths, shear_energy])
      angles = s%reals_of('laminate', 'angles')
      thicknesses = s%reals_of('laminate', 'thicknesses')
      names = s%texts_of('laminate', 'materials')
    end associate
    plies = size(angles)
    allocate (materials(size(names)))
    do i = 1, size(names)
      call find_material(deck, trim(names(i)%text), problems, materials(i))
    end do
    if (plies > most_plies) call tell(deck%settings, problems, 'laminate', 'angles', 'more than '//to_text(most_plies)// &
                                      ' plies.')
    if (plies == 0 .or. plies > most_plies) return
    call check_number(deck, 'thicknesses', size(thicknesses), plies, problems)
    call check_number(deck, 'materials', size(names), plies, problems)
    if (problems%concern('laminate') .or. any(materials == 0)) return
    if (size(materials) == 0 .or. size(thicknesses) == 0) return
    deck%laminate%angle = angles
    deck%laminate%thickness = [(thicknesses(min(i, size(thicknesses))), i=1, plies)]
    deck%laminate%material = [(materials(min(i, size(materials))), i=1, plies)]
  end subroutine fill_laminate

  !> A list that has one value or one a ply.
  subroutine check_number(deck, key, number, plies, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Name of the list
    character(len=*), intent(in) :: key
    !> Number of its values
    integer, intent(in) :: number
    !> Number of plies
    integer, intent(in) :: plies
    !> Faults found are added
    type(problems_t), intent(inout) :: problems

    if (number <= 1 .or. number == plies) return
    call tell(deck%settings, problems, 'laminate', key, to_text(number)//' values, but angles has '//to_text(plies)// &
              '; allowed: 1 value for all plies or 1 a ply.')
  end subroutine check_number

  !> Index of a material by its name, 0 if there is none.
  subroutine find_material(deck, name, problems, index)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Name of the material
    character(len=*), intent(in) :: name
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    !> The index
    integer, intent(out) :: index
    type(line_t), allocatable :: names(:)

    allocate (names(0))
    do index = 1, size(deck%materials)
      if (deck%materials(index)%name == name) return
      call append(names, deck%materials(index)%name)
    end do
    index = 0
    ! Without sound names of materials, and once for the same list, there is nothing to say.
    if (problems%concern('material', 'name') .or. problems%concern('laminate', 'materials')) return
    if (problems%concern('material') .and. size(names) == 0) return
    if (nearest_name(name, names) /= '') then
      call tell(deck%settings, problems, 'laminate', 'materials', 'no &material is named '''//name//'''; did you mean '''// &
                nearest_name(name, names)//'''?')
    else
      call tell(deck%settings, problems, 'laminate', 'materials', 'no &material is named '''//name//'''; allowed: '''// &
                joined(names, ''', ''')//'''.')
    end if
  end subroutine find_material
end module deck_laminate
