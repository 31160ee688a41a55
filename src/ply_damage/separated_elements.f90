!> Elements at a struck point that do not share their damage with those joined with them, as an earlier impact has
!> damaged them differently. Joined, one with little damage would soften by the large strains of the other, and record
!> more energy than it has stored.
module separated_elements
  use archives, only: archive_t
  use crack_band_sections, only: crack_band_sections_t
  use crack_bands, only: stiffness_lost
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use roundings, only: rounding
  implicit none
  private
  public :: separate_unequal, visit_separated

contains

  !> Separates joined elements with different damage. Collective.
  subroutine separate_unequal(sections)
    type(crack_band_sections_t), intent(inout) :: sections
    real(wp) :: lost(3, size(sections%area)), differences(size(sections%area))
    logical :: unequal(size(sections%area))
    integer :: place, element, i

    unequal = .false.
    do place = 0, size(sections%states%number) - 1
      lost = 0
      do element = 1, size(sections%area)
        associate (ply => sections%states%range(1, element) + place)
          if (ply > sections%states%range(2, element)) cycle
          lost(:, element) = stiffness_lost(sections%states%accepted(sections%states%offset(element) + ply))
        end associate
      end do
      do i = 1, size(lost, 1)
        differences = sections%joined%differences(lost(i, :))
        unequal = unequal .or. differences > rounding
      end do
    end do
    call separate(sections, unequal)
  end subroutine separate_unequal

  !> Separates elements from those joined with them.
  pure subroutine separate(sections, separated)
    type(crack_band_sections_t), intent(inout) :: sections
    !> True for these elements
    logical, intent(in) :: separated(:)
    integer :: element

    do element = 1, size(separated)
      if (.not. separated(element)) cycle
      sections%sides(:, element) = sections%sides(:, element)/merge(2, 1, sections%joined%joined(:, element))
      call sections%joined%separate(element)
    end do
  end subroutine separate

  !> Saves or loads which elements are separated.
  subroutine visit_separated(sections, archive, plate)
    type(crack_band_sections_t), intent(inout) :: sections
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    logical :: separated(size(sections%area))

    call sections%joined%visit(archive, plate, separated)
    if (archive%loading) call separate(sections, separated)
  end subroutine visit_separated
end module separated_elements
