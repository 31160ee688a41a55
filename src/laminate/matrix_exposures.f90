!> How near a state of stress in the plane of a ply is to failure of the matrix, for each set of criteria: the stress
!> exposure of Puck, which is 1 at failure and grows in proportion to the stresses.
module matrix_exposures
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: criteria_hashin, criteria_puck
  implicit none
  private
  public :: matrix_strengths_t, matrix_strengths, matrix_exposure, puck_exposure

  !> Inclinations of Puck's curve at no stress across the fibres, tension and compression, for carbon fibres
  !> (A. Puck, J. Kopp, M. Knops, Composites Science and Technology 62 (2002) 371-378).
  real(wp), parameter :: inclination_tension = 0.35_wp, inclination_compression = 0.30_wp

  !> What the criteria of the matrix ask for.
  type :: matrix_strengths_t
    !> Strengths across the fibres in tension and compression, in shear along and across the fibres
    real(wp) :: tension = 0, compression = 0, shear = 0, shear_across = 0
    !> criteria_hou, criteria_hashin or criteria_puck
    integer :: criteria = 0
  end type matrix_strengths_t

contains

  !> Strengths of a material. The set of Hou et al. has S12 where Hashin has the shear strength across the fibres;
  !> without Sm23 that is YC/2, which leaves of Hashin's crushing (s22/YC)**2 + (s12/S12)**2.
  pure function matrix_strengths(material, criteria) result(strengths)
    !> The material
    type(material_t), intent(in) :: material
    !> criteria_hou, criteria_hashin or criteria_puck
    integer, intent(in) :: criteria
    !> Its strengths
    type(matrix_strengths_t) :: strengths

    strengths = matrix_strengths_t(tension=material%yt, compression=material%yc, shear=material%s12, &
                                   shear_across=material%s12, criteria=criteria)
    if (criteria /= criteria_hashin) return
    strengths%shear_across = material%yc/2
    if (material%sm23 > 0) strengths%shear_across = material%sm23
  end function matrix_strengths

  !> Exposure of the matrix to stresses in the plane.
  pure real(wp) function matrix_exposure(strengths, across, shear) result(exposure)
    !> Strengths and set of criteria
    type(matrix_strengths_t), intent(in) :: strengths
    !> Stress across the fibres, and shear stress in the plane
    real(wp), intent(in) :: across, shear
    real(wp) :: linear, square

    if (strengths%criteria == criteria_puck) then
      exposure = puck_exposure(strengths, across, shear)
    else if (across >= 0) then
      exposure = hypot(across/strengths%tension, shear/strengths%shear)
    else
      ! The factor of the stresses that meets square f**2 + linear f = 1, inverted.
      square = (across/(2*strengths%shear_across))**2 + (shear/strengths%shear)**2
      linear = ((strengths%compression/(2*strengths%shear_across))**2 - 1)*across/strengths%compression
      exposure = (linear + sqrt(linear**2 + 4*square))/2
    end if
  end function matrix_exposure

  !> Exposure after Puck (A. Puck, H. Schuermann, Composites Science and Technology 58 (1998) 1045-1067), modes A, B, C.
  pure real(wp) function puck_exposure(strengths, across, shear) result(exposure)
    !> Strengths
    type(matrix_strengths_t), intent(in) :: strengths
    !> Stress across the fibres, and shear stress in the plane
    real(wp), intent(in) :: across, shear
    real(wp) :: fracture_plane, ratio

    associate (s => strengths%shear, yc => strengths%compression, yt => strengths%tension, &
               pt => inclination_tension, pc => inclination_compression)
      if (across >= 0) then
        exposure = hypot(shear/s, (1 - pt*yt/s)*across/yt) + pt*across/s
        return
      end if
      ! Strength of the plane of action across the fibres over S12, and the inclination that goes with it.
      fracture_plane = (sqrt(1 + 2*pc*yc/s) - 1)/(2*pc)
      ratio = pc*fracture_plane
      if (abs(across)*sqrt(1 + 2*ratio) <= fracture_plane*abs(shear)) then
        exposure = (hypot(shear, pc*across) + pc*across)/s
      else
        exposure = ((shear/(2*(1 + ratio)*s))**2 + (across/yc)**2)*yc/abs(across)
      end if
    end associate
  end function puck_exposure
end module matrix_exposures
