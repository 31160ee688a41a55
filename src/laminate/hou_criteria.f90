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
    real(wp) :: pressure

    indices = 0
    associate (m => material, s11 => stress(1), s22 => stress(2), s12 => stress(3), s13 => stress(4), s23 => stress(5))
      ! Along the fibres XC under compression if the deck gives it, else XT for both signs as in the paper.
      indices(fibre_failure) = (s11/merge(m%xc, m%xt, s11 < 0 .and. m%xc > 0))**2 + (s12**2 + s13**2)/m%sf**2
      if (s22 >= 0) then
        indices(matrix_cracking) = (s22/m%yt)**2 + (s12/m%s12)**2 + (s23/m%sm23)**2
      else
        ! Table 1 with its printed terms. It is 1 at s22 = -Yc; where Yc > 2 S12, moderate compression makes it
        ! negative, which increases the shear stress at failure.
        pressure = -s22
        indices(matrix_crushing) = (pressure/m%s12)**2/4 - m%yc*pressure/(4*m%s12**2) + pressure/m%yc + (s12/m%s12)**2
      end if
    end associate
  end function failure_indices
end module hou_criteria
