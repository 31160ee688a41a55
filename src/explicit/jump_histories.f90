!> Data of earlier steps required for the motion of jumps, and the energy dissipated at the jumps.
module jump_histories
  use archives, only: archive_t
  use kinds, only: wp
  implicit none
  private
  public :: jump_history_t, friction_history_t, create_jump_history

  !> Data of earlier steps of the friction at a point, for its heat.
  type :: friction_history_t
    !> Number of further steps whose forces depend on the last slip
    integer :: steps = 0
    !> Change of the elastic energy of sticking surfaces in the last step, per area
    real(wp) :: stored = 0
    !> Negative heat of earlier steps, which is subtracted from later heat, per area
    real(wp) :: deficit = 0
  end type friction_history_t

  !> Earlier steps of the jumps at each point.
  type :: jump_history_t
    !> Forces on the jumps in the last step, (3, points)
    real(wp), allocatable :: forces(:, :)
    !> Change of the jumps in the last step, and in the one before, (3, points)
    real(wp), allocatable :: change(:, :), earlier(:, :)
    !> Change of the elastic jumps of sticking surfaces in the last step, and in the one before, (4, points)
    real(wp), allocatable :: sticking(:, :)
    !> Friction, (points)
    type(friction_history_t), allocatable :: friction(:)
    !> Work on the cohesive law of damaged surfaces in the last step, (points)
    real(wp), allocatable :: work(:)
    !> Energy dissipated by contact of surfaces, and algorithmic dissipation of the tractions, (2, points)
    real(wp), allocatable :: lost(:, :)
  contains
    procedure :: begin_step
    procedure :: damp
    !> Checkpoint.
    procedure :: visit
  end type jump_history_t

contains

  !> The history of jumps that have not moved.
  pure function create_jump_history(points) result(self)
    !> Number of points
    integer, intent(in) :: points
    type(jump_history_t) :: self

    allocate (self%forces(3, points), self%change(3, points), self%earlier(3, points), self%sticking(4, points), &
              self%work(points), self%lost(2, points), source=0.0_wp)
    allocate (self%friction(points))
  end function create_jump_history

  !> The last change of each jump is the earlier one of the step that begins. Its own, `change`, has no meaning until
  !> the jump has moved: until then it is that of two steps before.
  pure subroutine begin_step(self)
    class(jump_history_t), intent(inout) :: self
    real(wp), allocatable :: before(:, :)

    call move_alloc(self%earlier, before)
    call move_alloc(self%change, self%earlier)
    call move_alloc(before, self%change)
  end subroutine begin_step

  !> Reduces the work done in the last step. The changes of the jumps are not reduced: with those of the undamped motion
  !> the weighted mean is stable for springs of any stiffness, with reduced ones it is not.
  pure subroutine damp(self, ratio)
    class(jump_history_t), intent(inout) :: self
    !> Factor of the work
    real(wp), intent(in) :: ratio

    self%work = ratio*self%work
    self%friction%stored = ratio*self%friction%stored
  end subroutine damp

  !> Writes or reads the history.
  subroutine visit(self, archive, owned, points)
    class(jump_history_t), intent(inout) :: self
    class(archive_t), intent(inout) :: archive
    !> Numbers of this rank's points in the mesh, and number of points of the mesh
    integer, intent(in) :: owned(:), points
    real(wp) :: values(19, size(self%work))

    values(1:3, :) = self%forces
    values(4:6, :) = self%change
    values(7:9, :) = self%earlier
    values(10:11, :) = self%lost
    values(12, :) = self%friction%steps
    values(13, :) = self%friction%stored
    values(14, :) = self%friction%deficit
    values(15, :) = self%work
    values(16:19, :) = self%sticking
    call archive%field('explicit/interfaces', owned, points, values)
    self%forces = values(1:3, :)
    self%change = values(4:6, :)
    self%earlier = values(7:9, :)
    self%lost = values(10:11, :)
    self%friction%steps = nint(values(12, :))
    self%friction%stored = values(13, :)
    self%friction%deficit = values(14, :)
    self%work = values(15, :)
    self%sticking = values(16:19, :)
  end subroutine visit
end module jump_histories
