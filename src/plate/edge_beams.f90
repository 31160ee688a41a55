!> A beam on an edge of a nine-node element: three nodes, Timoshenko's bending and torsion, theory (P13).
!>
!> The beam has the motion of the plate's normal at its edge: at the height z of its centroid the displacements are
!> u + z theta. Its axial strain is therefore the plate's strain at this height, with von Karman's terms of the slope
!> where the plate has them; its curvature is that of the rotation along it, its twist that of the other rotation. The
!> shear strain is sampled at +-1/sqrt(3), as the plate's assumed strain at this edge, so that it does not lock.
!>
!> Bending about the normal of the plate has no stiffness: it requires the second derivative of the lateral displacement
!> v + z theta_y along the beam, which nodal fields do not have. The skin holds the beam against it.
!>
!> Strains are products of constant rows with the unknowns of the element, which include the curved surface along which
!> u and v are measured, and the slope of a stress-free shape.
module edge_beams
  use kinds, only: wp
  use lagrange9, only: gauss2, gauss3, line_slopes, line_values, weights3
  use stringer_sections, only: stringer_section_t
  implicit none
  private
  public :: edge_beam_t, new_edge_beam, lumped_inertia

  !> Strains of a beam: three at the Gauss points each of axial strain, curvature and twist, and two of shear; forces
  !> are in the same order.
  integer, parameter, public :: beam_strains = 11
  !> The first of each.
  integer, parameter, public :: axial_row = 1, bending_row = 4, twist_row = 7, shear_row = 10
  !> Lumped masses over the mass of a line of three nodes: Simpson's rule.
  real(wp), parameter, public :: simpson(3) = [1, 4, 1]/6.0_wp
  !> Consistent masses over the mass of a line of three nodes.
  real(wp), parameter :: consistent(3, 3) = reshape([4, 2, -1, 2, 16, 2, -1, 2, 4], [3, 3])/30.0_wp

  !> A beam, with its share of the stringer: half of it if the cell on the other side of the edge has the other half.
  type :: edge_beam_t
    !> Lane of the element in its batch, and the stringer of the deck
    integer :: lane = 0, stringer = 0
    !> Nodes of the element on the edge
    integer :: nodes(3) = 0
    !> Sign of z from the face that it is bonded to towards its free edge
    integer :: outwards = 1
    !> Linear strains per unknown of the element, 5 (node - 1) + component
    real(wp) :: rows(45, beam_strains) = 0
    !> Slope along the beam per unknown, at the Gauss points of the axial strain
    real(wp) :: slopes(45, 3) = 0
    !> Stiffness and length of each strain
    real(wp) :: stiffness(beam_strains) = 0, weights(beam_strains) = 0
    !> I0, I1, I2 of the beam, to be lumped. I2 is that of the rotation about its axis, the larger one
    real(wp) :: mass(3) = 0
    !> Inertia of the five unknowns of a section, times the length
    real(wp) :: inertia(5, 5) = 0
  contains
    procedure :: strains_of
    procedure :: add_force
    procedure :: add_tangent_force
    procedure :: add_stiffness
    procedure :: add_inertia
    procedure :: add_mass
    procedure :: slope_stiffness
    procedure :: length
  end type edge_beam_t

