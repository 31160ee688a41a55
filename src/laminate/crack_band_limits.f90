!> Limits of softening plies: the strain below which no ply is damaged, and the longest elements that dissipate no more
!> than the fracture energies.
module crack_band_limits
  use crack_bands, only: band_state_t, band_strains_t, crack_band_t, remaining_stiffness
  use kinds, only: wp
  use larc_criteria, only: kinking_exposure
  use linear_softening, only: min_ratio
  use mathematical_constants, only: pi
  use matrix_exposures, only: matrix_exposure
  use plies, only: reduced_stiffness
  use ply_damage_parameters, only: energy_modes, matrix_tension, matrix_compression
  use roundings, only: rounding
  implicit none
  private
  public :: onset_strain, strain_of_stress, may_soften, longest_element

contains

  !> A strain below which a ply cannot be damaged, in any direction. The measure of in-plane strains is the root of
  !> e1**2 + e2**2 + g12**2/2, which is invariant under rotation. With nonlinear shear the limit is zero.
  pure real(wp) function onset_strain(band)
    type(crack_band_t), intent(in) :: band
    integer, parameter :: directions = 180
    real(wp) :: exposure, angle, nu12, nu21
    integer :: i

    nu12 = abs(band%elasticity%nu12)
    nu21 = nu12*band%elasticity%e2/band%elasticity%e1
    exposure = (1 - nu12*nu21)/strain_of_stress(band, minval(band%along)/max(1.0_wp, band%elasticity%compression))
    do i = 1, directions
      angle = pi*(i - 0.5_wp)/directions
      exposure = max(exposure, matrix_exposure(band%matrix, cos(angle)*band%elasticity%e2*sqrt(1 + nu12**2), &
                                               sin(angle)*band%elasticity%g12*sqrt(2.0_wp)))
    end do
    ! The envelopes of failure are convex on each side of pure shear, which lies midway between two of the directions.
    ! Between two adjacent directions the exposure is therefore at most the larger of their exposures over the cosine of
    ! half the angle between them.
    onset_strain = (1 - nu12*nu21)*cos(pi/(2*directions))/exposure
    if (band%kinking) onset_strain = min(onset_strain, kinking_strain(band))
    if (band%shear_beta > 0) onset_strain = 0
  end function onset_strain

  !> A strain below which the stress along undamaged fibres is smaller than a value, in the same measure.
  pure real(wp) function strain_of_stress(band, stress) result(strain)
    type(crack_band_t), intent(in) :: band
    !> The stress
    real(wp), intent(in) :: stress
    real(wp) :: nu12, nu21

    nu12 = abs(band%elasticity%nu12)
    nu21 = nu12*band%elasticity%e2/band%elasticity%e1
    strain = (1 - nu12*nu21)*stress/(band%elasticity%e1*sqrt(1 + nu21**2))
  end function strain_of_stress

  !> A strain below which fibres do not kink, in the same measure: the smallest of a grid of directions, less the
  !> variation of the exposure between two of them. Where the strain rate strengthens the matrix, stresses in it count
  !> less, also those across the fibres that press on them: they are left out, too.
  pure real(wp) function kinking_strain(band) result(strain)
    type(crack_band_t), intent(in) :: band
    integer, parameter :: directions = 60
    real(wp), parameter :: reserve = 0.9_wp
    real(wp) :: polar, turn, e(3), along, across, shear, exposure
    integer :: i, j

    exposure = 0
    associate (c => band%elasticity)
      do i = 0, directions
        do j = 0, directions
          polar = pi*i/directions
          turn = pi*j/directions
          e = [cos(polar), sin(polar)*cos(turn), sqrt(2.0_wp)*sin(polar)*sin(turn)]
          associate (q => reduced_stiffness(c))
            along = max(1.0_wp, c%compression)*(q(1)*e(1) + q(2)*e(2))
            across = q(2)*e(1) + q(3)*e(2)
            shear = q(4)*e(3)
          end associate
          exposure = max(exposure, kinking_exposure(band%matrix%larc, along, across, shear))
          if (band%rate_gain > 0) exposure = max(exposure, kinking_exposure(band%matrix%larc, along, 0.0_wp, shear))
        end do
      end do
    end associate
    strain = reserve/exposure
  end function kinking_strain

  !> False where strains certainly do not change the state of a ply: what may fail further is exposed by less than 1.
  !> Compressed sub-plies have another modulus along the fibres, which changes the strain that each stress alone would
  !> cause by less than that of all of them compressed; the exposures of the matrix are convex on each side of pure
  !> shear, hence largest at the ends.
  pure logical function may_soften(band, strains, state)
    type(crack_band_t), intent(in) :: band
    type(band_strains_t), intent(in) :: strains
    !> The ply in the last accepted state
    type(band_state_t), intent(in) :: state
    real(wp) :: left(2), along, across, shear, divisor

    may_soften = band%kinking .or. band%crack_closure .or. band%shear_beta > 0
    if (may_soften) return
    left = remaining_stiffness(band, state%damage)
    associate (c => band%elasticity, s => strains%square, stiffer => max(1.0_wp, band%elasticity%compression), &
               nu21 => left(2)*band%elasticity%nu12*band%elasticity%e2/band%elasticity%e1, &
               nu12 => left(1)*band%elasticity%nu12)
      divisor = (1 - nu12*nu21*stiffer)*(1 - rounding)
      if (state%damage(1) < 1) then
        along = sqrt(stiffer*max(0.0_wp, s(1) + nu21*(2*s(3) + nu21*s(2))))*c%e1/divisor
        may_soften = .not. max(along/band%along(1), sqrt(c%compression)*along/band%along(2)) < 1
      end if
      if (may_soften .or. .not. state%damage(2) < 1) return
      across = c%e2*(sqrt(max(0.0_wp, s(2) + nu12*(2*s(3) + nu12*s(1)))) &
                     + abs(nu12*(c%compression - 1))*sqrt(max(0.0_wp, s(1))))/divisor
      shear = c%g12*sqrt(strains%shear_square)/(1 - rounding)
    end associate
    may_soften = .not. max(matrix_exposure(band%matrix, across, shear), matrix_exposure(band%matrix, 0.0_wp, shear), &
                           matrix_exposure(band%matrix, -across, shear)) < 1
  end function may_soften

  !> Longest element across the crack that dissipates no more than the fracture energy, in each mode; shear counts as
  !> transverse compression.
  pure function longest_element(band) result(lengths)
    type(crack_band_t), intent(in) :: band
    !> The lengths in the order of the modes
    real(wp) :: lengths(energy_modes)
    real(wp) :: energies(energy_modes)

    associate (c => band%elasticity, m => band%matrix)
      energies(:2) = band%along**2/(2*c%e1*[1.0_wp, c%compression])
      energies(matrix_tension) = m%tension**2/(2*c%e2)
      energies(matrix_compression) = max(m%compression**2/(2*c%e2), m%shear**2/(2*c%g12) + &
                                                                    band%shear_beta*m%shear**4/2)
    end associate
    lengths = band%toughness/(min_ratio*energies)
  end function longest_element
end module crack_band_limits
