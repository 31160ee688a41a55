!> Points of cohesive interfaces on a plate that a factored operator takes for linear: the forces that hold their jumps
!> beyond what the operator takes for them, and the derivative of these.
module softening_points
  use cohesive_faces, only: cohesive_faces_t
  use cohesive_points, only: cohesive_point_t
  use kinds, only: wp
  implicit none
  private
  public :: softening_point_t, softening_points_t

  !> Derivatives of the forces: the true ones, those without their falling part, and slopes of lines through the
  !> origin.
  integer, parameter, public :: slopes_true = 1, slopes_rising = 2, slopes_secant = 3
  !> Stiffness that the operator lacks or has too much over the interface's own from which it counts: above rounding.
  real(wp), parameter :: noticed = 1.0e-10_wp

  !> A cohesive point.
  type :: softening_point_t
    !> Its faces
    type(cohesive_faces_t) :: faces
    !> The point in the last accepted state
    type(cohesive_point_t) :: old
    !> Its area times the factor of internal forces
    real(wp) :: area = 0
    !> Jumps before the correction, and the traction there
    real(wp) :: jumps(3) = 0, traction(3) = 0
    !> Stiffness of the jumps in the operator
    real(wp) :: held(3) = 0
  contains
    !> Force of a change of the jumps.
    procedure :: force
    !> Derivative of that force.
    procedure :: excess
  end type softening_point_t

  !> All of them on this rank.
  type :: softening_points_t
    !> The points
    type(softening_point_t), allocatable :: list(:)
    !> Which of this rank's points they are, (points)
    integer, allocatable :: places(:)
  contains
    !> Forces of a change of the plate's motion.
    procedure :: find_forces
    !> Derivatives of these, of the points where there are any.
    procedure :: find_slopes
  end type softening_points_t

contains

  !> What holds the point beyond what the operator takes for it, A (t(j + c) - t(j)) - D c.
  pure function force(self, change)
    !> The point
    class(softening_point_t), intent(in) :: self
    !> Change of the jumps
    real(wp), intent(in) :: change(3)
    !> The force
    real(wp) :: force(3)
    type(cohesive_point_t) :: new
    real(wp) :: traction(3)

    call self%faces%traction(self%jumps + change, self%old, traction, new)
    force = self%area*(traction - self%traction) - self%held*change
  end function force

  !> Derivative of the force by the jumps.
  pure function excess(self, change, kind)
    !> The point
    class(softening_point_t), intent(in) :: self
    !> Change of the jumps
    real(wp), intent(in) :: change(3)
    !> Which of them: slopes_true, slopes_rising or slopes_secant
    integer, intent(in) :: kind
    !> Force per jump, (force, jump)
    real(wp) :: excess(3, 3)
    real(wp) :: diagonal(3)
    integer :: k

    excess = 0
    diagonal = 0
    select case (kind)
    case (slopes_true)
      excess = self%area*self%faces%slopes(self%jumps + change, self%old)
    case (slopes_rising)
      diagonal = self%area*self%faces%diagonal(self%jumps + change, self%old)
    case (slopes_secant)
      diagonal = self%area*self%faces%secant(self%jumps + change, self%old)
    end select
    do k = 1, 3
      excess(k, k) = excess(k, k) + diagonal(k) - self%held(k)
    end do
  end function excess

  !> Forces of a change of the plate's motion.
  pure subroutine find_forces(self, change, forces)
    !> The points
    class(softening_points_t), intent(in) :: self
    !> Change of the jumps, (3, points)
    real(wp), intent(in) :: change(:, :)
    !> The forces, (3, points)
    real(wp), intent(out) :: forces(:, :)
    integer :: k

    do k = 1, size(self%list)
      forces(:, k) = self%list(k)%force(change(:, k))
    end do
  end subroutine find_forces

  !> Derivatives of these forces, of the points where the operator does not know them.
  pure subroutine find_slopes(self, change, kind, found, slopes)
    !> The points
    class(softening_points_t), intent(in) :: self
    !> Change of the jumps, (3, points)
    real(wp), intent(in) :: change(:, :)
    !> Which of them: slopes_true, slopes_rising or slopes_secant
    integer, intent(in) :: kind
    !> The points, of this list
    integer, allocatable, intent(out) :: found(:)
    !> Force per jump, (force, jump, points found)
    real(wp), allocatable, intent(out) :: slopes(:, :, :)
    real(wp) :: all(3, 3, size(self%list))
    logical :: counts(size(self%list))
    integer :: k

    do k = 1, size(self%list)
      all(:, :, k) = self%list(k)%excess(change(:, k), kind)
      counts(k) = any(abs(all(:, :, k)) > noticed*self%list(k)%area*self%list(k)%faces%law%stiffness_opening)
    end do
    found = pack([(k, k=1, size(counts))], counts)
    slopes = all(:, :, found)
  end subroutine find_slopes
end module softening_points
