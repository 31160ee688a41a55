!> Plies that soften by their fracture energies: one crack band per element (Z. P. Bazant, B. H. Oh, Materials and
!> Structures 16 (1983) 155-177), damage along and across the fibres, theory (M10) to (M12).
!>
!> With the damage d_f the moduli are (1 - d_f) E1 and Poisson's ratio (1 - d_f) nu12, with the damage d_m the moduli
!> are (1 - d_m) E2 and (1 - d_m) G12, down to a residual stiffness. The compliance that couples both directions is
!> constant, so reciprocity holds and the stiffness is positive definite. Each damage variable depends on its uniaxial
!> strain, s11/((1 - d_f) E1) along the fibres. The energy that d dissipates is then half the undamaged modulus times
!> the square of that strain, independent of the other damage (P. Maimi et al., Mechanics of Materials 39 (2007)
!> 897-908, for the energy and its variables). Before the matrix cracks, nonlinear shear may reduce G12 throughout the
!> element by the law of Hahn and Tsai.
module crack_bands
  use crack_band_laws, only: band_state_t, crack_band_t, create_crack_band
  use crack_closures, only: band_strains_t, remaining_t, fractions_under, find_strain_alone, compressed_share, &
                            find_recovered
  use hahn_tsai, only: shear_loss, energy_of_loss, shear_flow, energy_of_flow
  use kinds, only: wp
  use larc_criteria, only: frame_exposure, kinking_exposure
  use matrix_exposures, only: matrix_exposure
  use plies, only: elasticity_t
  use ply_damage_parameters, only: energy_modes, fibre_tension, fibre_compression, matrix_tension, &
                                   matrix_compression
  use linear_softening, only: softening_t, linear_softening_of, more_damaged, damage_at, dissipated_by
  implicit none
  private
  public :: crack_band_t, band_state_t, band_strains_t, create_crack_band, flow_band, soften_band, &
            degraded_elasticity, mean_elasticity, energy_of_shear, is_damaged, remaining_stiffness, stiffness_lost, &
            tensile_stress

  !> Largest number of iterations for both damage variables, and their tolerance. Poisson's coupling is weak, so five
  !> iterations are usual.
  integer, parameter :: max_iterations = 50
  real(wp), parameter :: damage_tolerance = 1.0e-14_wp

