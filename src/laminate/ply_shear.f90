!> Transverse shear stresses of plies by equilibrium through the thickness, averaged over each ply.
!>
!> The stresses are those of the intact laminate under its shear forces (see `transverse_shear`). Where a stack is
!> divided into layers, the shear force of a layer is distributed over its plies in the proportions of the laminate.
!> This satisfies equilibrium where layers are joined. Where their faces are free, the largest stress in a layer of
!> several plies is too low by a third at most.
module ply_shear
  use kinds, only: wp
  use interlaminar_stresses, only: unit_stresses_t, unit_stresses_of
  use plies, only: ply_t
  implicit none
  private
  public :: shear_shares_of, shear_of_plies

  !> Smallest ratio of the determinant of a layer's response to unit forces to the product of its diagonal at which the
  !> force is distributed over its plies in the proportions of the laminate. The ratio is 1 without coupling between the
  !> directions. Coupling amplifies the shares of the plies by its inverse; beyond ten a uniform stress is as good.
  real(wp), parameter :: min_determinant = 0.1_wp

contains

  !> Mean tau_xz and tau_yz (rows) of each ply of a laminate for Qx = 1 and Qy = 1 (columns).
  pure function shear_shares_of(plies) result(shares)
    type(ply_t), intent(in) :: plies(:)
    !> (2, 2, plies)
    real(wp) :: shares(2, 2, size(plies))
    type(unit_stresses_t) :: unit
    real(wp) :: above(2, 2), below(2, 2)
    integer :: i

    unit = unit_stresses_of(plies)
    above = 0
    do i = 1, size(plies)
      below = reshape([1, 0, 0, 1], [2, 2])
      if (i < size(plies)) below = unit%carried(:, :, i)
      shares(:, :, i) = (below - above)/(plies(i)%z_bottom - plies(i)%z_top)
      above = below
    end do
  end function shear_shares_of

  !> Mean tau_xz and tau_yz of the plies of a layer, or of the whole laminate, whose integral is its shear force.
  pure function shear_of_plies(plies, shares, force) result(stress)
    type(ply_t), intent(in) :: plies(:)
    !> Their part of the result of shear_shares_of
    real(wp), intent(in) :: shares(:, :, :)
    !> Qx and Qy of the layer, per length
    real(wp), intent(in) :: force(2)
    !> (2, plies)
    real(wp) :: stress(2, size(plies))
    real(wp) :: taken(2, 2), determinant, whole(2)
    integer :: i

    taken = 0
    do i = 1, size(plies)
      taken = taken + shares(:, :, i)*(plies(i)%z_bottom - plies(i)%z_top)
    end do
    determinant = taken(1, 1)*taken(2, 2) - taken(1, 2)*taken(2, 1)
    if (min(taken(1, 1), taken(2, 2)) > 0 .and. determinant >= min_determinant*taken(1, 1)*taken(2, 2)) then
      whole = [taken(2, 2)*force(1) - taken(1, 2)*force(2), taken(1, 1)*force(2) - taken(2, 1)*force(1)]/determinant
      do i = 1, size(plies)
        stress(:, i) = matmul(shares(:, :, i), whole)
      end do
    else
      stress = spread(force/(plies(size(plies))%z_bottom - plies(1)%z_top), 2, size(plies))
    end if
  end function shear_of_plies
end module ply_shear
