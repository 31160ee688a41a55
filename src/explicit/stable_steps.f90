!> Stable step of central differences: 2/omega with the highest frequency of the elements with lumped inertia.
!>
!> No frequency of the assembled plate lies above the highest frequency of a single element with its own part of the
!> inertia (I. Fried, 1972; T. J. R. Hughes, The Finite Element Method, 1987, section 9.4.2; `element_frequencies`).
!> Interfaces, clamps and frames are implicit and do not limit the step. The contact is a spring on w of the elements
!> below the impactor, with which their frequencies are tabulated.
module stable_steps
  use batch_resultants, only: in_plane_resultants
  use batch_strains, only: strains_of_batch
  use element_batches, only: element_batches_t, lanes
  use element_frequencies, only: batch_frequencies, smallest_divisor
  use inertia_scaling, only: inertia_scaling_t
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use plate_options, only: kinematics_linear
  use reference_fields, only: gather, reference_values
  implicit none
  private
  public :: highest_element_frequency, find_stiffened_frequency, sprung_elements_t, find_sprung_elements

  !> Largest ratio of the integral of the squared gradient of a deflection of nine nodes to the integral of its square,
  !> lumped by Simpson's rule, in an element of sides 2: 6 by the derivative along one side, 1.2 by that along the
  !> other.
  real(wp), parameter :: gradient_bound = 7.2_wp
  !> The same on a line of three nodes.
  real(wp), parameter :: line_gradient_bound = 6
  !> Springs of the table of `sprung_elements_t` over the square of the highest frequency without springs. With twice as
  !> many values the steps of two panels below a nose are the same to .02 %.
  real(wp), parameter :: tabulated(*) = [0.0_wp, 0.25_wp, 0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp]

  !> Highest frequency of elements with springs that act on w, theory (T6).
  type :: sprung_elements_t
    !> Stiffness over inertia of the springs, and squares of the highest frequency with them
    real(wp) :: springs(size(tabulated)) = 0, squares(size(tabulated)) = 0
    !> True for batches with such elements
    logical, allocatable :: batches(:)
  contains
    procedure :: bound
  end type sprung_elements_t

contains

  !> Bound of the square of the highest frequency with springs. The square is a convex function of the springs, which
  !> lies below the chords of the table, and beyond it increases by the springs at most.
  pure real(wp) function bound(self, spring) result(square)
    class(sprung_elements_t), intent(in) :: self
    !> Stiffness over inertia
    real(wp), intent(in) :: spring
    integer :: i

    associate (x => self%springs, y => self%squares)
      square = y(size(y)) + spring - x(size(x))
      do i = size(x) - 1, 1, -1
        if (spring < x(i + 1)) square = y(i) + (y(i + 1) - y(i))*(spring - x(i))/(x(i + 1) - x(i))
      end do
    end associate
  end function bound

  !> Tabulates the highest frequency of the elements at some points. Collective.
  subroutine find_sprung_elements(plate, stiffness, scaling, points, self)
    type(composite_plate_t), intent(in) :: plate
    real(wp), intent(in) :: stiffness(:, :, :)
    type(inertia_scaling_t), intent(in) :: scaling
    !> Points of this rank; 0: of another one
    integer, intent(in) :: points(:)
    type(sprung_elements_t), intent(out) :: self
    real(wp) :: sprung(5, size(plate%distribution%points)), sections(lanes, 3, plate%elements%batches)
    real(wp), allocatable :: beams(:, :)
    integer :: b, i

    allocate (self%batches(plate%elements%batches))
    sprung = 0
    sprung(:, pack(points, points > 0)) = 1
    call plate%halo%update(sprung)
    sections = scaling%sections(plate)
    beams = scaling%beams(plate)
    do b = 1, plate%elements%batches
      self%batches(b) = any(sprung(1, reshape(plate%elements%points(:plate%elements%lanes_used(b), :, b), &
                                              [9*plate%elements%lanes_used(b)])) > 0)
    end do
    do i = 1, size(tabulated)
      if (i == 2) self%springs = tabulated*self%squares(1)
      do b = 1, plate%elements%batches
        if (self%batches(b)) self%squares(i) = max(self%squares(i), maxval( &
          batch_frequencies(plate%elements, b, stiffness(:, :, b), sections(:, :, b), beams, self%springs(i))))
      end do
      call plate%communicator%maximum(self%squares(i))
    end do
  end subroutine find_sprung_elements

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
      squares = batch_frequencies(plate%elements, b, stiffness(:, :, b), sections(:, :, b), beams)
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
  subroutine find_stiffened_frequency(plate, stiffness, of_elements, motion, omega, sprung, sloped)
    type(composite_plate_t), intent(in) :: plate
    real(wp), contiguous, intent(in) :: stiffness(:, :, :)
    !> Square of the highest frequency of each undeformed element, (lanes, batches)
    real(wp), contiguous, intent(in) :: of_elements(:, :)
    !> Motion of the layers, ghosts up to date, (5, points)
    real(wp), contiguous, intent(in) :: motion(:, :)
    !> The bound
    real(wp), intent(out) :: omega
    !> Elements below the impactor, for the frequency that slopes and tension add there at most
    type(sprung_elements_t), intent(in), optional :: sprung
    !> This frequency
    real(wp), intent(out), optional :: sloped
    real(wp) :: r(lanes, 9, 5), strains(lanes, 9, 6), slopes(lanes, 9, 2), unused(lanes), added(lanes), below
    real(wp), parameter :: unit_area(lanes, 9) = 1
    integer :: b

    omega = 0
    below = 0
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
      if (.not. present(sprung)) cycle
      if (sprung%batches(b)) below = max(below, maxval(added))
    end do
    call plate%communicator%maximum(omega)
    omega = sqrt(omega)
    if (.not. present(sloped)) return
    call plate%communicator%maximum(below)
    sloped = sqrt(below)
  end subroutine find_stiffened_frequency

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

end module stable_steps
