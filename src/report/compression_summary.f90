!> Results of a compression in the summary.
module compression_summary
  use compressed_damage, only: figure_area, figure_mean, figure_width
  use compression_failures, only: compression_failure_t, failure_of
  use json_text, only: json_t
  use kinds, only: wp
  use plies, only: plies_text
  use run_figures, only: run_figures_t
  use run_records, only: run_record_t
  use run_results, only: results_t
  implicit none
  private
  public :: put_collapse, compression_text, collapse_text

contains

  !> Strength and modulus for the log.
  pure function compression_text(results, at) result(text)
    type(results_t), intent(in) :: results
    !> Time of the strength in words
    character(len=*), intent(in) :: at
    !> Figures after a label
    character(len=:), allocatable :: text

    text = results%shown('residual_strength')//' at a shortening of '//results%shown('shortening_at_strength')//', '//at
    if (results%has('failure_load')) text = text//', failure load '//results%shown('failure_load')// &
      ', stress of the laminate '//results%shown('skin_stress_at_strength')
    if (results%has('effective_modulus')) text = text//', effective modulus '//results%shown('effective_modulus')
    if (results%has('buckling_strain')) text = text//', buckled at a strain of '//results%shown('buckling_strain')
    if (.not. results%value('has_failed') > 0) text = text//'; a lower bound, as the plate has not failed'
  end function compression_text

  !> Place of failure, for the file.
  subroutine put_collapse(json, record, figures, below_plies)
    type(json_t), intent(inout) :: json
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    integer, intent(in) :: below_plies(:)
    type(compression_failure_t) :: failure
    integer :: i

    failure = failure_of(record%before, figures%compressed, figures%length, figures%thickness)
    if (record%compression%failed .and. len(failure%code) > 0) then
      call json%put('failure_code', failure%code)
    else
      call json%put_null('failure_code')
    end if
    call json%open_object('collapse')
    call json%open_list('interfaces')
    do i = 1, size(below_plies)
      call put_place('ply_above', below_plies(i), record%before%interfaces(:, i), figures%compressed%interfaces(:, i), &
                     failure%interfaces(i))
    end do
    call json%close()
    call json%open_list('fibres')
    do i = 1, size(figures%compressed%plies, 2)
      call put_place('ply', i, record%before%plies(:, i), figures%compressed%plies(:, i), failure%plies(i))
    end do
    call json%close()
    call json%close()

  contains

    !> One interface or ply.
    subroutine put_place(name, number, before, after, across)
      character(len=*), intent(in) :: name
      !> Its number
      integer, intent(in) :: number
      !> Quantities before the load, and at the end
      real(wp), intent(in) :: before(:), after(:)
      !> True: it has failed across the width since
      logical, intent(in) :: across

      call json%open_object('')
      call json%put(name, number)
      call json%put('area_before', before(figure_area))
      call json%put('area', after(figure_area))
      call json%put('mean_distance', after(figure_mean))
      call json%put('width_before', before(figure_width))
      call json%put('width', after(figure_width))
      call json%put('failed_across_width', across)
      call json%close()
    end subroutine put_place
  end subroutine put_collapse

  !> The same for the log.
  pure function collapse_text(record, figures, below_plies) result(text)
    type(run_record_t), intent(in) :: record
    type(run_figures_t), intent(in) :: figures
    integer, intent(in) :: below_plies(:)
    !> Code, interfaces and plies
    character(len=:), allocatable :: text
    type(compression_failure_t) :: failure
    integer :: i

    failure = failure_of(record%before, figures%compressed, figures%length, figures%thickness)
    if (len(failure%code) == 0) then
      text = 'no interface has delaminated across the width, no fibres have failed across it'
      return
    end if
    text = failure%code//' by ASTM D7137'
    if (any(failure%interfaces)) text = text//'; delaminated across the width below '// &
      plies_text(pack(below_plies, failure%interfaces))
    if (any(failure%plies)) text = text//'; fibres failed across the width in '// &
      plies_text(pack([(i, i=1, size(failure%plies))], failure%plies))
  end function collapse_text
end module compression_summary
