!> Sections of stringers as beams: stiffness, mass and place of the centroid, from the sizes of a blade or a T, or
!> given.
module stringer_sections
  use kinds, only: wp
  implicit none
  private
  public :: stringer_section_t, section_of_sizes, section_of_stiffness

  !> Section of a beam about its centroid.
  type :: stringer_section_t
    !> E A; E I against bending out of the plate; G J; k G A against deflection
    real(wp) :: axial = 0, bending = 0, torsion = 0, shear = 0
    !> Mass per length; rotary inertia per length of bending out of the plate, and of that about the normal of the
    !> plate, which counts in the inertia of twist
    real(wp) :: mass = 0, rotary = 0, lateral_rotary = 0
    !> Distance of the centroid from the face that the stringer is bonded to, and of its free edge; the latter is 0 if
    !> it is not known
    real(wp) :: eccentricity = 0, depth = 0
  end type stringer_section_t

  !> Shear correction of a rectangle (S. P. Timoshenko's beam with parabolic shear stress). The web of a T carries its
  !> shear force.
  real(wp), parameter :: shear_correction = 5/6.0_wp

contains

  !> Section of a web on the face, with or without a cap on its free edge.
  pure function section_of_sizes(web, cap, e, g, density) result(section)
    !> Height and thickness of the web; width and thickness of the cap, 0: none
    real(wp), intent(in) :: web(2), cap(2)
    !> Young's modulus along the stringer, shear modulus, density
    real(wp), intent(in) :: e, g, density
    type(stringer_section_t) :: section
    real(wp) :: areas(2), middles(2), second_moments(2), lateral_moments(2), area

    areas = [product(web), product(cap)]
    middles = [web(1)/2, web(1) + cap(2)/2]
    second_moments = [web(2)*web(1)**3, cap(1)*cap(2)**3]/12
    lateral_moments = [web(1)*web(2)**3, cap(2)*cap(1)**3]/12
    area = sum(areas)
    section%eccentricity = sum(areas*middles)/area
    section%depth = web(1) + cap(2)
    section%axial = e*area
    section%bending = e*sum(second_moments + areas*(middles - section%eccentricity)**2)
    section%torsion = g*(torsion_constant(web) + torsion_constant(cap))
    section%shear = shear_correction*g*areas(1)
    section%mass = density*area
    section%rotary = density*section%bending/e
    section%lateral_rotary = density*sum(lateral_moments)
  end function section_of_sizes

  !> Section with a given stiffness. Its radii of gyration are those of a section of one material.
  pure function section_of_stiffness(axial, bending, lateral, torsion, shear_ratio, mass, eccentricity) result(section)
    !> E A, E I, E I about the normal of the plate, G J
    real(wp), intent(in) :: axial, bending, lateral, torsion
    !> G/E of the material
    real(wp), intent(in) :: shear_ratio
    !> Mass per length, and distance of the centroid from the face
    real(wp), intent(in) :: mass, eccentricity
    type(stringer_section_t) :: section

    section = stringer_section_t(axial=axial, bending=bending, torsion=torsion, &
                                 shear=shear_correction*shear_ratio*axial, mass=mass, rotary=mass*bending/axial, &
                                 lateral_rotary=mass*lateral/axial, eccentricity=eccentricity)
  end function section_of_stiffness

  !> Torsion constant of a rectangle, within .3 % (W. C. Young, R. G. Budynas, Roark's Formulas for Stress and Strain,
  !> 2002, table 10.1).
  pure real(wp) function torsion_constant(sides) result(constant)
    !> Its sides; 0: none
    real(wp), intent(in) :: sides(2)
    real(wp) :: ratio

    constant = 0
    if (.not. all(sides > 0)) return
    ratio = minval(sides)/maxval(sides)
    constant = maxval(sides)*minval(sides)**3*(1/3.0_wp - 0.21_wp*ratio*(1 - ratio**4/12))
  end function torsion_constant
end module stringer_sections
