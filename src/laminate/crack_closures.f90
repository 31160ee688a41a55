!> Crack closure: stiffness lost in tension is recovered in compression, theory (M13) and (M14).
!>
!> The mean stress along or across the fibres over a ply of an element decides. If it is compressive, the stiffness lost
!> in tension acts on the mean strains; deviations from the mean keep the stiffness of open cracks. The recovered stress
!> is thus uniform, and zero where a crack closes, and force and energy derive from one potential. Shear stiffness is
!> not recovered, as the surfaces of a crack slide freely. The unilateral condition is that of P. Maimi et al.,
!> Mechanics of Materials 39 (2007) 897-908.
module crack_closures
  use kinds, only: wp
  use plies, only: elasticity_t, ply_t
  use linear_softening, only: weights_of_signs
  implicit none
  private
  public :: band_strains_t, remaining_t, remaining_stiffness_under, find_strain_alone, compressed_share, &
            find_recovered, closing_resultants

  !> Strains of a ply of an element in the ply's axes.
  type :: band_strains_t
    !> Means of the strains along and across the fibres
    real(wp) :: mean(2) = 0
    !> Means of their squares and of their product: 11, 22, 12; and of the square of the shear strain
    real(wp) :: square(3) = 0, shear_square = 0
    !> Mean of the shear strain
    real(wp) :: shear_mean = 0
  end type band_strains_t

  !> Remaining fractions of the stiffness along and across the fibres.
  type :: remaining_t
    !> With open cracks
    real(wp) :: open(2) = 1
    !> For the mean strains, for which cracks may be closed
    real(wp) :: mean(2) = 1
  end type remaining_t

