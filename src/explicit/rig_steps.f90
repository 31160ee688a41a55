!> Rigs in steps by central differences: unilateral frames, clamps and elastic edges node by node, frames with a
!> circular window, reactions.
!>
!> A frame supports the lower face: it constrains w of the lowest layer of its nodes to w <= 0. The force of a clamp
!> acts on the same layer, so that clamp and frame are in equilibrium without pressure between the layers. Springs act
!> on the first layer; they are implicit, so that their stiffness does not limit the step.
!>
!> On the edge of a circular window w is constrained where the edge crosses the sides of cells, as a weighted mean of
!> three nodes each. The frame holds both faces, so that the layers of a node move together. The reactions at all of
!> these points are found together, from a constant matrix. A node that moves as the image of another one is replaced by
!> that one, whose inertia is that of both.
module rig_steps
  use archives, only: archive_t
  use dense_systems, only: pseudo_inverse
  use dependent_points, only: find_masters
  use exact_sums, only: exact_sum_t
  use field_mappings, only: area_field
  use interface_stacks, only: last_layer
  use kinds, only: wp
  use listed_points, only: listed_points_t
  use composite_plates, only: composite_plate_t
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use rank_totals, only: totals_of
  use rigs, only: crossing_t, circle_crossings
  use step_lengths, only: step_lengths_t
  use support_parameters, only: max_supports
  implicit none
  private
  public :: rig_steps_t, create_rig_steps, add_clamp_forces

  !> Support points of circular frames, the same list on every rank.
  type :: circle_frames_t
    !> Mesh points of the three nodes of each, (3, crossings)
    integer, allocatable :: points(:, :)
    !> The same in one list
    type(listed_points_t) :: list
    !> Weights of their w, (3, crossings)
    real(wp), allocatable :: weights(:, :)
    !> The rig of each
    integer, allocatable :: rig(:)
    !> Inverse inertia of w at the nodes, (3, crossings)
    real(wp), allocatable, private :: inverse(:, :)
    !> Forces at the points per deflection, (crossings, crossings)
    real(wp), allocatable, private :: stiffness(:, :)
    !> Forces of the last step
    real(wp), allocatable :: forces(:)
    !> True at the first points of this rank's nodes whose layers they hold together, (points)
    logical, allocatable :: holds(:)
  contains
    procedure :: prepare
    procedure :: constrain
  end type circle_frames_t

  !> State of frames and springs at the first points of this rank's nodes, (points) each.
  type :: rig_steps_t
    !> True at points on a frame
    logical, allocatable :: on_frame(:)
    !> Reaction of the frame in the last step, force, and change of w of the lowest layer in it
    real(wp), allocatable :: reaction(:), approach(:)
    !> Energy dissipated so far on frames, and algorithmic dissipation of implicit springs and of changes of the step
    !> length
    real(wp), allocatable :: frame_loss(:), step_loss(:)
    !> Points on circular windows
    type(circle_frames_t) :: circles
  contains
    procedure :: stop_at_frame
    procedure :: record_springs
    procedure :: reactions_of
    procedure :: visit
  end type rig_steps_t

