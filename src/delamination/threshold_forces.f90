!> Delamination threshold force: closed forms for comparison with the result of a run.
module threshold_forces
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: effective_bending_stiffness, threshold_force, patch_factor


contains

  !> Bending stiffness of the isotropic plate that has the same deflection under a central force as an orthotropic one,
  !> D* = sqrt(D11 D22 (A + 1)/2) with A = (D12 + 2 D66)/sqrt(D11 D22) (R. Olsson, Composites A 32 (2001) 1207).
  pure real(wp) function effective_bending_stiffness(stiffness) result(bending)
    !> Section stiffness of the full laminate: A, B and D, each 11, 12, 16, 22, 26, 66, then shear
    real(wp), intent(in) :: stiffness(21)
    real(wp) :: mean

    associate (d11 => stiffness(13), d12 => stiffness(14), d22 => stiffness(16), d66 => stiffness(18))
      mean = sqrt(d11*d22)
      bending = sqrt(mean*(mean + d12 + 2*d66)/2)
    end associate
  end function effective_bending_stiffness

  !> Central force on a thin plate under which n equal circular delaminations grow, at any radius: the energy release
  !> rate of each is G = (n + 2) P**2/(32 pi**2 D*), hence P = pi sqrt(32 D* G_IIc/(n + 2)) (doc/manual/summary.md,
  !> threshold force).
  pure real(wp) function threshold_force(bending, toughness, interfaces) result(force)
    !> Effective bending stiffness of the laminate
    real(wp), intent(in) :: bending
    !> Critical energy release rate in shear
    real(wp), intent(in) :: toughness
    !> Number of delaminations, one on each interface
    integer, intent(in) :: interfaces

    force = pi*sqrt(32*bending*toughness/(interfaces + 2))
  end function threshold_force

  !> Factor of that force for one delamination of a given area under a load distributed over a square: 1/(1 - rp**2/(2
  !> a**2)), with the radii rp and a of the circles with the areas of square and delamination.
  pure real(wp) function patch_factor(patch, area) result(factor)
    !> Side of the square
    real(wp), intent(in) :: patch
    !> Area of the delamination; a smaller one is taken as the square
    real(wp), intent(in) :: area

    factor = 1/(1 - patch**2/(2*max(area, patch**2)))
  end function patch_factor
end module threshold_forces
