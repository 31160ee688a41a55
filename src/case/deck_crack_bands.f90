!> Checks of softening plies: whether all fracture energies are given, which keys have no effect, and whether elements
!> are short enough.
module deck_crack_bands
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use crack_band_limits, only: longest_element
  use crack_bands, only: create_crack_band
  use deck_contents, only: deck_t
  use deck_fibre_strengths, only: belongs_to_softening, check_fibre_strengths, fibre_factors
  use deck_problems, only: problems_t
  use deck_remarks, only: report, remark, are_clear
  use deck_stacks, only: place_of_stack, stacks_of
  use deck_strain_rates, only: check_strain_rates
  use in_situ_strengths, only: material_in_place
  use kinds, only: wp
  use larc_criteria, only: larc_objection
  use material_deck, only: material_group, key_shear_strain, toughness_keys
  use material_parameters, only: first_alike
  use mesh_parameters, only: is_halved
  use ply_blocks, only: block_of
  use ply_damage_deck, only: ply_damage_group, key_closure, key_in_situ, key_permanent
  use ply_stacks, only: ply_stack_t
  use ply_damage_parameters, only: fibre_tension
  use short_numbers, only: short_text
  use scale_tables, only: length_text
  use stepping_parameters, only: is_explicit
  use text, only: line_t, append, joined, rounded_text, to_text
  implicit none
  private
  public :: check_crack_bands

  !> Ratio of dissipated energy to fracture energy from which it is reported: smaller ratios are printed as 1.0.
  real(wp), parameter :: reported_ratio = 1.05_wp

