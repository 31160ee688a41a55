!> Damage of the plies in the deck: rows of its table and their filling.
module ply_damage_deck
  use deck_choices, only: code_of
  use deck_settings, only: settings_t
  use deck_vocabulary, only: group_row_length, key_row_length
  use kinds, only: wp
  use ply_damage_parameters, only: ply_damage_t, criteria_hou, criteria_hashin, criteria_puck, criteria_larc, &
                                   stress_at_middle, &
                                   stress_at_faces
  use text, only: to_text
  implicit none
  private
  public :: fill_ply_damage

  !> Names that checks across groups use.
  character(len=*), parameter, public :: ply_damage_group = 'ply_damage', key_in_situ = 'in_situ', &
                                         key_permanent = 'permanent_shear', key_closure = 'crack_closure', &
                                         key_compression = 'fibre_compression', &
                                         key_weibull = 'weibull_modulus', key_volume = 'reference_volume', &
                                         key_seed = 'strength_seed', key_square = 'strength_length'
  !> Keys without effect on plies that soften by their fracture energies.
  character(len=*), parameter, public :: keys_of_sudden_failure = 'd stress'
  character(len=group_row_length), parameter, public :: ply_damage_group_row = &
    'ply_damage | optional | Failure of plies: matrix cracking, matrix crushing, fibre failure.'
  character(len=key_row_length), parameter, public :: ply_damage_rows(*) = [character(len=key_row_length) :: &
    'ply_damage | d | real | 1 | - | 100 | >= 1 | &
      &Divisor of the elastic constants affected by a mode of failure (Li et al., Table 2). | not &material G_ft', &
    'ply_damage | e | real | 1 | - | 0.001 | > 0, <= 1 | &
      &Smallest value of an elastic constant, as a fraction of the undamaged one.', &
    'ply_damage | criteria | choice | 1 | - | ''hou'' | hou hashin puck larc | &
      &Set of failure criteria: of Hou et al. (2000), Hashin (1980), Puck (1998), or LaRC03 (Davila et al. 2005).', &
    'ply_damage | stress | choice | 1 | - | ''middle'' | middle faces | &
      &Where in a ply stresses are evaluated: its mid-plane, or the face with the higher failure index. | &
      &not &material G_ft', &
    'ply_damage | in_situ | logical | 1 | - | .false. | .true. .false. | &
      &Whether YT and S12 are raised to in-situ strengths, by the thickness of each block of plies, G_mt and G_mc.', &
    'ply_damage | permanent_shear | logical | 1 | - | .false. | .true. .false. | &
      &Whether nonlinear shear strain (shear_failure_strain) is permanent after unloading, which leaves a dent.', &
    'ply_damage | crack_closure | logical | 1 | - | .false. | .true. .false. | &
      &Whether plies that failed in tension, along or across the fibres, carry compression again.', &
    'ply_damage | fibre_compression | choice | 1 | - | ''strength'' | strength kinking | &
      &Failure of compressed fibres: at XC, or by kinking under compression and shear (Davila et al. 2005).', &
    'ply_damage | weibull_modulus | real | 1 | - | none | >= 1 | &
      &Weibull modulus of the fibres in tension: in small stressed volumes XT is larger; left out: XT is constant.', &
    'ply_damage | reference_volume | real | 1 | volume | = 3750 mm3 | > 0 | &
      &Stressed volume of the specimens that XT was measured on; 3750 mm3 is 250 mm by 15 mm by 1 mm. | &
      &weibull_modulus', &
    'ply_damage | strength_seed | integer | 1 | - | none | >= 1 | &
      &Seed of tensile strengths of fibres that scatter from place to place; left out: they do not scatter. | &
      &weibull_modulus', &
    'ply_damage | strength_length | real | 1 | length | = 1 mm | > 0 | &
      &Side of the squares of a ply within which a strength that scatters is uniform. | strength_seed']
  !> Its default in cubic metres: the gauge length of a tension specimen after ASTM D3039, 250 x 15 x 1 mm.
  real(wp), parameter :: usual_volume = 3.75e-6_wp
  !> Default of the side of squares in metres: shorter than the cells in which fibres fail, whose strengths then have a
  !> distribution that does not depend on it.
  real(wp), parameter :: usual_square = 1.0e-3_wp

contains

  !> Damage of the plies.
  subroutine fill_ply_damage(settings, units_in_metre, damage)
    !> Keys in effect; receives the reference volume
    type(settings_t), intent(inout) :: settings
    !> Units of length in a metre; 0: not known
    real(wp), intent(in) :: units_in_metre
    type(ply_damage_t), intent(inout) :: damage

    damage%d = settings%real_of(ply_damage_group, 'd')
    damage%e = settings%real_of(ply_damage_group, 'e')
    damage%criteria = code_of(settings%text_of(ply_damage_group, 'criteria'), 'hou hashin puck larc', &
                              [criteria_hou, criteria_hashin, criteria_puck, criteria_larc])
    damage%stress = code_of(settings%text_of(ply_damage_group, 'stress'), 'middle faces', &
                            [stress_at_middle, stress_at_faces])
    damage%in_situ = settings%logical_of(ply_damage_group, key_in_situ)
    damage%permanent_shear = settings%logical_of(ply_damage_group, key_permanent)
    damage%crack_closure = settings%logical_of(ply_damage_group, key_closure)
    damage%kinking = code_of(settings%text_of(ply_damage_group, key_compression), 'strength kinking', [1, 2]) == 2
    damage%weibull_modulus = settings%real_of(ply_damage_group, key_weibull)
    if (.not. damage%weibull_modulus > 0) return
    if (.not. settings%is_given(ply_damage_group, key_volume) .and. units_in_metre > 0) &
      call settings%derive(ply_damage_group, key_volume, to_text(usual_volume*units_in_metre**3), .false.)
    damage%reference_volume = settings%real_of(ply_damage_group, key_volume)
    damage%strength_seed = settings%integer_of(ply_damage_group, key_seed)
    if (.not. damage%scatters()) return
    if (.not. settings%is_given(ply_damage_group, key_square) .and. units_in_metre > 0) &
      call settings%derive(ply_damage_group, key_square, to_text(usual_square*units_in_metre), .false.)
    damage%strength_length = settings%real_of(ply_damage_group, key_square)
  end subroutine fill_ply_damage
end module ply_damage_deck
