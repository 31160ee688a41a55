!> Shear stresses between the plies of a stack that carries shear forces, by equilibrium through its thickness, and how
!> near they bring its interfaces to failing.
module interlaminar_shear
  use kinds, only: wp
  use plies, only: ply_t, in_plane_stiffness
  use transverse_shear, only: shear_between_plies
  implicit none
  private
  public :: onset_indices, shear_under_unit_forces

contains

  !> Shear stress over strength in the interface below each ply of a stack but the last; both faces of the stack are
  !> free. Plies as they were made: what cracks have taken from them is not looked at.
  pure function onset_indices(stack, strengths, force) result(indices)
    !> The plies, from the struck face
    type(ply_t), intent(in) :: stack(:)
    !> Shear strength of the interface below each ply; 0: none is known, or none can fail, (plies - 1)
    real(wp), intent(in) :: strengths(:)
    !> Shear forces Qx and Qy of the stack, per length
    real(wp), intent(in) :: force(2)
    !> 1: the strength is reached, (plies - 1)
    real(wp) :: indices(size(stack) - 1)
    real(wp) :: unit_stress(2, 2, size(stack) - 1)
    integer :: i

    unit_stress = shear_under_unit_forces(stack)
    indices = 0
    do i = 1, size(indices)
      if (strengths(i) > 0) indices(i) = norm2(matmul(unit_stress(:, :, i), force))/strengths(i)
    end do
  end function onset_indices

  !> Shear stresses between the plies of a stack under unit shear forces.
  pure function shear_under_unit_forces(stack) result(stress)
    !> The plies, from the struck face
    type(ply_t), intent(in) :: stack(:)
    !> tau_xz and tau_yz below each ply but the last, for Qx = 1 and Qy = 1, (2, 2, plies - 1)
    real(wp) :: stress(2, 2, size(stack) - 1)
    real(wp) :: in_plane(6, size(stack))
    integer :: i

    do i = 1, size(stack)
      in_plane(:, i) = in_plane_stiffness(stack(i), stack(i)%elasticity)
    end do
    stress = shear_between_plies([stack(1)%z_top, stack%z_bottom], in_plane)
  end function shear_under_unit_forces
end module interlaminar_shear