contains

  !> All checks.
  subroutine check_crack_bands(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(ply_stack_t), allocatable :: stacks(:)
    logical :: softens
    integer :: i, mode

    softens = any([(any(deck%setup%materials(i)%toughness > 0), i=1, size(deck%setup%materials))])
    call check_fibre_strengths(deck, softens, problems)
    call check_strain_rates(deck, softens, problems)
    if (.not. softens) then
      if (deck%setup%ply_damage%in_situ .and. &
          all([((are_clear(deck%settings, problems, material_group, toughness_keys(mode), i), &
                 mode=1, size(toughness_keys)), i=1, size(deck%setup%materials))])) &
        call report(deck%settings, problems, ply_damage_group, key_in_situ, &
                    'in-situ strengths follow from the fracture energies G_mt and G_mc; give G_ft, G_fc, G_mt and '// &
                    'G_mc of every material, or leave it out.')
      if (deck%setup%ply_damage%permanent_shear) &
        call report(deck%settings, problems, ply_damage_group, key_permanent, belongs_to_softening)
      if (deck%setup%ply_damage%crack_closure) &
        call report(deck%settings, problems, ply_damage_group, key_closure, belongs_to_softening)
      return
    end if
    do i = 1, size(deck%setup%materials)
      call check_material(deck, i, problems)
    end do
    if (deck%setup%ply_damage%permanent_shear) call check_permanent_shear(deck, problems)
    if (deck%setup%ply_damage%crack_closure .and. .not. (deck%has_time .and. is_explicit(deck%stepping))) &
      call report(deck%settings, problems, ply_damage_group, key_closure, 'implicit steps and load steps do not '// &
                'model crack closure; use integrator = ''central_difference'' of &time, or leave it out.')
    if (problems%errors() > 0) return
    stacks = stacks_of(deck%setup)
    if (deck%setup%ply_damage%in_situ .and. all([(block_of(stacks(i)%plies, 1) == [1, size(stacks(i)%plies)], &
                                                  i=1, size(stacks))])) &
      call remark(deck%settings, problems, ply_damage_group, key_in_situ, 'has no effect: all plies are of one '// &
                  'material and angle, so that no ply has a neighbour that constrains its cracks.')
    if (deck%setup%ply_damage%in_situ .and. deck%setup%ply_damage%kinking) call check_kinking_in_place(deck, problems)
    do i = 1, size(deck%setup%materials)
      call check_lengths(deck, i, problems)
    end do
  end subroutine check_crack_bands

  !> Kinking requires in-situ strengths that a misalignment of the fibres explains.
  subroutine check_kinking_in_place(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    type(ply_stack_t), allocatable :: stacks(:)
    character(len=:), allocatable :: objection
    integer :: i, ply

    stacks = stacks_of(deck%setup)
    do i = 1, size(stacks)
      do ply = 1, size(stacks(i)%plies)
        objection = larc_objection(material_in_place(stacks(i)%plies, ply, deck%setup%materials, &
                                                     deck%setup%ply_damage))
        if (objection == '') cycle
        call report(deck%settings, problems, ply_damage_group, key_in_situ, 'raises S12 of ply '// &
                    to_text(stacks(i)%number(ply))//place_of_stack(deck%setup, stacks(i))//' so far that '// &
                    objection//'.')
        return
      end do
    end do
  end subroutine check_kinking_in_place

  !> Permanent shear strains require nonlinear shear and central differences.
  subroutine check_permanent_shear(deck, problems)
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: place

    if (.not. (deck%has_time .and. is_explicit(deck%stepping))) &
      call report(deck%settings, problems, ply_damage_group, key_permanent, 'implicit steps and load steps have no '// &
                'permanent strains; use integrator = ''central_difference'' of &time, or leave it out.')
    if (any([(deck%settings%is_given(material_group, key_shear_strain, place), place=1, size(deck%setup%materials))])) &
      return
    call report(deck%settings, problems, ply_damage_group, key_permanent, 'there is no permanent strain without '// &
              key_shear_strain//' of a &'//material_group//'; give it, or leave this out.')
  end subroutine check_permanent_shear

  !> Checks that all four energies are given, and that nonlinear shear has a larger failure strain than linear shear.
  subroutine check_material(deck, place, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: missing(:)
    real(wp) :: strain
    integer :: mode

    allocate (missing(0))
    associate (material => deck%setup%materials(place))
      do mode = 1, size(toughness_keys)
        if (.not. material%toughness(mode) > 0 .and. &
            are_clear(deck%settings, problems, material_group, toughness_keys(mode), place)) &
          call append(missing, toughness_keys(mode))
      end do
      if (size(missing) > 0) call report(deck%settings, problems, material_group, '', &
        'fracture energies are given, but not '//joined(missing, ', ')// &
        '; give G_ft, G_fc, G_mt and G_mc of every material, or none.', place)
      strain = deck%settings%real_of(material_group, key_shear_strain, place)
      if (.not. (strain > 0 .and. material%g12 > 0)) return
      if (strain < material%s12/material%g12) &
        call report(deck%settings, problems, material_group, key_shear_strain, 'must be at least S12/G12 = '// &
                    short_text(material%s12/material%g12)//', that of linear shear.', place)
    end associate
  end subroutine check_material

  !> Warns of elements that dissipate more than the fracture energies because they are too long.
  subroutine check_lengths(deck, place, problems)
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: limits(:), excesses(:)
    character(len=:), allocatable :: excess, sides
    real(wp) :: longest(size(toughness_keys)), present(2), usual
    integer :: mode

    if (.not. any(deck%setup%used_materials() == place)) return
    present = element_lengths(deck)
    longest = longest_elements(deck, place)
    usual = present(2)
    if (deck%setup%mesh%cell > 0) usual = deck%setup%mesh%cell
    allocate (limits(0), excesses(0))
    do mode = 1, size(toughness_keys)
      if (longest(mode) < present(2)) &
        call append(limits, length_text(deck, longest(mode))//' ('//toughness_keys(mode)//')')
      if (usual > reported_ratio*longest(mode)) &
        call append(excesses, rounded_text(usual/longest(mode), 2)//' times '//toughness_keys(mode))
    end do
    if (size(limits) == 0) return
    excess = ''
    if (size(excesses) > 0) excess = ' A side of '//length_text(deck, usual)//' dissipates '// &
                                      joined(excesses, ', ')//'.'
    sides = length_text(deck, present(2))
    if (length_text(deck, present(1)) /= sides) sides = length_text(deck, present(1))//' to '//sides
    call remark(deck%settings, problems, material_group, '', 'the sides of elements are '//sides//' long; failure '// &
                'dissipates more than the fracture energy in elements longer than '//joined(limits, ', ')// &
                '. Use shorter elements where plies fail.'//excess, place)
  end subroutine check_lengths

  !> Longest elements that dissipate no more than the fracture energies, over all blocks of a material, with in-situ
  !> strengths and the fibres' strength in the smallest volume.
  pure function longest_elements(deck, place) result(longest)
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> The lengths in the order of the modes
    real(wp) :: longest(size(toughness_keys))
    type(ply_stack_t), allocatable :: stacks(:)
    integer :: i, ply, alike

    stacks = stacks_of(deck%setup)
    ! Plies have the first of equal materials.
    alike = first_alike(deck%setup%materials, place)
    longest = longest_element(create_crack_band(deck%setup%materials(place), deck%setup%ply_damage))
    do i = 1, size(stacks)
      do ply = 1, size(stacks(i)%plies)
        if (stacks(i)%plies(ply)%material == alike) longest = min(longest, longest_element(create_crack_band( &
          material_in_place(stacks(i)%plies, ply, deck%setup%materials, deck%setup%ply_damage), &
          deck%setup%ply_damage)))
      end do
    end do
    ! The energy at the onset grows with the square of the strength.
    longest(fibre_tension) = longest(fibre_tension)/maxval(fibre_factors(deck, alike))**2
  end function longest_elements

  !> Shortest and longest side of the cells, with joined cells at the lines of the struck point counted as one.
  pure function element_lengths(deck) result(lengths)
    type(deck_t), intent(in) :: deck
    !> Smallest and largest
    real(wp) :: lengths(2)
    type(cell_line_t) :: line
    logical :: joined(2)
    integer :: direction, cell

    lengths = [huge(1.0_wp), 0.0_wp]
    joined = is_halved(deck%setup%plate%symmetry) .or. deck%setup%impactor%is_present
    do direction = 1, 2
      line = cells_along(deck%setup%plate, deck%setup%mesh, direction)
      lengths = [min(lengths(1), minval(line%sides())), max(lengths(2), maxval(line%sides()))]
      line = line%from(deck%setup%mesh%struck(direction))
      if (.not. joined(direction)) cycle
      do cell = 1, line%cells()
        if (minval(abs(line%ends(cell))) < 1e-6_wp*line%side(cell)) lengths(2) = max(lengths(2), 2*line%side(cell))
      end do
    end do
  end function element_lengths
end module deck_crack_bands
