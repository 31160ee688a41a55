!> Energy release rates at the front of a delamination.
!>
!> Virtual crack closure, theory (D9). When a front advances by b, the tie forces F over this length are released, and
!> the jumps there become those now behind the front: a force at distance r ahead acts on the jump J at b - r behind.
!> The work to close them again gives G b = 1/2 sum of F.J per unit length of the front. The jump is a parabola fitted
!> to the nodes behind the smooth line of the front, on which it vanishes. Both enter as moments of forces and jumps at
!> the nodes, which are averaged along the front before they are multiplied. On a straight front with equal cells and b
!> equal to the side of a cell, this is the closure of nine-node elements: the force on the front acts on the jump one
!> cell behind, and the force half a cell ahead on the jump half a cell behind.
module virtual_crack_closure
  use dense_systems, only: solve_dense
  use kinds, only: wp
  use packed_matrices, only: unpacked
  implicit none
  private
  public :: two_state_release, converted_strains, segment_mean, closure_moments, closure_rates

  !> Number of moments of a node for the closure integral: forces times powers 0 to 2 of the distance ahead, powers 2 to
  !> 4 of the distance behind, and jumps times its powers 1 and 2. Components are normal to the front, along it and
  !> through the thickness.
  integer, parameter, public :: closure_figures = 18
  !> True for those along the front, which change sign under reflection.
  logical, parameter, public :: closure_odd(closure_figures) = &
    [.false., .true., .false., .false., .true., .false., .false., .true., .false., .false., .false., .false., &
     .false., .true., .false., .false., .true., .false.]
  !> Distance behind the front, in cells, of the nodes to which the jump is fitted: the diagonal of a square cell, so
  !> that a whole cell is included on inclined fronts too, and a tolerance of round-off.
  real(wp), parameter :: fitted = sqrt(2.0_wp)*(1 + 1.0e-6_wp)

