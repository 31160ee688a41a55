!> Failure criteria LaRC03 in plane stress: matrix cracking, matrix crushing on an inclined plane, and fibre kinking in
!> the frame of misaligned fibres, theory (M25) to (M29).
!>
!> C. G. Davila, P. P. Camanho, C. A. Rose, Journal of Composite Materials 39 (2005) 323-345. Exposures are 1 at failure
!> and proportional to the stresses.
module larc_criteria
  use kinds, only: wp
  use mathematical_constants, only: degree
  use material_parameters, only: material_t
  implicit none
  private
  public :: larc_t, larc_of, larc_objection, matrix_exposure_of, kinking_exposure, frame_exposure

  !> Inclination of the fracture plane under transverse compression (A. Puck, H. Schuermann, Composites Science and
  !> Technology 58 (1998) 1045-1067).
  real(wp), parameter :: fracture_angle = 53*degree
  !> Planes of the search, and relative tolerance of exposures.
  integer, parameter :: planes = 53
  real(wp), parameter :: tolerance = 1.0e-12_wp
  integer, parameter :: max_iterations = 100
  !> Largest stress over G12 at which the rotation of the fibres is evaluated: at 1 it is infinite.
  real(wp), parameter :: rotation_limit = 0.999_wp

  !> Constants of the criteria.
  type :: larc_t
    !> Strengths: along the fibres in compression, across them in tension, in shear along and across the fibres
    real(wp) :: along = 0, tension = 0, shear = 0, shear_across = 0
    !> Coefficients of the normal stress in the shear strengths along and across the fibres
    real(wp) :: friction = 0, friction_across = 0
    !> Ratio of the fracture energies of opening and shear
    real(wp) :: energy_ratio = 1
    !> Shear modulus, and misalignment of the fibres at XC
    real(wp) :: shear_modulus = 0, misalignment = 0
  end type larc_t

