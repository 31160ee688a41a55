!> Checks of plies that soften by their fracture energies: are all energies there, what has no effect beside them, and
!> does the mesh bear them?
module deck_crack_bands
  use cell_grids, only: cell_edges
  use crack_bands, only: create_crack_band, longest_element
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: tell, remark, remark_idle, are_clear
  use kinds, only: wp
  use material_deck, only: material_group, toughness_keys
  use ply_damage_deck, only: ply_damage_group, keys_of_sudden_failure
  use short_numbers, only: short_text
  use text, only: line_t, append, joined
  implicit none
  private
  public :: check_crack_bands

contains

  !> All checks.
  subroutine check_crack_bands(deck, problems)
    !> The deck, filled
    type(deck_t), intent(in) :: deck
    !> Faults and remarks are added
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (.not. any([(any(deck%materials(i)%toughness > 0), i=1, size(deck%materials))])) return
    do i = 1, size(deck%materials)
      call check_energies(deck, i, problems)
    end do
    call remark_idle(deck%settings, problems, ply_damage_group, keys_of_sudden_failure, &
                     'has no effect on plies with fracture energies.')
    if (problems%errors() > 0) return
    do i = 1, size(deck%materials)
      call check_lengths(deck, i, problems)
    end do
  end subroutine check_crack_bands

  !> Energies come all four, and for all materials.
  subroutine check_energies(deck, place, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> Faults found are added
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: missing(:)
    integer :: mode

    allocate (missing(0))
    do mode = 1, size(toughness_keys)
      if (deck%materials(place)%toughness(mode) > 0) cycle
      if (are_clear(deck%settings, problems, material_group, toughness_keys(mode), place)) &
        call append(missing, toughness_keys(mode))
    end do
    if (size(missing) > 0) call tell(deck%settings, problems, material_group, '', &
      'fracture energies are given, but not '//joined(missing, ', ')// &
      '; give G_ft, G_fc, G_mt and G_mc of every material, or none.', place)
  end subroutine check_energies

  !> Warns of elements too long to fail with no more than the fracture energies.
  subroutine check_lengths(deck, place, problems)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Index of the material
    integer, intent(in) :: place
    !> Remarks are added
    type(problems_t), intent(inout) :: problems
    type(line_t), allocatable :: limits(:)
    real(wp) :: longest(size(toughness_keys)), present(2)
    integer :: mode

    present = element_lengths(deck)
    longest = longest_element(create_crack_band(deck%materials(place), deck%ply_damage))
    allocate (limits(0))
    do mode = 1, size(toughness_keys)
      if (longest(mode) < present(2)) call append(limits, toughness_keys(mode)//' from '//short_text(longest(mode)))
    end do
    if (size(limits) > 0) call remark(deck%settings, problems, material_group, '', 'in long elements failure takes '// &
      'more than its fracture energy, '//joined(limits, ', ')//' on; they are '//short_text(present(1))//' to '// &
      short_text(present(2))//' long, so keep them shorter where plies fail.', place)
  end subroutine check_lengths

  !> Shortest and longest side of the cells.
  pure function element_lengths(deck) result(lengths)
    !> The deck
    type(deck_t), intent(in) :: deck
    !> Least and largest
    real(wp) :: lengths(2)
    integer :: direction

    lengths = [huge(1.0_wp), 0.0_wp]
    do direction = 1, 2
      lengths = extremes(cell_edges(deck%plate, deck%mesh, direction), lengths)
    end do
  end function element_lengths

  !> Least and largest distance of neighbouring edges, and of two before.
  pure function extremes(edges, before) result(lengths)
    !> Ascending coordinates
    real(wp), intent(in) :: edges(:)
    !> Least and largest so far
    real(wp), intent(in) :: before(2)
    !> Least and largest
    real(wp) :: lengths(2)

    associate (sides => edges(2:) - edges(:size(edges) - 1))
      lengths = [min(before(1), minval(sides)), max(before(2), maxval(sides))]
    end associate
  end function extremes
end module deck_crack_bands