contains

  !> Permanent shear strain of a ply under trial strains, which is subtracted from these. The opening of a crack is no
  !> strain of the ply: after cracking the permanent strain is constant.
  pure subroutine flow_band(band, strains, state)
    type(crack_band_t), intent(in) :: band
    !> Strains of the ply; receive the elastic ones
    type(band_strains_t), intent(inout) :: strains
    !> The ply in the last accepted state; receives its permanent strain
    type(band_state_t), intent(inout) :: state
    real(wp) :: total

    if (.not. band%permanent_shear) return
    total = strains%shear_mean
    if (.not. state%damage(2) > 0) &
      call shear_flow(band%elasticity%g12, band%shear_beta, total, state%permanent, state%accumulated)
    strains%shear_mean = total - state%permanent
    strains%shear_square = max(0.0_wp, strains%shear_square - state%permanent*(total + strains%shear_mean))
  end subroutine flow_band

  !> Damage of a ply under trial strains.
  pure subroutine soften_band(band, lengths, strains, old, new, rate_factor)
    type(crack_band_t), intent(in) :: band
    !> Length of the element along and across the fibres
    real(wp), intent(in) :: lengths(2)
    !> Strains of the ply without permanent ones
    type(band_strains_t), intent(in) :: strains
    type(band_state_t), intent(in) :: old
    !> The same with its present permanent strain; receives the damage
    type(band_state_t), intent(inout) :: new
    !> Factor of the matrix strengths by the strain rate before the matrix cracks; absent: 1
    real(wp), intent(in), optional :: rate_factor
    real(wp) :: factor

    factor = 1
    if (present(rate_factor)) factor = rate_factor
    ! While the matrix softens its strengths are constant, so that it dissipates its fracture energies.
    if (old%strengthened > 0) factor = max(1.0_wp, old%strengthened)
    if (.not. band%permanent_shear) call shear_band(band, strains, factor, old, new)
    if (new%shear_damage > 0) then
      call find_damage(sheared_law(band, new%shear_damage), lengths, strains, factor, old, new)
    else
      call find_damage(band, lengths, strains, factor, old, new)
    end if
    if (new%damage(2) > 0) new%strengthened = factor
  end subroutine soften_band

  !> Damage of fibres and matrix under trial strains, both found together, and the energy that it dissipates.
  pure subroutine find_damage(band, lengths, strains, factor, old, new)
    !> The law, with G12 reduced by nonlinear shear
    type(crack_band_t), intent(in) :: band
    !> Length of the element along and across the fibres
    real(wp), intent(in) :: lengths(2)
    type(band_strains_t), intent(in) :: strains
    !> Factor of the matrix strengths
    real(wp), intent(in) :: factor
    type(band_state_t), intent(in) :: old
    !> The ply with these strains
    type(band_state_t), intent(inout) :: new
    type(softening_t) :: signs(2, 2)
    type(remaining_t) :: left
    real(wp) :: before(2), share(2), recorded(energy_modes)
    integer :: round, i

    do round = 1, max_iterations
      before = new%damage
      left = remaining_fractions(band, new)
      new%kinked = old%kinked
      call soften_fibres(band, lengths(1), strains, left, new%kinked, signs(:, 1))
      signs(:, 2) = matrix_softening(band, lengths(2), strains, factor, left)
      do i = 1, 2
        new%damage(i) = max(old%damage(i), damage_at(more_damaged(signs(:, i))))
        if (band%crack_closure) new%closed(i) = max(old%closed(i), damage_at(signs(2, i)))
      end do
      if (all(abs(new%damage - before) <= damage_tolerance)) exit
    end do
    share = 0
    if (band%crack_closure) share = compressed_share(band%elasticity, strains, left)
    do i = 1, 2
      recorded = 0
      recorded(signs(2, i)%mode) = dissipated_by(signs(2, i), (1 - band%remainder)*share(i), old%closed(i), &
                                                 new%closed(i))
      associate (fall => more_damaged(signs(:, i)))
        recorded(fall%mode) = recorded(fall%mode) &
                            + dissipated_by(fall, (1 - band%remainder)*(1 - share(i)), old%damage(i), new%damage(i))
      end associate
      new%dissipated = new%dissipated + recorded
    end do
    if (band%crack_closure) &
      new%recovered = find_recovered(band%elasticity, strains, remaining_fractions(band, new))
  end subroutine find_damage

  !> Energy per volume dissipated by permanent shear strains of a ply.
  elemental real(wp) function energy_of_shear(band, state) result(energy)
    type(crack_band_t), intent(in) :: band
    type(band_state_t), intent(in) :: state

    energy = 0
    if (band%permanent_shear) energy = energy_of_flow(band%shear_beta, state%accumulated)
  end function energy_of_shear

  !> Loss of G12 by nonlinear shear before matrix cracking, found for the strains up to the onset of the crack.
  pure subroutine shear_band(band, strains, factor, old, new)
    type(crack_band_t), intent(in) :: band
    type(band_strains_t), intent(in) :: strains
    !> Factor of the matrix strengths
    real(wp), intent(in) :: factor
    type(band_state_t), intent(in) :: old
    !> The ply with these strains
    type(band_state_t), intent(inout) :: new
    real(wp) :: least, most, middle
    integer :: i

    if (.not. band%shear_beta > 0 .or. old%damage(2) > 0) return
    least = 0
    most = 1
    if (.not. cracks_at(most)) least = 1
    do i = 1, digits(least)
      if (least >= most) exit
      middle = (least + most)/2
      if (cracks_at(middle)) then
        most = middle
      else
        least = middle
      end if
    end do
    new%shear_damage = loss_at(least)
    associate (modulus => band%elasticity%g12, beta => band%shear_beta, recorded => new%dissipated(matrix_compression))
      recorded = recorded + (energy_of_loss(modulus, beta, new%shear_damage) &
                         - energy_of_loss(modulus, beta, old%shear_damage))
    end associate

  contains

    !> Loss of G12 at a fraction of the strains.
    pure real(wp) function loss_at(part) result(loss)
      real(wp), intent(in) :: part

      loss = max(old%shear_damage, shear_loss(band%elasticity%g12, band%shear_beta, part*sqrt(strains%shear_square)))
    end function loss_at

    !> True if the matrix cracks at a fraction of the strains.
    pure logical function cracks_at(part) result(cracks)
      real(wp), intent(in) :: part
      type(softening_t) :: signs(2)

      signs = matrix_softening(sheared_law(band, loss_at(part)), 1.0_wp, strains, factor, &
                               remaining_fractions(band, old))
      cracks = part*maxval(signs%exposure) > 1
    end function cracks_at
  end subroutine shear_band

  !> Fractions of the stiffness that a ply has lost: along and across the fibres, in shear before cracking.
  pure function stiffness_lost(state) result(lost)
    type(band_state_t), intent(in) :: state
    !> From 0 to 1
    real(wp) :: lost(3)

    lost = [state%damage, state%shear_damage]
  end function stiffness_lost

  !> True: not the undamaged state.
  elemental logical function is_damaged(state)
    type(band_state_t), intent(in) :: state

    is_damaged = any(stiffness_lost(state) > 0) .or. state%accumulated > 0
  end function is_damaged

  !> The law with the reduced G12.
  pure function sheared_law(band, loss) result(law)
    type(crack_band_t), intent(in) :: band
    !> Part of G12 that is lost
    real(wp), intent(in) :: loss
    type(crack_band_t) :: law

    law = band
    law%elasticity%g12 = band%elasticity%g12*(1 - loss)
  end function sheared_law

  !> Elastic constants of a state.
  elemental function degraded_elasticity(band, state) result(elasticity)
    type(crack_band_t), intent(in) :: band
    type(band_state_t), intent(in) :: state
    type(elasticity_t) :: elasticity
    real(wp) :: left(2)

    left = remaining_stiffness(band, state%damage)
    elasticity = band%elasticity
    elasticity%e1 = elasticity%e1*left(1)
    elasticity%nu12 = elasticity%nu12*left(1)
    elasticity%e2 = elasticity%e2*left(2)
    elasticity%g12 = elasticity%g12*(1 - state%shear_damage)*left(2)
  end function degraded_elasticity

  !> Remaining fractions of the stiffness along and across the fibres.
  pure function remaining_stiffness(band, damage) result(left)
    type(crack_band_t), intent(in) :: band
    !> Damage of fibres and matrix
    real(wp), intent(in) :: damage(2)
    !> From the remainder to 1
    real(wp) :: left(2)

    left = 1 - (1 - band%remainder)*damage
  end function remaining_stiffness

  !> Remaining fractions of the stiffness of a state.
  pure function remaining_fractions(band, state) result(left)
    type(crack_band_t), intent(in) :: band
    type(band_state_t), intent(in) :: state
    type(remaining_t) :: left

    left = remaining_t(remaining_stiffness(band, state%damage), remaining_stiffness(band, state%damage))
    if (band%crack_closure) left%closed = remaining_stiffness(band, state%closed)
  end function remaining_fractions

  !> Elastic constants of a state for mean strains.
  pure function mean_elasticity(band, state, mean) result(elasticity)
    type(crack_band_t), intent(in) :: band
    type(band_state_t), intent(in) :: state
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    type(elasticity_t) :: elasticity
    real(wp) :: left(2)

    left = fractions_under(band%elasticity, mean, remaining_fractions(band, state))
    elasticity = degraded_elasticity(band, state)
    elasticity%e1 = band%elasticity%e1*left(1)
    elasticity%nu12 = band%elasticity%nu12*left(1)
    elasticity%e2 = band%elasticity%e2*left(2)
  end function mean_elasticity

  !> Softening laws of the fibres.
  pure subroutine soften_fibres(band, length, strains, left, kinked, signs)
    type(crack_band_t), intent(in) :: band
    !> Length of the element along the fibres
    real(wp), intent(in) :: length
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> Compressive strength at the onset of kinking, which later loads do not change; 0: not yet
    real(wp), intent(inout) :: kinked
    !> Of tension and compression
    type(softening_t), intent(out) :: signs(2)
    real(wp) :: size, weights(2), energy, stress, exposure

    associate (c => band%elasticity, g => band%toughness)
      call find_strain_alone(c, strains, left, 1, size, weights)
      energy = c%e1*size**2/2
      stress = weights(2)*sqrt(c%compression)*c%e1*size
      exposure = stress/band%along(2)
      if (kinked > 0) then
        exposure = stress/kinked
      else if (band%kinking .and. stress > 0) then
        exposure = exposure_to_kinking(band, strains, left, -stress)
        if (exposure > 1) kinked = stress/exposure
      end if
      signs(1) = linear_softening_of(weights(1)*c%e1*size/band%along(1), energy, g(fibre_tension), length, &
                                     fibre_tension)
      signs(2) = linear_softening_of(exposure, energy, g(fibre_compression), length, fibre_compression)
    end associate
  end subroutine soften_fibres

  !> Undamaged stress of fibres in tension, which their exposure compares with XT.
  pure real(wp) function tensile_stress(band, strains, state) result(stress)
    type(crack_band_t), intent(in) :: band
    !> Strains of the ply without permanent ones
    type(band_strains_t), intent(in) :: strains
    !> The ply with these strains
    type(band_state_t), intent(in) :: state
    real(wp) :: size, weights(2)

    call find_strain_alone(band%elasticity, strains, remaining_fractions(band, state), 1, size, weights)
    stress = weights(1)*band%elasticity%e1*size
  end function tensile_stress

  !> Exposure of compressed fibres to kinking. The stresses across the fibres and in shear are those that the damaged
  !> matrix transfers: a failed matrix leaves XC.
  pure real(wp) function exposure_to_kinking(band, strains, left, along) result(exposure)
    type(crack_band_t), intent(in) :: band
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> Stress along the fibres, negative
    real(wp), intent(in) :: along
    real(wp) :: size, weights(2), across, shear

    associate (c => band%elasticity)
      call find_strain_alone(c, strains, left, 2, size, weights)
      across = c%e2*size*(weights(1) - weights(2))
      across = across*merge(left%open(2), left%closed(2), across > 0)
      shear = c%g12*sqrt(strains%shear_square)*left%open(2)
    end associate
    ! Below 1 its value does not matter.
    exposure = frame_exposure(band%matrix%larc, along, across, shear)
    if (exposure >= 1) exposure = kinking_exposure(band%matrix%larc, along, across, shear)
  end function exposure_to_kinking

  !> Softening laws of the matrix.
  pure function matrix_softening(band, length, strains, factor, left) result(signs)
    type(crack_band_t), intent(in) :: band
    !> Length of the element across the fibres
    real(wp), intent(in) :: length
    type(band_strains_t), intent(in) :: strains
    !> Factor of the matrix strengths
    real(wp), intent(in) :: factor
    type(remaining_t), intent(in) :: left
    !> Of tension and compression
    type(softening_t) :: signs(2)
    real(wp) :: size, weights(2), shear_energy, energy, toughness, across, shear

    associate (c => band%elasticity, g => band%toughness)
      call find_strain_alone(c, strains, left, 2, size, weights)
      shear_energy = c%g12*strains%shear_square/2
      energy = c%e2*size**2/2 + shear_energy
      ! Linear interaction of the modes (E. M. Wu, R. C. Reuter, 1965): G_I/G_mt + G_II/G_mc = 1, theory (M12).
      toughness = g(matrix_compression)
      if (energy > 0) &
        toughness = energy/((energy - shear_energy)/g(matrix_tension) + shear_energy/g(matrix_compression))
      across = c%e2*size
      shear = c%g12*sqrt(strains%shear_square)
      signs(1) = linear_softening_of(weights(1)*matrix_exposure(band%matrix, across, shear)/factor, energy, toughness, &
                                     length, matrix_tension)
      signs(2) = linear_softening_of(weights(2)*matrix_exposure(band%matrix, -across, shear)/factor, energy, &
                                     g(matrix_compression), length, matrix_compression)
    end associate
  end function matrix_softening
end module crack_bands
