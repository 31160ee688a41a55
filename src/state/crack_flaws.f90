!> Flaws of interfaces by cracks of adjacent plies (doc/theory/interfaces.md, flaws beside cracked plies).
module crack_flaws
  use delamination_parameters, only: law_cohesive
  use element_stresses, only: element_strains, has_ply, stress_of_ply
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
    real(wp), allocatable :: strains(:, :)
    logical, allocatable :: failed(:, :)
    logical :: beside(size(plate%mesh%zones)), cracked(product(plate%mesh%cells))
    integer :: zone, ply

    if (.not. (plate%map%layered .and. plate%setup%ply_damage%is_present)) return
    do ply = 1, plate%mesh%plies
      associate (below => plate%mesh%zones%below_ply, delaminations => plate%setup%delaminations)
        beside = (below == ply .or. below == ply - 1) .and. delaminations%law == law_cohesive .and. &
                 delaminations%flaw_strength < 1
        if (.not. any(beside)) cycle
        failed = plies%failed_in_elements(plate, ply)
        cracked = cells_of(plate, failed(matrix_cracking, :) .or. failed(matrix_crushing, :))
        do zone = 1, size(beside)
          if (beside(zone)) call weaken_beside(interfaces%cohesive, plate, zone, cracked, &
                                               block_thickness(plate%layup%laminates(1)%plies, ply), &
                                               delaminations(zone)%flaw_strength)
        end do
      end associate
    end do
    if (.not. any(plate%setup%delaminations%shear_cracks)) return
    strains = element_strains(plate, plies, displacement)
    do ply = 1, plate%mesh%plies
      call weaken_by_shear(plate, plies, strains, ply, interfaces)
    end do
  end subroutine update_flaws

  !> Reduces the strengths of the interfaces of a ply beside its cracks by transverse shear: a cracked ply transmits no
  !> more than its own shear strength. Collective.
  subroutine weaken_by_shear(plate, plies, strains, ply, interfaces)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    integer, intent(in) :: ply
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    type(matrix_strengths_t) :: strengths
    real(wp) :: parts(size(plate%mesh%zones)), reach
    logical :: beside(size(parts)), cracked(product(plate%mesh%cells))
    integer :: zone

    reach = block_thickness(plate%layup%laminates(1)%plies, ply)
    associate (setup => plate%setup, below => plate%mesh%zones%below_ply)
      strengths = crack_strengths(plate%layup%laminates(1)%plies, ply, setup%materials, setup%ply_damage)
      beside = (below == ply .or. below == ply - 1) .and. setup%delaminations%law == law_cohesive .and. &
               setup%delaminations%shear_cracks
      parts = 1
      where (beside) parts = shear_across_strength(strengths)/setup%delaminations%strength_shear
      beside = parts < 1
    end associate
    if (.not. any(beside)) return
    cracked = .false.
    do zone = 1, size(beside)
      if (beside(zone)) cracked = cracked .or. reachable_cells(plate%mesh, zone, reach)
    end do
    cracked = sheared_cells(plate, plies, strains, ply, cracked, strengths)
    do zone = 1, size(beside)
      if (beside(zone)) call weaken_beside(interfaces%cohesive, plate, zone, cracked, reach, parts(zone))
    end do
  end subroutine weaken_by_shear

  !> Cells in which a ply has started to crack or reaches its strength with transverse shear included, on all ranks.
  !> Collective.
  function sheared_cells(plate, plies, strains, ply, reachable, strengths) result(cracked)
    type(composite_plate_t), intent(in) :: plate
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    integer, intent(in) :: ply
    !> Cells in which a crack affects an interface of the ply, (cells of the mesh)
    logical, intent(in) :: reachable(:)
    !> The ply's strengths
    type(matrix_strengths_t), intent(in) :: strengths
    !> (cells of the mesh)
    logical, allocatable :: cracked(:)
    logical :: cracks(size(strains, 2))
    type(elasticity_t) :: left
    integer :: i

    do i = 1, size(cracks)
      cracks(i) = reachable(plate%mesh%element_cell(plate%distribution%elements(i)))
      if (cracks(i)) cracks(i) = has_ply(plate, ply, i)
      if (.not. cracks(i)) cycle
      left = plies%elasticity(plate, ply, i)
      associate (stack => plate%layup%stacks(plate%layup%stack(i)))
        cracks(i) = left%e2 < stack%plies(stack%place(ply))%elasticity%e2
      end associate
      if (.not. cracks(i)) &
        cracks(i) = cracks_on_a_plane(strengths, stress_of_ply(plate, plies, left, strains, ply, i))
    end do
    cracked = cells_of(plate, cracks)
  end function sheared_cells

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
