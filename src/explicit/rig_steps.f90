!> Unilateral frames, clamps and elastic edges in a step, node by node.
!>
!> A frame supports the lower face: it constrains w of the lowest layer of its nodes to w <= 0. The force of a clamp
!> acts on the same layer, so that clamp and frame are in equilibrium without pressure between the layers. Springs act
!> on the first layer; they are implicit, so that their stiffness does not limit the step.
module rig_steps
  use archives, only: archive_t
  use interface_stacks, only: last_layer
  use kinds, only: wp
  use models, only: model_t
  use nodal_inertia, only: nodal_inertia_t
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: rig_steps_t, create_rig_steps, add_clamp_forces

  !> State of frames and springs at the first points of this rank's nodes, (points) each.
  type :: rig_steps_t
    !> True at points on a frame
    logical, allocatable :: on_frame(:)
    !> Reaction of the frame in the last step, force, and change of w of the lowest layer in it
    real(wp), allocatable :: reaction(:), approach(:)
    !> Energy dissipated so far on frames, and algorithmic dissipation of implicit springs and of changes of the step
    !> length
    real(wp), allocatable :: frame_loss(:), step_loss(:)
  contains
    procedure :: stop_at_frame
    procedure :: add_spring_forces
    procedure :: record_springs
    procedure :: visit
  end type rig_steps_t

contains

  !> Frames of a model.
  pure function create_rig_steps(model) result(self)
    type(model_t), intent(in) :: model
    type(rig_steps_t) :: self
    integer :: points

    points = size(model%distribution%points)
    allocate (self%on_frame(points), source=.false.)
    if (model%rig%unilateral) self%on_frame = model%rig%frame > 0
    allocate (self%reaction(points), self%approach(points), self%frame_loss(points), self%step_loss(points), &
              source=0.0_wp)
  end function create_rig_steps

  !> Adds the forces of clamps to those on the lowest layers.
  pure subroutine add_clamp_forces(model, force)
    type(model_t), intent(in) :: model
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: force(:, :)
    integer :: i, lowest

    if (.not. model%rig%elastic) return
    do i = 1, model%distribution%owned
      if (.not. model%rig%clamp_preload(i) > 0) cycle
      lowest = last_layer(model%map%above, i)
      force(3, lowest) = force(3, lowest) + model%rig%clamp_preload(i)
    end do
  end subroutine add_clamp_forces

  !> Stops a layer that would penetrate its frame, and records the energy dissipated.
  pure subroutine stop_at_frame(self, p, steps, inverse, w, rate)
    class(rig_steps_t), intent(inout) :: self
    !> First point of the node
    integer, intent(in) :: p
    !> The step and the one before
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
                         + reaction*(steps%now*rate + steps%shift(self%approach(p), steps%now*rate)) &
                         + (reaction - self%reaction(p))*self%approach(p)/2
    self%reaction(p) = reaction
    self%approach(p) = steps%now*rate
  end subroutine stop_at_frame

  !> Adds the part of the spring forces that depends on the start of the step; the other part is in the inverse inertia.
  pure subroutine add_spring_forces(self, inertia, steps, u, v, force)
    class(rig_steps_t), intent(in) :: self
    !> The springs
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Unknowns and their rates, (5, points)
    real(wp), intent(in) :: u(:, :), v(:, :)
    !> Forces on the layers, (5, points)
    real(wp), intent(inout) :: force(:, :)
    integer :: i, p

    do i = 1, size(inertia%sprung)
      p = inertia%sprung(i)
      force(:, p) = force(:, p) - inertia%springs(:, p)*(u(:, p) + steps%now*v(:, p))
    end do
  end subroutine add_spring_forces

  !> Records the work of springs in a step beyond their stored energy. With the force -k u at the end of the step of h,
  !> the sum of kinetic energy (`step_lengths`) and k u**2/2 decreases by k (h**2 (v_old + v) v/2 - h (h - h_old)
  !> (v_old**2 + v**2)/4), where the change of step length is recorded with the force -k (u_old + h v_old).
  pure subroutine record_springs(self, inertia, steps, before, after)
    class(rig_steps_t), intent(inout) :: self
    !> The springs
    type(nodal_inertia_t), intent(in) :: inertia
    !> The step and the one before
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
  subroutine visit(self, archive, owned, points)
    class(rig_steps_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    !> Points of the mesh that this rank owns, and all points
    integer, intent(in) :: owned(:), points
    real(wp) :: fields(4, size(self%reaction))

    fields(1, :) = self%reaction
    fields(2, :) = self%approach
    fields(3, :) = self%frame_loss
    fields(4, :) = self%step_loss
    call archive%field('explicit/frames', owned, points, fields)
    self%reaction = fields(1, :)
    self%approach = fields(2, :)
    self%frame_loss = fields(3, :)
    self%step_loss = fields(4, :)
  end subroutine visit
end module rig_steps
