!> Highest frequency of each element with lumped inertia, by the Lanczos iteration (G. H. Golub, C. F. Van Loan, Matrix
!> Computations, 2013, section 10.1).
module element_frequencies
  use edge_beams, only: lumped_inertia
  use element_batches, only: element_batches_t, lanes
  use internal_forces, only: batch_force
  use kinds, only: long, wp
  use lagrange9, only: gauss_shapes
  implicit none
  private
  public :: batch_frequencies

  !> Number of Lanczos steps. The estimate converges from below; after these steps congruent elements differ by less
  !> than 1e-6.
  integer, parameter :: lanczos_steps = 24
  !> Number of bisections for the largest root of the tridiagonal matrix, to round-off.
  integer, parameter :: bisections = digits(1.0_wp)
  !> Smallest divisor, for padding elements of a batch, which have no mass.
  real(wp), parameter, public :: smallest_divisor = tiny(1.0_wp)**0.25_wp
contains

  !> Pseudo-random number between -1 and 1 for a seed, the same on every machine (G. Marsaglia, Journal of Statistical
  !> Software 8 (2003) 14, xorshift).
  pure real(wp) function pseudo_random(number)
    !> The seed
    integer, intent(in) :: number
    integer(long) :: bits

    bits = number*2654435761_long
    bits = ieor(bits, ishft(bits, 13))
    bits = ieor(bits, ishft(bits, -7))
    bits = ieor(bits, ishft(bits, 17))
    pseudo_random = real(iand(bits, 2_long**31 - 1), wp)/2.0_wp**30 - 1
  end function pseudo_random

  !> Squares of the highest frequencies of the elements of a batch: largest eigenvalue of K M^-1 by Lanczos iteration.
  function batch_frequencies(elements, b, stiffness, section, beams, springs) result(squares)
    type(element_batches_t), intent(in) :: elements
    integer, intent(in) :: b
    !> Section stiffness
    real(wp), intent(in) :: stiffness(lanes, 21)
    !> Scaled I0, I1, I2
    real(wp), intent(in) :: section(lanes, 3)
    !> Scaled I0, I1, I2 of the beams, (3, beams)
    real(wp), intent(in) :: beams(:, :)
    !> Stiffness over inertia of springs that act on w at every node
    real(wp), intent(in), optional :: springs
    !> (lane)
    real(wp) :: squares(lanes)
    real(wp) :: inverse(lanes, 9, 4), r(lanes, 9, 5), before(lanes, 9, 5), force(lanes, 9, 5), response(lanes, 9, 5)
    real(wp) :: diagonal(lanes, lanczos_steps), off_diagonal(lanes, 0:lanczos_steps)
    integer :: lanczos_step

    inverse = inverse_inertia(elements, b, section)
    if (elements%has_beams(b)) call add_beams(elements, b, section, beams, inverse)
    force = start_vector(inverse)
    call batch_force(elements, b, stiffness, force)
    before = 0
    r = 0
    do lanczos_step = 0, lanczos_steps
      if (lanczos_step > 0) then
        force = response
        call batch_force(elements, b, stiffness, force)
        if (present(springs)) force(:, :, 3) = force(:, :, 3) + springs*response(:, :, 3)/inverse(:, :, 4)
        diagonal(:, lanczos_step) = sum(sum(force*response, 3), 2)
        force = force - times_factors(r, diagonal(:, lanczos_step)) &
                - times_factors(before, off_diagonal(:, lanczos_step - 1))
      end if
      before = r
      response = force
      call multiply_by_inverse_inertia(inverse, response)
      off_diagonal(:, lanczos_step) = sqrt(max(0.0_wp, sum(sum(force*response, 3), 2)))
      r = times_factors(force, 1/max(smallest_divisor, off_diagonal(:, lanczos_step)))
      response = times_factors(response, 1/max(smallest_divisor, off_diagonal(:, lanczos_step)))
    end do
    squares = largest_roots(diagonal, off_diagonal(:, 1:lanczos_steps - 1))
  end function batch_frequencies

  !> Vectors times a factor of each lane.
  pure function times_factors(vectors, factors) result(scaled)
    !> (lane, node, component)
    real(wp), intent(in) :: vectors(lanes, 9, 5)
    !> (lane)
    real(wp), intent(in) :: factors(lanes)
    !> The products
    real(wp) :: scaled(lanes, 9, 5)
    integer :: a, k

    do k = 1, 5
      do a = 1, 9
        scaled(:, a, k) = factors*vectors(:, a, k)
      end do
    end do
  end function times_factors

  !> Inverse inertia of the nodes of a batch: of displacement, both, rotation, and w.
  function inverse_inertia(elements, b, section) result(inverse)
    type(element_batches_t), intent(in) :: elements
    integer, intent(in) :: b
    !> Scaled I0, I1, I2
    real(wp), intent(in) :: section(lanes, 3)
    !> (lane, node, kind)
    real(wp) :: inverse(lanes, 9, 4)
    real(wp) :: share(lanes), determinant(lanes)
    integer :: a

    do a = 1, 9
      share = max(smallest_divisor, matmul(elements%weight(:, :, b), gauss_shapes(a, :)))
      determinant = share*max(smallest_divisor, section(:, 1)*section(:, 3) - section(:, 2)**2)
      inverse(:, a, 1) = section(:, 3)/determinant
      inverse(:, a, 2) = -section(:, 2)/determinant
      inverse(:, a, 3) = section(:, 1)/determinant
      inverse(:, a, 4) = 1/(share*max(smallest_divisor, elements%mass(:, 1, b)))
    end do
  end function inverse_inertia

  !> Computes the inverse inertia of elements with beams anew.
  subroutine add_beams(elements, b, section, beams, inverse)
    type(element_batches_t), intent(in) :: elements
    integer, intent(in) :: b
    !> Scaled I0, I1, I2 of the sections, and of the beams, (3, beams)
    real(wp), intent(in) :: section(lanes, 3), beams(:, :)
    !> (lane, node, kind)
    real(wp), intent(inout) :: inverse(lanes, 9, 4)
    real(wp) :: mass(4, 9, lanes), lumped(3, 3), share
    integer :: k, a, lane

    do lane = 1, lanes
      do a = 1, 9
        share = dot_product(elements%weight(lane, :, b), gauss_shapes(a, :))
        mass(:, a, lane) = share*[section(lane, :), elements%mass(lane, 1, b)]
      end do
    end do
    do k = elements%first_beam(b), elements%first_beam(b + 1) - 1
      associate (beam => elements%beams(k))
        lumped = lumped_inertia(beams(:, k))
        mass(:3, beam%nodes, beam%lane) = mass(:3, beam%nodes, beam%lane) + lumped
        lumped = lumped_inertia(beam%mass)
        mass(4, beam%nodes, beam%lane) = mass(4, beam%nodes, beam%lane) + lumped(1, :)
      end associate
    end do
    do k = elements%first_beam(b), elements%first_beam(b + 1) - 1
      lane = elements%beams(k)%lane
      do a = 1, 9
        associate (m => mass(:, a, lane))
          inverse(lane, a, :) = [[m(3), -m(2), m(1)]/(m(1)*m(3) - m(2)**2), 1/m(4)]
        end associate
      end do
    end do
  end subroutine add_beams

  !> Start vector with components of all modes.
  pure function start_vector(inverse) result(r)
    !> Inverse inertia of the nodes
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> (lane, node, component)
    real(wp) :: r(lanes, 9, 5)
    integer :: a, k

    do k = 1, 5
      do a = 1, 9
        r(:, a, k) = pseudo_random(5*a + k)
        if (k > 3) r(:, a, k) = r(:, a, k)*sqrt(inverse(:, a, 3)/inverse(:, a, 4))
      end do
    end do
  end function start_vector

  !> Largest eigenvalues of symmetric tridiagonal matrices by Sturm sequences: a positive pivot of the matrix minus x
  !> times identity means an eigenvalue above x.
  pure function largest_roots(diagonal, off_diagonal) result(roots)
    !> Diagonals, (lane, row)
    real(wp), intent(in) :: diagonal(lanes, lanczos_steps)
    !> Off-diagonal entries, (lane, row)
    real(wp), intent(in) :: off_diagonal(lanes, lanczos_steps - 1)
    !> (lane)
    real(wp) :: roots(lanes)
    real(wp) :: low(lanes), middle(lanes), pivot(lanes)
    logical :: above(lanes)
    integer :: bisection, k

    low = maxval(diagonal, 2)
    roots = low + 2*maxval(off_diagonal, 2)
    do bisection = 1, bisections
      middle = low + (roots - low)/2
      pivot = diagonal(:, 1) - middle
      above = pivot > 0
      do k = 2, lanczos_steps
        pivot = diagonal(:, k) - middle - off_diagonal(:, k - 1)**2/sign(max(smallest_divisor, abs(pivot)), pivot)
        above = above .or. pivot > 0
      end do
      low = merge(middle, low, above)
      roots = merge(roots, middle, above)
    end do
  end function largest_roots

  !> Multiplies forces by the inverse inertia.
  pure subroutine multiply_by_inverse_inertia(inverse, r)
    !> Inverse inertia of the nodes
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> Forces on entry, accelerations on return
    real(wp), intent(inout) :: r(lanes, 9, 5)
    real(wp) :: moment(lanes)
    integer :: a, k

    do k = 1, 2
      do a = 1, 9
        moment = r(:, a, 3 + k)
        r(:, a, 3 + k) = inverse(:, a, 2)*r(:, a, k) + inverse(:, a, 3)*moment
        r(:, a, k) = inverse(:, a, 1)*r(:, a, k) + inverse(:, a, 2)*moment
      end do
    end do
    r(:, :, 3) = inverse(:, :, 4)*r(:, :, 3)
  end subroutine multiply_by_inverse_inertia
end module element_frequencies
