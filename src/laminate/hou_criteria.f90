!> Stress criteria of ply failure after Hou et al. (Table 1 of the paper, theory (M3) and (M4)).
module hou_criteria
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: failure_modes, fibre_failure, matrix_cracking, matrix_crushing
  implicit none
  private
  public :: failure_indices

contains

  !> Value of each criterion; a ply fails where it reaches 1. The required strengths must be given (see
  !> `needed_strengths`).
  pure function failure_indices(material, stress) result(indices)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: stress(5)
    !> Values in the order of the modes; the matrix criterion of the other sign of s22 is zero
    real(wp) :: indices(failure_modes)

    indices = 0
    associate (s11 => stress(1), s22 => stress(2), s12 => stress(3), s13 => stress(4), s23 => stress(5))
      indices(fibre_failure) = (s11/fibre_strength(material, s11))**2 + (s12**2 + s13**2)/material%sf**2
      if (s22 >= 0) then
        indices(matrix_cracking) = (s22/material%yt)**2 + (s12/material%s12)**2 + (s23/material%sm23)**2
      else
        indices(matrix_crushing) = crushing_index(-s22, s12, material%yc, material%s12)
      end if
    end associate
  end function failure_indices

  !> Strength along the fibres: XC under compression if the deck gives it, else XT for both signs as in the paper.
  pure real(wp) function fibre_strength(material, s11)
    type(material_t), intent(in) :: material
    !> Stress along the fibres
    real(wp), intent(in) :: s11

    fibre_strength = material%xt
    if (s11 < 0 .and. material%xc > 0) fibre_strength = material%xc
  end function fibre_strength

  !> Crushing, Table 1 with its printed terms. It is 1 at s22 = -Yc; where Yc > 2 S12, moderate compression makes it
  !> negative, which increases the shear stress at failure.
  pure real(wp) function crushing_index(pressure, s12, yc, strength)
    !> -s22, positive
    real(wp), intent(in) :: pressure
    !> In-plane shear stress
    real(wp), intent(in) :: s12
    !> Compressive strength across the fibres
    real(wp), intent(in) :: yc
    !> In-plane shear strength
    real(wp), intent(in) :: strength

    crushing_index = (pressure/strength)**2/4 - yc*pressure/(4*strength**2) + pressure/yc + (s12/strength)**2
  end function crushing_index
end module hou_criteria
