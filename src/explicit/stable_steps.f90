!> Stable step of central differences: 2/omega with the highest frequency of the elements with lumped inertia.
!>
!> No frequency of the assembled plate lies above the highest frequency of a single element with its own part of the
!> inertia (I. Fried, 1972; T. J. R. Hughes, The Finite Element Method, 1987, section 9.4.2). The frequency of an
!> element is found by the Lanczos iteration (G. H. Golub, C. F. Van Loan, Matrix Computations, 2013, section 10.1).
!> Interfaces, clamps and frames are implicit and do not limit the step.
module stable_steps
  use batch_resultants, only: in_plane_resultants
  use batch_strains, only: strains_of_batch
  use edge_beams, only: lumped_inertia
  use element_batches, only: element_batches_t, lanes
  use inertia_scaling, only: inertia_scaling_t
  use internal_forces, only: batch_force
  use kinds, only: long, wp
  use lagrange9, only: gauss_shapes
  use composite_plates, only: composite_plate_t
  use plate_options, only: kinematics_linear
  use reference_fields, only: gather, reference_values
  implicit none
  private
  public :: highest_element_frequency, stiffened_frequency

  !> Number of Lanczos steps. The estimate converges from below; after these steps congruent elements differ by less
  !> than 1e-6.
  integer, parameter :: lanczos_steps = 24
  !> Number of bisections for the largest root of the tridiagonal matrix, to round-off.
  integer, parameter :: bisections = digits(1.0_wp)
  !> Smallest divisor, for padding elements of a batch, which have no mass.
  real(wp), parameter :: smallest_divisor = tiny(1.0_wp)**0.25_wp
  !> Largest ratio of the integral of the squared gradient of a deflection of nine nodes to the integral of its square,
  !> lumped by Simpson's rule, in an element of sides 2: 6 by the derivative along one side, 1.2 by that along the
  !> other.
  real(wp), parameter :: gradient_bound = 7.2_wp
  !> The same on a line of three nodes.
  real(wp), parameter :: line_gradient_bound = 6

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

  !> Highest angular frequency of all elements, and the number of the element. Collective.
  subroutine highest_element_frequency(plate, stiffness, scaling, omega, element, of_elements)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(inertia_scaling_t), intent(in) :: scaling
    !> The frequency
    real(wp), intent(out) :: omega
    integer, intent(out) :: element
    !> Square of the highest frequency of each element, (lanes, batches)
    real(wp), allocatable, intent(out), optional :: of_elements(:, :)
    real(wp), allocatable :: sections(:, :, :), beams(:, :)
    real(wp) :: squares(lanes), largest
    integer :: b, lane

    largest = 0
    element = 0
    sections = scaling%sections(plate)
    beams = scaling%beams(plate)
    if (present(of_elements)) allocate (of_elements(lanes, plate%elements%batches), source=0.0_wp)
    do b = 1, plate%elements%batches
      squares = batch_frequencies(plate, b, stiffness(:, :, b), sections(:, :, b), beams)
      if (present(of_elements)) of_elements(:plate%elements%lanes_used(b), b) = squares(:plate%elements%lanes_used(b))
      do lane = 1, plate%elements%lanes_used(b)
        if (.not. squares(lane) > largest) cycle
        largest = squares(lane)
        element = plate%distribution%elements((b - 1)*lanes + lane)
      end do
    end do
    omega = largest
    call plate%communicator%maximum(omega)
    if (largest < omega) element = huge(element)
    call plate%communicator%minimum(element)
    omega = sqrt(omega)
  end subroutine highest_element_frequency

  !> Upper bound of the highest frequency with slopes and membrane tension. On a sloped plate membrane stiffness and
  !> tension act on w, whose mass is not scaled: with the derivatives S of the membrane strains by grad w, the energy
  !> per area is grad w^T G grad w / 2, G = S^T A S + N, with the damaged membrane stiffness A. In element coordinates
  !> of length 2 it is at most `gradient_bound` times the larger eigenvalue of G times the integral of w**2
  !> (`geometric_stiffness`). The energies of strains u and of slopes are at most (omega_u |u| + omega_w |w|)**2, so the
  !> squares of both frequencies are added. With linear strains the slopes are those of the stress-free shape, and N
  !> does not act. The curvature of a surface along which u and v are measured is part of `of_elements`, not of the
  !> slopes. Collective.
  real(wp) function stiffened_frequency(plate, stiffness, of_elements, motion) result(omega)
    type(composite_plate_t), intent(in) :: plate
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Square of the highest frequency of each undeformed element, (lanes, batches)
    real(wp), contiguous, intent(in) :: of_elements(:, :)
    !> Motion of the layers, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: motion(:, :)
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2), unused(lanes), added(lanes)
    real(wp), parameter :: unit_area(lanes, 9) = 1
    integer :: b

    omega = 0
    unused = 0
    do b = 1, plate%elements%batches
      call gather(plate%elements%points(:, :, b), motion, r)
      call strains_of_batch(plate%elements, b, plate%setup%mesh%kinematics, r, strains, slopes)
      if (allocated(plate%elements%surface_slopes)) call take_surface_slopes(plate%elements, b, slopes)
      if (plate%setup%mesh%kinematics == kinematics_linear) strains = 0
      call in_plane_resultants(stiffness(:, :, b), unit_area, strains, unused)
      added = gradient_bound*geometric_stiffness(stiffness(:, :, b), plate%elements%inverse_jacobian(:, :, :, b), &
                                                 slopes, strains)/max(smallest_divisor, plate%elements%mass(:, 1, b))
      if (plate%elements%has_beams(b)) call raise_by_beams(plate, b, r, added)
      omega = max(omega, maxval(of_elements(:, b) + added))
    end do
    call plate%communicator%maximum(omega)
    omega = sqrt(omega)
  end function stiffened_frequency

  !> Raises the bound of elements with beams to that of their beams, if it is larger: the frequency of both together is
  !> at most the higher of those of each with its own inertia.
  pure subroutine raise_by_beams(plate, b, r, added)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: b
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> Squares of frequencies by slopes, of each lane
    real(wp), intent(inout) :: added(lanes)
    integer :: k

    do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
      associate (beam => plate%elements%beams(k), lane => plate%elements%beams(k)%lane)
        added(lane) = max(added(lane), line_gradient_bound/beam%mass(1)*beam%length()* &
                          beam%slope_stiffness(plate%setup%mesh%kinematics /= kinematics_linear, &
                                               reshape(transpose(r(lane, :, :)), [45])))
      end associate
    end do
  end subroutine raise_by_beams

  !> Subtracts the slopes of the surface along which u and v are measured.
  pure subroutine take_surface_slopes(elements, b, slopes)
    type(element_batches_t), intent(in) :: elements
    integer, intent(in) :: b
    real(wp), intent(inout) :: slopes(lanes, 9, 2)
    real(wp) :: values(lanes, 9)
    integer :: i

    do i = 1, 2
      call reference_values(elements%surface_slopes(:, :, i, b), values)
      slopes(:, :, i) = slopes(:, :, i) - values
    end do
  end subroutine take_surface_slopes

  !> Largest geometric stiffness per area in each element of a batch: the larger eigenvalue of S^T A S + N in element
  !> coordinates.
  pure function geometric_stiffness(c, inverse, slopes, forces) result(largest)
    real(wp), intent(in) :: c(lanes, 21)
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    real(wp), intent(in) :: slopes(lanes, 9, 2)
    !> Nxx, Nyy, Nxy there, and moments
    real(wp), intent(in) :: forces(lanes, 9, 6)
    !> (lane)
    real(wp) :: largest(lanes)
    real(wp) :: xx(lanes), yy(lanes), xy(lanes), along(lanes), across(lanes), both(lanes)
    integer :: g

    largest = 0
    do g = 1, 9
      associate (x => slopes(:, g, 1), y => slopes(:, g, 2), p => inverse(:, g, :))
        xx = c(:, 1)*x*x + 2*c(:, 3)*x*y + c(:, 6)*y*y + forces(:, g, 1)
        yy = c(:, 4)*y*y + 2*c(:, 5)*x*y + c(:, 6)*x*x + forces(:, g, 2)
        xy = (c(:, 2) + c(:, 6))*x*y + c(:, 3)*x*x + c(:, 5)*y*y + forces(:, g, 3)
        along = p(:, 1)*(p(:, 1)*xx + 2*p(:, 3)*xy) + p(:, 3)*p(:, 3)*yy
        across = p(:, 2)*(p(:, 2)*xx + 2*p(:, 4)*xy) + p(:, 4)*p(:, 4)*yy
        both = p(:, 1)*(p(:, 2)*xx + p(:, 4)*xy) + p(:, 3)*(p(:, 2)*xy + p(:, 4)*yy)
      end associate
      largest = max(largest, (along + across)/2 + sqrt(((along - across)/2)**2 + both**2))
    end do
  end function geometric_stiffness

  !> Squares of the highest frequencies of the elements of a batch: largest eigenvalue of K M^-1 by Lanczos iteration.
  function batch_frequencies(plate, b, stiffness, section, beams) result(squares)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: b
    !> Section stiffness
    real(wp), intent(in) :: stiffness(lanes, 21)
    !> Scaled I0, I1, I2
    real(wp), intent(in) :: section(lanes, 3)
    !> Scaled I0, I1, I2 of the beams, (3, beams)
    real(wp), intent(in) :: beams(:, :)
    !> (lane)
    real(wp) :: squares(lanes)
    real(wp) :: inverse(lanes, 9, 4), r(lanes, 9, 5), before(lanes, 9, 5), force(lanes, 9, 5), response(lanes, 9, 5)
    real(wp) :: diagonal(lanes, lanczos_steps), off_diagonal(lanes, 0:lanczos_steps)
    integer :: lanczos_step

    inverse = inverse_inertia(plate, b, section)
    if (plate%elements%has_beams(b)) call add_beams(plate, b, section, beams, inverse)
    force = start_vector(inverse)
    call batch_force(plate%elements, b, stiffness, force)
    before = 0
    r = 0
    do lanczos_step = 0, lanczos_steps
      if (lanczos_step > 0) then
        force = response
        call batch_force(plate%elements, b, stiffness, force)
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
  function inverse_inertia(plate, b, section) result(inverse)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: b
    !> Scaled I0, I1, I2
    real(wp), intent(in) :: section(lanes, 3)
    !> (lane, node, kind)
    real(wp) :: inverse(lanes, 9, 4)
    real(wp) :: share(lanes), determinant(lanes)
    integer :: a

    do a = 1, 9
      share = max(smallest_divisor, matmul(plate%elements%weight(:, :, b), gauss_shapes(a, :)))
      determinant = share*max(smallest_divisor, section(:, 1)*section(:, 3) - section(:, 2)**2)
      inverse(:, a, 1) = section(:, 3)/determinant
      inverse(:, a, 2) = -section(:, 2)/determinant
      inverse(:, a, 3) = section(:, 1)/determinant
      inverse(:, a, 4) = 1/(share*max(smallest_divisor, plate%elements%mass(:, 1, b)))
    end do
  end function inverse_inertia

  !> Computes the inverse inertia of elements with beams anew.
  subroutine add_beams(plate, b, section, beams, inverse)
    type(composite_plate_t), intent(in) :: plate
    integer, intent(in) :: b
    !> Scaled I0, I1, I2 of the sections, and of the beams, (3, beams)
    real(wp), intent(in) :: section(lanes, 3), beams(:, :)
    !> (lane, node, kind)
    real(wp), intent(inout) :: inverse(lanes, 9, 4)
    real(wp) :: mass(4, 9, lanes), lumped(3, 3), share
    integer :: k, a, lane

    do lane = 1, lanes
      do a = 1, 9
        share = dot_product(plate%elements%weight(lane, :, b), gauss_shapes(a, :))
        mass(:, a, lane) = share*[section(lane, :), plate%elements%mass(lane, 1, b)]
      end do
    end do
    do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
      associate (beam => plate%elements%beams(k))
        lumped = lumped_inertia(beams(:, k))
        mass(:3, beam%nodes, beam%lane) = mass(:3, beam%nodes, beam%lane) + lumped
        lumped = lumped_inertia(beam%mass)
        mass(4, beam%nodes, beam%lane) = mass(4, beam%nodes, beam%lane) + lumped(1, :)
      end associate
    end do
    do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
      lane = plate%elements%beams(k)%lane
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
end module stable_steps
