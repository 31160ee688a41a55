!> Resultants by which plies with E1c differ from their sections in tension, with damage.
module signed_sections
  use band_energies, only: changed_by_signs
  use band_states, only: band_states_t
  use batch_resultants, only: element_means
  use crack_bands, only: crack_band_t
  use element_batches, only: first_element, lanes
  use joined_elements, only: joined_elements_t
  use kinds, only: wp
  use mean_sections, only: mean_sections_t
  use plies, only: ply_t
  implicit none
  private
  public :: signed_resultants

contains

  !> Resultants of a batch in the trial, where plies have E1c, beyond those of their sections in tension.
  function signed_resultants(signs, plies, bands, states, joined, touched, b, weight, strains) result(resultants)
    !> Signs of the mean stresses; receives those of damaged elements
    type(mean_sections_t), intent(inout) :: signs
    !> The laminate's plies
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    !> Their damage
    type(band_states_t), intent(in) :: states
    type(joined_elements_t), intent(in) :: joined
    !> True for elements with damage in the trial, (elements)
    logical, intent(in) :: touched(:)
    integer, intent(in) :: b
    real(wp), intent(in) :: weight(lanes, 9)
    real(wp), intent(in) :: strains(lanes, 9, 6)
    real(wp) :: resultants(lanes, 7)
    real(wp) :: means(lanes, 6)
    logical :: undamaged(lanes)
    integer :: lane, element

    means = element_means(weight, strains)
    undamaged = .true.
    do lane = 1, min(lanes, size(touched) - first_element(b) + 1)
      element = first_element(b) + lane - 1
      if (joined%shares(element)) means(lane, :) = joined%means_of(element, 6)
      undamaged(lane) = .not. touched(element)
      if (touched(element)) &
        call signs%set_element(element, changed_by_signs(plies, bands, states, element, means(lane, :)))
    end do
    call signs%update(b, means, undamaged)
    resultants = signs%resultants(b, means)
  end function signed_resultants
end module signed_sections