contains

  !> Constants of a material. Without fracture energies their ratio is that of a thick ply, 1.12**2 (1/E2 - nu21**2/E1)
  !> 2 G12 (YT/S12)**2. Without XC and YC its fibres do not kink, and its matrix is not crushed.
  pure function larc_of(material) result(larc)
    type(material_t), intent(in) :: material
    type(larc_t) :: larc
    real(wp) :: ratio

    associate (m => material)
      larc%along = m%xc
      larc%tension = m%yt
      larc%shear = m%s12
      larc%shear_modulus = m%g12
      larc%friction_across = -1/tan(2*fracture_angle)
      larc%shear_across = m%yc*cos(fracture_angle)*(sin(fracture_angle) + cos(fracture_angle)/tan(2*fracture_angle))
      if (m%yc > 0) larc%friction = -m%s12*cos(2*fracture_angle)/(m%yc*cos(fracture_angle)**2)
      if (all(m%toughness(3:4) > 0)) then
        larc%energy_ratio = m%toughness(3)/m%toughness(4)
      else if (min(m%s12, m%e1, m%e2) > 0) then
        larc%energy_ratio = 1.12_wp**2*2*(1/m%e2 - (m%nu12*m%e2/m%e1)**2/m%e1)*m%g12*(m%yt/m%s12)**2
      end if
      if (.not. m%xc > 0) return
      ratio = m%s12/m%xc
      larc%misalignment = atan(2*ratio/(1 + sqrt(max(0.0_wp, 1 - 4*(ratio + larc%friction)*ratio))))
    end associate
  end function larc_of

  !> Objection to kinking with the strengths of a material, or an empty text.
  pure function larc_objection(material) result(objection)
    !> The material, with XC, YC, S12
    type(material_t), intent(in) :: material
    !> One clause; empty: none
    character(len=:), allocatable :: objection
    type(larc_t) :: larc

    larc = larc_of(material)
    objection = ''
    associate (ratio => material%s12/material%xc)
      if (4*(ratio + larc%friction)*ratio > 1) then
        objection = 'XC is too small beside S12 for kinking: 4 (S12/XC + eta) S12/XC must be at most 1, with '// &
                    'eta = .761 S12/YC'
      else if (material%xc >= material%g12) then
        objection = 'fibres kink by rotation only if XC is below G12'
      end if
    end associate
  end function larc_objection

  !> Exposure of the matrix to in-plane stresses.
  pure real(wp) function matrix_exposure_of(larc, across, shear) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress across the fibres, and in-plane shear stress
    real(wp), intent(in) :: across, shear

    if (across >= 0) then
      exposure = cracking_exposure(larc, across, shear)
    else
      exposure = crushing_exposure(larc, across, shear)
    end if
  end function matrix_exposure_of

  !> Exposure in transverse tension: the inverse of the factor at which (1 - g) x + g x**2 + y**2 = 1.
  pure real(wp) function cracking_exposure(larc, across, shear) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress across the fibres, not negative, and in-plane shear stress
    real(wp), intent(in) :: across, shear
    real(wp) :: linear

    associate (x => across/larc%tension, g => larc%energy_ratio)
      linear = (1 - g)*x
      exposure = (linear + sqrt(linear**2 + 4*(g*x**2 + (shear/larc%shear)**2)))/2
    end associate
  end function cracking_exposure

  !> Exposure in transverse compression: the largest of the planes up to the fracture angle.
  pure real(wp) function crushing_exposure(larc, across, shear) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress across the fibres, negative, and in-plane shear stress
    real(wp), intent(in) :: across, shear
    real(wp), parameter :: golden = (sqrt(5.0_wp) - 1)/2
    real(wp) :: range(2), values(0:planes)
    integer :: i, best
    ! Of the inclinations of the planes.
    real(wp), parameter :: cosines(0:planes) = [(cos(fracture_angle*i/planes), i=0, planes)], &
                           sines(0:planes) = [(sin(fracture_angle*i/planes), i=0, planes)]

    do i = 0, planes
      values(i) = plane_exposure(larc, across, shear, cosines(i), sines(i))
    end do
    best = maxloc(values, 1) - 1
    exposure = values(best)
    range = fracture_angle*[max(best - 1, 0), min(best + 1, planes)]/planes
    do i = 1, 20
      associate (lower => range(2) - golden*(range(2) - range(1)), upper => range(1) + golden*(range(2) - range(1)))
        if (plane_exposure(larc, across, shear, cos(lower), sin(lower)) &
            > plane_exposure(larc, across, shear, cos(upper), sin(upper))) then
          range(2) = upper
        else
          range(1) = lower
        end if
      end associate
    end do
    exposure = max(exposure, plane_exposure(larc, across, shear, cos(sum(range)/2), sin(sum(range)/2)))
  end function crushing_exposure

  !> Exposure of one plane: effective shear stresses after Mohr and Coulomb.
  pure real(wp) function plane_exposure(larc, across, shear, c, s) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress across the fibres, negative, and in-plane shear stress
    real(wp), intent(in) :: across, shear
    !> Cosine and sine of the inclination of the plane
    real(wp), intent(in) :: c, s
    real(wp) :: normal, transverse, longitudinal

    normal = across*c**2
    transverse = max(0.0_wp, abs(across)*s*c + larc%friction_across*normal)
    longitudinal = max(0.0_wp, abs(shear)*c + larc%friction*normal)
    exposure = hypot(transverse/larc%shear_across, longitudinal/larc%shear)
  end function plane_exposure

  !> Exposure of compressed fibres to kinking: the inverse of the factor of the stresses at which the criterion is met
  !> in the frame of the misaligned fibres, which rotate with the load.
  pure real(wp) function kinking_exposure(larc, along, across, shear) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress along the fibres, negative; across them; in-plane shear stress
    real(wp), intent(in) :: along, across, shear
    real(wp) :: factors(2), values(2), middle, value, limit
    integer :: i

    exposure = 0
    if (.not. along < 0) return
    ! Factors of the stresses: the criterion is not met at the smaller one, and met at the larger one. Without shear
    ! the fibres kink at XC; transverse compression may raise the strength.
    limit = rotation_limit*larc%shear_modulus/(abs(along) + abs(across))
    factors(1) = 0
    factors(2) = min(limit, 1/max(abs(along)/larc%along, abs(shear)/(2*larc%shear)))
    values = [-1.0_wp, excess(factors(2))]
    do while (values(2) < 0 .and. factors(2) < limit)
      factors(1) = factors(2)
      values(1) = values(2)
      factors(2) = min(1.2_wp*factors(2), limit)
      values(2) = excess(factors(2))
    end do
    ! False position with halved values (Illinois).
    do i = 1, max_iterations
      if (factors(2) - factors(1) <= tolerance*factors(2) .or. values(2) <= 0) exit
      middle = (factors(1)*values(2) - factors(2)*values(1))/(values(2) - values(1))
      value = excess(middle)
      if (abs(value) <= tolerance) then
        factors(2) = middle
        exit
      else if (value > 0) then
        factors(2) = middle
        values = [values(1)/2, value]
      else
        factors(1) = middle
        values = [value, values(2)/2]
      end if
    end do
    exposure = 1/factors(2)

  contains

    !> Criterion at a factor of the stresses, less 1.
    pure real(wp) function excess(factor)
      !> The factor
      real(wp), intent(in) :: factor

      excess = frame_exposure(larc, factor*along, factor*across, factor*shear) - 1
    end function excess
  end function kinking_exposure

  !> Criterion of the matrix in the frame of the misaligned fibres; it is met at 1.
  pure real(wp) function frame_exposure(larc, along, across, shear) result(exposure)
    type(larc_t), intent(in) :: larc
    !> Stress along the fibres, negative; across them; in-plane shear stress
    real(wp), intent(in) :: along, across, shear
    real(wp) :: angle, c, s, normal, sliding

    ! The initial misalignment and the shear strain in its frame, for small angles.
    angle = (abs(shear) + (larc%shear_modulus - larc%along)*larc%misalignment)/(larc%shear_modulus + along - across)
    c = cos(angle)
    s = sin(angle)
    normal = s*s*along + c*c*across - 2*s*c*abs(shear)
    sliding = abs(s*c*(across - along) + (c*c - s*s)*abs(shear))
    if (normal >= 0) then
      exposure = cracking_exposure(larc, normal, sliding)
    else
      exposure = max(0.0_wp, sliding + larc%friction*normal)/larc%shear
    end if
  end function frame_exposure
end module larc_criteria
