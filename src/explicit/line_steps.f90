!> Lines in steps by central differences: lines with a force add it to their layers, lines with a displacement prescribe
!> the velocity of a layer at each node.
!>
!> A line prescribes one component of a layer's motion, u + z theta_x at the middle of the layer, v + z theta_y, w or a
!> rotation: c v = q. The inverse inertia of the layer is projected, M^-1 - M^-1 c c^T M^-1/(c^T M^-1 c), so that forces
!> do not change the component, and the velocity is corrected along M^-1 c. The reaction follows from the momentum
!> balance of the layer.
module line_steps
  use archives, only: archive_t
  use exact_sums, only: exact_sum_t
  use field_mappings, only: vector_fields
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use nodal_inertia, only: along_x, along_y, nodal_inertia_t
  use rank_totals, only: totals_of
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: line_steps_t, create_line_steps

  !> The lines of a model, and the motion of supports with a displacement at the start.
  type :: line_steps_t
    !> Points with prescribed components
    integer, allocatable :: points(:)
    !> Line that prescribes a component; 0: a support that moves; -1: none, (5, points)
    integer, allocatable :: line(:, :)
    !> Height at which u or v is prescribed, and rate of the component in the step, (5, points)
    real(wp), allocatable, private :: height(:, :), rate(:, :)
    !> Velocities of displacement and rotation, or of w, per unit velocity of the component, (2, 5, points)
    real(wp), allocatable, private :: gain(:, :, :)
    !> Difference between the component and its prescribed value at the start of the run, (5, points)
    real(wp), allocatable, private :: offset(:, :)
    !> Reaction in the last step, and change of the component in it, (5, points)
    real(wp), allocatable :: reaction(:, :), change(:, :)
    !> Work of the lines so far, (points)
    real(wp), allocatable :: work(:)
  contains
    procedure :: project
    procedure :: start_from
    procedure :: find_rates
    procedure :: prescribe
    procedure :: react
    procedure :: add_forces
    procedure :: totals
    procedure :: visit
  end type line_steps_t

