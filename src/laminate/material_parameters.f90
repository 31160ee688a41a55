!> Data of one ply material, as the deck gives it.
module material_parameters
  use kinds, only: wp
  implicit none
  private
  public :: material_t

  !> An orthotropic ply, 1 along the fibres. A strength that the deck does not give is zero or less. It has many
  !> components because the deck gives that many constants.
  type :: material_t
    !> Name that &laminate refers to
    character(len=:), allocatable :: name
    !> Mass per volume
    real(wp) :: density = 0
    !> Young's moduli along and across the fibres
    real(wp) :: e1 = 0, e2 = 0
    !> Shear moduli
    real(wp) :: g12 = 0, g13 = 0, g23 = 0
    !> Poisson's ratios; nu21 follows from reciprocity
    real(wp) :: nu12 = 0, nu23 = 0
    !> Tensile and compressive strength along the fibres; no XC: compression is judged by XT (Table 1)
    real(wp) :: xt = 0, xc = 0
    !> Tensile and compressive strength across the fibres
    real(wp) :: yt = 0, yc = 0
    !> Shear strengths: in the plane, of the fibres, and in the 2-3 plane
    real(wp) :: s12 = 0, sf = 0, sm23 = 0
    !> Hahn and Tsai's coefficient of shear in the plane; 0: it is linear
    real(wp) :: shear_beta = 0
    !> Fracture energies per area: fibre tension and compression, matrix tension and compression; 0: not given
    real(wp) :: toughness(4) = 0
    !> Thermal expansion along and across the fibres
    real(wp) :: expansion(2) = 0
  end type material_t
end module material_parameters
