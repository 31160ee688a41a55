!> Scaling of in-plane and rotary inertia, more in short elements and thin layers, so that all have about the same
!> stable step.
!>
!> In-plane waves of speed c limit the step of an element of shorter side L to L/c/sqrt(6), and to sqrt(f) times that if
!> its inertia is multiplied by f: L sqrt(f) is the side of an unscaled element with the same step. If this side is to
!> be tau for all elements, the factors are max(1, tau**2/L**2). Rotations against the transverse shear stiffness limit
!> the step of layers much thinner than long, whose rotary inertia is increased until they have the same step (T. J. R.
!> Hughes, M. Cohen, M. Haroun, Nuclear Engineering and Design 46 (1978) 203-222). The deck gives the mean factor of the
!> laminate's rotary inertia, from which tau follows: waves much longer than elements are slowed according to this mean.
module inertia_scaling
  use cell_grids, only: cells_along
  use cell_lines, only: cell_line_t
  use element_batches, only: batch_of, first_element, lane_of
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use setups, only: setup_t
  use stacking, only: section_mass, stacked_plies
  use stiffened_elements, only: beam_mass
  implicit none
  private
  public :: inertia_scaling_t, create_inertia_scaling

  !> Square of the highest frequency of an element divided by (c/L)**2, for three nodes on a line with Simpson's masses.
  real(wp), parameter :: of_waves = 24
  !> Number of bisections for tau, to round-off.
  integer, parameter :: bisections = digits(1.0_wp)

  !> Factors of in-plane and rotary inertia.
  type :: inertia_scaling_t
    !> Square of tau; 0: no scaling
    real(wp) :: side_square = 0
    !> Square of the radius of gyration that is added to the rotary inertia of every layer
    real(wp) :: radius_square = 0
  contains
    procedure :: sections
    procedure :: beams
    procedure :: factor
  end type inertia_scaling_t

