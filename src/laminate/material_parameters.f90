!> Data of one ply material in the deck.
module material_parameters
  use kinds, only: wp
  implicit none
  private
  public :: material_t, first_alike, constants_of, modulus_differs

  !> Largest strain regarded as small: at 5 % the logarithmic strain differs from it by 2.5 %. Thermal strains of
  !> polymers, 1e-4 per degree, reach it at 500 degrees; fibres fail at far smaller strains.
  real(wp), parameter, public :: largest_strain = 0.05_wp
  !> Constants of a material, and their names in the deck in the order of the type.
  integer, parameter, public :: constants = 25
  character(len=*), parameter, public :: constant_names(constants) = [character(len=18) :: 'density', 'E1', 'E1c', &
    'E2', 'G12', 'G13', 'G23', 'nu12', 'nu23', 'XT', 'XC', 'YT', 'YC', 'S12', 'Sf', 'Sm23', 'shear_beta', 'G_ft', &
    'G_fc', 'G_mt', 'G_mc', 'alpha1', 'alpha2', 'rate_strengthening', 'reference_rate']

  !> An orthotropic ply, 1 along the fibres. A strength that the deck does not give is zero or less. It has many
  !> components because the deck gives that many constants.
  type :: material_t
    !> Name that &laminate refers to
    character(len=:), allocatable :: name
    !> Mass per volume
    real(wp) :: density = 0
    !> Young's moduli along and across the fibres
    real(wp) :: e1 = 0, e2 = 0
    !> Young's modulus along the fibres in compression; 0: E1
    real(wp) :: e1c = 0
    !> Shear moduli
    real(wp) :: g12 = 0, g13 = 0, g23 = 0
    !> Poisson's ratios; nu21 follows from reciprocity
    real(wp) :: nu12 = 0, nu23 = 0
    !> Tensile and compressive strength along the fibres; without XC, XT applies in compression (Table 1)
    real(wp) :: xt = 0, xc = 0
    !> Tensile and compressive strength across the fibres
    real(wp) :: yt = 0, yc = 0
    !> Shear strengths: in-plane, of the fibres, and in the 2-3 plane
    real(wp) :: s12 = 0, sf = 0, sm23 = 0
    !> Hahn and Tsai's coefficient of in-plane shear; 0: it is linear
    real(wp) :: shear_beta = 0
    !> Fracture energies per area: fibre tension and compression, matrix tension and compression; 0: not given
    real(wp) :: toughness(4) = 0
    !> Thermal expansion along and across the fibres
    real(wp) :: expansion(2) = 0
    !> Gain of the matrix strengths per decade of strain rate, as a fraction, and the rate at which they hold
    real(wp) :: rate_gain = 0, reference_rate = 0
  end type material_t

contains

  !> True: the moduli along the fibres in tension and in compression differ.
  elemental logical function modulus_differs(material)
    type(material_t), intent(in) :: material

    modulus_differs = material%e1c > 0 .and. abs(material%e1c - material%e1) > 0
  end function modulus_differs

  !> First material with equal constants: two names with equal constants are one material.
  pure integer function first_alike(materials, index) result(first)
    type(material_t), intent(in) :: materials(:)
    !> The material
    integer, intent(in) :: index

    do first = 1, index
      if (all(.not. abs(constants_of(materials(first)) - constants_of(materials(index))) > 0)) return
    end do
    first = index
  end function first_alike

  !> Everything about a material but its name.
  pure function constants_of(material) result(values)
    type(material_t), intent(in) :: material
    !> In the order of the type
    real(wp) :: values(constants)

    associate (m => material)
      values = [m%density, m%e1, merge(m%e1c, m%e1, m%e1c > 0), m%e2, m%g12, m%g13, m%g23, m%nu12, m%nu23, m%xt, &
                m%xc, m%yt, m%yc, m%s12, m%sf, m%sm23, m%shear_beta, m%toughness, m%expansion, m%rate_gain, &
                m%reference_rate]
    end associate
  end function constants_of
end module material_parameters
