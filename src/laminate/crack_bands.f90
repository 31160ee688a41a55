!> Plies that take energy to break: one band of cracks an element (Z. P. Bazant, B. H. Oh, Materials and Structures 16
!> (1983) 155-177), damage along and across the fibres.
!>
!> Damage d_f leaves (1 - d_f) E1 and (1 - d_f) nu12, damage d_m leaves (1 - d_m) E2 and (1 - d_m) G12, but for a
!> remainder. The compliance between both directions stays, and so does reciprocity; the stiffness stays positive
!> definite. Each damage follows the strain that its stress would have alone, s11/((1 - d_f) E1). That makes the
!> energy d dissipates half the undamaged modulus times the square of that strain, whatever the others do
!> (P. Maimi et al., Mechanics of Materials 39 (2007) 897-908, for the energy and its variables).
module crack_bands
  use kinds, only: wp
  use material_parameters, only: material_t
  use matrix_exposures, only: matrix_strengths_t, matrix_strengths, matrix_exposure
  use plies, only: elasticity_t, elasticity_of
  use ply_damage_parameters, only: ply_damage_t, energy_modes, fibre_tension, fibre_compression, matrix_tension, &
                                   matrix_compression
  implicit none
  private
  public :: crack_band_t, band_state_t, band_strains_t, create_crack_band, strain_band, elasticity_left, onset_strain, &
            longest_element

  !> Least strain at failure over that at the onset: a longer element would snap back.
  real(wp), parameter, public :: least_ratio = 1.25_wp
  !> Rounds in which both damages find together, and the change at which they have. Poisson's coupling is weak, so that
  !> five are usual.
  integer, parameter :: most_rounds = 50
  real(wp), parameter :: settled = 1.0e-14_wp

  !> The law of a ply.
  type :: crack_band_t
    !> Constants without damage
    type(elasticity_t) :: elasticity
    !> Strengths along the fibres, tension and compression
    real(wp) :: along(2) = 0
    !> Those of the matrix, with the set of criteria
    type(matrix_strengths_t) :: matrix
    !> Energy per area of crack in each mode
    real(wp) :: toughness(energy_modes) = 0
    !> Part of the stiffness that damage cannot take
    real(wp) :: remainder = 0
  end type crack_band_t

  !> What a ply of an element remembers.
  type :: band_state_t
    !> Damage of fibres and matrix, from 0 to 1
    real(wp) :: damage(2) = 0
    !> Energy dissipated per volume in each mode
    real(wp) :: dissipated(energy_modes) = 0
  end type band_state_t

  !> Strains of a ply of an element in the ply's axes.
  type :: band_strains_t
    !> Means of the strains along and across the fibres
    real(wp) :: mean(2) = 0
    !> Means of their squares and of their product: 11, 22, 12; and of the square of the shear strain
    real(wp) :: square(3) = 0, shear_square = 0
  end type band_strains_t

  !> One straight fall of stress over strain.
  type :: softening_t
    !> Strain over that of the onset
    real(wp) :: exposure = 0
    !> Strain at failure over that of the onset, N
    real(wp) :: ratio = huge(1.0_wp)
    !> Energy per volume that it takes in all
    real(wp) :: energy = 0
    !> Mode in which it is booked
    integer :: mode = fibre_tension
  end type softening_t

