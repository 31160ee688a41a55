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
  use nodal_inertia, only: nodal_inertia_t
  use rank_totals, only: totals_of
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: line_steps_t, create_line_steps

  !> A prescribed component of a layer's motion.
  type :: prescribed_dof_t
    !> Point of the layer, and the line
    integer :: point = 0, line = 0
    !> Component of the motion, 1 to 5
    integer :: component = 0
    !> Height at which it is prescribed
    real(wp) :: height = 0
    !> Velocities of displacement and rotation, or of w, per unit velocity of the component
    real(wp) :: gain(2) = 0
    !> Rate in the step
    real(wp) :: rate = 0
    !> Difference between the component and its prescribed value at the start of the run
    real(wp) :: offset = 0
    !> Reaction in the last step, and change of the component in it
    real(wp) :: reaction = 0, change = 0
  end type prescribed_dof_t

  !> The lines of a model.
  type :: line_steps_t
    !> Prescribed components, sorted by point and component
    type(prescribed_dof_t), allocatable :: dofs(:)
    !> First prescribed component of each point, (points + 1)
    integer, allocatable, private :: first(:)
    !> Work of the lines so far, (points)
    real(wp), allocatable :: work(:)
  contains
    procedure :: is_prescribed
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
    type(prescribed_dof_t), allocatable :: dofs(:)
    integer :: line, node, p

    allocate (dofs(0), self%work(size(inertia%is_dependent)), self%first(size(inertia%is_dependent) + 1))
    self%work = 0
    do line = 1, size(model%loads%lines)
      associate (its => model%loads%lines(line))
        if (.not. its%load%prescribed) cycle
        do node = 1, size(its%weight)
          p = its%point(its%first(node))
          if (inertia%is_dependent(p) .or. inertia%constrained(its%load%component, p)) cycle
          dofs = [dofs, prescribed_dof_t(point=p, line=line, component=its%load%component, &
                              height=merge(its%height(node), 0.0_wp, its%load%component <= 2))]
        end do
      end associate
    end do
    call sort_dofs(self, dofs)
  end function create_line_steps

  !> True: a component of a point is prescribed.
  pure logical function is_prescribed(self, p)
    class(line_steps_t), intent(in) :: self
    !> The point
    integer, intent(in) :: p

    is_prescribed = self%first(p + 1) > self%first(p)
  end function is_prescribed

  !> Projects the prescribed components out of the inverse inertia.
  pure subroutine project(self, inverse)
    class(line_steps_t), intent(inout) :: self
    !> Inverse inertia, (7, points)
    real(wp), intent(inout) :: inverse(:, :)
    real(wp) :: direction(2), compliance
    integer :: i, from

    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i), m => inverse(:, self%dofs(i)%point))
        if (dof%component == 3) then
          dof%gain = [1.0_wp, 0.0_wp]
          m(7) = 0
          cycle
        end if
        from = merge(1, 4, dof%component == 1 .or. dof%component == 4)
        direction = merge([1.0_wp, dof%height], [0.0_wp, 1.0_wp], dof%component <= 2)
        dof%gain = [m(from)*direction(1) + m(from + 1)*direction(2), &
                    m(from + 1)*direction(1) + m(from + 2)*direction(2)]
        compliance = dot_product(dof%gain, direction)
        if (.not. compliance > 0) then
          ! Supported components move only as prescribed.
          dof%gain = merge([1.0_wp, 0.0_wp], [0.0_wp, 1.0_wp], dof%component <= 2)
          cycle
        end if
        m(from:from + 2) = m(from:from + 2) - [dof%gain(1)**2, product(dof%gain), dof%gain(2)**2]/compliance
        dof%gain = dof%gain/compliance
      end associate
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
    integer :: i

    supported = inertia%constrained .and. abs(motion) > 0
    supported(:, inertia%dependents) = .false.
    supported(:, model%plate%distribution%owned + 1:) = .false.
    call add_supported(self, supported)
    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i))
        dof%offset = component_of(dof, motion(:, dof%point))
        if (dof%line > 0) dof%offset = dof%offset - model%loads%lines(dof%line)%load%at_factor(0.0_wp)
      end associate
    end do
  end subroutine start_from

  !> Sorts prescribed components by point, displacements before rotations: the moment of a line that rotates a layer
  !> excludes the moments of the forces of lines that displace the layer at its middle.
  pure subroutine sort_dofs(self, dofs)
    class(line_steps_t), intent(inout) :: self
    !> Prescribed components, in any order
    type(prescribed_dof_t), intent(in) :: dofs(:)
    integer :: order(size(dofs)), component, i, p

    self%first = 1
    do i = 1, size(dofs)
      self%first(dofs(i)%point + 1:) = self%first(dofs(i)%point + 1:) + 1
    end do
    order = 0
    do component = 1, 5
      do i = 1, size(dofs)
        if (dofs(i)%component /= component) cycle
        p = self%first(dofs(i)%point)
        do while (order(p) > 0)
          p = p + 1
        end do
        order(p) = i
      end do
    end do
    self%dofs = dofs(order)
  end subroutine sort_dofs

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
    real(wp) :: value
    integer :: i

    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i))
        value = left*dof%offset
        if (dof%line > 0) value = value + model%loads%lines(dof%line)%load%at_factor(load_factor)
        dof%rate = (value - component_of(dof, motion(:, dof%point)))/steps%now
      end associate
    end do
  end subroutine find_rates

  !> The prescribed component of a layer's motion.
  pure real(wp) function component_of(dof, motion) result(value)
    type(prescribed_dof_t), intent(in) :: dof
    !> Motion or velocity of the layer
    real(wp), intent(in) :: motion(5)

    value = motion(dof%component)
    if (dof%component <= 2) value = value + dof%height*motion(dof%component + 3)
  end function component_of

  !> Sets the prescribed velocity of the layer of a point.
  pure subroutine prescribe(self, p, velocity)
    class(line_steps_t), intent(in) :: self
    !> The point
    integer, intent(in) :: p
    !> Velocity of its layer
    real(wp), intent(inout) :: velocity(5)
    real(wp) :: missing
    integer :: i, k

    do i = self%first(p), self%first(p + 1) - 1
      associate (dof => self%dofs(i))
        missing = dof%rate - component_of(dof, velocity)
        k = dof%component
        if (k == 3) then
          velocity(3) = dof%rate
        else
          if (k > 3) k = k - 3
          velocity([k, k + 3]) = velocity([k, k + 3]) + dof%gain*missing
        end if
      end associate
    end do
  end subroutine prescribe

  !> Records the reactions on a point: change of the momentum of its layer minus the impulse of the other forces.
  pure subroutine react(self, p, steps, mass, before, after, force)
    class(line_steps_t), intent(inout) :: self
    !> The point
    integer, intent(in) :: p
    type(step_lengths_t), intent(in) :: steps
    !> Inertia of the layer
    real(wp), intent(in) :: mass(4)
    !> Velocities of the layer before and after, and the other forces on it
    real(wp), intent(in) :: before(5), after(5), force(5)
    real(wp) :: gained(5), missing(5), reaction, change
    integer :: i

    gained = (after - before)/steps%mean()
    missing = [mass(1)*gained(1:2) + mass(2)*gained(4:5), mass(4)*gained(3), &
               mass(2)*gained(1:2) + mass(3)*gained(4:5)] - force
    do i = self%first(p), self%first(p + 1) - 1
      associate (dof => self%dofs(i))
        reaction = missing(dof%component)
        if (dof%component <= 2) missing(dof%component + 3) = missing(dof%component + 3) - dof%height*reaction
        change = steps%now*component_of(dof, after)
        self%work(p) = self%work(p) + steps%work(reaction, dof%reaction, change, dof%change)
        dof%reaction = reaction
        dof%change = change
      end associate
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
    real(wp) :: values(2), share
    integer :: line, node
    type(prescribed_dof_t) :: place

    do line = 1, size(model%loads%lines)
      associate (its => model%loads%lines(line))
        if (its%load%prescribed) cycle
        values = its%load%at_factor(load_factors)
        do node = 1, size(its%weight)
          place = prescribed_dof_t(point=its%point(its%first(node)), component=its%load%component, &
                        height=merge(its%height(node), 0.0_wp, its%load%component <= 2))
          share = its%share*its%weight(node)
          associate (p => place%point, k => place%component)
            forces(k, p) = forces(k, p) + share*values(2)
            if (k <= 2) forces(k + 3, p) = forces(k + 3, p) + place%height*share*values(2)
            self%work(p) = self%work(p) + share*sum(values)/2*component_of(place, change(:, p))
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
    integer :: i

    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i))
        if (dof%line > 0) call sums(dof%line)%add(dof%reaction/model%loads%lines(dof%line)%share)
      end associate
    end do
    forces = totals_of(model%plate%communicator, sums)
  end function totals

  !> Saves or loads reactions, changes and work.
  subroutine visit(self, archive, plate)
    class(line_steps_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp) :: fields(16, size(self%work))
    integer :: i

    fields = 0
    fields(11, :) = self%work
    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i))
        fields(dof%component, dof%point) = dof%reaction
        fields(dof%component + 5, dof%point) = dof%change
        fields(dof%component + 11, dof%point) = dof%offset
      end associate
    end do
    call plate%visit_points(archive, 'explicit/lines', fields, vector_fields([1, 4, 6, 9, 12, 15]))
    self%work = fields(11, :)
    if (archive%loading) call add_offset(self, fields(12:, :))
    do i = 1, size(self%dofs)
      associate (dof => self%dofs(i))
        dof%reaction = fields(dof%component, dof%point)
        dof%change = fields(dof%component + 5, dof%point)
        dof%offset = fields(dof%component + 11, dof%point)
      end associate
    end do
  end subroutine visit

  !> Adds the supported components with an offset to the prescribed components.
  pure subroutine add_offset(self, offsets)
    type(line_steps_t), intent(inout) :: self
    !> Offset of each component, (5, points)
    real(wp), intent(in) :: offsets(:, :)
    logical :: missing(5, size(offsets, 2))
    integer :: i

    missing = abs(offsets) > 0
    do i = 1, size(self%dofs)
      missing(self%dofs(i)%component, self%dofs(i)%point) = .false.
    end do
    call add_supported(self, missing)
  end subroutine add_offset

  !> Adds supported components to the prescribed ones.
  pure subroutine add_supported(self, supported)
    type(line_steps_t), intent(inout) :: self
    !> True for those to be added, (5, points)
    logical, intent(in) :: supported(:, :)
    type(prescribed_dof_t), allocatable :: dofs(:)
    integer :: p, component

    dofs = self%dofs
    do p = 1, size(supported, 2)
      do component = 1, 5
        if (supported(component, p)) dofs = [dofs, prescribed_dof_t(point=p, component=component)]
      end do
    end do
    call sort_dofs(self, dofs)
  end subroutine add_supported
end module line_steps