contains

  !> Energy release rate at a node of the front from the strains on both of its sides, Eq. 11 with the sign of Eq. 9
  !> corrected, theory (D10): with the same stiffness on both sides, the sum of N'(E' - E) - (N'E' - NE)/2 is the strain
  !> energy of the jump of strain. The stiffness is that of the plies with their damage, the same for both sides: with
  !> two different ones the energy of damage would count as released. Strains of cells of another stiffness are
  !> converted first.
  pure real(wp) function two_state_release(stiffness, delaminated, intact) result(rate)
    !> Section stiffness of the layers above and below the interface, (21, layers)
    real(wp), intent(in) :: stiffness(:, :)
    !> Generalised strains of the layers on the delaminated side of the node: membrane, curvature, shear, (8, layers)
    real(wp), intent(in) :: delaminated(:, :)
    !> The same on the intact side
    real(wp), intent(in) :: intact(:, :)
    real(wp) :: jump(8)
    integer :: layer

    rate = 0
    do layer = 1, size(stiffness, 2)
      jump = delaminated(:, layer) - intact(:, layer)
      rate = rate + dot_product(jump, matmul(full_stiffness(stiffness(:, layer)), jump))/2
    end do
  end function two_state_release

  !> Strains of a layer converted across a straight border to plies of another stiffness. Forces and moments on the
  !> border and strains along it are continuous; the other strains differ. A jump of the stiffness alone then causes no
  !> difference between converted states.
  function converted_strains(strains, from, to, direction) result(carried)
    !> Membrane strains, curvatures, transverse shear strains of the layer
    real(wp), intent(in) :: strains(8)
    !> Section stiffness of the strains, and beyond the border
    real(wp), intent(in) :: from(21), to(21)
    !> Normal of the border: x (1) or y (2)
    integer, intent(in) :: direction
    !> The strains beyond the border
    real(wp) :: carried(8)
    integer, parameter :: across(5, 2) = reshape([1, 3, 4, 6, 7, 2, 3, 5, 6, 8], [5, 2])
    real(wp) :: matrix(8, 8), force(8), change(5)
    logical :: singular

    carried = strains
    if (all(abs(to - from) <= 0)) return
    matrix = full_stiffness(to)
    force = matmul(full_stiffness(from) - matrix, strains)
    associate (n => across(:, direction))
      change = force(n)
      ! Positive definite, as are all section stiffnesses.
      call solve_dense(matrix(n, n), change, singular)
      carried(n) = strains(n) + change
    end associate
  end function converted_strains

  !> Section stiffness as a full matrix.
  pure function full_stiffness(packed) result(full)
    !> Section stiffness
    real(wp), intent(in) :: packed(21)
    !> Forces, moments and transverse shear forces of unit strains
    real(wp) :: full(8, 8)

    full = 0
    full(1:3, 1:3) = unpacked(packed(1:6))
    full(1:3, 4:6) = unpacked(packed(7:12))
    full(4:6, 1:3) = full(1:3, 4:6)
    full(4:6, 4:6) = unpacked(packed(13:18))
    full(7, 7:8) = packed(19:20)
    full(8, 7:8) = packed(20:21)
  end function full_stiffness

  !> Energy release rate of a segment from those of its three nodes (step 3 of section 3.3.3).
  pure real(wp) function segment_mean(rates) result(mean)
    !> Energy release rates at the corners and the middle of the segment
    real(wp), intent(in) :: rates(3)
    mean = sum(rates)/3
  end function segment_mean

  !> Moments of a node for the closure integral.
  pure function closure_moments(normal, distance, ahead, behind, tied, weight, force, jump) result(figures)
    !> Outward normal of the front next to the node
    real(wp), intent(in) :: normal(2)
    !> Distance of the node ahead of the front, negative behind it
    real(wp), intent(in) :: distance
    !> Length of the cells ahead and behind
    real(wp), intent(in) :: ahead, behind
    !> True: the surfaces are tied there
    logical, intent(in) :: tied
    !> Weight of the node's jump
    real(wp), intent(in) :: weight
    !> Tie force x, y, z, positive against a positive jump
    real(wp), intent(in) :: force(3)
    !> Jump of the displacements x, y, z
    real(wp), intent(in) :: jump(3)
    real(wp) :: figures(closure_figures)
    real(wp) :: turn(3, 3)

    figures = 0
    turn = reshape([normal(1), -normal(2), 0.0_wp, normal(2), normal(1), 0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [3, 3])
    if (tied .and. distance < ahead) then
      figures(1:3) = matmul(turn, force)
      figures(4:6) = distance*figures(1:3)
      figures(7:9) = distance*figures(4:6)
    end if
    ! Tied nodes behind the smooth line are included: the jump there is the mean along the front.
    if (distance < 0 .and. -distance < fitted*behind) then
      figures(10:12) = weight*distance**2*[1.0_wp, -distance, distance**2]
      figures(13:15) = -weight*distance*matmul(turn, jump)
      figures(16:18) = -distance*figures(13:15)
    end if
  end function closure_moments

  !> Energy release rates G_I (opening), G_II (sliding across the front) and G_III (sliding along it) from sums of the
  !> moments of nodes. A negative rate of a mode (surfaces under pressure) counts as zero.
  pure function closure_rates(figures, length, extension) result(modes)
    !> The sums
    real(wp), intent(in) :: figures(closure_figures)
    !> Length of the front of these sums, and length of its advance; positive
    real(wp), intent(in) :: length, extension
    !> G_I, G_II, G_III, none negative
    real(wp) :: modes(3)
    !> Relative determinant below which the nodes are at one distance from the front, so that only a straight line is
    !> fitted: round-off is 1e-15, and two distances of which one is half the other give .01 and more.
    real(wp), parameter :: one_distance = 1.0e-9_wp
    real(wp) :: slope(3), bend(3), det, work(3)

    slope = 0
    bend = 0
    associate (s => figures(10:12), b => extension)
      det = s(1)*s(3) - s(2)**2
      if (det > one_distance*s(1)*s(3)) then
        slope = (figures(13:15)*s(3) - figures(16:18)*s(2))/det
        bend = (figures(16:18)*s(1) - figures(13:15)*s(2))/det
      else if (s(1) > 0) then
        slope = figures(13:15)/s(1)
      end if
      work = slope*(b*figures(1:3) - figures(4:6)) + bend*(b**2*figures(1:3) - 2*b*figures(4:6) + figures(7:9))
    end associate
    modes = max(0.0_wp, work([3, 1, 2]))/(2*extension*length)
  end function closure_rates
end module virtual_crack_closure