contains

  !> Remaining fractions of the stiffness under mean strains: of the four combinations of open and closed cracks the one
  !> whose mean stresses have the assumed signs. The complementary energy is convex, so that there is one.
  pure function remaining_stiffness_under(elasticity, mean, open, closed) result(left)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    !> Remaining fractions along and across the fibres with open and with closed cracks
    real(wp), intent(in) :: open(2), closed(2)
    !> The parts
    type(remaining_t) :: left
    logical :: compressed(2)
    integer :: combination

    left = remaining_t(open, open)
    if (.not. any(closed > open)) return
    do combination = 0, 3
      compressed = [btest(combination, 0), btest(combination, 1)]
      left%mean = merge(closed, open, compressed)
      if (all((uniaxial_strains(elasticity, mean, left%mean) < 0) .eqv. compressed)) return
    end do
    left%mean = open
  end function remaining_stiffness_under

  !> Mean uniaxial strains, those that s11 or s22 alone would cause: s11/(E1 left) and s22/(E2 left).
  pure function uniaxial_strains(elasticity, mean, left) result(strains)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    !> Remaining fractions of the stiffness
    real(wp), intent(in) :: left(2)
    !> The strains
    real(wp) :: strains(2)
    real(wp) :: part(2)

    part = coupling(elasticity, left)
    strains = (mean + part*mean([2, 1]))/(1 - product(part))
  end function uniaxial_strains

  !> Poisson's ratios nu21 and nu12 of a damaged ply.
  pure function coupling(elasticity, left) result(part)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Remaining fractions of the stiffness
    real(wp), intent(in) :: left(2)
    !> Factor of the strain in the other direction in the uniaxial strain of each direction
    real(wp) :: part(2)

    part = [left(2)*elasticity%nu12*elasticity%e2/elasticity%e1, left(1)*elasticity%nu12]
  end function coupling

  !> Uniaxial strain, that s11 or s22 alone would cause: e1 + part e2, e2 + part e1, over a common divisor.
  pure subroutine find_strain_alone(elasticity, strains, left, direction, size, weights)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Strains of the ply
    type(band_strains_t), intent(in) :: strains
    !> Remaining fractions of the stiffness along and across the fibres
    type(remaining_t), intent(in) :: left
    !> 1: along the fibres, 2: across
    integer, intent(in) :: direction
    !> Its root mean square
    real(wp), intent(out) :: size
    !> Weights of tension and compression in it
    real(wp), intent(out) :: weights(2)
    real(wp) :: part(2), means(2), spread(3)

    part = coupling(elasticity, left%open)
    associate (m => strains%mean, s => strains%square, i => direction, j => 3 - direction)
      if (all(left%mean <= left%open)) then
        size = sqrt(max(0.0_wp, s(i) + part(i)*(2*s(3) + part(i)*s(j))))/(1 - product(part))
        weights = weights_of_signs((m(i) + part(i)*m(j))/(1 - product(part)), size)
      else
        spread = s - [m(1)**2, m(2)**2, m(1)*m(2)]
        means = uniaxial_strains(elasticity, m, left%mean)
        size = max(0.0_wp, spread(i) + part(i)*(2*spread(3) + part(i)*spread(j)))/(1 - product(part))**2
        size = sqrt(size + means(i)**2)
        weights = weights_of_signs(means(i), size)
      end if
    end associate
  end subroutine find_strain_alone

  !> Share that the mean compression along and across the fibres has in the energy that damage there can release.
  pure function compressed_share(elasticity, strains, left) result(share)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Strains of the ply
    type(band_strains_t), intent(in) :: strains
    !> Remaining fractions of the stiffness
    type(remaining_t), intent(in) :: left
    !> From 0 to 1
    real(wp) :: share(2)
    real(wp) :: means(2), energies(2), weights(2), size
    integer :: i

    means = min(0.0_wp, uniaxial_strains(elasticity, strains%mean, left%mean))
    energies = [0.0_wp, elasticity%g12*strains%shear_square]
    do i = 1, 2
      call find_strain_alone(elasticity, strains, left, i, size, weights)
      associate (modulus => merge(elasticity%e1, elasticity%e2, i == 1))
        energies(i) = energies(i) + modulus*size**2
        share(i) = 0
        if (energies(i) > 0) share(i) = min(1.0_wp, modulus*means(i)**2/energies(i))
      end associate
    end do
  end function compressed_share

  !> Stresses of closed cracks along and across the fibres, and half their product with the mean strains.
  pure function find_recovered(elasticity, mean, left) result(recovered)
    !> Constants without damage
    type(elasticity_t), intent(in) :: elasticity
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    !> Remaining fractions of the stiffness
    type(remaining_t), intent(in) :: left
    !> Two stresses and an energy per volume
    real(wp) :: recovered(3)

    recovered = 0
    if (all(left%mean <= left%open)) return
    recovered(:2) = [elasticity%e1, elasticity%e2]*(left%mean*uniaxial_strains(elasticity, mean, left%mean) &
                                                    - left%open*uniaxial_strains(elasticity, mean, left%open))
    recovered(3) = dot_product(recovered(:2), mean)/2
  end function find_recovered

  !> Contribution of closed cracks to the resultants of stress-free strains, which are subtracted from those of the
  !> section: forces and moments, and energy per area.
  pure function closing_resultants(plies, recovered) result(resultants)
    !> Neighbouring plies
    type(ply_t), intent(in) :: plies(:)
    !> Stresses and energy of closed cracks, (3, plies)
    real(wp), intent(in) :: recovered(:, :)
    !> Nxx, Nyy, Nxy, Mxx, Myy, Mxy, energy
    real(wp) :: resultants(7)
    real(wp) :: force(3), thickness
    integer :: i

    resultants = 0
    do i = 1, size(plies)
      thickness = plies(i)%z_bottom - plies(i)%z_top
      associate (c => plies(i)%cosine, s => plies(i)%sine, stress => recovered(:2, i))
        force = thickness*[c*c*stress(1) + s*s*stress(2), s*s*stress(1) + c*c*stress(2), c*s*(stress(1) - stress(2))]
        resultants(7) = resultants(7) - thickness*(recovered(3, i) + dot_product(stress, plies(i)%free_strain(:2)))
      end associate
      resultants(1:3) = resultants(1:3) - force
      resultants(4:6) = resultants(4:6) - force*(plies(i)%z_top + plies(i)%z_bottom)/2
    end do
  end function closing_resultants
end module crack_closures
