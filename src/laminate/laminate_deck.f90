!> The laminate of the deck: rows of its table, filling, and the checks on which its plies depend.
module laminate_deck
  use deck_choices, only: code_of
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use laminate_parameters, only: laminate_t, shear_five_sixths, shear_energy
  use material_deck, only: material_group
  use material_parameters, only: material_t
  use plies, only: material_objection
  use shear_corrections, only: natural_correction
  use stacking, only: stacked_plies
  use stacking_sequences, only: read_sequence, max_plies, usual_degrees, count_hint
  use text, only: line_t, append, counted, joined, nearest_name, to_text, words_of
  implicit none
  private
  public :: fill_laminate, find_material

  !> Names that checks across groups use.
  character(len=*), parameter, public :: laminate_group = 'laminate', key_thicknesses = 'thicknesses', &
                                         key_ply_thickness = 'ply_thickness', key_correction = 'shear_correction', &
                                         key_bending_error = 'bending_error'
  !> Names used here more than once.
  character(len=*), parameter :: key_angles = 'angles', key_stacking = 'stacking'
  character(len=*), parameter :: either = 'give stacking and ply_thickness, or angles and thicknesses.'
  character(len=group_row_length), parameter, public :: laminate_group_row = &
    'laminate | required | The plies, from the struck face to the back.'
  character(len=key_row_length), parameter, public :: laminate_rows(*) = [character(len=key_row_length) :: &
    'laminate | materials | text | 1 or plies | - | required | names of &material groups | &
      &Material of each ply from the struck face; one value serves all.', &
    'laminate | angles | real | plies | degree | = stacking | >= -360, <= 360 | &
      &Fibre angle of each ply from x; their number is the number of plies.', &
    'laminate | thicknesses | real | 1 or plies | length | = ply_thickness | > 0 | &
      &Thickness of each ply; one value serves all. | | laminate thickness', &
    'laminate | stacking | text | 1 | - | none | not empty | &
      &Plies as in [45/0/-45/90]2s, instead of angles and thicknesses.', &
    'laminate | ply_thickness | real | 1 | length | none | > 0 | &
      &Thickness of every ply of stacking. | | laminate thickness', &
    'laminate | shear_correction | choice | 1 | - | = energy if shear moduli differ tenfold, else 5/6 | 5/6 energy | &
      &Correction of the transverse shear stiffness: the factor 5/6, or equal shear energy.', &
    'laminate | bending_error | real | 1 | - | 0.005 | >= 1e-6, <= 1 | &
      &Error of the bending stiffness, by which plies with E1c are divided into sub-plies.']

contains

  !> The plies. Invalid lists remain unallocated.
  subroutine fill_laminate(settings, materials, laminate, problems)
    !> Keys in effect; receive angles and thicknesses of the stacking sequence
    type(settings_t), intent(inout) :: settings
    type(material_t), intent(in) :: materials(:)
    type(laminate_t), intent(inout) :: laminate
    type(problems_t), intent(inout) :: problems
    real(wp), allocatable :: angles(:), thicknesses(:)
    type(line_t), allocatable :: names(:)
    integer, allocatable :: indices(:)
    integer :: plies, i

    call resolve_stacking(settings, problems)
    angles = settings%reals_of(laminate_group, key_angles)
    thicknesses = settings%reals_of(laminate_group, key_thicknesses)
    names = settings%texts_of(laminate_group, 'materials')
    plies = size(angles)
    allocate (indices(size(names)))
    do i = 1, size(names)
      call find_material(settings, materials, trim(names(i)%text), problems, indices(i), laminate_group)
    end do
    if (plies > max_plies) call report(settings, problems, laminate_group, key_angles, &
                                      'more than '//to_text(max_plies)//' plies.')
    if (plies == 0 .or. plies > max_plies) return
    call check_number(settings, key_thicknesses, size(thicknesses), plies, problems)
    call check_number(settings, 'materials', size(names), plies, problems)
    laminate%angle = angles
    laminate%bending_error = settings%real_of(laminate_group, key_bending_error)
    if (size(thicknesses) == plies .or. size(thicknesses) == 1) &
      laminate%thickness = [(thicknesses(min(i, size(thicknesses))), i=1, plies)]
    if (any(indices == 0)) return
    if (size(indices) == plies .or. size(indices) == 1) &
      laminate%material = [(indices(min(i, size(indices))), i=1, plies)]
    call choose_correction(settings, materials, laminate)
  end subroutine fill_laminate

  !> Shear correction: the choice of the deck, or the default for these plies.
  subroutine choose_correction(settings, materials, laminate)
    !> Keys in effect; receive the chosen one
    type(settings_t), intent(inout) :: settings
    type(material_t), intent(in) :: materials(:)
    !> The plies; receives it
    type(laminate_t), intent(inout) :: laminate
    character(len=*), parameter :: corrections = '5/6 energy'
    integer, parameter :: codes(2) = [shear_five_sixths, shear_energy]
    type(line_t), allocatable :: words(:)

    if (settings%is_given(laminate_group, key_correction)) then
      laminate%shear_correction = code_of(settings%text_of(laminate_group, key_correction), corrections, codes)
    else if (is_valid(laminate, materials)) then
      laminate%shear_correction = natural_correction(stacked_plies(laminate, materials))
      words = words_of(corrections, ' ')
      call settings%derive(laminate_group, key_correction, &
                           words(findloc(codes, laminate%shear_correction, 1))%text, .true.)
    end if
  end subroutine choose_correction

  !> True if there are plies of admissible materials.
  pure logical function is_valid(laminate, materials)
    !> The plies
    type(laminate_t), intent(in) :: laminate
    !> Their materials
    type(material_t), intent(in) :: materials(:)
    integer :: i

    is_valid = allocated(laminate%material) .and. allocated(laminate%thickness)
    if (is_valid) is_valid = &
      all([(material_objection(materials(laminate%material(i))) == '', i=1, size(laminate%material))])
  end function is_valid

  !> Turns stacking and ply_thickness into angles and thicknesses, and reports missing and repeated values.
  subroutine resolve_stacking(settings, problems)
    type(settings_t), intent(inout) :: settings
    type(problems_t), intent(inout) :: problems
    character(len=*), parameter :: listed(2) = [character(len=11) :: key_angles, key_thicknesses], &
                                   noted(2) = [character(len=13) :: key_stacking, key_ply_thickness]
    character(len=:), allocatable :: fault
    real(wp), allocatable :: angles(:)
    integer :: i

    if (.not. settings%has_group(laminate_group)) return
    if (any([(settings%is_given(laminate_group, noted(i)), i=1, 2)])) then
      do i = 1, 2
        if (settings%is_given(laminate_group, listed(i))) call report(settings, problems, laminate_group, &
          trim(listed(i)), trim(noted(i))//' is another form of this key; '//either)
      end do
      call require(settings, noted, problems)
      if (.not. are_clear(settings, problems, laminate_group, key_stacking)) return
      if (any([(settings%is_given(laminate_group, listed(i)), i=1, 2)])) return
      call read_sequence(settings%text_of(laminate_group, key_stacking), angles, fault)
      if (fault /= '') then
        call report(settings, problems, laminate_group, key_stacking, fault//'.')
        return
      end if
      call remark_large(key_stacking, angles, '; '//count_hint)
      call settings%derive_numbers(laminate_group, key_angles, angles)
      call settings%derive_numbers(laminate_group, key_thicknesses, &
                                   settings%reals_of(laminate_group, key_ply_thickness))
    else
      call require(settings, listed, problems)
      if (are_clear(settings, problems, laminate_group, key_angles) .and. &
          settings%is_given(laminate_group, key_angles)) &
        call remark_large(key_angles, settings%reals_of(laminate_group, key_angles), '')
    end if

  contains

    !> Remarks on the largest angle beyond 180 degrees.
    subroutine remark_large(key, values, hint)
      character(len=*), intent(in) :: key
      !> Its angles, degrees
      real(wp), intent(in) :: values(:)
      !> Ends the sentence
      character(len=*), intent(in) :: hint
      integer :: largest

      largest = maxloc(abs(values), 1)
      if (abs(values(largest)) > usual_degrees) &
        call remark(settings, problems, laminate_group, key, 'the angle '//to_text(values(largest))// &
                    ' is beyond 180 degrees'//hint//'.')
    end subroutine remark_large
  end subroutine resolve_stacking

  !> Reports those of some keys that are missing.
  subroutine require(settings, keys, problems)
    type(settings_t), intent(in) :: settings
    !> Their names
    character(len=*), intent(in) :: keys(:)
    type(problems_t), intent(inout) :: problems
    integer :: i

    do i = 1, size(keys)
      if (settings%is_given(laminate_group, keys(i)) .or. problems%concern(laminate_group, trim(keys(i)))) cycle
      call report(settings, problems, laminate_group, trim(keys(i)), 'is missing; '//either)
    end do
  end subroutine require

  !> Checks that a list has one value, or one per ply.
  subroutine check_number(settings, key, number, plies, problems)
    type(settings_t), intent(in) :: settings
    !> Name of the list
    character(len=*), intent(in) :: key
    !> Number of its values
    integer, intent(in) :: number
    !> Number of plies
    integer, intent(in) :: plies
    type(problems_t), intent(inout) :: problems

    if (number <= 1 .or. number == plies) return
    call report(settings, problems, laminate_group, key, counted(to_text(number), 'value')// &
                ', but angles has '//to_text(plies)//'; allowed: 1 value for all plies or 1 per ply.')
  end subroutine check_number

  !> Index of a material by its name, 0 if there is none.
  subroutine find_material(settings, materials, name, problems, index, group, place)
    type(settings_t), intent(in) :: settings
    type(material_t), intent(in) :: materials(:)
    !> Name of the material
    character(len=*), intent(in) :: name
    type(problems_t), intent(inout) :: problems
    !> The index
    integer, intent(out) :: index
    !> Group of the plies that name it
    character(len=*), intent(in) :: group
    integer, intent(in), optional :: place
    type(line_t), allocatable :: names(:)

    allocate (names(0))
    do index = 1, size(materials)
      if (materials(index)%name == name) return
      call append(names, materials(index)%name)
    end do
    index = 0
    ! Only with valid names of materials, and once for the same list.
    if (problems%concern(material_group, 'name') .or. problems%concern(group, 'materials', place)) return
    if (problems%concern(material_group) .and. size(names) == 0) return
    if (nearest_name(name, names) /= '') then
      call report(settings, problems, group, 'materials', 'no &material is named '''//name// &
                '''; did you mean '''//nearest_name(name, names)//'''?', place)
    else
      call report(settings, problems, group, 'materials', 'no &material is named '''//name// &
                  '''; allowed: '''// &
                joined(names, ''', ''')//'''.', place)
    end if
  end subroutine find_material
end module laminate_deck
