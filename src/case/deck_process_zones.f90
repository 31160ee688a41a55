!> Resolution of the process zones of cohesive interfaces: warnings, and the strength beside cracks.
module deck_process_zones
  use cell_grids, only: cells_along, cells_from_struck
  use cell_lines, only: cell_line_t
  use deck_contents, only: deck_t
  use deck_problems, only: problems_t
  use deck_remarks, only: remark, remark_idle
  use interface_places, only: delamination_group
  use delamination_deck, only: key_flaws, key_shear_cracks
  use delamination_parameters, only: delamination_t, growth_by_energy, law_cohesive, toughnesses
  use in_situ_strengths, only: crack_strengths
  use kinds, only: wp
  use mathematical_constants, only: pi
  use layer_extents, only: largest_extents
  use laminate_parameters, only: shear_five_sixths
  use matrix_exposures, only: shear_across_strength
  use plies, only: ply_t
  use ply_stacks, only: ply_stack_t
  use process_zones, only: cells_in_zones, process_zone_t, process_zone_warning, resolved_part, shear_zone_length
  use scale_tables, only: length_unit, length_unit_size
  use mean_stiffnesses, only: in_bending
  use stacking, only: stacked_plies, section_stiffness
  use stepping_parameters, only: is_explicit
  use text, only: to_text
  implicit none
  private
  public :: check_process_zones, fewest_cells, set_flaws, shortest_shear_zone