contains

  !> A beam on an edge of an element with sides parallel to x and y.
  pure function new_edge_beam(section, height, along, side, sides, initial_deflection, surface_slopes, share) &
    result(beam)
    type(stringer_section_t), intent(in) :: section
    !> z of the centroid
    real(wp), intent(in) :: height
    !> Direction: 1 for x, 2 for y; side of the element: -1 the low one, 1 the high one
    integer, intent(in) :: along, side
    !> Sides of the element along x and y
    real(wp), intent(in) :: sides(2)
    !> Height of the stress-free shape at the nodes, and slopes there of the surface along which u and v are measured
    real(wp), intent(in) :: initial_deflection(9), surface_slopes(9, 2)
    !> Share of the stringer
    real(wp), intent(in) :: share
    type(edge_beam_t) :: beam
    real(wp), parameter :: gauss(3) = [-gauss3, 0.0_wp, gauss3]
    real(wp) :: values(9), slopes(9)
    integer :: g

    if (along == 1) beam%nodes = [1, 2, 3] + merge(6, 0, side > 0)
    if (along == 2) beam%nodes = [1, 4, 7] + merge(2, 0, side > 0)
    do g = 1, 3
      call shapes_at(gauss(g), along, side, sides, values, slopes)
      associate (rows => beam%rows, place => g - 1, surface => surface_slopes(:, along))
        beam%slopes(3::5, g) = slopes
        rows(along::5, axial_row + place) = slopes
        rows(3 + along::5, axial_row + place) = height*slopes
        rows(3::5, axial_row + place) = slopes*(dot_product(slopes, initial_deflection) - surface)
        rows(3 + along::5, bending_row + place) = slopes
        rows(6 - along::5, twist_row + place) = slopes
      end associate
    end do
    do g = 1, 2
      call shapes_at(merge(-gauss2, gauss2, g == 1), along, side, sides, values, slopes)
      beam%rows(3::5, shear_row + g - 1) = slopes
      beam%rows(3 + along::5, shear_row + g - 1) = values
    end do
    beam%stiffness = share*[spread(section%axial, 1, 3), spread(section%bending, 1, 3), spread(section%torsion, 1, 3), &
                            spread(section%shear, 1, 2)]
    beam%weights = sides(along)/2*[weights3, weights3, weights3, 1.0_wp, 1.0_wp]
    call set_inertia(section, height, along, share*sides(along), beam)
  end function new_edge_beam

  !> Shape functions at a point of an edge, and their derivatives along it.
  pure subroutine shapes_at(place, along, side, sides, values, slopes)
    !> Coordinate along the edge, -1 to 1
    real(wp), intent(in) :: place
    !> Direction of the edge, and side of the element
    integer, intent(in) :: along, side
    !> Sides of the element along x and y
    real(wp), intent(in) :: sides(2)
    !> Of each node
    real(wp), intent(out) :: values(9), slopes(9)
    real(wp) :: n(3, 2), s(3)
    integer :: i, j, a

    n(:, along) = line_values(place)
    n(:, 3 - along) = line_values(real(side, wp))
    s = line_slopes(place)*2/sides(along)
    do j = 1, 3
      do i = 1, 3
        a = i + 3*(j - 1)
        values(a) = n(i, 1)*n(j, 2)
        slopes(a) = merge(s(i)*n(j, 2), n(i, 1)*s(j), along == 1)
      end do
    end do
  end subroutine shapes_at

  !> Inertia of a beam about the plate's reference plane.
  pure subroutine set_inertia(section, height, along, length, beam)
    type(stringer_section_t), intent(in) :: section
    !> z of the centroid
    real(wp), intent(in) :: height
    integer, intent(in) :: along
    !> Length times share
    real(wp), intent(in) :: length
    type(edge_beam_t), intent(inout) :: beam
    real(wp) :: polar
    integer :: i

    polar = section%rotary + section%lateral_rotary
    beam%mass = length*[section%mass, section%mass*height, section%mass*height**2 + polar]
    do i = 1, 3
      beam%inertia(i, i) = beam%mass(1)
    end do
    do i = 1, 2
      beam%inertia(i, 3 + i) = beam%mass(2)
      beam%inertia(3 + i, i) = beam%mass(2)
      beam%inertia(3 + i, 3 + i) = length*(section%mass*height**2 + merge(section%rotary, polar, i == along))
    end do
  end subroutine set_inertia

  !> Strains of the beam.
  pure function strains_of(self, is_moderate, u) result(strains)
    class(edge_beam_t), intent(in) :: self
    logical, intent(in) :: is_moderate
    !> Unknowns of the element
    real(wp), intent(in) :: u(45)
    real(wp) :: strains(beam_strains)

    strains = matmul(u, self%rows)
    if (is_moderate) strains(:3) = strains(:3) + matmul(u, self%slopes)**2/2
  end function strains_of

  !> Adds the nodal forces and the strain energy.
  pure subroutine add_force(self, is_moderate, u, f, energy)
    class(edge_beam_t), intent(in) :: self
    logical, intent(in) :: is_moderate
    !> Unknowns of the element
    real(wp), intent(in) :: u(45)
    !> Forces on them, and energy
    real(wp), intent(inout) :: f(45), energy
    real(wp) :: strains(beam_strains), forces(beam_strains)

    strains = self%strains_of(is_moderate, u)
    forces = self%stiffness*self%weights*strains
    energy = energy + dot_product(forces, strains)/2
    f = f + matmul(self%rows, forces)
    if (is_moderate) f = f + matmul(self%slopes, forces(:3)*matmul(u, self%slopes))
  end subroutine add_force

  !> Adds the tangent stiffness at a displacement times a motion.
  pure subroutine add_tangent_force(self, is_moderate, u, motion, f)
    class(edge_beam_t), intent(in) :: self
    logical, intent(in) :: is_moderate
    !> Unknowns of the element, and their motion
    real(wp), intent(in) :: u(45), motion(45)
    !> Forces on the unknowns
    real(wp), intent(inout) :: f(45)
    real(wp) :: forces(beam_strains), change(beam_strains), slopes(3), turn(3)

    change = matmul(motion, self%rows)
    if (is_moderate) then
      slopes = matmul(u, self%slopes)
      turn = matmul(motion, self%slopes)
      change(:3) = change(:3) + slopes*turn
      forces = self%stiffness*self%weights*self%strains_of(is_moderate, u)
      f = f + matmul(self%slopes, forces(:3)*turn + self%stiffness(:3)*self%weights(:3)*change(:3)*slopes)
    end if
    f = f + matmul(self%rows, self%stiffness*self%weights*change)
  end subroutine add_tangent_force

  !> Adds the tangent stiffness times a factor to the matrix of the element.
  pure subroutine add_stiffness(self, is_moderate, u, factor, k)
    class(edge_beam_t), intent(in) :: self
    logical, intent(in) :: is_moderate
    !> Unknowns of the element, used in this case only; factor
    real(wp), intent(in) :: u(45), factor
    !> Matrix
    real(wp), intent(inout) :: k(45, 45)
    real(wp) :: rows(45, beam_strains), forces(beam_strains)
    integer :: i, column

    rows = self%rows
    forces = 0
    if (is_moderate) then
      rows(:, :3) = rows(:, :3) + self%slopes*spread(matmul(u, self%slopes), 1, 45)
      forces = self%stiffness*self%weights*self%strains_of(is_moderate, u)
    end if
    do i = 1, beam_strains
      do column = 1, 45
        if (.not. abs(rows(column, i)) > 0) cycle
        k(:, column) = k(:, column) + factor*self%stiffness(i)*self%weights(i)*rows(column, i)*rows(:, i)
      end do
    end do
    if (.not. is_moderate) return
    do i = 1, 3
      do column = 3, 45, 5
        k(:, column) = k(:, column) + factor*forces(i)*self%slopes(column, i)*self%slopes(:, i)
      end do
    end do
  end subroutine add_stiffness

  !> Adds the consistent mass times accelerations.
  pure subroutine add_inertia(self, a, f)
    class(edge_beam_t), intent(in) :: self
    !> Accelerations of the unknowns of the element
    real(wp), intent(in) :: a(5, 9)
    !> Forces on them
    real(wp), intent(inout) :: f(5, 9)

    f(:, self%nodes) = f(:, self%nodes) + matmul(self%inertia, matmul(a(:, self%nodes), consistent))
  end subroutine add_inertia

  !> Adds the consistent mass times a factor to the matrix of the element.
  pure subroutine add_mass(self, factor, k)
    class(edge_beam_t), intent(in) :: self
    !> Factor of mass
    real(wp), intent(in) :: factor
    !> Matrix
    real(wp), intent(inout) :: k(45, 45)
    integer :: a, b

    do b = 1, 3
      do a = 1, 3
        associate (row => 5*self%nodes(a) - 4, column => 5*self%nodes(b) - 4)
          k(row:row + 4, column:column + 4) = k(row:row + 4, column:column + 4) + factor*consistent(a, b)*self%inertia
        end associate
      end do
    end do
  end subroutine add_mass

  !> Inertia of a beam lumped at its three nodes.
  pure function lumped_inertia(mass) result(lumped)
    !> I0, I1, I2 of the beam
    real(wp), intent(in) :: mass(3)
    !> Of each node, (3, nodes)
    real(wp) :: lumped(3, 3)

    lumped = spread(mass, 2, 3)*spread(simpson, 1, 3)
  end function lumped_inertia

  !> Largest stiffness against the slope along the beam, E A s**2 + N, with the slopes s of stress-free shape and
  !> deflection and the axial force N, over the square of half the length.
  pure real(wp) function slope_stiffness(self, is_moderate, u) result(largest)
    class(edge_beam_t), intent(in) :: self
    logical, intent(in) :: is_moderate
    !> Unknowns of the element
    real(wp), intent(in) :: u(45)
    real(wp) :: slopes(3), forces(beam_strains), half

    half = self%length()/2
    slopes = 0
    forces = 0
    if (is_moderate) then
      slopes = matmul(u, self%slopes)
      forces = self%stiffness*self%strains_of(is_moderate, u)
    end if
    largest = maxval([0.0_wp, self%stiffness(:3)*slopes**2 + forces(:3)])/half**2
  end function slope_stiffness

  !> Length of the edge.
  pure real(wp) function length(self)
    class(edge_beam_t), intent(in) :: self

    length = sum(self%weights(shear_row:))
  end function length
end module edge_beams
