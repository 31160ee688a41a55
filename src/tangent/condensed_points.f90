!> Equilibrium of a few cohesive points on a linear plate: the small dense system that is left when every other unknown
!> is eliminated by the factored operator.
!>
!> A force q on the jumps moves them by C q, with C the operator's answers to unit forces. With the operator's own
!> stiffness D of a jump the force that mends it is q = D x - (t(j + x) - t(j)), so the change x of the jumps solves
!> C^-1 (x - x_free) - D x + t(j + x) - t(j) = 0: softening points are met exactly, however many pass their onset.
module condensed_points
  use cohesive_faces, only: cohesive_faces_t
  use cohesive_points, only: cohesive_point_t
  use dense_systems, only: positive_factor_t
  use kinds, only: wp
  implicit none
  private
  public :: condensed_point_t, condensed_points_t

  !> Newton iterations at most; those that soften far take some twenty.
  integer, parameter :: most_iterations = 60
  !> Trials along a direction, and how much of the slope may be left at its end.
  integer, parameter :: most_trials = 8
  real(wp), parameter :: slope_left = 0.5_wp
  !> Forces left over those at the strength of a point: far below any tolerance of equilibrium.
  real(wp), parameter :: settled = 1.0e-7_wp

  !> A cohesive point of the system.
  type :: condensed_point_t
    !> Its faces
    type(cohesive_faces_t) :: faces
    !> The point in the last accepted state
    type(cohesive_point_t) :: old
    !> Its area times the factor of internal forces
    real(wp) :: area = 0
    !> Jumps before the correction, and the change of those that are no unknowns here
    real(wp) :: jumps(3) = 0, drift(3) = 0
    !> Unknown of each jump; 0: none
    integer :: place(3) = 0
  end type condensed_point_t

  !> The system.
  type :: condensed_points_t
    !> The points
    type(condensed_point_t), allocatable :: points(:)
    !> Stiffness of each unknown in the operator, less what ties and contacts have added since: (unknowns)
    real(wp), allocatable :: held(:)
    !> Inverse of the operator's answers to unit forces, (unknowns, unknowns)
    real(wp), allocatable :: stiffness(:, :)
    !> Tangent of the latest iteration, factored
    type(positive_factor_t), private :: factor
  contains
    !> Change of the jumps at equilibrium.
    procedure :: solve
    !> Forces that mend the operator's answer.
    procedure :: mending_forces
    !> The same for a small change of the free jumps.
    procedure :: mending_slopes
  end type condensed_points_t

