!> Flaws of interfaces by cracks of adjacent plies (doc/theory/interfaces.md, flaws beside cracked plies).
module crack_flaws
  use delamination_parameters, only: law_cohesive
  use element_stresses, only: element_strains, stress_of_ply
  use in_situ_strengths, only: crack_strengths
  use interface_flaws, only: reachable_cells, weaken_beside
  use interface_states, only: interface_state_t
  use kinds, only: wp
  use matrix_exposures, only: matrix_strengths_t, cracks_on_a_plane, shear_across_strength
  use composite_plates, only: composite_plate_t
  use plies, only: elasticity_t
  use ply_blocks, only: block_thickness
  use ply_damage_parameters, only: matrix_cracking, matrix_crushing
  use ply_failures, only: ply_failure_t
  implicit none
  private
  public :: update_flaws

contains

  !> Reduces the strength of interfaces within the thickness of a block from matrix cracks of the ply above or below.
  !> Collective.
  subroutine update_flaws(plate, plies, displacement, interfaces)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> Displacement in the accepted state, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    logical, allocatable :: failed(:, :)
    logical :: beside(size(plate%mesh%zones)), cracked(product(plate%mesh%cells))
    integer :: laminate_of(product(plate%mesh%cells)), zone, ply, laminate

    if (.not. (plate%map%layered .and. plate%setup%ply_damage%is_present)) return
    laminate_of = laminates_of_cells(plate)
    do ply = 1, plate%mesh%plies
      associate (below => plate%mesh%zones%below_ply, delaminations => plate%setup%delaminations)
        beside = (below == ply .or. below == ply - 1) .and. delaminations%law == law_cohesive .and. &
                 delaminations%flaw_strength < 1
        if (.not. any(beside)) cycle
        failed = plies%failed_in_elements(plate, ply)
        cracked = cells_of(plate, failed(matrix_cracking, :) .or. failed(matrix_crushing, :))
        do laminate = 1, size(plate%layup%laminates)
          associate (stack => plate%layup%laminates(laminate))
            if (.not. stack%has(ply)) cycle
            do zone = 1, size(beside)
              if (beside(zone)) call weaken_beside(interfaces%cohesive, plate, zone, &
                                                   cracked .and. laminate_of == laminate, &
                                                   block_thickness(stack%plies, stack%place(ply)), &
                                                   delaminations(zone)%flaw_strength)
            end do
          end associate
        end do
      end associate
    end do
    if (.not. any(plate%setup%delaminations%shear_cracks)) return
    associate (strains => element_strains(plate, plies, displacement))
      do laminate = 1, size(plate%layup%laminates)
        call weaken_by_shear(plate, plies, strains, laminate, laminate_of == laminate, interfaces)
      end do
    end associate
  end subroutine update_flaws

  !> Laminate of each cell of the mesh.
  pure function laminates_of_cells(plate) result(laminate_of)
    type(composite_plate_t), intent(in) :: plate
    integer :: laminate_of(product(plate%mesh%cells)), element

    associate (mesh => plate%mesh)
      do element = 1, mesh%elements()
        laminate_of(mesh%element_cell(element)) = mesh%layers(mesh%element_layer(element))%laminate
      end do
    end associate
  end function laminates_of_cells

  !> Reduces the strengths of the interfaces of plies beside their cracks by transverse shear: a cracked ply transmits
  !> no more than its own shear strength. Collective.
  subroutine weaken_by_shear(plate, plies, strains, laminate, has_laminate, interfaces)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Number of the laminate whose cracks are considered
    integer, intent(in) :: laminate
    !> True for the cells of the mesh with this laminate
    logical, intent(in) :: has_laminate(:)
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    type(matrix_strengths_t) :: strengths(plate%mesh%plies)
    !> Part of its strength that an interface has beside cracks of a ply; 1: all of it, (zones, plies)
    real(wp) :: parts(size(plate%mesh%zones), plate%mesh%plies), reach(plate%mesh%plies)
    logical :: cracked(product(plate%mesh%cells), plate%mesh%plies)
    integer :: ply, zone

    cracked = .false.
    parts = 1
    do ply = 1, size(reach)
      associate (setup => plate%setup, below => plate%mesh%zones%below_ply, stack => plate%layup%laminates(laminate))
        if (.not. stack%has(ply)) cycle
        reach(ply) = block_thickness(stack%plies, stack%place(ply))
        strengths(ply) = crack_strengths(stack%plies, stack%place(ply), setup%materials, setup%ply_damage)
        where ((below == ply .or. below == ply - 1) .and. setup%delaminations%law == law_cohesive .and. &
               setup%delaminations%shear_cracks) &
          parts(:, ply) = min(1.0_wp, shear_across_strength(strengths(ply))/setup%delaminations%strength_shear)
      end associate
      do zone = 1, size(parts, 1)
        if (parts(zone, ply) < 1) &
          cracked(:, ply) = cracked(:, ply) .or. has_laminate .and. reachable_cells(plate%mesh, zone, reach(ply))
      end do
    end do
    call find_sheared_cells(plate, plies, strains, strengths, cracked)
    do ply = 1, size(reach)
      do zone = 1, size(parts, 1)
        if (parts(zone, ply) < 1) call weaken_beside(interfaces%cohesive, plate, zone, cracked(:, ply), reach(ply), &
                                                     parts(zone, ply))
      end do
    end do
  end subroutine weaken_by_shear

  !> Cells in which plies have started to crack or reach their strength with transverse shear included, on all ranks.
  !> Collective.
  subroutine find_sheared_cells(plate, plies, strains, strengths, cells)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Strengths of the plies
    type(matrix_strengths_t), intent(in) :: strengths(:)
    !> Cells in which a crack of a ply affects an interface; returns those of them with cracks, (cells, plies)
    logical, intent(inout) :: cells(:, :)
    real(wp) :: found(size(cells))
    type(elasticity_t) :: left
    integer :: i, cell, ply, place

    found = 0
    do i = 1, size(strains, 2)
      cell = plate%mesh%element_cell(plate%distribution%elements(i))
      if (.not. any(cells(cell, :))) cycle
      associate (stack => plate%layup%stacks(plate%layup%stack(i)))
        associate (shear => stack%shear_stresses(strains(7:8, i)))
          do place = 1, size(stack%number)
            ply = stack%number(place)
            if (ply > size(cells, 2)) cycle
            if (.not. cells(cell, ply)) cycle
            left = plies%elasticity(plate, ply, i)
            if (left%e2 < stack%plies(place)%elasticity%e2) then
              found(cell + (ply - 1)*size(cells, 1)) = 1
            else if (cracks_on_a_plane(strengths(ply), stress_of_ply(plate, plies, left, strains(:, i), &
                                                                     shear(:, place), place, i))) then
              found(cell + (ply - 1)*size(cells, 1)) = 1
            end if
          end do
        end associate
      end associate
    end do
    call plate%communicator%maximum(found)
    cells = reshape(found > 0, shape(cells))
  end subroutine find_sheared_cells

  !> Cells of elements, on all ranks. Collective.
  function cells_of(plate, elements) result(cells)
    type(composite_plate_t), intent(in) :: plate
    !> True for elements of this rank, (elements)
    logical, intent(in) :: elements(:)
    !> (cells of the mesh)
    logical, allocatable :: cells(:)
    real(wp), allocatable :: found(:)
    integer :: i

    allocate (found(product(plate%mesh%cells)), source=0.0_wp)
    do i = 1, size(elements)
      if (elements(i)) found(plate%mesh%element_cell(plate%distribution%elements(i))) = 1
    end do
    call plate%communicator%maximum(found)
    cells = found > 0
  end function cells_of
end module crack_flaws
