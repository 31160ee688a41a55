!> One unidirectional ply: elastic constants, position in the stack, stiffness in the axes of the plate.
module plies
  use kinds, only: wp
  use mathematical_constants, only: degree
  use material_parameters, only: material_t
  use short_numbers, only: short_text
  use text, only: listed
  implicit none
  private
  public :: elasticity_t, ply_t, elasticity_of, is_bimodular, compressed, uniaxial_strain, material_objection
  public :: reduced_stiffness, in_plane_stiffness, shear_stiffness, set_angle, plies_text

  !> Elastic constants of a ply in plane stress; damage reduces them (nu23 has no effect).
  type :: elasticity_t
    !> Young's moduli along and across the fibres
    real(wp) :: e1 = 0, e2 = 0
    !> Shear moduli
    real(wp) :: g12 = 0, g13 = 0, g23 = 0
    !> Poisson's ratio; nu21 = nu12 E2/E1 by reciprocity
    real(wp) :: nu12 = 0
    !> Modulus along the fibres in compression over that in tension, E1c/E1
    real(wp) :: compression = 1
  end type elasticity_t

  !> A ply of the laminate. z is measured downwards from the mid-plane of the laminate.
  type :: ply_t
    !> Index of its material in the list of materials
    integer :: material = 0
    !> Elastic constants without damage
    type(elasticity_t) :: elasticity
    !> Mass per volume
    real(wp) :: density = 0
    !> Fibre angle from x, degrees
    real(wp) :: angle = 0
    !> Cosine and sine of the fibre angle, exact at multiples of 90 degrees
    real(wp) :: cosine = 1, sine = 0
    !> z of the face towards the struck side and of the other one
    real(wp) :: z_top = 0, z_bottom = 0
    !> Stress-free strains: along and across the fibres, as by cooling, and the permanent shear strain
    real(wp) :: free_strain(3) = 0
    !> Number of sub-plies of equal thickness, each with its own sign of the stress along the fibres
    integer :: sub_plies = 1
  end type ply_t

