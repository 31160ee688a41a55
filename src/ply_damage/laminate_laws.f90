!> Laws of softening of the plies of all laminates.
module laminate_laws
  use composite_plates, only: composite_plate_t
  use crack_bands, only: crack_band_t, create_crack_band
  use in_situ_strengths, only: material_in_place
  use plies, only: ply_t
  implicit none
  private
  public :: find_laws

contains

  !> The plies of all laminates, and their laws with in-situ strengths.
  pure subroutine find_laws(plate, plies, bands)
    type(composite_plate_t), intent(in) :: plate
    !> In the order of the laminates
    type(ply_t), allocatable, intent(out) :: plies(:)
    !> The law of each
    type(crack_band_t), allocatable, intent(out) :: bands(:)
    integer :: i, ply

    allocate (plies(0), bands(0))
    do i = 1, size(plate%layup%laminates)
      associate (stacked => plate%layup%laminates(i)%plies, setup => plate%setup)
        plies = [plies, stacked]
        bands = [bands, [(create_crack_band(material_in_place(stacked, ply, setup%materials, setup%ply_damage), &
                                            setup%ply_damage), ply=1, size(stacked))]]
      end associate
    end do
  end subroutine find_laws
end module laminate_laws
