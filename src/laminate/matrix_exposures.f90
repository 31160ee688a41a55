!> Stress exposure of the matrix by the in-plane stresses of a ply, for each set of criteria. The exposure is that of
!> Puck: it is 1 at failure and proportional to the stresses.
module matrix_exposures
  use kinds, only: wp
  use larc_criteria, only: larc_t, larc_of, matrix_exposure_of
  use mathematical_constants, only: pi
  use material_parameters, only: material_t
  use ply_damage_parameters, only: criteria_hashin, criteria_puck, criteria_larc
  implicit none
  private
  public :: matrix_strengths_t, matrix_strengths, matrix_exposure, puck_exposure, plane_exposure, &
            cracks_on_a_plane, shear_across_strength

  !> Inclinations of Puck's fracture curve at zero stress across the fibres, tension and compression, for carbon fibres
  !> (A. Puck, J. Kopp, M. Knops, Composites Science and Technology 62 (2002) 371-378).
  real(wp), parameter :: inclination_tension = 0.35_wp, inclination_compression = 0.30_wp
  !> Planes that are evaluated, a degree apart: between two of them the exposure is larger by less than 2e-4.
  integer, parameter :: planes = 180

  !> Strengths for the matrix criteria.
  type :: matrix_strengths_t
    !> Strengths across the fibres in tension and compression, in shear along and across the fibres
    real(wp) :: tension = 0, compression = 0, shear = 0, shear_across = 0
    !> criteria_hou, criteria_hashin, criteria_puck or criteria_larc
    integer :: criteria = 0
    !> Constants of criteria_larc, and of kinking
    type(larc_t) :: larc
  end type matrix_strengths_t

