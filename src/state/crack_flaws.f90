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
  subroutine update_flaws(model, plies, displacement, interfaces)
    class(composite_plate_t), intent(in) :: model
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> Displacement in the accepted state, ghosts up to date, (5, points)
    real(wp), intent(in) :: displacement(:, :)
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    real(wp), allocatable :: strains(:, :)
    logical :: beside(size(model%mesh%zones)), cracked(product(model%mesh%cells))
    integer :: zone, ply

    if (.not. (model%map%layered .and. model%setup%ply_damage%is_present)) return
    do ply = 1, model%mesh%plies
      associate (below => model%mesh%zones%below_ply, delaminations => model%setup%delaminations)
        beside = (below == ply .or. below == ply - 1) .and. delaminations%law == law_cohesive .and. &
                 delaminations%flaw_strength < 1
        if (.not. any(beside)) cycle
        cracked = cracked_cells(model, plies, ply)
        do zone = 1, size(beside)
          if (beside(zone)) call weaken_beside(interfaces%cohesive, model, zone, cracked, &
                                               block_thickness(model%laminates(1)%plies, ply), &
                                               delaminations(zone)%flaw_strength)
        end do
      end associate
    end do
    if (.not. any(model%setup%delaminations%shear_cracks)) return
    strains = element_strains(model, plies, displacement)
    do ply = 1, model%mesh%plies
      call weaken_by_shear(model, plies, strains, ply, interfaces)
    end do
  end subroutine update_flaws

  !> Reduces the strengths of the interfaces of a ply beside its cracks by transverse shear: a cracked ply transmits no
  !> more than its own shear strength. Collective.
  subroutine weaken_by_shear(model, plies, strains, ply, interfaces)
    class(composite_plate_t), intent(in) :: model
    !> Failures of the plies in the accepted state
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> The interfaces in the accepted state
    type(interface_state_t), intent(inout) :: interfaces
    type(matrix_strengths_t) :: strengths
    real(wp) :: parts(size(model%mesh%zones)), reach
    logical :: beside(size(parts)), cracked(product(model%mesh%cells))
    integer :: zone

    reach = block_thickness(model%laminates(1)%plies, ply)
    associate (setup => model%setup, below => model%mesh%zones%below_ply)
      strengths = crack_strengths(model%laminates(1)%plies, ply, setup%materials, setup%ply_damage)
      beside = (below == ply .or. below == ply - 1) .and. setup%delaminations%law == law_cohesive .and. &
               setup%delaminations%shear_cracks
      parts = 1
      where (beside) parts = shear_across_strength(strengths)/setup%delaminations%strength_shear
      beside = parts < 1
    end associate
    if (.not. any(beside)) return
    cracked = .false.
    do zone = 1, size(beside)
      if (beside(zone)) cracked = cracked .or. reachable_cells(model%mesh, zone, reach)
    end do
    cracked = sheared_cells(model, plies, strains, ply, cracked, strengths)
    do zone = 1, size(beside)
      if (beside(zone)) call weaken_beside(interfaces%cohesive, model, zone, cracked, reach, parts(zone))
    end do
  end subroutine weaken_by_shear

  !> Cells in which a ply has started to crack or reaches its strength with transverse shear included, on all ranks.
  !> Collective.
  function sheared_cells(model, plies, strains, ply, reachable, strengths) result(cracked)
    class(composite_plate_t), intent(in) :: model
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> Strains from element_strains
    real(wp), intent(in) :: strains(:, :)
    !> Ply of the laminate
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
      cracks(i) = reachable(model%mesh%element_cell(model%distribution%elements(i)))
      if (cracks(i)) cracks(i) = has_ply(model, ply, i)
      if (.not. cracks(i)) cycle
      left = plies%elasticity(model, ply, i)
      associate (stack => model%stacks(model%stack(i)))
        cracks(i) = left%e2 < stack%plies(stack%place(ply))%elasticity%e2
      end associate
      if (.not. cracks(i)) &
        cracks(i) = cracks_on_a_plane(strengths, stress_of_ply(model, plies, left, strains, ply, i))
    end do
    cracked = cells_of(model, cracks)
  end function sheared_cells

  !> Cells with matrix cracks in a ply, on all ranks. Collective.
  function cracked_cells(model, plies, ply) result(cracked)
    class(composite_plate_t), intent(in) :: model
    !> Failures of the plies
    type(ply_failure_t), intent(in) :: plies
    !> Ply of the laminate
    integer, intent(in) :: ply
    !> (cells of the mesh)
    logical, allocatable :: cracked(:)
    logical, allocatable :: failed(:, :)

    failed = plies%failed_in_elements(model, ply)
    cracked = cells_of(model, failed(matrix_cracking, :) .or. failed(matrix_crushing, :))
  end function cracked_cells

  !> Cells of elements, on all ranks. Collective.
  function cells_of(model, elements) result(cells)
    class(composite_plate_t), intent(in) :: model
    !> True for elements of this rank, (elements)
    logical, intent(in) :: elements(:)
    !> (cells of the mesh)
    logical, allocatable :: cells(:)
    real(wp), allocatable :: found(:)
    integer :: i

    allocate (found(product(model%mesh%cells)), source=0.0_wp)
    do i = 1, size(elements)
      if (elements(i)) found(model%mesh%element_cell(model%distribution%elements(i))) = 1
    end do
    call model%communicator%maximum(found)
    cells = found > 0
  end function cells_of
end module crack_flaws
