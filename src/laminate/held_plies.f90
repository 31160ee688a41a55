!> Stiffness and strength of a laminate through its thickness under a local pressure, theory (F9) to (F11): fibres in
!> several directions, and the face around the pressure, hold the in-plane strains at zero.
module held_plies
  use kinds, only: wp
  use laminate_parameters, only: laminate_t
  use material_parameters, only: material_t
  use mathematical_constants, only: degree
  implicit none
  private
  public :: held_modulus, held_strength, held_ratio

  !> Angle of the fracture plane of a ply under compression across its fibres (C. G. Davila, P. P. Camanho, C. A. Rose,
  !> Journal of Composite Materials 39 (2005) 323-345).
  real(wp), parameter :: fracture_angle = 53*degree

contains

  !> Modulus through the thickness of a laminate whose in-plane strains are held: layers in series.
  pure real(wp) function held_modulus(laminate, materials) result(modulus)
    type(laminate_t), intent(in) :: laminate
    type(material_t), intent(in) :: materials(:)
    integer :: ply

    modulus = sum(laminate%thickness)/ &
              sum([(laminate%thickness(ply)/modulus_of(materials(laminate%material(ply))), &
                    ply=1, size(laminate%thickness))])
  end function held_modulus

  !> Modulus C33 of a ply across its fibres if its other strains are zero.
  pure real(wp) function modulus_of(material) result(modulus)
    type(material_t), intent(in) :: material
    real(wp) :: product

    product = material%nu12**2*material%e2/material%e1
    modulus = material%e2*(1 - product)/((1 + material%nu23)*(1 - material%nu23 - 2*product))
  end function modulus_of

  !> Ratio of the in-plane pressure across the fibres to that through the thickness, C23/C33, if the in-plane strains
  !> are zero.
  pure real(wp) function held_ratio(material) result(ratio)
    type(material_t), intent(in) :: material
    real(wp) :: product

    product = material%nu12**2*material%e2/material%e1
    ratio = (material%nu23 + product)/(1 - product)
  end function held_ratio

  !> Pressure through the thickness at which the matrix of a ply is crushed if its in-plane strains are zero, by
  !> Hashin's criterion (Z. Hashin, Journal of Applied Mechanics 47 (1980) 329-334) with all three normal stresses.
  !> Without Sm23 the shear strength across the fibres follows from YC and the angle of the fracture plane.
  pure real(wp) function held_strength(material) result(strength)
    !> The material, with YC
    type(material_t), intent(in) :: material
    real(wp) :: shear, square, linear, ratio

    shear = material%sm23
    if (.not. shear > 0) &
      shear = material%yc*cos(fracture_angle)*(sin(fracture_angle) + cos(fracture_angle)/tan(2*fracture_angle))
    ratio = held_ratio(material)
    square = ((1 - ratio)/(2*shear))**2
    linear = ((material%yc/(2*shear))**2 - 1)*(1 + ratio)/material%yc
    strength = (linear + sqrt(linear**2 + 4*square))/(2*square)
  end function held_strength
end module held_plies
