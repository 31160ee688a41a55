!> Stresses between the plies of a stack that carries shear forces, by equilibrium through its thickness, theory (D7),
!> and the onset index of its interfaces, (D8).
module interlaminar_stresses
  use kinds, only: wp
  use plies, only: ply_t, in_plane_stiffness
  use transverse_shear, only: find_unit_stresses
  implicit none
  private
  public :: unit_stresses_t, unit_stresses_of

  !> Stresses below each ply of a stack but the last, of undamaged plies.
  type :: unit_stresses_t
    !> tau_xz and tau_yz for Qx = 1 and Qy = 1, and the parts of these forces that plies above carry, (2, 2, plies - 1)
    real(wp), allocatable :: shear(:, :, :), carried(:, :, :)
  contains
    procedure :: opening
    procedure :: onset_indices
  end type unit_stresses_t

contains

  !> Stresses of a stack whose faces are free of shear.
  pure function unit_stresses_of(stack) result(self)
    !> The plies, from the struck face
    type(ply_t), intent(in) :: stack(:)
    type(unit_stresses_t) :: self
    real(wp) :: in_plane(6, size(stack))
    integer :: i

    do i = 1, size(stack)
      in_plane(:, i) = in_plane_stiffness(stack(i), stack(i)%elasticity)
    end do
    call find_unit_stresses([stack(1)%z_top, stack%z_bottom], in_plane, self%shear, self%carried)
  end function unit_stresses_of

  !> Normal stress below a ply, from sigma_z,z = -tau_xz,x - tau_yz,y. A non-zero divergence of the shear forces is
  !> interpreted as pressure on the upper or lower face. Inertia and membrane forces of a curved plate are neglected;
  !> the stress is too low by at most their force per area.
  pure real(wp) function opening(self, ply, gradient) result(stress)
    class(unit_stresses_t), intent(in) :: self
    !> The ply above the interface, from the top of the stack
    integer, intent(in) :: ply
    !> Derivatives of Qx and Qy (columns) along x and y (rows), force per area
    real(wp), intent(in) :: gradient(2, 2)

    stress = min(gradient(1, 1) + gradient(2, 2), 0.0_wp) - sum(self%carried(:, :, ply)*gradient)
  end function opening

  !> Onset index of each interface, stresses over strengths: sqrt((tau/S)**2 + (sigma/T)**2), pressure left out.
  pure function onset_indices(self, strengths, force, gradient) result(indices)
    class(unit_stresses_t), intent(in) :: self
    !> Strengths in shear and opening of the interface below each ply; 0: not known, and without a shear strength the
    !> interface cannot fail, (2, plies - 1)
    real(wp), intent(in) :: strengths(:, :)
    !> Shear forces Qx and Qy of the stack, per length
    real(wp), intent(in) :: force(2)
    !> Derivatives of Qx and Qy (columns) along x and y (rows)
    real(wp), intent(in) :: gradient(2, 2)
    !> 1: the strength is reached, (plies - 1)
    real(wp) :: indices(size(strengths, 2))
    real(wp) :: part(2)
    integer :: i

    indices = 0
    do i = 1, size(indices)
      if (.not. strengths(1, i) > 0) cycle
      part = 0
      part(1) = norm2(matmul(self%shear(:, :, i), force))/strengths(1, i)
      if (strengths(2, i) > 0) part(2) = max(0.0_wp, self%opening(i, gradient))/strengths(2, i)
      indices(i) = norm2(part)
    end do
  end function onset_indices
end module interlaminar_stresses