contains

  !> The law of a ply of a material.
  pure function create_crack_band(material, damage) result(band)
    !> The material, with strengths and fracture energies
    type(material_t), intent(in) :: material
    !> Criteria and remainder
    type(ply_damage_t), intent(in) :: damage
    !> The law
    type(crack_band_t) :: band

    band%elasticity = elasticity_of(material)
    band%along = [material%xt, merge(material%xc, material%xt, material%xc > 0)]
    band%matrix = matrix_strengths(material, damage%criteria)
    band%toughness = material%toughness
    band%remainder = damage%e
  end function create_crack_band

  !> What a ply remembers if trial strains are accepted.
  pure subroutine strain_band(band, lengths, strains, old, new)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> Length of the element along and across the fibres
    real(wp), intent(in) :: lengths(2)
    !> Strains of the ply
    type(band_strains_t), intent(in) :: strains
    !> The ply in the last accepted state
    type(band_state_t), intent(in) :: old
    !> The ply with these strains
    type(band_state_t), intent(out) :: new
    type(softening_t) :: falls(2)
    real(wp) :: before(2)
    integer :: round, i

    new = old
    do round = 1, most_rounds
      before = new%damage
      falls = softening_of(band, lengths, strains, new%damage)
      do i = 1, 2
        new%damage(i) = max(old%damage(i), damage_at(falls(i)))
      end do
      if (all(abs(new%damage - before) <= settled)) exit
    end do
    do i = 1, 2
      if (new%damage(i) > old%damage(i)) &
        new%dissipated(falls(i)%mode) = old%dissipated(falls(i)%mode) + (1 - band%remainder)*falls(i)%energy* &
                                        share_growth(falls(i)%ratio, old%damage(i), new%damage(i))
    end do
  end subroutine strain_band

  !> Constants that damage leaves.
  pure function elasticity_left(band, damage) result(elasticity)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> Damage of fibres and matrix
    real(wp), intent(in) :: damage(2)
    !> The constants
    type(elasticity_t) :: elasticity
    real(wp) :: left(2)

    left = stiffness_left(band, damage)
    elasticity = band%elasticity
    elasticity%e1 = elasticity%e1*left(1)
    elasticity%nu12 = elasticity%nu12*left(1)
    elasticity%e2 = elasticity%e2*left(2)
    elasticity%g12 = elasticity%g12*left(2)
  end function elasticity_left

  !> Parts of the stiffness along and across the fibres that damage leaves.
  pure function stiffness_left(band, damage) result(left)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> Damage of fibres and matrix
    real(wp), intent(in) :: damage(2)
    !> From the remainder to 1
    real(wp) :: left(2)

    left = 1 - (1 - band%remainder)*damage
  end function stiffness_left

  !> The falls on which fibres and matrix are: of tension and of compression that with the larger damage.
  pure function softening_of(band, lengths, strains, damage) result(falls)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> Length of the element along and across the fibres
    real(wp), intent(in) :: lengths(2)
    !> Strains of the ply
    type(band_strains_t), intent(in) :: strains
    !> Damage of fibres and matrix
    real(wp), intent(in) :: damage(2)
    !> Of fibres and matrix
    type(softening_t) :: falls(2)
    type(softening_t) :: signs(2)
    real(wp) :: left(2), part(2), size, weights(2), shear_energy, energy, toughness

    associate (c => band%elasticity, m => strains%mean, s => strains%square, g => band%toughness)
      left = stiffness_left(band, damage)
      ! Strains that the stresses s11 and s22 would have alone: e1 + part e2, e2 + part e1, over a common divisor.
      part = [left(2)*c%nu12*c%e2/c%e1, left(1)*c%nu12]
      size = sqrt(max(0.0_wp, s(1) + part(1)*(2*s(3) + part(1)*s(2))))/(1 - product(part))
      weights = weights_of_signs((m(1) + part(1)*m(2))/(1 - product(part)), size)
      energy = c%e1*size**2/2
      signs(1) = fall_of(weights(1)*c%e1*size/band%along(1), energy, g(fibre_tension), lengths(1), fibre_tension)
      signs(2) = fall_of(weights(2)*c%e1*size/band%along(2), energy, g(fibre_compression), lengths(1), &
                         fibre_compression)
      falls(1) = worse(signs)
      size = sqrt(max(0.0_wp, s(2) + part(2)*(2*s(3) + part(2)*s(1))))/(1 - product(part))
      weights = weights_of_signs((m(2) + part(2)*m(1))/(1 - product(part)), size)
      shear_energy = c%g12*strains%shear_square/2
      energy = c%e2*size**2/2 + shear_energy
      ! Linear interaction of the modes (E. M. Wu, R. C. Reuter, 1965): G_I/G_mt + G_II/G_mc = 1.
      toughness = g(matrix_compression)
      if (energy > 0) &
        toughness = energy/((energy - shear_energy)/g(matrix_tension) + shear_energy/g(matrix_compression))
      associate (across => c%e2*size, shear => c%g12*sqrt(strains%shear_square))
        signs(1) = fall_of(weights(1)*matrix_exposure(band%matrix, across, shear), energy, toughness, lengths(2), &
                           matrix_tension)
        signs(2) = fall_of(weights(2)*matrix_exposure(band%matrix, -across, shear), energy, g(matrix_compression), &
                           lengths(2), matrix_compression)
      end associate
      falls(2) = worse(signs)
    end associate
  end function softening_of

  !> Parts that tension and compression have in the root mean square of a strain. They are those of two halves of the
  !> ply that differ as much as needed, and change smoothly where the mean changes its sign.
  pure function weights_of_signs(mean, size) result(weights)
    !> Mean and root mean square
    real(wp), intent(in) :: mean, size
    !> Of tension and compression; their squares add up to 1
    real(wp) :: weights(2)
    real(wp) :: middle, spread

    weights = [1, 0]
    if (.not. size > tiny(size)) return
    middle = max(-1.0_wp, min(1.0_wp, mean/size))
    spread = sqrt(1 - middle**2)
    weights(1) = sqrt((max(0.0_wp, middle + spread)**2 + max(0.0_wp, middle - spread)**2)/2)
    weights(2) = sqrt((max(0.0_wp, -middle + spread)**2 + max(0.0_wp, -middle - spread)**2)/2)
  end function weights_of_signs

  !> That of two falls with the larger damage.
  pure function worse(signs)
    !> Tension and compression
    type(softening_t), intent(in) :: signs(2)
    !> One of them
    type(softening_t) :: worse

    worse = signs(1)
    if (damage_at(signs(2)) > damage_at(signs(1))) worse = signs(2)
  end function worse

  !> The fall of a mode whose stress, undamaged, would stand at an exposure and store an energy.
  pure function fall_of(exposure, energy, toughness, length, mode) result(fall)
    !> Undamaged stress over that of the onset
    real(wp), intent(in) :: exposure
    !> Energy per volume that the strain would store undamaged
    real(wp), intent(in) :: energy
    !> Energy per area of crack
    real(wp), intent(in) :: toughness
    !> Length of the element across the crack
    real(wp), intent(in) :: length
    !> The mode
    integer, intent(in) :: mode
    !> The fall
    type(softening_t) :: fall

    fall%mode = mode
    fall%exposure = exposure
    if (.not. exposure > 1) return
    fall%ratio = max(least_ratio, toughness/length/(energy/exposure**2))
    fall%energy = fall%ratio*(energy/exposure**2)
  end function fall_of

  !> Damage on a fall: d = N (f - 1)/(f (N - 1)).
  pure real(wp) function damage_at(fall) result(damage)
    !> The fall
    type(softening_t), intent(in) :: fall

    damage = 0
    if (fall%exposure >= fall%ratio) then
      damage = 1
    else if (fall%exposure > 1) then
      damage = min(1.0_wp, fall%ratio*(fall%exposure - 1)/(fall%exposure*(fall%ratio - 1)))
    end if
  end function damage_at

  !> Growth of the dissipated part d/(N (1 - d) + d) with the damage, free of cancellation.
  pure real(wp) function share_growth(ratio, damage_from, damage_to) result(growth)
    !> N
    real(wp), intent(in) :: ratio
    !> Damage before and after
    real(wp), intent(in) :: damage_from, damage_to
    real(wp) :: from, to

    from = ratio*(1 - damage_from) + damage_from
    to = ratio*(1 - damage_to) + damage_to
    growth = ratio*(damage_to - damage_from)/(from*to)
  end function share_growth

  !> A strain below which a ply can't begin to be damaged, whatever its direction: strains in its plane are measured by
  !> the root of e1**2 + e2**2 + g12**2/2, which a turn of the axes leaves as it is.
  pure real(wp) function onset_strain(band)
    !> The law
    type(crack_band_t), intent(in) :: band
    integer, parameter :: directions = 180
    real(wp), parameter :: pi = acos(-1.0_wp)
    real(wp) :: exposure, angle, nu12, nu21
    integer :: i

    nu12 = abs(band%elasticity%nu12)
    nu21 = nu12*band%elasticity%e2/band%elasticity%e1
    exposure = band%elasticity%e1*sqrt(1 + nu21**2)/minval(band%along)
    do i = 1, directions
      angle = pi*(i - 0.5_wp)/directions
      exposure = max(exposure, matrix_exposure(band%matrix, cos(angle)*band%elasticity%e2*sqrt(1 + nu12**2), &
                                               sin(angle)*band%elasticity%g12*sqrt(2.0_wp)))
    end do
    ! Between two directions the exposure is larger by less than 2 %.
    onset_strain = (1 - nu12*nu21)/(1.02_wp*exposure)
  end function onset_strain

  !> Longest element across the crack that takes no more than the fracture energy, in each mode; shear counts with
  !> compression across the fibres.
  pure function longest_element(band) result(lengths)
    !> The law
    type(crack_band_t), intent(in) :: band
    !> The lengths in the order of the modes
    real(wp) :: lengths(energy_modes)
    real(wp) :: energies(energy_modes)

    associate (c => band%elasticity, m => band%matrix)
      energies(:2) = band%along**2/(2*c%e1)
      energies(matrix_tension) = m%tension**2/(2*c%e2)
      energies(matrix_compression) = max(m%compression**2/(2*c%e2), m%shear**2/(2*c%g12))
    end associate
    lengths = band%toughness/(least_ratio*energies)
  end function longest_element
end module crack_bands
