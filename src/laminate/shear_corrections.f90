!> Suitable reduction of the transverse shear stiffness of a stack of plies, and the error of the factor 5/6.
module shear_corrections
  use kinds, only: wp
  use laminate_parameters, only: shear_five_sixths, shear_energy
  use packed_matrices, only: inverse_of_two
  use plies, only: ply_t, shear_stiffness
  use stacking, only: section_stiffness
  implicit none
  private
  public :: natural_correction, shear_contrast, shear_excess

  !> Ratio of the plies' shear moduli beyond which one shear strain for all plies is not accurate. The shear moduli of
  !> plies of one fibre composite differ by G13/G23, which is below 3; foam and honeycomb differ from their skins by a
  !> factor of 30 and more.
  real(wp), parameter :: max_contrast = 10

contains

  !> Default reduction for a stack.
  pure integer function natural_correction(plies) result(correction)
    type(ply_t), intent(in) :: plies(:)

    correction = merge(shear_energy, shear_five_sixths, shear_contrast(plies) > max_contrast)
  end function natural_correction

  !> Largest over smallest shear modulus of the plies across x or y, whichever differ more.
  pure real(wp) function shear_contrast(plies) result(contrast)
    type(ply_t), intent(in) :: plies(:)
    real(wp) :: moduli(3, size(plies))
    integer :: i

    do i = 1, size(plies)
      moduli(:, i) = shear_stiffness(plies(i), plies(i)%elasticity)
    end do
    contrast = max(maxval(moduli(1, :))/minval(moduli(1, :)), maxval(moduli(3, :))/minval(moduli(3, :)))
  end function shear_contrast

  !> Transverse shear stiffness with the factor 5/6 over that of equilibrium, in the direction where this is largest:
  !> the larger eigenvalue of one times the inverse of the other.
  pure real(wp) function shear_excess(plies) result(excess)
    type(ply_t), intent(in) :: plies(:)
    real(wp) :: factor(21), energy(21), flexibility(3), ratio(2, 2), middle

    factor = section_stiffness(plies, plies%elasticity, shear_five_sixths)
    energy = section_stiffness(plies, plies%elasticity, shear_energy)
    flexibility = inverse_of_two(energy(19:21))
    ratio = matmul(reshape([flexibility(1:2), flexibility(2:3)], [2, 2]), &
                   reshape([factor(19:20), factor(20:21)], [2, 2]))
    middle = (ratio(1, 1) + ratio(2, 2))/2
    excess = middle + sqrt(max(0.0_wp, ((ratio(1, 1) - ratio(2, 2))/2)**2 + ratio(1, 2)*ratio(2, 1)))
  end function shear_excess
end module shear_corrections