contains

  !> Scaling with a mean factor of the laminate's rotary inertia over the core, or over the plate without one.
  pure function create_inertia_scaling(setup, mean) result(self)
    class(setup_t), intent(in) :: setup
    !> The mean factor, at least 1
    real(wp), intent(in) :: mean
    type(inertia_scaling_t) :: self
    real(wp), allocatable :: x(:), y(:)

    if (.not. mean > 1) return
    x = core_sides(setup, 1)
    y = core_sides(setup, 2)
    self = scaling_of_mean(x, y, mean, ratio_of_moduli(setup)/of_waves, laminate_radius_square(setup))
  end function create_inertia_scaling

  !> Scaling with a mean factor, by bisection: the mean grows with tau.
  pure function scaling_of_mean(x, y, mean, ratio, radius_square) result(self)
    !> Sides of the core's cells along x and y
    real(wp), intent(in) :: x(:), y(:)
    !> The mean factor
    real(wp), intent(in) :: mean
    !> Square of the added radius of gyration over that of tau
    real(wp), intent(in) :: ratio
    !> Square of the radius of gyration of the laminate
    real(wp), intent(in) :: radius_square
    type(inertia_scaling_t) :: self
    real(wp) :: shortest, low, high, found
    integer :: bisection, i, j

    shortest = min(minval(x), minval(y))**2
    low = shortest
    high = mean*max(maxval(x), maxval(y))**2
    do bisection = 1, bisections
      self%side_square = low + (high - low)/2
      self%radius_square = ratio*(self%side_square - shortest)
      found = sum([((self%factor([x(i), y(j)])*x(i)*y(j), i=1, size(x)), j=1, size(y))]) &
              /(sum(x)*sum(y)) + self%radius_square/radius_square
      if (found > mean) then
        high = self%side_square
      else
        low = self%side_square
      end if
    end do
  end function scaling_of_mean

  !> Sides of the cells of the core, or of all cells without a core.
  pure function core_sides(setup, direction) result(sides)
    class(setup_t), intent(in) :: setup
    integer, intent(in) :: direction
    !> The sides
    real(wp), allocatable :: sides(:)
    type(cell_line_t) :: line

    line = cells_along(setup%plate, setup%mesh, direction)
    sides = line%sides()
    if (.not. setup%mesh%cell > 0) return
    sides = pack(sides, abs(line%middles() - setup%mesh%struck(direction)) &
                 < max(setup%mesh%core(direction), setup%mesh%patch)/2)
  end function core_sides

  !> Largest transverse shear modulus over the largest in-plane modulus. A radius of gyration r limits the step by
  !> rotations to 2 r sqrt(rho/G), a side tau of the elements that by in-plane waves to 2 tau sqrt(rho/(24 E)).
  pure real(wp) function ratio_of_moduli(setup) result(ratio)
    class(setup_t), intent(in) :: setup
    integer, allocatable :: used(:)

    used = setup%used_materials() ! not as an index in `associate`, which GNU 14 refuses
    associate (materials => setup%materials(used))
      ratio = maxval([materials%g13, materials%g23])/maxval([materials%e1, materials%e2])
    end associate
  end function ratio_of_moduli

  !> Square of the radius of gyration of the laminate at the struck point about its centre of mass.
  pure real(wp) function laminate_radius_square(setup) result(square)
    class(setup_t), intent(in) :: setup
    real(wp) :: mass(3)

    mass = section_mass(stacked_plies(setup%struck_laminate(), setup%materials))
    square = mass(3)/mass(1) - (mass(2)/mass(1))**2
  end function laminate_radius_square

  !> Scaled masses of the sections of a plate: the factor times I0, I1, I2, and the added rotary inertia. The sum over
  !> layers is the mass of the joined layers, so that the insertion of layers does not change the kinetic energy.
  function sections(self, plate) result(masses)
    class(inertia_scaling_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> I0, I1, I2, (lanes, 3, batches)
    real(wp), allocatable :: masses(:, :, :)
    real(wp) :: sides(2)
    integer :: i

    masses = plate%elements%mass
    do i = 1, plate%elements%elements
      sides = sides_of(plate, i)
      associate (mass => masses(lane_of(i), :, batch_of(i)))
        mass = self%factor(sides)*mass
        mass(3) = mass(3) + self%radius_square*plate%elements%mass(lane_of(i), 1, batch_of(i))
      end associate
    end do
  end function sections

  !> Scaled masses of the beams of a plate, by the factors of their elements.
  function beams(self, plate) result(masses)
    class(inertia_scaling_t), intent(in) :: self
    type(composite_plate_t), intent(in) :: plate
    !> I0, I1, I2, (3, beams)
    real(wp), allocatable :: masses(:, :)
    integer :: b, k

    masses = beam_mass(plate%elements)
    if (.not. allocated(plate%elements%beams)) return
    do b = 1, plate%elements%batches
      do k = plate%elements%first_beam(b), plate%elements%first_beam(b + 1) - 1
        associate (unscaled => plate%elements%beams(k)%mass)
          masses(:, k) = self%factor(sides_of(plate, first_element(b) + plate%elements%beams(k)%lane - 1))*unscaled
          masses(3, k) = masses(3, k) + self%radius_square*unscaled(1)
        end associate
      end do
    end do
  end function beams

  !> Sides of the cell of an element.
  function sides_of(plate, element) result(sides)
    type(composite_plate_t), intent(in) :: plate
    !> Position among this rank's elements
    integer, intent(in) :: element
    !> Along x and y
    real(wp) :: sides(2)

    sides = plate%mesh%cell_sides(plate%mesh%place_of(plate%mesh%element_cell(plate%distribution%elements(element))))
  end function sides_of

  !> Factor of in-plane and rotary inertia of an element.
  pure real(wp) function factor(self, sides)
    class(inertia_scaling_t), intent(in) :: self
    !> Sides of the element along x and y
    real(wp), intent(in) :: sides(2)

    factor = max(1.0_wp, self%side_square/minval(sides)**2)
  end function factor
end module inertia_scaling