contains

  !> Elastic constants of a material without damage.
  pure function elasticity_of(material) result(elasticity)
    type(material_t), intent(in) :: material
    type(elasticity_t) :: elasticity

    elasticity = elasticity_t(material%e1, material%e2, material%g12, material%g13, material%g23, material%nu12)
    if (material%e1c > 0) elasticity%compression = material%e1c/material%e1
  end function elasticity_of

  !> True: the moduli along the fibres in tension and in compression differ.
  elemental logical function is_bimodular(elasticity)
    type(elasticity_t), intent(in) :: elasticity

    is_bimodular = abs(elasticity%compression - 1) > 0
  end function is_bimodular

  !> Constants under compression along the fibres, theory (M22): nu12 is proportional to E1, so that the compliance that
  !> couples both directions is that in tension.
  elemental function compressed(elasticity) result(constants)
    !> Constants in tension
    type(elasticity_t), intent(in) :: elasticity
    !> The same with E1c
    type(elasticity_t) :: constants

    constants = elasticity
    constants%e1 = elasticity%e1*elasticity%compression
    constants%nu12 = elasticity%nu12*elasticity%compression
    constants%compression = 1
  end function compressed

  !> Strain with the sign of the stress along the fibres, with E1 as with E1c: e1 + nu21 e2.
  pure real(wp) function uniaxial_strain(elasticity, strains)
    type(elasticity_t), intent(in) :: elasticity
    !> Strains along and across the fibres
    real(wp), intent(in) :: strains(2)

    uniaxial_strain = strains(1) + elasticity%nu12*elasticity%e2/elasticity%e1*strains(2)
  end function uniaxial_strain

  !> Objection to the elastic constants of a material, or an empty text: the strain energy must be positive for any
  !> strain, in plane stress and, where nu23 is given, also in three dimensions with E3 = E2 and nu13 = nu12.
  pure function material_objection(material) result(objection)
    type(material_t), intent(in) :: material
    !> One clause for the user, without the name of the material; empty: admissible
    character(len=:), allocatable :: objection

    objection = ''
    associate (m => material, moduli => [material%e1, material%e2, material%g12, material%g13, material%g23])
      if (.not. all(moduli > 0 .and. moduli <= huge(moduli))) then
        objection = 'the moduli E1, E2, G12, G13 and G23 must all be positive and finite'
      else if (.not. (m%density >= 0 .and. m%density <= huge(m%density))) then
        objection = 'the density must not be negative'
      else if (.not. m%nu12**2 < m%e1/m%e2) then
        objection = 'nu12 must lie between -sqrt(E1/E2) and sqrt(E1/E2), which is '//short_text(sqrt(m%e1/m%e2))// &
                    ' with E1 = '//short_text(m%e1)//' and E2 = '//short_text(m%e2)
      else if (.not. m%nu12**2*m%e1c < m%e1**2/m%e2) then
        objection = 'E1c must be below E1**2/(E2 nu12**2)'
      else if (.not. abs(m%nu23) < 1) then
        objection = 'nu23 must lie between -1 and 1'
      else if (abs(m%nu23) > 0 .and. .not. 1 - m%nu23 - 2*m%nu12**2*m%e2/m%e1 > 0) then
        objection = 'nu12 and nu23 are too large together: 1 - nu23 - 2 nu12**2 E2/E1 must be positive'
      end if
    end associate
  end function material_objection

  !> Turns the fibres of a ply to an angle.
  pure subroutine set_angle(ply, angle)
    type(ply_t), intent(inout) :: ply
    !> Fibre angle from x, degrees
    real(wp), intent(in) :: angle
    real(wp) :: rest, cosine, sine
    integer :: quarter_turns

    ! Quarter turns are removed first, so that a 90 degree ply has no spurious coupling.
    rest = modulo(angle, 360.0_wp)
    quarter_turns = nint(rest/90)
    rest = (rest - 90*quarter_turns)*degree
    cosine = cos(rest)
    sine = sin(rest)
    ply%angle = angle
    select case (modulo(quarter_turns, 4))
    case (0)
      ply%cosine = cosine
      ply%sine = sine
    case (1)
      ply%cosine = -sine
      ply%sine = cosine
    case (2)
      ply%cosine = -cosine
      ply%sine = -sine
    case (3)
      ply%cosine = sine
      ply%sine = -cosine
    end select
  end subroutine set_angle

  !> Plane-stress stiffness in material axes, theory (P3).
  pure function reduced_stiffness(elasticity) result(stiffness)
    type(elasticity_t), intent(in) :: elasticity
    !> Q11, Q12, Q22, Q66
    real(wp) :: stiffness(4)

    associate (c => elasticity)
      stiffness(1:3) = [c%e1, c%nu12*c%e2, c%e2]/(1 - c%nu12**2*c%e2/c%e1)
      stiffness(4) = c%g12
    end associate
  end function reduced_stiffness

  !> Plane-stress stiffness in the axes of the plate.
  pure function in_plane_stiffness(ply, elasticity) result(stiffness)
    !> The ply, for its angle
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> 11, 12, 16, 22, 26, 66 in Voigt order xx, yy, xy with the engineering shear strain
    real(wp) :: stiffness(6)
    real(wp) :: q(4), even, along, across

    q = reduced_stiffness(elasticity)
    associate (cc => ply%cosine**2, ss => ply%sine**2, cs => ply%cosine*ply%sine)
      even = q(2) + 2*q(4)
      along = q(1) - even
      across = even - q(3)
      stiffness(1) = q(1)*cc**2 + 2*even*cs**2 + q(3)*ss**2
      stiffness(2) = q(2) + (q(1) + q(3) - 2*even)*cs**2
      stiffness(3) = cs*(along*cc + across*ss)
      stiffness(4) = q(1)*ss**2 + 2*even*cs**2 + q(3)*cc**2
      stiffness(5) = cs*(along*ss + across*cc)
      stiffness(6) = q(4) + (q(1) + q(3) - 2*even)*cs**2
    end associate
  end function in_plane_stiffness

  !> Transverse shear stiffness in the axes of the plate, without any correction.
  pure function shear_stiffness(ply, elasticity) result(stiffness)
    !> The ply, for its angle
    type(ply_t), intent(in) :: ply
    !> Its present elastic constants
    type(elasticity_t), intent(in) :: elasticity
    !> xz-xz, xz-yz, yz-yz
    real(wp) :: stiffness(3)

    associate (c => ply%cosine, s => ply%sine, g13 => elasticity%g13, g23 => elasticity%g23)
      stiffness = [c*c*g13 + s*s*g23, c*s*(g13 - g23), s*s*g13 + c*c*g23]
    end associate
  end function shear_stiffness

  !> Plies in a sentence.
  pure function plies_text(numbers) result(text)
    !> Their numbers, at least one
    integer, intent(in) :: numbers(:)
    !> Such as `ply 2` or `plies 2 to 11, 13`
    character(len=:), allocatable :: text

    text = trim(merge('plies', 'ply  ', size(numbers) > 1))//' '//listed(numbers)
  end function plies_text
end module plies
