!> Elastic constants of a failed ply (Table 2 of the paper, theory (M9)).
module degradation
  use kinds, only: wp
  use plies, only: elasticity_t
  use ply_damage_parameters, only: ply_damage_t, failure_modes, fibre_failure, matrix_cracking, matrix_crushing
  implicit none
  private
  public :: degraded

contains

  !> Elastic constants left after some modes of failure, each of which acts once.
  !>
  !> Table 2 divides a constant c by d at each mode that affects it and keeps it above a floor, here e times its
  !> undamaged value c0. Whatever the order of the modes, n of them leave max(c0/d**n, e c0): the failed modes are the
  !> only history variables. E2 is never reduced less than E1, so nu12**2 E2/E1 does not increase and the reduced
  !> stiffness remains positive definite.
  pure function degraded(original, failed, damage) result(elasticity)
    !> Constants without damage
    type(elasticity_t), intent(in) :: original
    !> True for modes that have occurred
    logical, intent(in) :: failed(failure_modes)
    !> Divisor and floor
    type(ply_damage_t), intent(in) :: damage
    type(elasticity_t) :: elasticity
    real(wp) :: fibre, in_plane_shear, matrix

    fibre = left(count(failed([fibre_failure])), damage)
    in_plane_shear = left(count(failed([fibre_failure, matrix_cracking])), damage)
    matrix = left(count(failed([fibre_failure, matrix_cracking, matrix_crushing])), damage)
    elasticity%e1 = original%e1*fibre
    elasticity%e2 = original%e2*matrix
    elasticity%g12 = original%g12*in_plane_shear
    elasticity%g13 = original%g13*fibre
    elasticity%g23 = original%g23*fibre
    elasticity%nu12 = original%nu12*matrix
    elasticity%compression = original%compression
  end function degraded

  !> Fraction of a constant that is left.
  pure real(wp) function left(modes, damage)
    !> Number of modes that have occurred and affect the constant
    integer, intent(in) :: modes
    !> Divisor and floor
    type(ply_damage_t), intent(in) :: damage

    left = max(1/damage%d**modes, damage%e)
  end function left
end module degradation
