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
  function failed_areas(model, failures) result(areas)
    class(composite_plate_t), intent(in) :: model
    type(ply_failure_t), intent(in) :: failures
    !> (modes, plies)
    real(wp) :: areas(failure_modes, model%plies)
    real(wp) :: area
    logical :: failed(failure_modes)
    type(exact_sum_t) :: sums(failure_modes, model%plies)
    integer :: k, mode, i

    areas = 0
    if (.not. model%setup%ply_damage%is_present) return
    do i = 1, model%elements%elements
      if (.not. may_have_failed(failures, i)) cycle
      area = model%mesh%cell_area(model%mesh%place_of(model%mesh%element_cell(model%distribution%elements(i))))
      associate (plies => model%stacks(model%stack(i))%number)
        do k = 1, size(plies)
          failed = failures%failed(plies(k), i)
          do mode = 1, failure_modes
            if (failed(mode)) call sums(mode, plies(k))%add(area)
          end do
        end do
      end associate
    end do
    areas = reshape(totals_of(model%communicator, [sums]), shape(areas))*model%mesh%multiplicity
  end function failed_areas

  !> Number of ply elements failed in each mode, of the full plate. Collective.
  function failed_counts(model, failures) result(counts)
    class(composite_plate_t), intent(in) :: model
    type(ply_failure_t), intent(in) :: failures
    !> Fibre failure, matrix cracking, matrix crushing
    integer :: counts(failure_modes)
    integer :: element, k, mode

    counts = 0
    if (.not. model%setup%ply_damage%is_present) return
    do element = 1, model%elements%elements
      if (.not. may_have_failed(failures, element)) cycle
      associate (plies => model%stacks(model%stack(element))%number)
        do k = 1, size(plies)
          where (failures%failed(plies(k), element)) counts = counts + model%mesh%multiplicity
        end do
      end associate
    end do
    do mode = 1, failure_modes
      call model%communicator%sum(counts(mode))
    end do
  end function failed_counts

  !> False for elements without failed plies.
  pure logical function may_have_failed(failures, element)
    type(ply_failure_t), intent(in) :: failures
    !> Element of this rank
    integer, intent(in) :: element

    may_have_failed = .true.
    if (allocated(failures%bands)) may_have_failed = failures%bands%touched(element)
  end function may_have_failed
end module failed_plies_areas
