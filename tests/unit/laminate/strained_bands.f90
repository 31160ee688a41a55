!> A softening ply under given strains, for the tests of its law.
module strained_bands
  use crack_bands, only: band_state_t, band_strains_t, crack_band_t, flow_band, soften_band
  use kinds, only: wp
  implicit none
  private
  public :: strain_band

contains

  !> History variables of a ply under trial strains.
  pure subroutine strain_band(band, lengths, total, old, new)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> Length of the element along and transverse to the fibres
    real(wp), intent(in) :: lengths(2)
    !> Strains of the ply
    type(band_strains_t), intent(in) :: total
    !> The ply in the last accepted state
    type(band_state_t), intent(in) :: old
    !> The ply under these strains
    type(band_state_t), intent(out) :: new
    type(band_strains_t) :: strains

    new = old
    strains = total
    call flow_band(band, strains, new)
    call soften_band(band, lengths, strains, old, new)
  end subroutine strain_band
end module strained_bands
