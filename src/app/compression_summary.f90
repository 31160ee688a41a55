!> Results of a compression in the summary.
module compression_summary
  use compression_records, only: compression_record_t
  use gauges, only: gauge_t
  use json_text, only: json_t
  use placed_gauges, only: back_to_back
  use text, only: rounded_text
  implicit none
  private
  public :: put_compression, compression_text

contains

  !> Strength and modulus for the file.
  subroutine put_compression(json, record, gauges)
    !> The summary
    type(json_t), intent(inout) :: json
    !> Record of the run
    type(compression_record_t), intent(in) :: record
    !> Strain gauges of the deck
    type(gauge_t), intent(in) :: gauges(:)

    call json%put('residual_strength', record%strength)
    call json%put('residual_strength_at', record%at)
    call json%put('shortening_at_strength', record%shortening)
    call json%put('has_failed', record%failed)
    if (record%modulus() > 0) then
      call json%put('effective_modulus', record%modulus())
    else
      call json%put_null('effective_modulus')
    end if
    if (.not. all(back_to_back(gauges) > 0)) return
    call json%put('percent_bending', record%bending)
    if (record%buckling > 0) then
      call json%put('buckling_strain', record%buckling)
    else
      call json%put_null('buckling_strain')
    end if
  end subroutine put_compression

  !> The same for the log.
  pure function compression_text(record) result(text)
    !> Record of the run
    type(compression_record_t), intent(in) :: record
    !> Figures after a label
    character(len=:), allocatable :: text

    text = rounded_text(record%strength)//' at a shortening of '//rounded_text(record%shortening)//', time '// &
           rounded_text(record%at)
    if (record%modulus() > 0) text = text//', effective modulus '//rounded_text(record%modulus())
    if (record%buckling > 0) text = text//', buckled at a strain of '//rounded_text(record%buckling)
    if (.not. record%failed) text = text//'; the plate has not failed, so it is borne at least'
  end function compression_text
end module compression_summary
