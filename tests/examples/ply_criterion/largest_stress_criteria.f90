!> Ply failure by maximum stress criteria, without interaction.
module largest_stress_criteria
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: failure_modes, fibre_failure, matrix_cracking, matrix_crushing
  implicit none
  private
  public :: largest_stress_indices

contains

  !> Value of each criterion; a ply fails where it reaches 1.
  pure function largest_stress_indices(material, stress) result(indices)
    !> Material of the ply; XT, YT, YC, S12 and Sm23 must be given
    type(material_t), intent(in) :: material
    !> s11, s22, s12, s13, s23
    real(wp), intent(in) :: stress(5)
    !> Values in the order of the modes; the matrix criterion of the other sign of s22 is zero
    real(wp) :: indices(failure_modes)
    real(wp) :: shear

    indices = 0
    associate (s11 => stress(1), s22 => stress(2), m => material)
      indices(fibre_failure) = (s11/merge(m%xc, m%xt, s11 < 0 .and. m%xc > 0))**2
      shear = max((stress(3)/m%s12)**2, (stress(5)/m%sm23)**2)
      if (s22 >= 0) then
        indices(matrix_cracking) = max((s22/m%yt)**2, shear)
      else
        indices(matrix_crushing) = max((s22/m%yc)**2, shear)
      end if
    end associate
  end function largest_stress_indices
end module largest_stress_criteria
