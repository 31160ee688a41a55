!> Stress criteria of ply failure after Hashin (Journal of Applied Mechanics 47 (1980) 329-334; theory (M5) and (M6)),
!> in plane stress with the transverse shear stresses.
module hashin_criteria
  use kinds, only: wp
  use material_parameters, only: material_t
  use ply_damage_parameters, only: failure_modes, fibre_failure, matrix_cracking, matrix_crushing
  implicit none
  private
  public :: hashin_indices

contains

  !> Value of each criterion; a ply fails where it reaches 1. Needs XT, YT, YC, S12, Sm23.
  pure function hashin_indices(material, stress) result(indices)
    type(material_t), intent(in) :: material
    real(wp), intent(in) :: stress(5)
    !> Values in the order of the modes; the matrix criterion of the other sign of s22 is zero
    real(wp) :: indices(failure_modes)
    real(wp) :: along, across

    indices = 0
    associate (s11 => stress(1), s22 => stress(2), s23 => stress(5), m => material)
      along = (stress(3)**2 + stress(4)**2)/m%s12**2
      across = (s23/m%sm23)**2
      if (s11 >= 0) then
        indices(fibre_failure) = (s11/m%xt)**2 + along
      else
        indices(fibre_failure) = (s11/merge(m%xc, m%xt, m%xc > 0))**2
      end if
      if (s22 >= 0) then
        indices(matrix_cracking) = (s22/m%yt)**2 + across + along
      else
        indices(matrix_crushing) = (s22/(2*m%sm23))**2 + ((m%yc/(2*m%sm23))**2 - 1)*s22/m%yc + across + along
      end if
    end associate
  end function hashin_indices
end module hashin_criteria
