!> Lumped inertia of the layers at each node, theory (P7), and its inverse.
!>
!> In each in-plane direction a layer has a displacement u of the mid-plane z = 0 and a rotation theta, coupled
!> where the layer lies off the mid-plane: M = [I0 I1; I1 I2]. In-plane and rotary inertia may be scaled, which
!> lengthens the stable step (`inertia_scaling`; L. Olovsson, K. Simonsson, M. Unosson, International Journal for
!> Numerical Methods in Engineering 63 (2005) 1436-1445); the mass of w is never scaled. The inertia of dependent
!> points is added to that of the points that determine their motion.
module nodal_inertia
  use kinds, only: wp
  use dependent_points, only: find_masters
  use inertia_forces, only: add_lumped_mass
  use inertia_scaling, only: inertia_scaling_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  implicit none
  private
  public :: nodal_inertia_t, create_nodal_inertia

  !> Positions in `inverse`: u-u, u-theta_x, theta_x-theta_x, v-v, v-theta_y, theta_y-theta_y, w-w.
  integer, parameter, public :: along_x = 1, along_y = 4, along_z = 7

  !> Inertia of this rank's points.
  type :: nodal_inertia_t
    !> Scaled I0, I1, I2 of in-plane motion and rotation, and I0 of w, (4, points); zero at dependent points
    real(wp), allocatable :: mass(:, :)
    !> True for unknowns constrained to zero, (5, points)
    logical, allocatable :: constrained(:, :)
    !> Stiffness of springs on the unknowns of the first layer, treated implicitly, (5, points); unallocated: none
    real(wp), allocatable :: springs(:, :)
    !> Points with springs
    integer, allocatable :: sprung(:)
    !> Inverse of inertia and implicit springs, zero for constrained unknowns, (7, points)
    real(wp), allocatable :: inverse(:, :)
    !> Product of the step for which it was found and the mean of it and the step before
    real(wp) :: step_square = 0
    !> Dependent points and their masters, (dependents)
    integer, allocatable :: dependents(:), masters(:)
    !> True for dependent points, (points)
    logical, allocatable :: is_dependent(:)
    !> Signs of their motion, (5, dependents)
    real(wp), allocatable :: signs(:, :)
  contains
    procedure :: invert
    procedure :: fold
    procedure :: move_dependents
    procedure :: inverse_of_images
    procedure :: add_spring_forces
  end type nodal_inertia_t