contains

  !> Support points of the circular frames of a plate.
  function create_circle_frames(plate) result(self)
    type(composite_plate_t), intent(in) :: plate
    type(circle_frames_t) :: self
    type(crossing_t), allocatable :: crossings(:)
    integer :: i, k, cell, nodes(9)

    allocate (self%points(3, 0), self%weights(3, 0), self%rig(0))
    if (allocated(plate%setup%supports)) then
      do i = 1, size(plate%setup%supports)
        if (plate%setup%supports(i)%unilateral) cycle
        do cell = 1, product(plate%mesh%cells)
          crossings = circle_crossings(plate%mesh, plate%setup%supports(i), cell)
          nodes = plate%mesh%cell_nodes(cell)
          do k = 1, size(crossings)
            self%rig = [self%rig, i]
            self%points = reshape([self%points, plate%mesh%first_point(nodes(crossings(k)%nodes))], [3, size(self%rig)])
            self%weights = reshape([self%weights, crossings(k)%weights], [3, size(self%rig)])
          end do
        end do
      end do
    end if
    if (size(self%rig) > 0) call replace_dependents(plate, self%points)
    self%list%local = plate%distribution%local([self%points])
    where (self%list%local > plate%distribution%owned) self%list%local = 0
    allocate (self%holds(size(plate%distribution%points)), source=.false.)
    self%holds(pack(self%list%local, self%list%local > 0)) = .true.
    allocate (self%inverse(3, size(self%rig)), self%forces(size(self%rig)), source=0.0_wp)
  end function create_circle_frames

  !> Replaces points that move as images by those that determine their motion; w is the same at both. The masters in
  !> `nodal_inertia` are those of this rank's points only, the masters here those of all ranks.
  subroutine replace_dependents(plate, points)
    type(composite_plate_t), intent(in) :: plate
    !> Mesh points, (3, crossings)
    integer, intent(inout) :: points(:, :)
    integer :: master(plate%mesh%points()), i, k
    real(wp) :: signs(5, plate%mesh%points())
    logical :: fixed(5, plate%mesh%points())

    fixed = .false.
    call find_masters(plate%mesh, master, signs, fixed, plate%constraints%images)
    do i = 1, size(points, 2)
      do k = 1, size(points, 1)
        if (master(points(k, i)) > 0) points(k, i) = master(points(k, i))
      end do
    end do
  end subroutine replace_dependents

  !> Computes the matrix for an inertia. Collective.
  subroutine prepare(self, plate, inverse)
    class(circle_frames_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Inverse inertia of w of the layers, (points)
    real(wp), intent(in) :: inverse(:)
    real(wp) :: matrix(size(self%rig), size(self%rig)), scale(size(self%rig))
    integer :: i, j, k, l

    if (size(self%rig) == 0) return
    self%inverse = reshape(self%list%gathered(plate%communicator, inverse_of_nodes(plate%map%above, inverse)), &
                           shape(self%points))
    matrix = 0
    do j = 1, size(self%rig)
      do i = 1, size(self%rig)
        do k = 1, 3
          do l = 1, 3
            if (self%points(k, i) == self%points(l, j)) matrix(i, j) = matrix(i, j) &
              + self%weights(k, i)*self%inverse(k, i)*self%weights(l, j)
          end do
        end do
      end do
    end do
    ! The diagonal is scaled to 1. A point with three constrained nodes has a row of zeros and needs no force.
    scale = 0
    do j = 1, size(scale)
      if (matrix(j, j) > 0) scale(j) = 1/sqrt(matrix(j, j))
    end do
    do j = 1, size(scale)
      matrix(:, j) = scale*matrix(:, j)*scale(j)
      if (.not. scale(j) > 0) matrix(j, j) = 1
    end do
    self%stiffness = pseudo_inverse(matrix)
    do j = 1, size(scale)
      self%stiffness(:, j) = scale*self%stiffness(:, j)*scale(j)
    end do
  end subroutine prepare

  !> Inverse inertia of w of all layers of a node that move together, at its first point.
  pure function inverse_of_nodes(above, inverse) result(together)
    !> Point of the layer above each point; 0: none
    integer, intent(in) :: above(:)
    !> Inverse inertia of w of the layers, (points); 0 where a layer is fixed
    real(wp), intent(in) :: inverse(:)
    !> (points)
    real(wp) :: together(size(inverse))
    integer :: i, first(size(inverse))

    together = inverse
    do i = 1, size(inverse)
      first(i) = i
      if (above(i) == 0) cycle
      first(i) = first(above(i))
      associate (sum => together(first(i)))
        if (sum > 0 .and. inverse(i) > 0) then
          sum = sum*inverse(i)/(sum + inverse(i))
        else
          sum = 0
        end if
      end associate
    end do
  end function inverse_of_nodes

  !> Enforces zero deflection of the points at the end of a step. Collective.
  subroutine constrain(self, plate, steps, w, rate)
    !> The points; receive their forces
    class(circle_frames_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    type(step_lengths_t), intent(in) :: steps
    !> Deflection at the end of the step, and its rate, (points); corrected
    real(wp), intent(inout) :: w(:), rate(:)
    real(wp) :: change
    integer :: i, k

    if (size(self%rig) == 0) return
    self%forces = matmul(self%stiffness, sum(self%weights*reshape(self%list%gathered(plate%communicator, w), &
                                                                  shape(self%points)), 1))/(steps%now*steps%mean())
    do i = 1, size(self%rig)
      do k = 1, 3
        associate (p => self%list%local(3*i - 3 + k))
          if (p == 0) cycle
          change = -steps%mean()*self%inverse(k, i)*self%weights(k, i)*self%forces(i)
          rate(p) = rate(p) + change
          w(p) = w(p) + steps%now*change
        end associate
      end do
    end do
  end subroutine constrain

  !> Frames of a model.
  function create_rig_steps(model) result(self)
    type(model_t), intent(in) :: model
    type(rig_steps_t) :: self
    integer :: points

    points = size(model%plate%distribution%points)
    allocate (self%on_frame(points), source=.false.)
    if (model%rig%unilateral) self%on_frame = model%rig%frame > 0
    allocate (self%reaction(points), self%approach(points), self%frame_loss(points), self%step_loss(points), &
              source=0.0_wp)
    self%circles = create_circle_frames(model%plate)
  end function create_rig_steps

  !> Adds the forces of clamps to those on the lowest layers.
  pure subroutine add_clamp_forces(model, force)
    type(model_t), intent(in) :: model
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: force(:, :)
    integer :: i, lowest

    if (.not. model%rig%elastic) return
    do i = 1, model%plate%distribution%owned
      if (.not. model%rig%clamp_preload(i) > 0) cycle
      lowest = last_layer(model%plate%map%above, i)
      force(3, lowest) = force(3, lowest) + model%rig%clamp_preload(i)
    end do
  end subroutine add_clamp_forces

  !> Stops a layer that would penetrate its frame, and records the energy dissipated.
  pure subroutine stop_at_frame(self, p, steps, inverse, w, rate)
    class(rig_steps_t), intent(inout) :: self
    !> First point of the node
    integer, intent(in) :: p
    type(step_lengths_t), intent(in) :: steps
    !> Inverse inertia of w of the layer
    real(wp), intent(in) :: inverse
    !> Deflection at the start of the step
    real(wp), intent(in) :: w
    !> Its rate without the frame on entry, with it on return
    real(wp), intent(inout) :: rate
    real(wp) :: trial, reaction

    trial = rate
    if (w + steps%now*rate > 0) rate = -w/steps%now
    reaction = 0
    if (inverse > 0) reaction = (trial - rate)/(steps%mean()*inverse)
    if (.not. w + steps%now*trial > 0) reaction = 0
    self%frame_loss(p) = self%frame_loss(p) &
                         + steps%work(reaction, self%reaction(p), steps%now*rate, self%approach(p))
    self%reaction(p) = reaction
    self%approach(p) = steps%now*rate
  end subroutine stop_at_frame

  !> Records the work of springs in a step beyond their stored energy. With the force -k u at the end of the step of h,
  !> the sum of kinetic energy (`step_lengths`) and k u**2/2 decreases by k (h**2 (v_old + v) v/2 - h (h - h_old)
  !> (v_old**2 + v**2)/4), where the change of step length is recorded with the force -k (u_old + h v_old).
  pure subroutine record_springs(self, inertia, steps, before, after)
    class(rig_steps_t), intent(inout) :: self
    type(nodal_inertia_t), intent(in) :: inertia
    type(step_lengths_t), intent(in) :: steps
    !> Rates of the unknowns before the step, (5, points with springs), and after it, (5, points)
    real(wp), intent(in) :: before(:, :), after(:, :)
    integer :: i, p

    do i = 1, size(inertia%sprung)
      p = inertia%sprung(i)
      associate (old => before(:, i), new => after(:, p))
        self%step_loss(p) = self%step_loss(p) + steps%now/2*sum(inertia%springs(:, p)*( &
          steps%now*(old + new)*new - (steps%now - steps%last)/2*(old**2 + new**2)))
      end associate
    end do
  end subroutine record_springs

  !> Saves or loads.
  subroutine visit(self, archive, plate)
    class(rig_steps_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    type(composite_plate_t), intent(in) :: plate
    real(wp) :: fields(4, size(self%reaction))

    fields(1, :) = self%reaction
    fields(2, :) = self%approach
    fields(3, :) = self%frame_loss
    fields(4, :) = self%step_loss
    call plate%visit_points(archive, 'explicit/frames', fields, area_field)
    self%reaction = fields(1, :)
    self%approach = fields(2, :)
    self%frame_loss = fields(3, :)
    self%step_loss = fields(4, :)
  end subroutine visit

  !> Reaction of each rig on the full plate, positive against the impact: forces at constrained deflections, reactions
  !> of frames, springs and clamps. Collective.
  function reactions_of(self, model, force, displacement) result(reactions)
    class(rig_steps_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> Forces on the layers without tractions, and unknowns, (5, points)
    real(wp), intent(in) :: force(:, :), displacement(:, :)
    !> 0 for rigs that the deck does not have
    real(wp) :: reactions(max_supports)
    type(exact_sum_t) :: sums(max_supports)
    integer :: i, layer

    reactions = 0
    if (.not. allocated(model%rig%constrained_by)) return
    do i = 1, model%plate%distribution%owned
      associate (constrained_by => model%rig%constrained_by(i), on_frame => model%rig%frame(i), &
                 clamps => model%rig%clamps(i))
        if (constrained_by > 0) then
          do layer = i, last_layer(model%plate%map%above, i)
            call sums(constrained_by)%add(force(3, layer))
          end do
        else
          if (on_frame > 0) call sums(on_frame)%add(self%reaction(i))
          if (clamps > 0) &
            call sums(clamps)%add(model%rig%springs(3, i)*displacement(3, i) - model%rig%clamp_preload(i))
        end if
      end associate
    end do
    reactions = totals_of(model%plate%communicator, sums)
    do i = 1, size(self%circles%rig)
      associate (rig => self%circles%rig(i))
        reactions(rig) = reactions(rig) + self%circles%forces(i)
      end associate
    end do
    reactions = reactions*model%plate%mesh%multiplicity
  end function reactions_of
end module rig_steps
