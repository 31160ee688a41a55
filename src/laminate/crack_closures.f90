!> Crack closure: stiffness lost in tension is recovered in compression, theory (M13) and (M14).
!>
!> The mean stress along or across the fibres over a ply of an element decides. If it is compressive, the stiffness lost
!> in tension acts on the mean strains; deviations from the mean keep the stiffness of open cracks. The recovered stress
!> is thus uniform, and zero where a crack closes, and force and energy derive from one potential. Shear stiffness is
!> not recovered, as the surfaces of a crack slide freely. The modulus E1c of compressed fibres is another case of this
!> rule. The unilateral condition is that of P. Maimi et al.,
!> Mechanics of Materials 39 (2007) 897-908.
module crack_closures
  use kinds, only: wp
  use plies, only: elasticity_t, ply_t
  use linear_softening, only: weights_of_signs
  implicit none
  private
  public :: band_strains_t, remaining_t, fractions_under, find_strain_alone, compressed_share, find_recovered, &
            closing_resultants

  !> Strains of a ply of an element in the ply's axes.
  type :: band_strains_t
    !> Means of the strains along and across the fibres
    real(wp) :: mean(2) = 0
    !> Means of their squares and of their product: 11, 22, 12; and of the square of the shear strain
    real(wp) :: square(3) = 0, shear_square = 0
    !> Mean of the shear strain
    real(wp) :: shear_mean = 0
    !> Difference of the mean strains along and across the fibres between bottom and top
    real(wp) :: rise(2) = 0
    !> Number of sub-plies, each with its own sign of the mean stresses
    integer :: sub_plies = 1
  end type band_strains_t

  !> Remaining fractions of the stiffness along and across the fibres.
  type :: remaining_t
    !> With open and with closed cracks
    real(wp) :: open(2) = 1, closed(2) = 1
  end type remaining_t

