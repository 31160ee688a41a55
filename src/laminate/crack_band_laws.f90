!> Constants and history variables of softening plies, theory (M10) to (M12).
module crack_band_laws
  use kinds, only: wp
  use material_parameters, only: material_t
  use matrix_exposures, only: matrix_strengths_t, matrix_strengths
  use plies, only: elasticity_t, elasticity_of
  use ply_damage_parameters, only: ply_damage_t, energy_modes
  implicit none
  private
  public :: crack_band_t, band_state_t, create_crack_band

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
    !> Residual stiffness, as a fraction
    real(wp) :: remainder = 0
    !> Coefficient beta of Hahn and Tsai; 0: shear is linear
    real(wp) :: shear_beta = 0
    !> True: shear strain beyond s12/G12 is permanent
    logical :: permanent_shear = .false.
    !> True: tensile cracks carry compression
    logical :: crack_closure = .false.
    !> True: compressed fibres fail by kinking
    logical :: kinking = .false.
    !> Gain of the matrix strengths per decade of strain rate, as a fraction, and the rate at which they hold
    real(wp) :: rate_gain = 0, reference_rate = 0
  end type crack_band_t

  !> History variables of a ply in an element.
  type :: band_state_t
    !> Damage of fibres and matrix, from 0 to 1
    real(wp) :: damage(2) = 0
    !> Energy dissipated per volume in each mode
    real(wp) :: dissipated(energy_modes) = 0
    !> Loss of G12 by shear before matrix cracking, as a fraction
    real(wp) :: shear_damage = 0
    !> Permanent shear strain, and its accumulated magnitude
    real(wp) :: permanent = 0, accumulated = 0
    !> Part of the damage of fibres and matrix that remains when cracks close
    real(wp) :: closed(2) = 0
    !> Stresses carried by closed cracks, and half their product with the mean strains
    real(wp) :: recovered(3) = 0
    !> Compressive strength along the fibres at the onset of kinking; 0: they have not kinked
    real(wp) :: kinked = 0
    !> Factor of the matrix strengths by the strain rate at the onset of cracking; 0: the matrix has not cracked
    real(wp) :: strengthened = 0
  end type band_state_t

contains

  !> The law of a ply of a material.
  pure function create_crack_band(material, damage) result(band)
    !> The material, with strengths and fracture energies
    type(material_t), intent(in) :: material
    !> Criteria, and residual stiffness as a fraction
    type(ply_damage_t), intent(in) :: damage
    type(crack_band_t) :: band

    band%elasticity = elasticity_of(material)
    band%along = [material%xt, merge(material%xc, material%xt, material%xc > 0)]
    band%matrix = matrix_strengths(material, damage%criteria)
    band%toughness = material%toughness
    band%remainder = damage%e
    band%shear_beta = material%shear_beta
    band%rate_gain = material%rate_gain
    band%reference_rate = material%reference_rate
    band%crack_closure = damage%crack_closure
    band%kinking = damage%kinking
    band%permanent_shear = damage%permanent_shear .and. material%shear_beta > 0
  end function create_crack_band
end module crack_band_laws
