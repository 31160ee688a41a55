!> Frames with a circular window in steps by central differences: w is constrained where the edge of the window crosses
!> the sides of cells, as a weighted mean of three nodes each. The frame holds both faces, so that the layers of a node
!> move together. The reactions at all of these points are found together, from a constant matrix. A node that moves as
!> the image of another one is replaced by that one, whose inertia is that of both.
module circle_frames
  use dense_systems, only: pseudo_inverse
  use dependent_points, only: find_masters
  use kinds, only: wp
  use models, only: model_t
  use rigs, only: crossing_t, circle_crossings
  use step_lengths, only: step_lengths_t
  implicit none
  private
  public :: circle_frames_t, create_circle_frames

  !> Support points of circular frames, the same list on every rank.
  type :: circle_frames_t
    !> Mesh points of the three nodes of each, (3, crossings), and their indices on this rank; 0: on another rank
    integer, allocatable :: points(:, :), local(:, :)
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
  contains
    procedure :: prepare
    procedure :: constrain
  end type circle_frames_t

contains

  !> Support points of the circular frames of a model.
  function create_circle_frames(model) result(self)
    type(model_t), intent(in) :: model
    type(circle_frames_t) :: self
    type(crossing_t), allocatable :: crossings(:)
    integer :: i, k, cell, nodes(9)

    allocate (self%points(3, 0), self%weights(3, 0), self%rig(0))
    if (allocated(model%setup%supports)) then
      do i = 1, size(model%setup%supports)
        if (model%setup%supports(i)%unilateral) cycle
        do cell = 1, product(model%mesh%cells)
          crossings = circle_crossings(model%mesh, model%setup%supports(i), cell)
          nodes = model%mesh%cell_nodes(cell)
          do k = 1, size(crossings)
            self%rig = [self%rig, i]
            self%points = reshape([self%points, model%mesh%first_point(nodes(crossings(k)%nodes))], [3, size(self%rig)])
            self%weights = reshape([self%weights, crossings(k)%weights], [3, size(self%rig)])
          end do
        end do
      end do
    end if
    if (size(self%rig) > 0) call replace_dependents(model, self%points)
    self%local = reshape(model%distribution%local([self%points]), shape(self%points))
    where (self%local > model%distribution%owned) self%local = 0
    allocate (self%inverse(3, size(self%rig)), self%forces(size(self%rig)), source=0.0_wp)
  end function create_circle_frames

  !> Replaces points that move as images by those that determine their motion; w is the same at both. The masters in
  !> `nodal_inertia` are those of this rank's points only, the masters here those of all ranks.
  subroutine replace_dependents(model, points)
    type(model_t), intent(in) :: model
    !> Mesh points, (3, crossings)
    integer, intent(inout) :: points(:, :)
    integer :: master(model%mesh%points()), i, k
    real(wp) :: signs(5, model%mesh%points())
    logical :: fixed(5, model%mesh%points())

    fixed = .false.
    call find_masters(model%mesh, master, signs, fixed, model%images)
    do i = 1, size(points, 2)
      do k = 1, size(points, 1)
        if (master(points(k, i)) > 0) points(k, i) = master(points(k, i))
      end do
    end do
  end subroutine replace_dependents

  !> Computes the matrix for an inertia. Collective.
  subroutine prepare(self, model, inverse)
    class(circle_frames_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Inverse inertia of w of the layers, (points)
    real(wp), intent(in) :: inverse(:)
    real(wp) :: matrix(size(self%rig), size(self%rig)), scale(size(self%rig))
    integer :: i, j, k, l

    if (size(self%rig) == 0) return
    self%inverse = gathered(self, model, inverse_of_nodes(model%map%above, inverse))
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

  !> Values at the nodes of all points, the same on every rank. Collective.
  function gathered(self, model, values)
    type(circle_frames_t), intent(in) :: self
    type(model_t), intent(in) :: model
    !> (points)
    real(wp), intent(in) :: values(:)
    !> (3, crossings)
    real(wp) :: gathered(3, size(self%rig))
    real(wp) :: list(3*size(self%rig))
    integer :: i, k

    gathered = 0
    do i = 1, size(self%rig)
      do k = 1, 3
        if (self%local(k, i) > 0) gathered(k, i) = values(self%local(k, i))
      end do
    end do
    list = reshape(gathered, [size(list)])
    call model%communicator%sum(list)
    gathered = reshape(list, shape(gathered))
  end function gathered

  !> Enforces zero deflection of the points at the end of a step. Collective.
  subroutine constrain(self, model, steps, w, rate)
    !> The points; receive their forces
    class(circle_frames_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> The step and the one before
    type(step_lengths_t), intent(in) :: steps
    !> Deflection at the end of the step, and its rate, (points); corrected
    real(wp), intent(inout) :: w(:), rate(:)
    real(wp) :: change
    integer :: i, k

    if (size(self%rig) == 0) return
    self%forces = matmul(self%stiffness, sum(self%weights*gathered(self, model, w), 1))/(steps%now*steps%mean())
    do i = 1, size(self%rig)
      do k = 1, 3
        if (self%local(k, i) == 0) cycle
        change = -steps%mean()*self%inverse(k, i)*self%weights(k, i)*self%forces(i)
        rate(self%local(k, i)) = rate(self%local(k, i)) + change
        w(self%local(k, i)) = w(self%local(k, i)) + steps%now*change
      end do
    end do
  end subroutine constrain
end module circle_frames