contains

  !> Fractions of the stiffness for mean strains: of the four combinations of open and closed cracks the one whose mean
  !> stresses have the assumed signs. The complementary energy is convex, so that there is one. Along the fibres,
  !> compression has its own modulus.
  pure function fractions_under(elasticity, mean, left) result(fractions)
    type(elasticity_t), intent(in) :: elasticity
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    type(remaining_t), intent(in) :: left
    !> Of E1 and E2
    real(wp) :: fractions(2)
    logical :: is_compressed(2)
    real(wp) :: limits(2)
    integer :: combination

    fractions = left%open
    limits = left%closed*[elasticity%compression, 1.0_wp]
    if (.not. any(abs(limits - left%open) > 0)) return
    do combination = 0, 3
      is_compressed = [btest(combination, 0), btest(combination, 1)]
      fractions = merge(limits, left%open, is_compressed)
      if (all((uniaxial_strains(elasticity, mean, fractions) < 0) .eqv. is_compressed)) return
    end do
    fractions = left%open
  end function fractions_under

  !> Mean strains of a sub-ply along and across the fibres.
  pure function sub_ply_means(strains, number) result(mean)
    type(band_strains_t), intent(in) :: strains
    !> Number of the sub-ply, from the top
    integer, intent(in) :: number
    real(wp) :: mean(2)

    mean = strains%mean
    if (strains%sub_plies > 1) mean = mean + ((number - 0.5_wp)/strains%sub_plies - 0.5_wp)*strains%rise
  end function sub_ply_means

  !> Mean uniaxial strains, those that s11 or s22 alone would cause: s11/(E1 left) and s22/(E2 left).
  pure function uniaxial_strains(elasticity, mean, left) result(strains)
    type(elasticity_t), intent(in) :: elasticity
    !> Mean strains along and across the fibres
    real(wp), intent(in) :: mean(2)
    !> Remaining fractions of the stiffness
    real(wp), intent(in) :: left(2)
    real(wp) :: strains(2)
    real(wp) :: part(2)

    part = coupling(elasticity, left)
    strains = (mean + part*mean([2, 1]))/(1 - product(part))
  end function uniaxial_strains

  !> Poisson's ratios nu21 and nu12 of a damaged ply.
  pure function coupling(elasticity, left) result(part)
    type(elasticity_t), intent(in) :: elasticity
    !> Remaining fractions of the stiffness
    real(wp), intent(in) :: left(2)
    !> Factor of the strain in the other direction in the uniaxial strain of each direction
    real(wp) :: part(2)

    part = [left(2)*elasticity%nu12*elasticity%e2/elasticity%e1, left(1)*elasticity%nu12]
  end function coupling

  !> Uniaxial strain, that s11 or s22 alone would cause: e1 + part e2, e2 + part e1, over a common divisor. With E1c its
  !> squares in compression are weighted by E1c/E1, so that it measures the energy that damage can release.
  pure subroutine find_strain_alone(elasticity, strains, left, direction, size, weights)
    type(elasticity_t), intent(in) :: elasticity
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> 1: along the fibres, 2: across
    integer, intent(in) :: direction
    !> Its root mean square
    real(wp), intent(out) :: size
    !> Weights of tension and compression in it
    real(wp), intent(out) :: weights(2)
    real(wp) :: part(2), spread(3), means(3), alone
    logical :: is_open

    part = coupling(elasticity, left%open)
    associate (m => strains%mean, s => strains%square, i => direction, j => 3 - direction)
      call find_means(elasticity, strains, left, direction, spread, means, is_open)
      if (is_open) then
        size = sqrt(max(0.0_wp, s(i) + part(i)*(2*s(3) + part(i)*s(j))))/(1 - product(part))
        weights = weights_of_signs((m(i) + part(i)*m(j))/(1 - product(part)), size)
      else
        size = max(0.0_wp, spread(i) + part(i)*(2*spread(3) + part(i)*spread(j)))/(1 - product(part))**2
        alone = sqrt(size + means(2))
        weights = weights_of_signs(means(1), alone)
        size = sqrt(size + means(3))
      end if
    end associate
  end subroutine find_strain_alone

  !> Means over the sub-plies of a ply.
  pure subroutine find_means(elasticity, strains, left, direction, spread, means, is_open)
    type(elasticity_t), intent(in) :: elasticity
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> 1: along the fibres, 2: across
    integer, intent(in) :: direction
    !> Mean products of the deviations from the means of sub-plies: 11, 22, 12
    real(wp), intent(out) :: spread(3)
    !> Of their mean uniaxial strain, of its square, and of its square times the modulus over that in tension
    real(wp), intent(out) :: means(3)
    !> True: the stiffness for the means is that of open cracks
    logical, intent(out) :: is_open
    real(wp) :: mean(2), fractions(2), alone(2), ratio
    integer :: k

    spread = strains%square
    means = 0
    is_open = .true.
    associate (parts => strains%sub_plies)
      do k = 1, parts
        mean = sub_ply_means(strains, k)
        fractions = fractions_under(elasticity, mean, left)
        is_open = is_open .and. .not. any(abs(fractions - left%open) > 0)
        alone = uniaxial_strains(elasticity, mean, fractions)
        ratio = 1
        if (direction == 1 .and. alone(1) < 0) ratio = elasticity%compression
        means = means + [alone(direction), alone(direction)**2, ratio*alone(direction)**2]/parts
        spread = spread - [mean(1)**2, mean(2)**2, mean(1)*mean(2)]/parts
      end do
    end associate
  end subroutine find_means

  !> Share that the mean compression along and across the fibres has in the energy that damage there can release.
  pure function compressed_share(elasticity, strains, left) result(share)
    type(elasticity_t), intent(in) :: elasticity
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> From 0 to 1
    real(wp) :: share(2)
    real(wp) :: means(2), energies(2), weights(2), compressive(2), size, mean(2)
    integer :: i, k

    compressive = 0
    do k = 1, strains%sub_plies
      mean = sub_ply_means(strains, k)
      means = min(0.0_wp, uniaxial_strains(elasticity, mean, fractions_under(elasticity, mean, left)))
      compressive = compressive + [elasticity%compression, 1.0_wp]*means**2/strains%sub_plies
    end do
    energies = [0.0_wp, elasticity%g12*strains%shear_square]
    do i = 1, 2
      call find_strain_alone(elasticity, strains, left, i, size, weights)
      associate (modulus => merge(elasticity%e1, elasticity%e2, i == 1))
        energies(i) = energies(i) + modulus*size**2
        share(i) = 0
        if (energies(i) > 0) share(i) = min(1.0_wp, modulus*compressive(i)/energies(i))
      end associate
    end do
  end function compressed_share

  !> Mean stresses of closed cracks along and across the fibres, and half their product with the mean strains.
  pure function find_recovered(elasticity, strains, left) result(recovered)
    type(elasticity_t), intent(in) :: elasticity
    type(band_strains_t), intent(in) :: strains
    type(remaining_t), intent(in) :: left
    !> Two stresses and an energy per volume
    real(wp) :: recovered(3)
    real(wp) :: mean(2), open(2), fractions(2), stress(2)
    integer :: k

    recovered = 0
    do k = 1, strains%sub_plies
      mean = sub_ply_means(strains, k)
      fractions = fractions_under(elasticity, mean, left)
      open = fractions_under(elasticity, mean, remaining_t(left%open, left%open))
      if (all(fractions <= open)) cycle
      stress = [elasticity%e1, elasticity%e2]*(fractions*uniaxial_strains(elasticity, mean, fractions) &
                                               - open*uniaxial_strains(elasticity, mean, open))
      recovered = recovered + [stress, dot_product(stress, mean)/2]/strains%sub_plies
    end do
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
