!> Saves and loads the history variables of softening plies.
module band_archives
  use archives, only: archive_t
  use crack_bands, only: band_state_t
  use kinds, only: wp
  use models, only: model_t
  use ply_damage_parameters, only: energy_modes
  implicit none
  private
  public :: visit_bands

contains

  !> Saves or loads the states of all plies. Collective.
  subroutine visit_bands(archive, model, range, states)
    !> Archive of the checkpoint
    class(archive_t), intent(inout) :: archive
    type(model_t), intent(in) :: model
    !> First and last ply of each element, (2, elements)
    integer, intent(in) :: range(:, :)
    !> Their states, (plies, elements)
    type(band_state_t), intent(inout) :: states(:, :)
    integer, parameter :: numbers = 3 + energy_modes
    real(wp) :: table(numbers*size(states, 1), size(states, 2)), strains(2*size(states, 1), size(states, 2)), &
                closed(2*size(states, 1), size(states, 2))
    integer :: element, ply

    do element = 1, size(states, 2)
      table(:, element) = [([states(ply, element)%damage, states(ply, element)%shear_damage, &
                             states(ply, element)%dissipated], ply=1, size(states, 1))]
      strains(:, element) = [([states(ply, element)%permanent, states(ply, element)%accumulated], &
                              ply=1, size(states, 1))]
      closed(:, element) = [(states(ply, element)%closed, ply=1, size(states, 1))]
    end do
    call archive%field('ply_failure/crack_bands', model%distribution%elements, model%mesh%elements(), table)
    if (model%setup%ply_damage%permanent_shear) &
      call archive%field('ply_failure/permanent_shear', model%distribution%elements, model%mesh%elements(), strains)
    if (model%setup%ply_damage%crack_closure) &
      call archive%field('ply_failure/closed_cracks', model%distribution%elements, model%mesh%elements(), closed)
    if (.not. archive%loading) return
    do element = 1, size(states, 2)
      do ply = 1, size(states, 1)
        associate (values => table((ply - 1)*numbers + 1:ply*numbers, element), &
                   shear => strains(2*ply - 1:2*ply, element))
          states(ply, element) = band_state_t(damage=values(1:2), shear_damage=values(3), dissipated=values(4:), &
                                              permanent=shear(1), accumulated=shear(2), &
                                              closed=closed(2*ply - 1:2*ply, element))
        end associate
        ! The loaded state may be that of an element with more plies.
        if (ply < range(1, element) .or. ply > range(2, element)) states(ply, element) = band_state_t()
      end do
    end do
  end subroutine visit_bands
end module band_archives
