!> Reports keys without effect because the group that uses them is missing.
module deck_idle_keys
  use case_deck, only: case_group, key_name, stem_of
  use controls_deck, only: controls_group
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark, remark_idle, remark_unused
  use deck_vocabulary, only: vocabulary_t
  use interface_places, only: interfaces_between
  use impact_parameters, only: law_thornton
  use indentation_deck, only: takes_laminate
  use material_deck, only: material_group, key_fibre_shear, key_shear_23, of_interfaces, strength_keys, toughness_keys
  use ply_damage_deck, only: ply_damage_group
  use ply_damage_parameters, only: criteria_hou, criteria_puck, criteria_larc
  implicit none
  private
  public :: check_idle_keys

contains

  !> Adds the remarks.
  subroutine check_idle_keys(deck, vocabulary, problems)
    type(deck_t), intent(in) :: deck
    type(vocabulary_t), intent(in) :: vocabulary
    type(problems_t), intent(inout) :: problems
    integer :: place

    call remark_unused(deck%settings, vocabulary, problems)
    do place = 1, size(deck%setup%materials)
      call check_material(deck, place, problems)
    end do
    associate (s => deck%settings)
      if (.not. s%is_given(case_group, key_name) .and. s%text_of(case_group, key_name) /= stem_of(deck%source)) &
        call remark(s, problems, case_group, key_name, 'is '''//s%text_of(case_group, key_name)//''', as the file '// &
                    'name of the deck has other characters than letters, digits, . _ and -; give a name, so that '// &
                    'decks do not share results.')
      if (s%has_group(controls_group)) call remark(s, problems, controls_group, '', 'is for studies of the iteration.')
    end associate
  end subroutine check_idle_keys

  !> Remarks on a material without plies, and on constants without effect.
  subroutine check_material(deck, place, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    logical :: has_yield_pressure

    if (allocated(deck%setup%laminate%material)) then
      if (.not. any(deck%setup%used_materials() == place) .and. problems%errors() == 0) then
        call remark(deck%settings, problems, material_group, '', ''''//deck%setup%materials(place)%name// &
                    ''' has no effect: no ply of the laminate has it.', place)
        return
      end if
    end if
    if (problems%concern(ply_damage_group)) return
    if (deck%setup%ply_damage%is_present) then
      if (deck%setup%ply_damage%criteria /= criteria_hou .or. any(deck%setup%materials(place)%toughness > 0)) &
        call remark_idle(deck%settings, problems, material_group, key_fibre_shear, &
                         'has no effect: only criteria = ''hou'' without fracture energies contain it.', place)
      if (any(deck%setup%ply_damage%criteria == [criteria_puck, criteria_larc])) &
        call remark_idle(deck%settings, problems, material_group, key_shear_23, &
                         'has no effect with criteria = '''//trim(merge('puck', 'larc', &
                           deck%setup%ply_damage%criteria == criteria_puck))//'''.', place)
      return
    end if
    ! Strengths of the plies determine the yield pressure of the struck face.
    has_yield_pressure = deck%setup%impactor%is_present .and. &
                         deck%setup%impactor%indentation%law == law_thornton .and. takes_laminate(deck%settings)
    call remark_first(deck, place, pack(strength_keys, .not. ((of_interfaces .and. has_interfaces(deck)) .or. &
      (has_yield_pressure .and. (strength_keys == 'YC' .or. strength_keys == key_shear_23)))), 'strengths', &
                      problems)
    call remark_first(deck, place, toughness_keys, 'fracture energies', problems)
  end subroutine check_material

  !> True: plies differ from each other or may separate, so that there are interfaces with strengths between them.
  pure logical function has_interfaces(deck)
    type(deck_t), intent(in) :: deck

    has_interfaces = size(deck%setup%delaminations) > 0
    if (.not. (allocated(deck%setup%laminate%angle) .and. allocated(deck%setup%laminate%material))) return
    associate (laminate => deck%setup%laminate)
      has_interfaces = has_interfaces .or. size(interfaces_between(laminate%angle, laminate%material)) > 0
    end associate
  end function has_interfaces

  !> Remarks on the first given key of several without effect where plies do not fail.
  subroutine remark_first(deck, place, keys, quantities, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> The keys, and the quantities that they give
    character(len=*), intent(in) :: keys(:), quantities
    type(problems_t), intent(inout) :: problems
    integer :: i

    do i = 1, size(keys)
      if (.not. deck%settings%is_given(material_group, keys(i), place)) cycle
      call remark_idle(deck%settings, problems, material_group, keys(i), quantities//' have no effect without &'// &
                       ply_damage_group//': the plies do not fail.', place)
      exit
    end do
  end subroutine remark_first
end module deck_idle_keys
