!> Elastic constants of a failed ply (Table 2 of the paper).
module degradation
  use kinds, only: wp
  use plies, only: elasticity_t
  use ply_damage_parameters, only: ply_damage_t, failure_modes, fibre_failure, matrix_cracking, matrix_crushing
  implicit none
  private
  public :: degraded

contains

  !> Elastic constants left after some modes of failure, each of which acts once and may do so bit by bit.
  !>
  !> Table 2 divides a constant c by d at each mode that touches it and keeps it above a floor, here e times its
  !> undamaged value c0. Whatever the order of the modes, n of them leave max(c0/d**n, e c0): the failed modes alone are
  !> the state. A mode that has taken the part x of what it takes leaves 1 - x + x/d. E2 is never cut less than E1, so
  !> nu12**2 E2/E1 only falls and the reduced stiffness stays positive definite.
  pure function degraded(original, taken, damage) result(elasticity)
    !> Constants without damage
    type(elasticity_t), intent(in) :: original
    !> Part that each mode has taken of what it takes: 0 before it occurs, 1 in the end
    real(wp), intent(in) :: taken(failure_modes)
    !> Divisor and floor
    type(ply_damage_t), intent(in) :: damage
    !> Constants that are left
    type(elasticity_t) :: elasticity
    real(wp) :: fibre, in_plane_shear, matrix

    fibre = left([taken(fibre_failure)], damage)
    in_plane_shear = left([taken(fibre_failure), taken(matrix_cracking)], damage)
    matrix = left([taken(fibre_failure), taken(matrix_cracking), taken(matrix_crushing)], damage)
    elasticity%e1 = original%e1*fibre
    elasticity%e2 = original%e2*matrix
    elasticity%g12 = original%g12*in_plane_shear
    elasticity%g13 = original%g13*fibre
    elasticity%g23 = original%g23*fibre
    elasticity%nu12 = original%nu12*matrix
  end function degraded

  !> Fraction of a constant that is left.
  pure real(wp) function left(taken, damage)
    !> Parts taken by those of the modes that touch the constant
    real(wp), intent(in) :: taken(:)
    !> Divisor and floor
    type(ply_damage_t), intent(in) :: damage

    left = max(product(1 - taken + taken/damage%d), damage%e)
  end function left
end module degradation