contains

  !> The lines of a model.
  function create_line_steps(model, inertia) result(self)
    type(model_t), intent(in) :: model
    type(nodal_inertia_t), intent(in) :: inertia
    type(line_steps_t) :: self
    integer :: line, node, points

    points = size(inertia%is_dependent)
    allocate (self%line(5, points), source=-1)
    allocate (self%height(5, points), self%rate(5, points), self%gain(2, 5, points), self%offset(5, points), &
              self%reaction(5, points), self%change(5, points), self%work(points), source=0.0_wp)
    do line = 1, size(model%loads%lines)
      associate (its => model%loads%lines(line), k => model%loads%lines(line)%load%component)
        if (.not. its%load%prescribed) cycle
        do node = 1, size(its%weight)
          associate (p => its%point(its%first(node)))
            if (inertia%is_dependent(p) .or. inertia%constrained(k, p)) cycle
            self%line(k, p) = line
            if (k <= 2) self%height(k, p) = its%height(node)
          end associate
        end do
      end associate
    end do
    call list_points(self)
  end function create_line_steps

  !> Lists the points with prescribed components.
  pure subroutine list_points(self)
    type(line_steps_t), intent(inout) :: self
    integer :: p

    self%points = pack([(p, p=1, size(self%work))], any(self%line >= 0, 1))
  end subroutine list_points

  !> Projects the prescribed components out of the inverse inertia, of each layer displacements before rotations: the
  !> moment of a line that rotates a layer excludes the moments of the forces of lines that displace it at its middle.
  pure subroutine project(self, inverse)
    class(line_steps_t), intent(inout) :: self
    !> Inverse inertia, (7, points)
    real(wp), intent(inout) :: inverse(:, :)
    real(wp) :: direction(2), compliance
    integer :: i, k, from

    do i = 1, size(self%points)
      do k = 1, 5
        associate (m => inverse(:, self%points(i)), gain => self%gain(:, k, self%points(i)))
          if (self%line(k, self%points(i)) < 0) cycle
          gain = [1.0_wp, 0.0_wp]
          if (k == 3) then
            m(7) = 0
            cycle
          end if
          from = merge(along_x, along_y, k == 1 .or. k == 4)
          direction = merge([1.0_wp, self%height(k, self%points(i))], [0.0_wp, 1.0_wp], k <= 2)
          gain = [m(from)*direction(1) + m(from + 1)*direction(2), m(from + 1)*direction(1) + m(from + 2)*direction(2)]
          compliance = dot_product(gain, direction)
          if (.not. compliance > 0) then
            ! Supported components move only as prescribed.
            gain = merge([1.0_wp, 0.0_wp], [0.0_wp, 1.0_wp], k <= 2)
            cycle
          end if
          m(from:from + 2) = m(from:from + 2) - [gain(1)**2, product(gain), gain(2)**2]/compliance
          gain = gain/compliance
        end associate
      end do
    end do
  end subroutine project

  !> Sets the motion from which the prescribed one starts: lines and supports move from there to their prescribed
  !> positions. Supported components with a non-zero value are prescribed, too.
  subroutine start_from(self, model, inertia, motion)
    class(line_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(nodal_inertia_t), intent(in) :: inertia
    real(wp), intent(in) :: motion(:, :)
    logical :: supported(5, size(motion, 2))
    integer :: i, k

    supported = inertia%constrained .and. abs(motion) > 0
    supported(:, inertia%dependents) = .false.
    supported(:, model%plate%distribution%owned + 1:) = .false.
    call add_supported(self, supported)
    do i = 1, size(self%points)
      associate (p => self%points(i))
        self%offset(:, p) = components_of(self, p, motion(:, p))
        do k = 1, 5
          associate (line => self%line(k, p))
            if (line > 0) self%offset(k, p) = self%offset(k, p) - model%loads%lines(line)%load%at_factor(0.0_wp)
            if (line < 0) self%offset(k, p) = 0
          end associate
        end do
      end associate
    end do
  end subroutine start_from

  !> Adds supported components to the prescribed ones.
  pure subroutine add_supported(self, supported)
    type(line_steps_t), intent(inout) :: self
    !> True for those to be added, (5, points)
    logical, intent(in) :: supported(:, :)

    where (supported .and. self%line < 0) self%line = 0
    call list_points(self)
  end subroutine add_supported

  !> Computes the rates by which each component has its prescribed value at the end of the step.
  pure subroutine find_rates(self, model, steps, load_factor, left, motion)
    class(line_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    type(step_lengths_t), intent(in) :: steps
    !> Ramps over their full values at the end of the step
    real(wp), intent(in) :: load_factor
    !> Fraction of the initial offsets that remains at the end of the step
    real(wp), intent(in) :: left
    !> Motion of the layers at the start of the step, (5, points)
    real(wp), intent(in) :: motion(:, :)
    real(wp) :: values(5)
    integer :: i, k

    do i = 1, size(self%points)
      associate (p => self%points(i))
        values = left*self%offset(:, p)
        do k = 1, 5
          if (self%line(k, p) > 0) &
            values(k) = values(k) + model%loads%lines(self%line(k, p))%load%at_factor(load_factor)
        end do
        self%rate(:, p) = (values - components_of(self, p, motion(:, p)))/steps%now
      end associate
    end do
  end subroutine find_rates

  !> Components of a layer's motion, u and v at the heights where they are prescribed.
  pure function components_of(self, p, motion) result(components)
    type(line_steps_t), intent(in) :: self
    integer, intent(in) :: p
    !> Motion or velocity of the layer
    real(wp), intent(in) :: motion(5)
    real(wp) :: components(5)

    components = motion
    components(:2) = motion(:2) + self%height(:2, p)*motion(4:)
  end function components_of

  !> Sets the prescribed velocity of the layer of a point.
  pure subroutine prescribe(self, p, velocity)
    class(line_steps_t), intent(in) :: self
    integer, intent(in) :: p
    !> Velocity of its layer
    real(wp), intent(inout) :: velocity(5)
    real(wp) :: missing(5)
    integer :: k, from

    do k = 1, 5
      if (self%line(k, p) < 0) cycle
      missing = self%rate(:, p) - components_of(self, p, velocity)
      from = merge(k, k - 3, k < 3)
      if (k == 3) then
        velocity(3) = self%rate(3, p)
      else
        velocity([from, from + 3]) = velocity([from, from + 3]) + self%gain(:, k, p)*missing(k)
      end if
    end do
  end subroutine prescribe

  !> Records the reactions on a point: change of the momentum of its layer minus the impulse of the other forces.
  pure subroutine react(self, p, steps, mass, before, after, force)
    class(line_steps_t), intent(inout) :: self
    integer, intent(in) :: p
    type(step_lengths_t), intent(in) :: steps
    !> Inertia of the layer
    real(wp), intent(in) :: mass(4)
    !> Velocities of the layer before and after, and the other forces on it
    real(wp), intent(in) :: before(5), after(5), force(5)
    real(wp) :: gained(5), missing(5), change(5)
    integer :: k

    gained = (after - before)/steps%mean()
    missing = [mass(1)*gained(1:2) + mass(2)*gained(4:5), mass(4)*gained(3), &
               mass(2)*gained(1:2) + mass(3)*gained(4:5)] - force
    where (self%line(:2, p) >= 0) missing(4:) = missing(4:) - self%height(:2, p)*missing(:2)
    change = steps%now*components_of(self, p, after)
    do k = 1, 5
      if (self%line(k, p) < 0) cycle
      self%work(p) = self%work(p) + steps%work(missing(k), self%reaction(k, p), change(k), self%change(k, p))
      self%reaction(k, p) = missing(k)
      self%change(k, p) = change(k)
    end do
  end subroutine react

  !> Adds the forces of lines with a force, and their work in a step by the mean of the forces at its ends.
  pure subroutine add_forces(self, model, load_factors, change, forces)
    class(line_steps_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Ramps over their full values at the start and at the end of the step
    real(wp), intent(in) :: load_factors(2)
    !> Change of the motion of the layers in the step, (5, points)
    real(wp), intent(in) :: change(:, :)
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: forces(:, :)
    real(wp) :: values(2), share, moved
    integer :: line, node

    do line = 1, size(model%loads%lines)
      associate (its => model%loads%lines(line))
        if (its%load%prescribed) cycle
        values = its%load%at_factor(load_factors)
        do node = 1, size(its%weight)
          share = its%share*its%weight(node)
          associate (p => its%point(its%first(node)), k => its%load%component)
            forces(k, p) = forces(k, p) + share*values(2)
            if (k <= 2) forces(k + 3, p) = forces(k + 3, p) + its%height(node)*share*values(2)
            moved = change(k, p)
            if (k <= 2) moved = moved + its%height(node)*change(k + 3, p)
            self%work(p) = self%work(p) + share*sum(values)/2*moved
          end associate
        end do
      end associate
    end do
  end subroutine add_forces

  !> Force of each line on the full plate. Collective.
  function totals(self, model) result(forces)
    class(line_steps_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Reactions of lines that prescribe motion, 0 for others
    real(wp) :: forces(size(model%loads%lines))
    type(exact_sum_t) :: sums(size(model%loads%lines))
    integer :: i, k

    do i = 1, size(self%points)
      do k = 1, 5
        associate (line => self%line(k, self%points(i)))
          if (line > 0) call sums(line)%add(self%reaction(k, self%points(i))/model%loads%lines(line)%share)
        end associate
      end do
    end do
    forces = totals_of(model%plate%communicator, sums)
  end function totals

  !> Saves or loads reactions, changes, work and offsets. Those of supports show which of their components move.
  subroutine visit(self, archive, plate)
    class(line_steps_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp) :: fields(16, size(self%work))
    integer :: k

    fields(:5, :) = self%reaction
    fields(6:10, :) = self%change
    fields(11, :) = self%work
    fields(12:, :) = self%offset
    call plate%visit_points(archive, 'explicit/lines', fields, vector_fields([1, 4, 6, 9, 12, 15]))
    if (archive%loading) call add_supported(self, abs(fields(12:, :)) > 0)
    ! Values mapped from another mesh also lie beside the lines.
    do k = 1, 5
      self%reaction(k, :) = merge(fields(k, :), 0.0_wp, self%line(k, :) >= 0)
      self%change(k, :) = merge(fields(k + 5, :), 0.0_wp, self%line(k, :) >= 0)
      self%offset(k, :) = merge(fields(k + 11, :), 0.0_wp, self%line(k, :) >= 0)
    end do
    self%work = fields(11, :)
  end subroutine visit
end module line_steps
