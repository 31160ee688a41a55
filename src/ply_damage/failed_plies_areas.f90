!> Areas in which plies have failed, and numbers of failed plies.
module failed_plies_areas
  use exact_sums, only: exact_sum_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use ply_damage_parameters, only: failure_modes
  use ply_failures, only: ply_failure_t
  use rank_totals, only: totals_of
  implicit none
  private
  public :: failed_areas, failed_counts

contains

  !> Area in which each ply has failed in each mode, of the full plate. Collective.
  function failed_areas(plate, failures) result(areas)
    type(composite_plate_t), intent(in) :: plate
    type(ply_failure_t), intent(in) :: failures
    !> (modes, plies)
    real(wp) :: areas(failure_modes, plate%layup%plies)
    real(wp) :: area
    logical :: failed(failure_modes)
    type(exact_sum_t) :: sums(failure_modes, plate%layup%plies)
    integer :: k, mode, i

    areas = 0
    if (.not. plate%setup%ply_damage%is_present) return
    do i = 1, plate%elements%elements
      if (.not. may_have_failed(failures, i)) cycle
      area = plate%mesh%cell_area(plate%mesh%place_of(plate%mesh%element_cell(plate%distribution%elements(i))))
      associate (plies => plate%layup%stacks(plate%layup%stack(i))%number)
        do k = 1, size(plies)
          failed = failures%failed(plies(k), i)
          do mode = 1, failure_modes
            if (failed(mode)) call sums(mode, plies(k))%add(area)
          end do
        end do
      end associate
    end do
    areas = reshape(totals_of(plate%communicator, [sums]), shape(areas))
    do mode = 1, failure_modes
      areas(mode, :) = plate%layup%of_full_plate(areas(mode, :))
    end do
  end function failed_areas

  !> Number of ply elements failed in each mode, of the full plate. Collective.
  function failed_counts(plate, failures) result(counts)
    type(composite_plate_t), intent(in) :: plate
    type(ply_failure_t), intent(in) :: failures
    !> Fibre failure, matrix cracking, matrix crushing
    integer :: counts(failure_modes)
    integer :: element, k, mode

    counts = 0
    if (.not. plate%setup%ply_damage%is_present) return
    do element = 1, plate%elements%elements
      if (.not. may_have_failed(failures, element)) cycle
      associate (plies => plate%layup%stacks(plate%layup%stack(element))%number)
        do k = 1, size(plies)
          where (failures%failed(plies(k), element)) counts = counts + plate%mesh%multiplicity
        end do
      end associate
    end do
    do mode = 1, failure_modes
      call plate%communicator%sum(counts(mode))
    end do
  end function failed_counts

  !> False for elements without failed plies.
  pure logical function may_have_failed(failures, element)
    type(ply_failure_t), intent(in) :: failures
    integer, intent(in) :: element

    may_have_failed = .true.
    if (allocated(failures%bands)) may_have_failed = failures%bands%touched(element)
  end function may_have_failed
end module failed_plies_areas
