!> Equilibrium of a few cohesive points on a linear plate: the small dense system that is left when every other unknown
!> is eliminated by the factored operator.
!>
!> A force q on the jumps moves them by C q, with C the operator's answers to unit forces. With the operator's own
!> stiffness D of a jump the force that mends it is q = D x - (t(j + x) - t(j)), so the change x of the jumps solves
!> C^-1 (x - x_free) - D x + t(j + x) - t(j) = 0: softening points are met exactly, however many pass their onset.
module condensed_points
  use cohesive_faces, only: cohesive_faces_t
  use cohesive_points, only: cohesive_point_t
  use dense_systems, only: dense_factor_t, positive_factor_t
  use kinds, only: wp
  use outside_forces, only: outside_force_t
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
  !> The same where Newton's method needs the skew part of the tangent.
  real(wp), parameter :: close_by = 0.05_wp

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
    !> Traction before the correction
    real(wp) :: traction(3) = 0
    !> Unknown of each jump; 0: none
    integer :: place(3) = 0
  end type condensed_point_t

  !> The system. Its last unknown is the motion under a force from outside, if there is one.
  type :: condensed_points_t
    !> The points
    type(condensed_point_t), allocatable :: points(:)
    !> Stiffness of each unknown in the operator, less what ties and contacts have added since: (unknowns)
    real(wp), allocatable :: held(:)
    !> Inverse of the operator's answers to unit forces, (unknowns, unknowns)
    real(wp), allocatable :: stiffness(:, :)
    !> What the points hold beyond what the operator takes for it, less the force from outside, (unknowns)
    real(wp), allocatable :: forces(:)
    !> Symmetric part of the latest iteration's tangent, factored
    type(positive_factor_t), private :: factor
    !> All of it, factored
    type(dense_factor_t), private :: whole
    !> True: modes of different toughness grow, and the tangent is not symmetric
    logical, private :: skew = .false.
  contains
    !> Change of the jumps at equilibrium.
    procedure :: solve
  end type condensed_points_t

contains

  !> Change of the jumps at equilibrium, found by Newton's method along directions that descend.
  subroutine solve(self, free, outside, change)
    !> The system
    class(condensed_points_t), intent(inout) :: self
    !> Change of the jumps by the operator alone, (unknowns)
    real(wp), intent(in) :: free(:)
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> First guess on entry, solution on return, (unknowns)
    real(wp), intent(inout) :: change(:)
    real(wp) :: force(size(free)), direction(size(free)), along(size(free)), elastic(size(free))
    real(wp) :: scale(size(free)), share, load, slope
    integer :: i

    scale = force_scale(self)
    do i = 1, most_iterations
      elastic = matmul(self%stiffness, change - free)
      call find_forces(self, change, outside, self%forces, load, slope)
      force = elastic + self%forces
      if (all(abs(force) <= settled*max(scale, abs(load)))) exit
      call factorize(self, change, slope, all(abs(force) <= close_by*max(scale, abs(load))))
      direction = -force
      if (self%skew) then
        call self%whole%solve(direction)
      else
        call self%factor%solve(direction)
      end if
      along = matmul(self%stiffness, direction)
      call descend(self, change, direction, elastic, along, dot_product(force, direction), outside, share)
      change = change + share*direction
    end do
  end subroutine solve

  !> Share of a direction to go: all of it unless the force along it turns round too far on the way.
  subroutine descend(self, change, direction, elastic, along, slope, outside, share)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change so far, direction, and the elastic forces of both, (unknowns)
    real(wp), intent(in) :: change(:), direction(:), elastic(:), along(:)
    !> Force along the direction at its start, negative
    real(wp), intent(in) :: slope
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> The share
    real(wp), intent(out) :: share
    real(wp) :: left, right, left_slope, right_slope, forces(size(change)), load, load_slope
    integer :: i

    share = 1
    left = 0
    left_slope = slope
    do i = 1, most_trials
      call find_forces(self, change + share*direction, outside, forces, load, load_slope)
      right_slope = dot_product(direction, elastic + share*along + forces)
      if (right_slope <= slope_left*abs(slope)) return
      right = share
      share = left + (right - left)*min(0.9_wp, max(0.1_wp, -left_slope/(right_slope - left_slope)))
    end do
  end subroutine descend

  !> Factors the tangent at a change of the jumps: its symmetric part if that is positive, else one without its falling
  !> part, else the secant, which always is. Near the solution the skew part counts too: with modes of different
  !> toughness iterations without it come nearer by a fifth only. The positive symmetric part makes it descend.
  subroutine factorize(self, change, slope, near)
    !> The system
    type(condensed_points_t), intent(inout) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> Slope of the force from outside
    real(wp), intent(in) :: slope
    !> True near the solution
    logical, intent(in) :: near
    real(wp), allocatable :: matrix(:, :)
    integer :: kind, last

    do kind = 1, 3
      matrix = tangent(self, change, kind)
      last = size(matrix, 1)
      matrix(last, last) = matrix(last, last) - slope
      call self%factor%factorize(matrix)
      if (self%factor%positive) exit
    end do
    self%skew = .false.
    if (kind > 1 .or. .not. near) return
    matrix = tangent(self, change, 0)
    if (all(abs(matrix - transpose(matrix)) <= epsilon(slope)*maxval(abs(matrix)))) return
    matrix(last, last) = matrix(last, last) - slope
    call self%whole%factorize(matrix)
    self%skew = .not. self%whole%singular
  end subroutine factorize

  !> Tangent of the system.
  pure function tangent(self, change, kind) result(matrix)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> 0: the true one; 1: its symmetric part; 2: without its falling part; 3: secant
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
        if (kind == 0) slopes = point%faces%slopes(jumps, point%old)
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

  !> Change of the forces that hold the points less what the operator takes for it, t(j + x) - t(j) - D x, less the
  !> change of the force from outside.
  subroutine find_forces(self, change, outside, force, load, slope)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Change of the jumps, (unknowns)
    real(wp), intent(in) :: change(:)
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> Force, (unknowns)
    real(wp), intent(out) :: force(:)
    !> Change of the force from outside, and its slope
    real(wp), intent(out) :: load, slope
    type(cohesive_point_t) :: new
    real(wp) :: after(3)
    integer :: i, k

    force = -self%held*change
    do i = 1, size(self%points)
      associate (point => self%points(i))
        call point%faces%traction(jumps_of(point, change), point%old, after, new)
        do k = 1, 3
          if (point%place(k) > 0) force(point%place(k)) = force(point%place(k)) &
                                                        + point%area*(after(k) - point%traction(k))
        end do
      end associate
    end do
    load = 0
    slope = 0
    if (.not. allocated(outside)) return
    call outside%at(change(size(change)), load, slope)
    force(size(force)) = force(size(force)) - load
  end subroutine find_forces

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

  !> Force of each unknown at the strength of its point, that of all of them for ties, contacts and the force from
  !> outside.
  pure function force_scale(self) result(scale)
    !> The system
    type(condensed_points_t), intent(in) :: self
    !> Force, (unknowns)
    real(wp) :: scale(size(self%held))
    integer :: i, k

    scale = 0
    do i = 1, size(self%points)
      associate (point => self%points(i))
        do k = 1, 3
          if (point%place(k) > 0) &
            scale(point%place(k)) = point%area*min(point%faces%law%strength_shear, point%faces%law%strength_opening)
        end do
      end associate
    end do
    where (.not. scale > 0) scale = sum(scale)
  end function force_scale
end module condensed_points