contains

  !> Warns of unresolved process zones.
  subroutine check_process_zones(deck, problems)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    type(problems_t), intent(inout) :: problems
    character(len=:), allocatable :: warning
    real(wp) :: fewest(2)
    integer :: i

    if (problems%errors() > 0) return
    fewest = fewest_cells(deck)
    do i = 1, size(deck%setup%delaminations)
      if (deck%setup%delaminations(i)%law /= law_cohesive) cycle
      warning = process_zone_warning(process_zone(deck, deck%setup%delaminations(i)), &
                                     deck%setup%delaminations(i)%below_ply, &
                                     fewest, length_unit(deck), length_unit_size(deck))
      if (warning /= '') call remark(deck%settings, problems, delamination_group, '', warning, &
                                     deck%setup%delaminations(i)%group)
    end do
  end subroutine check_process_zones

  !> Fewest cells in the process zones of shear and opening of all cohesive interfaces; huge without any.
  pure function fewest_cells(deck) result(fewest)
    !> The deck, filled and checked
    type(deck_t), intent(in) :: deck
    !> In shear and in opening
    real(wp) :: fewest(2)
    integer :: i

    fewest = huge(fewest)
    do i = 1, size(deck%setup%delaminations)
      if (deck%setup%delaminations(i)%law /= law_cohesive) cycle
      fewest = min(fewest, cells_in_zones(process_zone(deck, deck%setup%delaminations(i))))
    end do
  end function fewest_cells

  !> Finds the strength of interfaces beside cracks, and reports where cracks have no effect.
  subroutine set_flaws(deck, problems)
    !> The deck, filled and checked; its interfaces receive that strength
    type(deck_t), intent(inout) :: deck
    type(problems_t), intent(inout) :: problems
    integer :: i

    if (problems%errors() > 0) return
    do i = 1, size(deck%setup%delaminations)
      associate (d => deck%setup%delaminations(i))
        if (d%law /= law_cohesive) cycle
        if (d%shear_cracks) call remark_shear_cracks(deck, d, problems)
        if (.not. d%cracks_as_flaws) cycle
        d%flaw_strength = resolved_part(process_zone(deck, d))
        if (deck%setup%ply_damage%is_present .and. .not. d%flaw_strength < 1) then
          call remark_idle(deck%settings, problems, delamination_group, key_flaws, 'has no effect below ply '// &
                           to_text(d%below_ply)//', where the cells resolve the strengths.', d%group)
        end if
      end associate
    end do
  end subroutine set_flaws

  !> Reports where transverse shear cracks of the plies have no effect.
  subroutine remark_shear_cracks(deck, delamination, problems)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination
    type(problems_t), intent(inout) :: problems
    type(ply_t), allocatable :: plies(:)
    real(wp) :: least
    integer :: ply

    if (.not. deck%setup%ply_damage%is_present) return
    plies = stacked_plies(deck%setup%laminate, deck%setup%materials)
    least = minval([(shear_across_strength(crack_strengths(plies, ply, deck%setup%materials, deck%setup%ply_damage)), &
                     ply=delamination%below_ply, delamination%below_ply + 1)])
    if (least < delamination%strength_shear) return
    call remark_idle(deck%settings, problems, delamination_group, key_shear_cracks, 'has no effect below ply '// &
                     to_text(delamination%below_ply)//', where the shear strength of the plies exceeds that of the '// &
                     'interface.', delamination%group)
  end subroutine remark_shear_cracks

  !> Length of the shortest process zone of shear of the interfaces that grow by energy; 0: there are none. The mesh
  !> need not be known.
  pure real(wp) function shortest_shear_zone(deck) result(shortest)
    type(deck_t), intent(in) :: deck
    integer :: i

    shortest = huge(shortest)
    do i = 1, size(deck%setup%delaminations)
      associate (d => deck%setup%delaminations(i))
        if (d%law /= law_cohesive .or. .not. d%strength_shear > 0) cycle
        if (d%bonds_doublers()) then
          if (any(d%doublers == 0)) cycle
        else if (d%below_ply < 1 .or. d%below_ply >= size(deck%setup%laminate%angle)) then
          cycle
        end if
        if (grows_by_energy(deck, d)) shortest = min(shortest, shear_zone_length(zone_of_any_cells(deck, d)))
      end associate
    end do
    if (.not. shortest < huge(shortest)) shortest = 0
  end function shortest_shear_zone

  !> True where the energy release rate starts growth.
  pure logical function grows_by_energy(deck, delamination)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination

    grows_by_energy = delamination%growth_control == growth_by_energy .and. deck%has_time .and. &
                      is_explicit(deck%stepping)
  end function grows_by_energy

  !> Data of the process zone of an interface.
  pure function process_zone(deck, delamination) result(zone)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination
    !> Modulus and thickness of the thinner layer, toughness, strengths and cells
    type(process_zone_t) :: zone
    type(cell_line_t) :: line
    real(wp) :: cells(2), extents(2)
    integer :: direction

    zone = zone_of_any_cells(deck, delamination)
    extents = delamination%zone
    if (delamination%is_adaptive) &
      extents = largest_extents(extents, deck%setup%mesh%core, deck%setup%mesh%cell, deck%setup%plate%length)
    do direction = 1, 2
      if (delamination%bonds_doublers()) then
        cells(direction) = longest_in_doublers(deck, delamination%doublers, direction)
        cycle
      end if
      line = cells_from_struck(deck%setup%plate, deck%setup%mesh, direction)
      cells(direction) = line%longest_within(extents(direction))
    end do
    zone%cell = maxval(cells)
    if (delamination%has_strip()) zone%cell = cells(1)
  end function process_zone

  !> Longest side of the cells in doublers.
  pure real(wp) function longest_in_doublers(deck, doublers, direction) result(longest)
    type(deck_t), intent(in) :: deck
    !> Their indices
    integer, intent(in) :: doublers(:)
    integer, intent(in) :: direction
    type(cell_line_t) :: line
    integer :: i

    longest = 0
    line = cells_along(deck%setup%plate, deck%setup%mesh, direction)
    do i = 1, size(doublers)
      associate (ends => deck%setup%zones%doublers(doublers(i))%edges(direction), middles => line%middles())
        longest = max(longest, maxval(line%sides(), mask=middles > ends(1) .and. middles < ends(2)))
      end associate
    end do
  end function longest_in_doublers

  !> Data of the process zone of an interface, without cells.
  pure function zone_of_any_cells(deck, delamination) result(zone)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination
    !> Modulus and thickness of the thinner layer, toughness and strengths
    type(process_zone_t) :: zone
    type(ply_t), allocatable :: plies(:), layer(:)
    real(wp) :: toughness(2), bending(6)
    integer :: above

    plies = in_bending(plies_around(deck, delamination))
    above = delamination%below_ply
    if (delamination%is_on_front()) above = size(plies) - size(deck%setup%laminate%material)
    layer = plies(:above)
    zone%thickness = thickness_of(layer)
    if (thickness_of(plies(above + 1:)) < zone%thickness) layer = plies(above + 1:)
    zone%thickness = thickness_of(layer)
    bending = bending_moduli(layer)
    zone%modulus = largest_modulus(bending)
    if (delamination%has_strip()) zone%modulus = bending(1)
    toughness = toughnesses(delamination)
    zone%toughness_opening = toughness(1)
    zone%toughness_shear = toughness(2)
    zone%strength_opening = delamination%strength_opening
    zone%strength_shear = delamination%strength_shear
    zone%is_pulled = .not. deck%setup%impactor%is_present
    zone%by_energy = grows_by_energy(deck, delamination)
    zone%is_implicit_specimen = zone%is_pulled .and. .not. (deck%has_time .and. is_explicit(deck%stepping)) .and. &
                                (delamination%starter > 0 .or. delamination%has_strip())
  end function zone_of_any_cells

  !> Plies through the thickness where an interface is: those of the laminate, and for a bond those of its thinnest
  !> doubler.
  pure function plies_around(deck, delamination) result(plies)
    type(deck_t), intent(in) :: deck
    type(delamination_t), intent(in) :: delamination
    type(ply_t), allocatable :: plies(:)
    type(ply_stack_t) :: stack
    logical, allocatable :: here(:)
    integer :: i

    plies = stacked_plies(deck%setup%laminate, deck%setup%materials)
    if (.not. delamination%bonds_doublers()) return
    here = deck%setup%zones%at([huge(1.0_wp), huge(1.0_wp)])
    associate (doublers => delamination%doublers)
      here(doublers(minloc([(sum(deck%setup%zones%doublers(doublers(i))%laminate%thickness), i=1, size(doublers))], &
                           1))) = .true.
    end associate
    stack = deck%setup%zones%stack(deck%setup%laminate, deck%setup%materials, here)
    plies = stack%plies
  end function plies_around

  !> Total thickness of plies.
  pure real(wp) function thickness_of(layer)
    !> The plies, from the struck face
    type(ply_t), intent(in) :: layer(:)

    thickness_of = layer(size(layer))%z_bottom - layer(1)%z_top
  end function thickness_of

  !> Bending moduli of plies about their own mid-plane, 12 D/h**3.
  pure function bending_moduli(layer) result(moduli)
    !> The plies, from the struck face
    type(ply_t), intent(in) :: layer(:)
    !> Those of D(11, 12, 16, 22, 26, 66)
    real(wp) :: moduli(6)
    real(wp) :: stiffness(21), middle

    stiffness = section_stiffness(layer, layer%elasticity, shear_five_sixths)
    middle = (layer(1)%z_top + layer(size(layer))%z_bottom)/2
    moduli = stiffness(13:18) - 2*middle*stiffness(7:12) + middle**2*stiffness(1:6)
    moduli = 12*moduli/thickness_of(layer)**3
  end function bending_moduli

  !> Largest bending modulus over all directions. Delaminations grow first and farthest along the stiff direction of the
  !> thinner layer, so that cells that resolve the front there suffice (doc/studies/accuracy.md).
  pure real(wp) function largest_modulus(moduli) result(largest)
    !> Along x and y, as of bending_moduli
    real(wp), intent(in) :: moduli(6)
    integer :: i
    real(wp) :: c, s

    largest = 0
    do i = 0, 35
      c = cos(i*pi/36)
      s = sin(i*pi/36)
      largest = max(largest, dot_product(moduli, [c**4, 2*(c*s)**2, 4*c**3*s, s**4, 4*c*s**3, 4*(c*s)**2]))
    end do
  end function largest_modulus
end module deck_process_zones
