!> Transverse shear stiffness of a stack of plies from the energy of its equilibrium stresses.
!>
!> The shear stresses follow from integrating equilibrium through the thickness for moments that vary as in two
!> cylindrical bendings, Mx,x = Qx and My,y = Qy, without membrane forces (R. Rolfes, K. Rohwer, Int. J. Numer. Meth.
!> Eng. 40 (1997) 51-60; for symmetric cross-plies the same as Whitney 1973 and Rohwer 1988). Their complementary energy
!> equals that of the mean shear strain, Q S**-1 Q / 2, theory (P5). Both faces of the stack are taken as free of shear.
!> The integral of the stresses is the shear force, so S never exceeds the sum of G dz, and it is positive definite if
!> the stiffness of the plies is. The result does not depend on the origin of z.
module transverse_shear
  use kinds, only: wp
  use packed_matrices, only: unpacked, inverse, inverse_of_two
  implicit none
  private
  public :: shear_stiffness_from_energy, layer_stiffness_from_energy, find_unit_stresses

  !> Three Gauss points of the unit interval, exact for the fourth-degree energy density of a ply
  real(wp), parameter :: abscissae(3) = 0.5_wp + [-1, 0, 1]*sqrt(0.15_wp)
  !> Their weights
  real(wp), parameter :: weights(3) = [5, 8, 5]/18.0_wp

