!> Stable step of central differences: 2/omega of the highest frequency that elements have on lumped inertia.
!>
!> No frequency of the assembled plate lies above the highest of a single element with its own part of the inertia
!> (I. Fried, 1972; T. J. R. Hughes, The Finite Element Method, 1987, section 9.4.2). That of an element is found
!> by power iteration. Interfaces, clamps and frames are implicit and set no limit.
module stable_steps
  use batch_strains, only: in_plane_strains
  use element_batches, only: lanes
  use internal_forces, only: batch_force
  use kinds, only: long, wp
  use lagrange9, only: gauss_shapes
  use models, only: model_t
  use plate_options, only: kinematics_von_karman
  use reference_fields, only: gather
  implicit none
  private
  public :: highest_element_frequency, stiffened_frequency

  !> Products of the iterations. The estimate rises from below; after these it changes by less than 1e-3 a product.
  integer, parameter :: products = 40

contains

  !> A number between -1 and 1 that goes with another one, the same everywhere (G. Marsaglia, Journal of Statistical
  !> Software 8 (2003) 14, xorshift).
  pure real(wp) function scattered(number)
    !> The other number
    integer, intent(in) :: number
    integer(long) :: bits

    bits = number*2654435761_long
    bits = ieor(bits, ishft(bits, 13))
    bits = ieor(bits, ishft(bits, -7))
    bits = ieor(bits, ishft(bits, 17))
    scattered = real(iand(bits, 2_long**31 - 1), wp)/2.0_wp**30 - 1
  end function scattered

  !> Highest angular frequency of any element of all ranks, and the element of the mesh that has it. Collective.
  subroutine highest_element_frequency(model, stiffness, scaling, omega, element, of_elements)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), intent(in) :: stiffness(:, :, :)
    !> Factor of in-plane and rotary inertia
    real(wp), intent(in) :: scaling
    !> The frequency
    real(wp), intent(out) :: omega
    !> The element
    integer, intent(out) :: element
    !> Square of the highest frequency of each element, (lanes, batches)
    real(wp), allocatable, intent(out), optional :: of_elements(:, :)
    real(wp) :: squares(lanes), largest
    integer :: b, lane

    largest = 0
    element = 0
    if (present(of_elements)) allocate (of_elements(lanes, model%elements%batches), source=0.0_wp)
    do b = 1, model%elements%batches
      squares = batch_frequencies(model, b, stiffness(:, :, b), scaling)
      if (present(of_elements)) of_elements(:model%elements%lanes_used(b), b) = squares(:model%elements%lanes_used(b))
      do lane = 1, model%elements%lanes_used(b)
        if (.not. squares(lane) > largest) cycle
        largest = squares(lane)
        element = model%distribution%elements((b - 1)*lanes + lane)
      end do
    end do
    omega = largest
    call model%communicator%maximum(omega)
    if (largest < omega) element = huge(element)
    call model%communicator%minimum(element)
    omega = sqrt(omega)
  end subroutine highest_element_frequency

  !> Highest frequency with the slopes and the tension of a motion. Where the plate is sloped its membrane stiffness
  !> acts on w too, whose mass is not scaled, and tension adds as much as strain is to 1: frequencies grow to
  !> omega**2 (1 + s m (w,x**2 + w,y**2 + e)) at most, s the scaling, e the largest strain, and m the part of the
  !> membrane stiffness that damage has left. Collective.
  real(wp) function stiffened_frequency(model, stiffness, of_elements, scaling, motion) result(omega)
    type(model_t), intent(in) :: model
    !> Section stiffness left in the elements, (lanes, 21, batches)
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Square of the highest frequency of each element without motion, (lanes, batches)
    real(wp), contiguous, intent(in) :: of_elements(:, :)
    !> Factor of in-plane and rotary inertia
    real(wp), intent(in) :: scaling
    !> Motion of the layers, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: motion(:, :)
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2), growth(lanes), left(lanes)
    integer :: b

    omega = 0
    do b = 1, model%elements%batches
      call gather(model%elements%points(:, :, b), motion, r)
      call in_plane_strains(model%elements%inverse_jacobian(:, :, :, b), kinematics_von_karman, r, strains, slopes)
      growth = maxval(slopes(:, :, 1)**2 + slopes(:, :, 2)**2, 2) &
               + max(0.0_wp, maxval(maxval(strains(:, :, 1:2), 3), 2)) + maxval(abs(strains(:, :, 3)), 2)/2
      associate (whole => model%elements%stiffness(:, :, b))
        left = max(stiffness(:, 1, b), stiffness(:, 4, b))/max(tiny(left), whole(:, 1), whole(:, 4))
      end associate
      omega = max(omega, maxval(of_elements(:, b)*(1 + scaling*left*growth)))
    end do
    call model%communicator%maximum(omega)
    omega = sqrt(omega)
  end function stiffened_frequency

  !> Squares of the highest frequencies of the elements of a batch.
  function batch_frequencies(model, b, stiffness, scaling) result(squares)
    type(model_t), intent(in) :: model
    !> Number of the batch
    integer, intent(in) :: b
    !> Section stiffness
    real(wp), intent(in) :: stiffness(lanes, 21)
    !> Factor of in-plane and rotary inertia
    real(wp), intent(in) :: scaling
    !> (lane)
    real(wp) :: squares(lanes)
    real(wp) :: r(lanes, 9, 5), inverse(lanes, 9, 4), before(lanes, 9, 5), share(lanes), length(lanes)
    integer :: a, k, product

    associate (mass => model%elements%mass(:, :, b), weight => model%elements%weight(:, :, b))
      do a = 1, 9
        share = max(tiny(share)**0.25_wp, matmul(weight, gauss_shapes(a, :)))
        length = scaling*share*max(tiny(share)**0.25_wp, mass(:, 1)*mass(:, 3) - mass(:, 2)**2)
        inverse(:, a, 1) = mass(:, 3)/length
        inverse(:, a, 2) = -mass(:, 2)/length
        inverse(:, a, 3) = mass(:, 1)/length
        inverse(:, a, 4) = 1/(share*max(tiny(share)**0.25_wp, mass(:, 1)))
        do k = 1, 5
          r(:, a, k) = scattered(5*a + k)
          if (k > 3) r(:, a, k) = r(:, a, k)*sqrt(inverse(:, a, 3)/inverse(:, a, 4))
        end do
      end do
    end associate
    do product = 1, products
      before = r
      call batch_force(model%elements, b, stiffness, r)
      squares = sum(sum(r*before, 3), 2)
      call divide(inverse, r)
      length = sqrt(squares)
      if (product == products) squares = squares_of(model, b, stiffness, inverse, r)
      do k = 1, 5
        do a = 1, 9
          r(:, a, k) = r(:, a, k)/max(length, tiny(length)**0.25_wp)
        end do
      end do
    end do
  end function batch_frequencies

  !> Rayleigh's quotients r K M^-1 K r over r K r of a batch.
  function squares_of(model, b, stiffness, inverse, r) result(squares)
    type(model_t), intent(in) :: model
    !> Number of the batch
    integer, intent(in) :: b
    !> Section stiffness
    real(wp), intent(in) :: stiffness(lanes, 21)
    !> Inverse inertia of the nodes: of displacement, both, rotation, and w
    real(wp), intent(in) :: inverse(lanes, 9, 4)
    !> The motion
    real(wp), intent(in) :: r(lanes, 9, 5)
    !> (lane)
    real(wp) :: squares(lanes)
    real(wp) :: force(lanes, 9, 5), answer(lanes, 9, 5)

    force = r
    call batch_force(model%elements, b, stiffness, force)
    answer = force
    call divide(inverse, answer)
    squares = sum(sum(force*answer, 3), 2)/max(tiny(squares), sum(sum(force*r, 3), 2))
  end function squares_of

  !> Turns forces into accelerations.
  pure subroutine divide(inverse, r)
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
  end subroutine divide
end module stable_steps