contains

  !> Inertia of the points of a model with a lumped mass.
  function create_nodal_inertia(model, scaling) result(self)
    type(model_t), intent(in) :: model
    type(inertia_scaling_t), intent(in) :: scaling
    type(nodal_inertia_t) :: self
    real(wp), allocatable :: scaled(:, :)
    integer :: points

    points = size(model%plate%distribution%points)
    allocate (self%mass(4, points), self%inverse(7, points))
    allocate (scaled(3, model%plate%borders%columns), source=0.0_wp)
    call add_lumped_mass(model%plate%elements, scaling%sections(model%plate), scaling%beams(model%plate), scaled)
    call model%plate%borders%add(scaled)
    self%mass(1:3, :) = scaled(:, :points)
    self%mass(4, :) = model%lumped(1, :)
    call find_dependents(model%plate, self)
    call fold_mass(self, self%mass)
    call find_springs(model, self)
  end function create_nodal_inertia

  !> Dependent points of this rank, and unknowns constrained by supports and symmetry.
  subroutine find_dependents(plate, self)
    type(composite_plate_t), intent(in) :: plate
    type(nodal_inertia_t), intent(inout) :: self
    integer :: master(plate%mesh%points()), i
    real(wp) :: signs(5, plate%mesh%points())
    logical :: constrained(5, plate%mesh%points())

    constrained = plate%constraints%fixed
    call find_masters(plate%mesh, master, signs, constrained, plate%constraints%images)
    associate (partition => plate%distribution)
      self%constrained = constrained(:, partition%points)
      self%is_dependent = master(partition%points) > 0 .and. [(i, i=1, size(partition%points))] <= partition%owned
      self%dependents = pack([(i, i=1, size(partition%points))], self%is_dependent)
      self%masters = partition%local(master(partition%points(self%dependents)))
      self%signs = signs(:, partition%points(self%dependents))
    end associate
  end subroutine find_dependents

  !> Adds the inertia of dependent points to that of their masters, so that the kinetic energy is that of both.
  pure subroutine fold_mass(self, mass)
    type(nodal_inertia_t), intent(in) :: self
    !> A nodal quantity without sign, (:, points)
    real(wp), intent(inout) :: mass(:, :)
    integer :: i

    do i = 1, size(self%dependents)
      mass(:, self%masters(i)) = mass(:, self%masters(i)) + mass(:, self%dependents(i))
      mass(:, self%dependents(i)) = 0
    end do
  end subroutine fold_mass

  !> Stiffness of clamps and elastic edges at the points of the first layer, edges lumped like the mass.
  subroutine find_springs(model, self)
    type(model_t), intent(in) :: model
    type(nodal_inertia_t), intent(inout) :: self
    real(wp), allocatable :: field(:, :)
    integer :: i, k

    if (.not. (model%rig%elastic .or. allocated(model%rig%line_rig))) return
    allocate (self%springs(5, size(self%mass, 2)), source=0.0_wp)
    if (allocated(model%rig%line_rig)) then
      allocate (field(5, model%rig%line_borders%columns), source=0.0_wp)
      do i = 1, size(model%rig%line_rig)
        if (model%rig%line_rig(i) /= 0) cycle
        associate (component => model%rig%line_component(i), targets => model%rig%line_targets(:, i))
          do k = 1, 3
            field(component, targets(k)) = field(component, targets(k)) &
                                           + model%rig%line_stiffness(i)*model%rig%line_weights(k, i)
          end do
        end associate
      end do
      call model%rig%line_borders%add(field)
      self%springs = field(:, :size(self%springs, 2))
    end if
    if (model%rig%elastic) self%springs(1:3, :) = self%springs(1:3, :) + model%rig%springs
    call fold_mass(self, self%springs)
    self%sprung = pack([(i, i=1, size(self%springs, 2))], any(self%springs > 0, 1))
  end subroutine find_springs

  !> Computes the inverse for a step length, with the stiffness of springs times its square.
  pure subroutine invert(self, step_square)
    class(nodal_inertia_t), intent(inout) :: self
    real(wp), intent(in) :: step_square
    real(wp) :: added(5)
    integer :: i

    self%step_square = step_square
    added = 0
    do i = 1, size(self%mass, 2)
      if (allocated(self%springs)) added = step_square*self%springs(:, i)
      associate (m => self%mass(:, i), constrained => self%constrained(:, i), inverse => self%inverse(:, i))
        inverse(1:3) = inverse_block([m(1) + added(1), m(2), m(3) + added(4)], constrained([1, 4]))
        inverse(4:6) = inverse_block([m(1) + added(2), m(2), m(3) + added(5)], constrained([2, 5]))
        inverse(7) = 0
        if (m(4) > 0 .and. .not. constrained(3)) inverse(7) = 1/(m(4) + added(3))
      end associate
    end do
  end subroutine invert

  !> Adds the part of the spring forces that depends on the start of the step; the other part is in the inverse inertia.
  pure subroutine add_spring_forces(self, step, u, v, force)
    class(nodal_inertia_t), intent(in) :: self
    real(wp), intent(in) :: step
    real(wp), intent(in) :: u(:, :)
    real(wp), intent(in) :: v(:, :)
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: force(:, :)
    integer :: i, p

    do i = 1, size(self%sprung)
      p = self%sprung(i)
      force(:, p) = force(:, p) - self%springs(:, p)*(u(:, p) + step*v(:, p))
    end do
  end subroutine add_spring_forces

  !> Inverse of the inertia of displacement and rotation, without constrained unknowns.
  pure function inverse_block(mass, constrained) result(inverse)
    !> I0, I1, I2
    real(wp), intent(in) :: mass(3)
    !> True for constrained unknowns: displacement, rotation
    logical, intent(in) :: constrained(2)
    !> Entries of displacement, coupling, rotation
    real(wp) :: inverse(3)
    real(wp) :: determinant

    inverse = 0
    if (.not. mass(1) > 0) return
    determinant = mass(1)*mass(3) - mass(2)**2
    if (.not. any(constrained)) then
      inverse = [mass(3), -mass(2), mass(1)]/determinant
    else if (constrained(1) .and. .not. constrained(2)) then
      inverse(3) = 1/mass(3)
    else if (constrained(2) .and. .not. constrained(1)) then
      inverse(1) = 1/mass(1)
    end if
  end function inverse_block

  !> Inverse inertia of w at each point, as if images of a point moved independently: that of their master times the
  !> number of images, since images have the same inertia.
  pure function inverse_of_images(self) result(inverse)
    class(nodal_inertia_t), intent(in) :: self
    !> (points)
    real(wp) :: inverse(size(self%inverse, 2))
    integer :: images(size(inverse)), i

    images = 1
    do i = 1, size(self%dependents)
      images(self%masters(i)) = images(self%masters(i)) + 1
    end do
    inverse = images*self%inverse(along_z, :)
    inverse(self%dependents) = inverse(self%masters)
  end function inverse_of_images

  !> Adds forces on dependent points to those on their masters.
  pure subroutine fold(self, forces)
    class(nodal_inertia_t), intent(in) :: self
    !> Forces, (5, points); those on dependents become zero
    real(wp), intent(inout) :: forces(:, :)
    integer :: i

    do i = 1, size(self%dependents)
      associate (dependent => self%dependents(i), master => self%masters(i))
        forces(:, master) = forces(:, master) + self%signs(:, i)*forces(:, dependent)
        forces(:, dependent) = 0
      end associate
    end do
  end subroutine fold

  !> Sets the motion of dependent points to that of their masters.
  pure subroutine move_dependents(self, motion)
    class(nodal_inertia_t), intent(in) :: self
    !> Displacement or velocity, (5, points)
    real(wp), intent(inout) :: motion(:, :)
    integer :: i

    do i = 1, size(self%dependents)
      motion(:, self%dependents(i)) = self%signs(:, i)*motion(:, self%masters(i))
    end do
  end subroutine move_dependents
end module nodal_inertia