contains

  !> Energy-consistent transverse shear stiffness.
  pure function shear_stiffness_from_energy(z, in_plane, shear) result(stiffness)
    !> z of the plies' faces, top of the first to bottom of the last, from any origin
    real(wp), intent(in) :: z(0:)
    real(wp), intent(in) :: in_plane(:, :)
    !> Packed transverse shear stiffness of each ply, shape (3, plies)
    real(wp), intent(in) :: shear(:, :)
    !> xz-xz, xz-yz, yz-yz, such that Q = S gamma
    real(wp) :: stiffness(3)
    real(wp) :: compliance(3), carried(2, 2)

    call integrate_layer(z, in_plane, shear, 1, size(in_plane, 2), compliance, carried)
    stiffness = inverse_of_two(compliance)
  end function shear_stiffness_from_energy

  !> Energy-consistent transverse shear stiffness of a layer within the stack, whose faces are not free of shear, theory
  !> (P6): of the shear forces Q of the stack it carries T Q and has the complementary energy Q E Q / 2, so that its
  !> stiffness is T E**-1 T'. By Schwarz's inequality it does not exceed the sum of G dz over the layer.
  pure function layer_stiffness_from_energy(z, in_plane, shear, first, last) result(stiffness)
    !> z of the plies' faces, top of the first to bottom of the last, from any origin
    real(wp), intent(in) :: z(0:)
    real(wp), intent(in) :: in_plane(:, :)
    !> Packed transverse shear stiffness of each ply, shape (3, plies)
    real(wp), intent(in) :: shear(:, :)
    !> Plies of the layer
    integer, intent(in) :: first, last
    !> xz-xz, xz-yz, yz-yz
    real(wp) :: stiffness(3)
    real(wp) :: energies(3), carried(2, 2), product(2, 2), inverted(3)

    call integrate_layer(z, in_plane, shear, first, last, energies, carried)
    inverted = inverse_of_two(energies)
    product = matmul(matmul(carried, reshape([inverted(1:2), inverted(2:3)], [2, 2])), transpose(carried))
    stiffness = [product(1, 1), product(1, 2), product(2, 2)]
  end function layer_stiffness_from_energy

  !> Integrates equilibrium stresses of the stack, and their energy, over the thickness of a layer.
  pure subroutine integrate_layer(z, in_plane, shear, first, last, energies, carried)
    !> z of the plies' faces, top of the first to bottom of the last, from any origin
    real(wp), intent(in) :: z(0:)
    real(wp), intent(in) :: in_plane(:, :)
    !> Packed transverse shear stiffness of each ply, shape (3, plies)
    real(wp), intent(in) :: shear(:, :)
    !> Plies of the layer
    integer, intent(in) :: first, last
    !> Twice the complementary energy, packed quadratic form in the shear forces of the stack
    real(wp), intent(out) :: energies(3)
    !> Shear forces of the layer (rows) for Qx = 1 and Qy = 1 (columns), without their sign
    real(wp), intent(out) :: carried(2, 2)
    real(wp) :: middle, top, bottom, height, q(3, 3), flexibility(3)
    real(wp) :: constant(3, 2), slope(3, 2), flow(2, 2), flow_here(2, 2)
    integer :: ply, point

    ! Relative to the middle of this stack, so that a thin layer far from the laminate's mid-plane loses no digits.
    middle = (z(0) + z(ubound(z, 1)))/2
    call strains_of_unit_shear(z - middle, in_plane, constant, slope)
    flow = 0
    energies = 0
    carried = 0
    do ply = 1, last
      top = z(ply - 1) - middle
      bottom = z(ply) - middle
      q = unpacked(in_plane(:, ply))
      flexibility = inverse_of_two(shear(:, ply))
      do point = 1, 3
        if (ply < first) exit
        height = top + (bottom - top)*abscissae(point)
        flow_here = flow + flow_between(top, height, q, constant, slope)
        energies = energies + weights(point)*(bottom - top)*energy(flow_here, flexibility)
        carried = carried + weights(point)*(bottom - top)*flow_here
      end do
      flow = flow + flow_between(top, bottom, q, constant, slope)
    end do
  end subroutine integrate_layer

  !> Shear stresses between the plies under unit shear forces, and the share of the forces that the plies above carry.
  pure subroutine find_unit_stresses(z, in_plane, stress, carried)
    !> z of the plies' faces, top of the first to bottom of the last, from any origin
    real(wp), intent(in) :: z(0:)
    real(wp), intent(in) :: in_plane(:, :)
    !> tau_xz and tau_yz (rows) on the bottom of each ply but the last, for Qx = 1 and Qy = 1 (columns), and their
    !> integrals from the top of the first, (2, 2, plies - 1)
    real(wp), allocatable, intent(out) :: stress(:, :, :), carried(:, :, :)
    real(wp) :: constant(3, 2), slope(3, 2), flow(2, 2), half(2, 2), whole(2, 2), sum_above(2, 2), middle, top, bottom
    integer :: ply

    allocate (stress(2, 2, size(in_plane, 2) - 1), carried(2, 2, size(in_plane, 2) - 1))
    middle = (z(0) + z(ubound(z, 1)))/2
    call strains_of_unit_shear(z - middle, in_plane, constant, slope)
    flow = 0
    sum_above = 0
    do ply = 1, size(stress, 3)
      top = z(ply - 1) - middle
      bottom = z(ply) - middle
      half = flow + flow_between(top, (top + bottom)/2, unpacked(in_plane(:, ply)), constant, slope)
      whole = flow + flow_between(top, bottom, unpacked(in_plane(:, ply)), constant, slope)
      ! Simpson's rule is exact for the parabola.
      sum_above = sum_above + (bottom - top)*(flow + 4*half + whole)/6
      flow = whole
      stress(:, :, ply) = -flow
      carried(:, :, ply) = -sum_above
    end do
  end subroutine find_unit_stresses

  !> Derivative of the in-plane strain, constant + slope z, along x for Qx = 1 (column 1) and along y for Qy = 1 (column
  !> 2).
  pure subroutine strains_of_unit_shear(z, in_plane, constant, slope)
    !> z of the plies' faces
    real(wp), intent(in) :: z(0:)
    real(wp), intent(in) :: in_plane(:, :)
    !> Membrane strains
    real(wp), intent(out) :: constant(3, 2)
    !> Curvatures
    real(wp), intent(out) :: slope(3, 2)
    real(wp), dimension(3, 3) :: membrane, coupling, bending, release, flexibility
    real(wp) :: packed(6, 3)
    integer :: ply

    packed = 0
    do ply = 1, size(in_plane, 2)
      associate (top => z(ply - 1), bottom => z(ply))
        packed(:, 1) = packed(:, 1) + in_plane(:, ply)*(bottom - top)
        packed(:, 2) = packed(:, 2) + in_plane(:, ply)*(bottom**2 - top**2)/2
        packed(:, 3) = packed(:, 3) + in_plane(:, ply)*(bottom**3 - top**3)/3
      end associate
    end do
    membrane = unpacked(packed(:, 1))
    coupling = unpacked(packed(:, 2))
    bending = unpacked(packed(:, 3))
    release = matmul(inverse(membrane), coupling)
    flexibility = inverse(bending - matmul(coupling, release))
    slope = flexibility(:, 1:2)
    constant = -matmul(release, slope)
  end subroutine strains_of_unit_shear

  !> Shear flow between two heights of one ply: integral of the derivatives of the in-plane stresses, which by
  !> equilibrium is (tau_xz, tau_yz), columns for Qx = 1 and Qy = 1. The sign is omitted, as the energy does not depend
  !> on it.
  pure function flow_between(from, to, q, constant, slope) result(flow)
    !> z where the integral starts
    real(wp), intent(in) :: from
    !> z where it ends
    real(wp), intent(in) :: to
    !> In-plane stiffness of the ply
    real(wp), intent(in) :: q(3, 3)
    !> Membrane strains of strains_of_unit_shear
    real(wp), intent(in) :: constant(3, 2)
    !> Curvatures of strains_of_unit_shear
    real(wp), intent(in) :: slope(3, 2)
    !> Rows tau_xz and tau_yz
    real(wp) :: flow(2, 2)
    real(wp) :: stress(3, 2)

    stress = matmul(q, (to - from)*(constant + slope*(to + from)/2))
    flow(1, :) = [stress(1, 1), stress(3, 2)]
    flow(2, :) = [stress(3, 1), stress(2, 2)]
  end function flow_between

  !> Twice the complementary energy density of two unit shear forces: flow' flexibility flow.
  pure function energy(flow, flexibility) result(doubled)
    !> Shear stresses of the unit forces
    real(wp), intent(in) :: flow(2, 2)
    !> Packed shear flexibility of the ply
    real(wp), intent(in) :: flexibility(3)
    !> Packed quadratic form in (Qx, Qy)
    real(wp) :: doubled(3)
    real(wp) :: strain(2, 2)

    strain(1, :) = flexibility(1)*flow(1, :) + flexibility(2)*flow(2, :)
    strain(2, :) = flexibility(2)*flow(1, :) + flexibility(3)*flow(2, :)
    doubled = [dot_product(flow(:, 1), strain(:, 1)), dot_product(flow(:, 1), strain(:, 2)), &
               dot_product(flow(:, 2), strain(:, 2))]
  end function energy
end module transverse_shear
