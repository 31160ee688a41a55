!> Sums over the softening plies of elements: energies dissipated, resultants of stress-free strains, and changes of
!> sections by the sign of stresses.
module band_energies
  use band_states, only: band_states_t
  use crack_closures, only: closing_resultants
  use crack_bands, only: crack_band_t, degraded_elasticity, energy_of_shear, mean_elasticity
  use exact_sums, only: exact_sum_t
  use free_strains, only: free_resultants
  use kinds, only: wp
  use mean_stiffnesses, only: change_values, mean_change, mean_strains_at, sub_ply_middle
  use plies, only: ply_t
  use ply_damage_parameters, only: energy_modes
  implicit none
  private
  public :: dissipated_in_trial, dissipated_so_far, strengthened_so_far, changed_by_signs, resultants_without_strain

contains

  !> Energy that the trial dissipates in each mode beyond the accepted state, as exact sums.
  pure function dissipated_in_trial(states, plies, area, touched) result(energies)
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Area of each element
    real(wp), intent(in) :: area(:)
    !> True for elements with damage
    logical, intent(in) :: touched(:)
    !> In the order of the modes
    type(exact_sum_t) :: energies(energy_modes)
    real(wp) :: dissipated(energy_modes)
    integer :: element, ply, mode

    do element = 1, size(touched)
      if (.not. touched(element)) cycle
      do ply = states%range(1, element), states%range(2, element)
        associate (state => states%offset(element) + ply)
          dissipated = area(element)*(plies(ply)%z_bottom - plies(ply)%z_top) &
                       *(states%trial(state)%dissipated - states%accepted(state)%dissipated)
        end associate
        do mode = 1, energy_modes
          call energies(mode)%add(dissipated(mode))
        end do
      end do
    end do
  end function dissipated_in_trial

  !> Energy dissipated so far in each mode and by permanent shear, as exact sums.
  pure function dissipated_so_far(states, plies, bands, area, touched) result(energies)
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    !> Area of each element
    real(wp), intent(in) :: area(:)
    !> True for elements with damage
    logical, intent(in) :: touched(:)
    !> In the order of the modes, then permanent shear
    type(exact_sum_t) :: energies(energy_modes + 1)
    integer :: element, ply, mode

    do element = 1, size(touched)
      if (.not. touched(element)) cycle
      do ply = states%range(1, element), states%range(2, element)
        associate (volume => area(element)*(plies(ply)%z_bottom - plies(ply)%z_top), &
                   state => states%accepted(states%offset(element) + ply))
          do mode = 1, energy_modes
            if (.not. abs(state%dissipated(mode)) <= 0) call energies(mode)%add(volume*state%dissipated(mode))
          end do
          if (bands(ply)%permanent_shear) &
            call energies(energy_modes + 1)%add(volume*energy_of_shear(bands(ply), state))
        end associate
      end do
    end do
  end function dissipated_so_far

  !> Volume of plies with a cracked matrix, and its integral of the factor of their strengths by the strain rate, as
  !> exact sums.
  pure function strengthened_so_far(states, plies, area) result(sums)
    type(band_states_t), intent(in) :: states
    type(ply_t), intent(in) :: plies(:)
    !> Area of each element
    real(wp), intent(in) :: area(:)
    type(exact_sum_t) :: sums(2)
    integer :: element, ply

    do element = 1, size(area)
      do ply = states%range(1, element), states%range(2, element)
        associate (volume => area(element)*(plies(ply)%z_bottom - plies(ply)%z_top), &
                   factor => states%accepted(states%offset(element) + ply)%strengthened)
          if (.not. factor > 0) cycle
          call sums(1)%add(volume)
          call sums(2)%add(volume*factor)
        end associate
      end do
    end do
  end function strengthened_so_far

  !> Change of the section of a damaged element against its mean strains.
  pure function changed_by_signs(plies, bands, states, element, means) result(change)
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    type(band_states_t), intent(in) :: states
    integer, intent(in) :: element
    !> Its mean strains
    real(wp), intent(in) :: means(6)
    !> The change
    real(wp) :: change(change_values)
    real(wp) :: z
    integer :: ply, number

    change = 0
    do ply = states%range(1, element), states%range(2, element)
      associate (band => bands(ply), state => states%trial(states%offset(element) + ply))
        do number = 1, plies(ply)%sub_plies
          z = sub_ply_middle(plies(ply), number)
          change = change + mean_change(plies(ply), degraded_elasticity(band, state), &
                                        mean_elasticity(band, state, mean_strains_at(plies(ply), means, z)), z)
        end do
      end associate
    end do
  end function changed_by_signs

  !> Resultants of the stress-free strains of an element in the trial.
  pure function resultants_without_strain(plies, bands, states, element, closing) result(resultants)
    type(ply_t), intent(in) :: plies(:)
    !> Their laws
    type(crack_band_t), intent(in) :: bands(:)
    type(band_states_t), intent(in) :: states
    integer, intent(in) :: element
    !> True: with the stresses that closed cracks carry
    logical, intent(in) :: closing
    !> Of the section, and their energy per area
    real(wp) :: resultants(7)
    type(ply_t) :: strained(states%range(1, element):states%range(2, element))
    integer :: ply

    associate (first => states%range(1, element), last => states%range(2, element), offset => states%offset(element))
      strained = plies(first:last)
      strained%free_strain(3) = states%trial(offset + first:offset + last)%permanent
      resultants = free_resultants(strained, degraded_elasticity(bands(first:last), &
                                                                 states%trial(offset + first:offset + last)))
      if (closing .and. bands(first)%crack_closure) resultants = resultants + closing_resultants(strained, &
        reshape([(states%trial(offset + ply)%recovered, ply=first, last)], [3, last - first + 1]))
    end associate
  end function resultants_without_strain
end module band_energies