contains

  !> Strengths of a material. The criteria of Hou et al. have S12 where those of Hashin have the shear strength across
  !> the fibres. Without Sm23 the latter is YC/2, with which Hashin's crushing becomes (s22/YC)**2 + (s12/S12)**2.
  pure function matrix_strengths(material, criteria) result(strengths)
    type(material_t), intent(in) :: material
    !> criteria_hou, criteria_hashin, criteria_puck or criteria_larc
    integer, intent(in) :: criteria
    type(matrix_strengths_t) :: strengths

    strengths = matrix_strengths_t(tension=material%yt, compression=material%yc, shear=material%s12, &
                                   shear_across=material%s12, criteria=criteria, larc=larc_of(material))
    if (criteria /= criteria_hashin) return
    strengths%shear_across = material%yc/2
    if (material%sm23 > 0) strengths%shear_across = material%sm23
  end function matrix_strengths

  !> Exposure of the matrix to in-plane stresses.
  pure real(wp) function matrix_exposure(strengths, across, shear) result(exposure)
    !> Strengths and set of criteria
    type(matrix_strengths_t), intent(in) :: strengths
    !> Stress across the fibres, and in-plane shear stress
    real(wp), intent(in) :: across, shear
    real(wp) :: linear, square

    if (strengths%criteria == criteria_puck) then
      exposure = puck_exposure(strengths, across, shear)
    else if (strengths%criteria == criteria_larc) then
      exposure = matrix_exposure_of(strengths%larc, across, shear)
    else if (across >= 0) then
      exposure = hypot(across/strengths%tension, shear/strengths%shear)
    else
      ! The inverse of the factor f of the stresses at which square f**2 + linear f = 1.
      square = (across/(2*strengths%shear_across))**2 + (shear/strengths%shear)**2
      linear = ((strengths%compression/(2*strengths%shear_across))**2 - 1)*across/strengths%compression
      exposure = (linear + sqrt(linear**2 + 4*square))/2
    end if
  end function matrix_exposure

  !> Exposure after Puck (A. Puck, H. Schuermann, Composites Science and Technology 58 (1998) 1045-1067; theory (M8)),
  !> modes A, B, C.
  pure real(wp) function puck_exposure(strengths, across, shear) result(exposure)
    type(matrix_strengths_t), intent(in) :: strengths
    !> Stress across the fibres, and in-plane shear stress
    real(wp), intent(in) :: across, shear
    real(wp) :: plane, ratio

    associate (s => strengths%shear, yc => strengths%compression, yt => strengths%tension, &
               pt => inclination_tension, pc => inclination_compression)
      if (across >= 0) then
        exposure = hypot(shear/s, (1 - pt*yt/s)*across/yt) + pt*across/s
        return
      end if
      plane = action_plane(strengths)
      ratio = pc*plane
      if (abs(across)*sqrt(1 + 2*ratio) <= plane*abs(shear)) then
        exposure = (hypot(shear, pc*across) + pc*across)/s
      else
        exposure = ((shear/(2*(1 + ratio)*s))**2 + (across/yc)**2)*yc/abs(across)
      end if
    end associate
  end function puck_exposure

  !> Shear strength R of the action plane across the fibres over S12, from YC, theory (M7).
  pure real(wp) function action_plane(strengths) result(plane)
    type(matrix_strengths_t), intent(in) :: strengths

    associate (pc => inclination_compression)
      plane = (sqrt(1 + 2*pc*strengths%compression/strengths%shear) - 1)/(2*pc)
    end associate
  end function action_plane

  !> Exposure after Puck with transverse shear: the largest of all planes along the fibres (Puck, Schuermann, 1998;
  !> theory (D5) and (D6)). The ratio of inclination to strength is the same for shear along and across the fibres, as
  !> in modes A, B and C, which are reproduced without transverse shear.
  pure real(wp) function plane_exposure(strengths, stress) result(exposure)
    type(matrix_strengths_t), intent(in) :: strengths
    real(wp), intent(in) :: stress(5)
    real(wp) :: c, s, normal, along, across, strength_across
    integer :: i
    ! Of the inclinations of the planes.
    real(wp), parameter :: cosines(planes) = [(cos(pi*i/planes), i=1, planes)], &
                           sines(planes) = [(sin(pi*i/planes), i=1, planes)]

    exposure = 0
    strength_across = action_plane(strengths)*strengths%shear
    associate (s22 => stress(2), s23 => stress(5))
      do i = 1, planes
        c = cosines(i)
        s = sines(i)
        normal = s22*c**2 + 2*s23*s*c
        across = (s23*(c - s)*(c + s) - s22*s*c)/strength_across
        along = (stress(3)*c + stress(4)*s)/strengths%shear
        exposure = max(exposure, exposure_of(strengths, normal, norm2([along, across])))
      end do
    end associate
  end function plane_exposure

  !> True if stresses crack the matrix on a plane. Planes are evaluated only where an upper bound of their exposures
  !> reaches 1, and by squares: with the linear part l of its exposure, `exposure_of`, a plane cracks if the square of
  !> the rest reaches that of 1 - l.
  pure logical function cracks_on_a_plane(strengths, stress) result(cracks)
    type(matrix_strengths_t), intent(in) :: strengths
    real(wp), intent(in) :: stress(5)
    real(wp) :: across, tension, normal(planes), excess(planes)
    integer :: i
    ! Of the inclinations of the planes.
    real(wp), parameter :: cosines(planes) = [(cos(pi*i/planes), i=1, planes)], &
                           sines(planes) = [(sin(pi*i/planes), i=1, planes)]

    across = action_plane(strengths)*strengths%shear
    associate (s => strengths%shear, s22 => stress(2), s23 => stress(5), yt => strengths%tension)
      cracks = (max(0.0_wp, s22) + abs(s23))/yt + (abs(s22)/2 + abs(s23))/across &
               + (abs(stress(3)) + abs(stress(4)))/s >= 1
      if (.not. cracks) return
      tension = (1 - inclination_tension*yt/s)/yt
      normal = (s22*cosines + 2*s23*sines)*cosines
      excess = ((s23*(cosines - sines)*(cosines + sines) - s22*sines*cosines)/across)**2 &
               + ((stress(3)*cosines + stress(4)*sines)/s)**2 &
               + (merge(tension, inclination_compression/s, normal >= 0)*normal)**2 &
               - max(0.0_wp, 1 - merge(inclination_tension, inclination_compression, normal >= 0)/s*normal)**2
    end associate
    cracks = any(excess >= 0)
  end function cracks_on_a_plane

  !> Exposure of one plane.
  pure real(wp) function exposure_of(strengths, normal, shear) result(exposure)
    type(matrix_strengths_t), intent(in) :: strengths
    !> Stress normal to the plane, and shear stress in it over its strength
    real(wp), intent(in) :: normal, shear

    associate (s => strengths%shear, yt => strengths%tension, pt => inclination_tension, pc => inclination_compression)
      if (normal >= 0) then
        exposure = hypot(shear, (1 - pt*yt/s)*normal/yt) + pt*normal/s
      else
        exposure = hypot(shear, pc*normal/s) + pc*normal/s
      end if
    end associate
  end function exposure_of

  !> Transverse shear stress s23 that cracks the matrix if it acts alone, usually in tension on the plane at 45 degrees.
  pure real(wp) function shear_across_strength(strengths) result(strength)
    type(matrix_strengths_t), intent(in) :: strengths

    strength = 1/plane_exposure(strengths, [0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp])
  end function shear_across_strength
end module matrix_exposures