contains

  !> Change of the jumps at equilibrium, found by Newton's method along directions that descend.
  subroutine solve(self, free, change)
    !> The system
    class(condensed_points_t), intent(inout) :: self
    !> Change of the jumps by the operator alone, (unknowns)
    real(wp), intent(in) :: free(:)
    !> First guess on entry, solution on return, (unknowns)
    real(wp), intent(inout) :: change(:)
    real(wp) :: force(size(free)), direction(size(free)), along(size(free)), elastic(size(free))
    real(wp) :: scale(size(free)), share
    integer :: i

    scale = force_scale(self)
    do i = 1, most_iterations
      elastic = matmul(self%stiffness, change - free)
      force = elastic + cohesive_forces(self, change)
      call factorize(self, change)
      if (all(abs(force) <= settled*scale)) exit
      direction = -force
      call self%factor%solve(direction)
      along = matmul(self%stiffness, direction)
      share = descent(self, change, direction, elastic, along, dot_product(force, direction))
      change = change + share*direction
    end do
  end subroutine solve

  !> Share of a direction to go: all of it unless the force along it turns round too far on the way.
  pure real(wp) function descent(self, change, direction, elastic, along, slope) result(share)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change so far, direction, and the elastic forces of both, (unknowns)
    real(wp), intent(in) :: change(:), direction(:), elastic(:), along(:)
    !> Force along the direction at its start, negative
    real(wp), intent(in) :: slope
    real(wp) :: left, right, left_slope, right_slope, here
    integer :: i

    share = 1
    left = 0
    left_slope = slope
    do i = 1, most_trials
      here = dot_product(direction, elastic + share*along + cohesive_forces(self, change + share*direction))
      if (here <= slope_left*abs(slope)) return
      right = share
      right_slope = here
      share = left + (right - left)*min(0.9_wp, max(0.1_wp, -left_slope/(right_slope - left_slope)))
    end do
  end function descent

  !> Factors the tangent at a change of the jumps: the true one if it is positive, else one without its falling part,
  !> else the secant, which always is.
  subroutine factorize(self, change)
    !> The system
    type(condensed_points_t), intent(inout) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    integer :: kind

    do kind = 1, 3
      call self%factor%factorize(tangent(self, change, kind))
      if (self%factor%positive) return
    end do
  end subroutine factorize

  !> Tangent of the system.
  pure function tangent(self, change, kind) result(matrix)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> 1: the true one; 2: without its falling part; 3: secant
    integer, intent(in) :: kind
    !> The matrix, (unknowns, unknowns)
    real(wp), allocatable :: matrix(:, :)
    real(wp) :: jumps(3), slopes(3, 3), diagonal(3)
    integer :: i, k, l

    matrix = self%stiffness
    do i = 1, size(self%held)
      matrix(i, i) = matrix(i, i) - self%held(i)
    end do
    do i = 1, size(self%points)
      associate (point => self%points(i))
        jumps = jumps_of(point, change)
        slopes = 0
        if (kind == 1) slopes = point%faces%tangent(jumps, point%old)
        if (kind > 1) then
          diagonal = point%faces%diagonal(jumps, point%old)
          if (kind == 3) diagonal = point%faces%secant(jumps, point%old)
          do k = 1, 3
            slopes(k, k) = diagonal(k)
          end do
        end if
        do k = 1, 3
          do l = 1, 3
            if (point%place(k) > 0 .and. point%place(l) > 0) &
              matrix(point%place(k), point%place(l)) = matrix(point%place(k), point%place(l)) + point%area*slopes(k, l)
          end do
        end do
      end associate
    end do
  end function tangent

  !> Change of the forces of the points less what the operator takes for it, t(j + x) - t(j) - D x.
  pure function cohesive_forces(self, change) result(force)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> Force, (unknowns)
    real(wp) :: force(size(change))
    type(cohesive_point_t) :: new
    real(wp) :: before(3), after(3)
    integer :: i, k

    force = -self%held*change
    do i = 1, size(self%points)
      associate (point => self%points(i))
        call point%faces%traction(point%jumps, point%old, before, new)
        call point%faces%traction(jumps_of(point, change), point%old, after, new)
        do k = 1, 3
          if (point%place(k) > 0) force(point%place(k)) = force(point%place(k)) + point%area*(after(k) - before(k))
        end do
      end associate
    end do
  end function cohesive_forces

  !> Jumps of a point after a change of the unknowns.
  pure function jumps_of(point, change) result(jumps)
    !> The point
    type(condensed_point_t), intent(in) :: point
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> Two shears and opening
    real(wp) :: jumps(3)
    integer :: k

    jumps = point%jumps + point%drift
    do k = 1, 3
      if (point%place(k) > 0) jumps(k) = point%jumps(k) + change(point%place(k))
    end do
  end function jumps_of

  !> Force of each unknown at the strength of its point; nothing for ties and contacts, which are linear.
  pure function force_scale(self) result(scale)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Force, (unknowns)
    real(wp) :: scale(size(self%held))
    integer :: i, k

    scale = huge(scale)
    do i = 1, size(self%points)
      associate (point => self%points(i))
        do k = 1, 3
          if (point%place(k) > 0) &
            scale(point%place(k)) = point%area*min(point%faces%law%strength_shear, point%faces%law%strength_opening)
        end do
      end associate
    end do
  end function force_scale

  !> Forces q that mend the operator's answer: what the operator takes for the points less what they have.
  pure function mending_forces(self, change) result(force)
    !> The system
    class(condensed_points_t), intent(in) :: self
    !> Change of the jumps at equilibrium, (unknowns)
    real(wp), intent(in) :: change(:)
    !> Force on each unknown
    real(wp) :: force(size(change))

    force = -cohesive_forces(self, change)
  end function mending_forces

  !> Mending forces per change of the free jumps, with the tangent of the latest iteration.
  subroutine mending_slopes(self, free, force)
    !> The system, solved
    class(condensed_points_t), intent(in) :: self
    !> Change of the free jumps, (unknowns)
    real(wp), intent(in) :: free(:)
    !> Force on each unknown
    real(wp), intent(out) :: force(:)
    real(wp) :: change(size(free))

    change = matmul(self%stiffness, free)
    call self%factor%solve(change)
    force = matmul(self%stiffness, change - free)
  end subroutine mending_slopes
end module condensed_points
