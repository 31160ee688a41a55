!> Materials of the deck: rows of its table, assignment, and checks.
module material_deck
  use deck_problems, only: problems_t
  use deck_remarks, only: report, are_clear
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use hahn_tsai, only: shear_coefficient
  use kinds, only: wp
  use material_parameters, only: material_t
  use plies, only: material_objection
  use short_numbers, only: short_text
  use text, only: line_t, append, joined, to_text, words_of
  implicit none
  private
  public :: fill_materials, require_densities, normal_compliance

  !> Name that checks across groups use.
  character(len=*), parameter, public :: material_group = 'material', key_isotropic = 'E ', key_along = 'E1', &
                                         key_other_moduli = 'E2 G12 G13 G23', &
                                         key_density = 'density', &
                                         key_shear_strain = 'shear_failure_strain', &
                                         key_fibre_shear = 'Sf', key_shear_23 = 'Sm23', &
                                         key_expansion = 'alpha1 alpha2', key_library = 'library', &
                                         key_compressive = 'XC', key_gain = 'rate_strengthening', &
                                         key_rate = 'reference_rate'
  character(len=group_row_length), parameter, public :: material_group_row = &
    'material | repeatable | One ply material, orthotropic or isotropic; may be given several times.'
  character(len=key_row_length), parameter, public :: material_rows(*) = [character(len=key_row_length) :: &
    'material | name | text | 1 | - | required | not empty | &
      &Name that &laminate refers to.', &
    'material | library | choice | 1 | - | none | t700_m21 t700gc_m21 im7_8552 as4_3501_6 t300_976 e_glass_my750 | &
      &Published material whose values fill in keys left out.', &
    'material | density | real | 1 | mass/volume | none | > 0 | &
      &Mass per volume; needed unless the analysis is static. | | density', &
    'material | E | real | 1 | pressure | none | > 0 | &
      &Young''s modulus of an isotropic material, given with nu instead of E1 to nu23. | | modulus', &
    'material | nu | real | 1 | - | none | > -1, < 0.5 | &
      &Poisson''s ratio of an isotropic material.', &
    'material | E1 | real | 1 | pressure | none | > 0 | &
      &Young''s modulus along the fibres, in tension. | | modulus', &
    'material | E1c | real | 1 | pressure | = E1 | > 0 | &
      &Young''s modulus along the fibres in compression.', &
    'material | E2 | real | 1 | pressure | none | > 0 | &
      &Transverse Young''s modulus. | | modulus', &
    'material | G12 | real | 1 | pressure | none | > 0 | &
      &In-plane shear modulus. | | modulus', &
    'material | G13 | real | 1 | pressure | = G12 | > 0 | &
      &Shear modulus between the fibres and the normal. | | modulus', &
    'material | G23 | real | 1 | pressure | none | > 0 | &
      &Transverse shear modulus. | | modulus', &
    'material | nu12 | real | 1 | - | none | > -10, < 10 | &
      &Major Poisson''s ratio; its magnitude is below sqrt(E1/E2).', &
    'material | nu23 | real | 1 | - | 0 | > -1, < 1 | &
      &Transverse Poisson''s ratio, for face=''laminate'' of &indentation; elsewhere plies are in plane stress.', &
    'material | XT | real | 1 | pressure | none | > 0 | &
      &Tensile strength along the fibres. | | strength', &
    'material | XC | real | 1 | pressure | none | > 0 | &
      &Compressive strength along the fibres, a positive number; left out: XT is used. | | strength', &
    'material | YT | real | 1 | pressure | none | > 0 | &
      &Transverse tensile strength. | | strength', &
    'material | YC | real | 1 | pressure | none | > 0 | &
      &Transverse compressive strength, a positive number. | | strength', &
    'material | S12 | real | 1 | pressure | none | > 0 | &
      &In-plane shear strength. | | strength', &
    'material | Sf | real | 1 | pressure | none | > 0 | &
      &Shear strength in the criterion of fibre failure. | | strength', &
    'material | Sm23 | real | 1 | pressure | none | > 0 | &
      &Shear strength in the 2-3 plane in the criterion of matrix failure. | | strength', &
    'material | G_ft | real | 1 | energy/area | none | > 0 | &
      &Fracture energy of fibres in tension; with G_fc, G_mt and G_mc plies soften. | | fibre toughness', &
    'material | G_fc | real | 1 | energy/area | none | > 0 | &
      &Fracture energy of fibres in compression. | | fibre toughness', &
    'material | G_mt | real | 1 | energy/area | none | > 0 | &
      &Fracture energy of the matrix in transverse tension. | | toughness', &
    'material | G_mc | real | 1 | energy/area | none | > 0 | &
      &Fracture energy of the matrix in shear or transverse compression. | | toughness', &
    'material | shear_failure_strain | real | 1 | - | none | > 0 | &
      &In-plane shear strain at S12; left out: S12/G12, shear is linear. | &ply_damage, G_ft', &
    'material | alpha1 | real | 1 | 1/temperature | 0 | any | &
      &Thermal expansion along the fibres. | &thermal', &
    'material | alpha2 | real | 1 | 1/temperature | 0 | any | &
      &Transverse thermal expansion. | &thermal', &
    'material | rate_strengthening | real | 1 | - | 0 | >= 0 | &
      &Gain of YT, YC, S12 and Sm23 of softening plies per decade of strain rate, as a fraction.', &
    'material | reference_rate | real | 1 | 1/time | none | > 0 | &
      &Strain rate of the tests that these strengths are from; strengths do not change below it. | rate_strengthening']
  !> Keys of the strengths.
  character(len=*), parameter, public :: strength_keys(7) = [character(len=4) :: 'XT', 'XC', 'YT', 'YC', 'S12', 'Sf', &
                                                             'Sm23']
  !> Those that are also strengths of the interfaces between plies.
  logical, parameter, public :: of_interfaces(7) = strength_keys == 'YT' .or. strength_keys == 'S12'
  !> Keys of the fracture energies in the order of the modes.
  character(len=*), parameter, public :: toughness_keys(4) = [character(len=4) :: 'G_ft', 'G_fc', 'G_mt', 'G_mc']

  !> Keys that an orthotropic material requires, and all of them.
  character(len=*), parameter :: needed_keys = 'E1 E2 G12 G23 nu12', orthotropic_keys = needed_keys//' G13 nu23 E1c'
  !> Largest ratio of two moduli of a material; beyond it round-off dominates the result: together with the slenderness
  !> of a plate few of sixteen digits remain.
  real(wp), parameter :: max_contrast = 1.0e6_wp

contains

  !> All materials.
  subroutine fill_materials(settings, materials, problems)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    type(material_t), allocatable, intent(out) :: materials(:)
    type(problems_t), intent(inout) :: problems
    integer :: i, j

    allocate (materials(settings%groups_named(material_group)))
    do i = 1, size(materials)
      call fill_material(settings, i, materials(i), problems)
      do j = 1, i - 1
        if (materials(i)%name /= materials(j)%name .or. materials(i)%name == '') cycle
        call report(settings, problems, material_group, 'name', 'another material has this name; give each its own.', i)
        exit
      end do
    end do
  end subroutine fill_materials

  !> One material; its constants are 0 unless all are given and valid.
  subroutine fill_material(settings, place, material, problems)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    !> Its index
    integer, intent(in) :: place
    type(material_t), intent(inout) :: material
    type(problems_t), intent(inout) :: problems
    logical :: complete
    integer :: mode

    material%name = trim(settings%text_of(material_group, 'name', place))
    material%density = settings%real_of(material_group, 'density', place)
    material%xt = settings%real_of(material_group, 'XT', place)
    material%xc = settings%real_of(material_group, 'XC', place)
    material%yt = settings%real_of(material_group, 'YT', place)
    material%yc = settings%real_of(material_group, 'YC', place)
    material%s12 = settings%real_of(material_group, 'S12', place)
    material%sf = settings%real_of(material_group, 'Sf', place)
    material%sm23 = settings%real_of(material_group, 'Sm23', place)
    material%expansion = [settings%real_of(material_group, 'alpha1', place), &
                          settings%real_of(material_group, 'alpha2', place)]
    material%rate_gain = settings%real_of(material_group, key_gain, place)
    material%reference_rate = settings%real_of(material_group, key_rate, place)
    do mode = 1, size(toughness_keys)
      material%toughness(mode) = settings%real_of(material_group, toughness_keys(mode), place)
    end do
    call check_completeness(settings, place, problems, complete)
    if (.not. complete) return
    if (settings%is_given(material_group, 'E', place)) then
      call fill_isotropic(settings, place, material)
    else
      call fill_orthotropic(settings, place, material)
    end if
    if (material_objection(material) /= '') then
      call report(settings, problems, material_group, '', material_objection(material)//'.', place)
    else if (contrast(material) > max_contrast) then
      call report(settings, problems, material_group, '', contrast_text(material)//' differ by more than a factor '// &
                  'of '//to_text(max_contrast)//', where round-off dominates.', place)
    end if
    material%shear_beta = shear_coefficient(material%g12, material%s12, &
                                            settings%real_of(material_group, key_shear_strain, place))
  end subroutine fill_material

  !> Largest over smallest modulus of a material.
  pure real(wp) function contrast(material)
    type(material_t), intent(in) :: material
    real(wp) :: moduli(6)

    moduli = [material%e1, merge(material%e1c, material%e1, material%e1c > 0), material%e2, material%g12, &
              material%g13, material%g23]
    contrast = maxval(moduli)/minval(moduli)
  end function contrast

  !> Smallest and largest modulus as text.
  pure function contrast_text(material) result(words)
    type(material_t), intent(in) :: material
    !> Such as `its moduli G23 = 2980 and E1 = 139e9`
    character(len=:), allocatable :: words
    character(len=*), parameter :: names(5) = [character(len=3) :: 'E1', 'E2', 'G12', 'G13', 'G23']
    real(wp) :: moduli(5)
    integer :: least, largest

    moduli = [material%e1, material%e2, material%g12, material%g13, material%g23]
    least = minloc(moduli, 1)
    largest = maxloc(moduli, 1)
    words = 'its moduli '//trim(names(least))//' = '//short_text(moduli(least))//' and '//trim(names(largest))// &
            ' = '//short_text(moduli(largest))
  end function contrast_text

  !> Whether the elastic constants are complete and valid; reports missing ones.
  subroutine check_completeness(settings, place, problems, complete)
    type(settings_t), intent(in) :: settings
    !> Index of the material
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    !> True: they are complete and valid
    logical, intent(out) :: complete
    type(line_t), allocatable :: given(:), missing(:)
    integer :: i

    complete = .false.
    if (.not. are_clear(settings, problems, material_group, key_library, place)) return
    given = words_with(settings, place, orthotropic_keys, .true.)
    if (settings%is_given(material_group, 'E', place) .or. settings%is_given(material_group, 'nu', place)) then
      missing = words_with(settings, place, 'E nu', .false.)
      if (size(given) > 0) then
        call report(settings, problems, material_group, given(1)%text, &
                    'the material has E or nu too; give either E '// &
                  'and nu (isotropic) or E1, E2, G12, G23, nu12 (orthotropic).', place)
        return
      end if
    else
      missing = words_with(settings, place, needed_keys, .false.)
      if (size(given) == 0) then
        deallocate (missing)
        call append(missing, 'E and nu (isotropic) or E1, E2, G12, G23, nu12 (orthotropic)')
      end if
    end if
    if (size(missing) > 0) then
      ! One of them that is given under a misspelt name has been reported.
      if (.not. any([(problems%concern(material_group, missing(i)%text, place), i=1, size(missing))])) &
        call report(settings, problems, material_group, '', joined(missing, ', ')//' must be given too.', place)
      return
    end if
    complete = are_clear(settings, problems, material_group, 'E nu '//orthotropic_keys, place)
  end subroutine check_completeness

  !> Those of some keys that the deck gives, or those that it does not.
  function words_with(settings, place, keys, given) result(words)
    type(settings_t), intent(in) :: settings
    !> Index of the material
    integer, intent(in) :: place
    !> Names separated by blanks
    character(len=*), intent(in) :: keys
    !> True: those given
    logical, intent(in) :: given
    type(line_t), allocatable :: words(:)
    type(line_t), allocatable :: names(:)
    integer :: i

    names = words_of(keys, ' ')
    allocate (words(0))
    do i = 1, size(names)
      if (settings%is_given(material_group, names(i)%text, place) .eqv. given) call append(words, names(i)%text)
    end do
  end function words_with

  !> Constants of an isotropic material.
  subroutine fill_isotropic(settings, place, material)
    type(settings_t), intent(in) :: settings
    !> Index of the material
    integer, intent(in) :: place
    type(material_t), intent(inout) :: material

    material%e1 = settings%real_of(material_group, 'E', place)
    material%nu12 = settings%real_of(material_group, 'nu', place)
    material%e2 = material%e1
    material%nu23 = material%nu12
    material%g12 = material%e1/(2*(1 + material%nu12))
    material%g13 = material%g12
    material%g23 = material%g12
  end subroutine fill_isotropic

  !> Constants of an orthotropic material.
  subroutine fill_orthotropic(settings, place, material)
    !> Keys in effect; receives defaults
    type(settings_t), intent(inout) :: settings
    !> Index of the material
    integer, intent(in) :: place
    type(material_t), intent(inout) :: material

    material%e1 = settings%real_of(material_group, 'E1', place)
    if (.not. settings%is_given(material_group, 'E1c', place)) &
      call settings%derive(material_group, 'E1c', to_text(material%e1), .false., place)
    material%e1c = settings%real_of(material_group, 'E1c', place)
    material%e2 = settings%real_of(material_group, 'E2', place)
    material%g12 = settings%real_of(material_group, 'G12', place)
    if (.not. settings%is_given(material_group, 'G13', place)) &
      call settings%derive(material_group, 'G13', to_text(material%g12), .false., place)
    material%g13 = settings%real_of(material_group, 'G13', place)
    material%g23 = settings%real_of(material_group, 'G23', place)
    material%nu12 = settings%real_of(material_group, 'nu12', place)
    material%nu23 = settings%real_of(material_group, 'nu23', place)
  end subroutine fill_orthotropic

  !> Checks that every material has a density, which a run in time requires.
  subroutine require_densities(settings, problems)
    type(settings_t), intent(in) :: settings
    type(problems_t), intent(inout) :: problems
    integer :: i

    do i = 1, settings%groups_named(material_group)
      if (settings%is_given(material_group, 'density', i)) cycle
      if (.not. are_clear(settings, problems, material_group, 'density '//key_library, i)) cycle
      call report(settings, problems, material_group, 'density', 'is missing; a run in time needs a density > 0.', i)
    end do
  end subroutine require_densities

  !> Compliance of a half-space in Sun's formula: 1/E2; Hertz' (1 - nu**2)/E if isotropic; 0 if the constants are not
  !> known.
  pure real(wp) function normal_compliance(settings, place, material) result(compliance)
    type(settings_t), intent(in) :: settings
    !> Index of the material
    integer, intent(in) :: place
    type(material_t), intent(in) :: material

    compliance = 0
    if (material%e2 <= 0) return
    compliance = 1/material%e2
    if (settings%is_given(material_group, 'E', place)) compliance = (1 - material%nu12**2)/material%e2
  end function normal_compliance
end module material_deck
