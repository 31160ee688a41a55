!> Equilibrium of softening points on a linear plate. The plate's answers to what is out of balance span a space, in
!> which Newton's method finds the equilibrium; what is then still out of balance asks for the next answer.
!>
!> For a law that does not soften these are conjugate gradients, preconditioned by the factored operator (see Y. Saad,
!> Iterative Methods for Sparse Linear Systems, 2003). The small system is exact about the law in every iteration, so it
!> does not matter how many points pass their onset at once, nor that their tangents are not positive definite. It
!> remembers earlier answers, so the iteration of equilibrium around it starts from what the last one found.
module softening_equilibria
  use dense_systems, only: dense_factor_t, positive_factor_t
  use errors, only: error_t
  use kinds, only: wp
  use outside_forces, only: outside_force_t
  use plate_answers, only: linear_plate_t, plate_answers_t
  use softening_points, only: softening_points_t, slopes_true, slopes_rising, slopes_secant
  implicit none
  private
  public :: find_equilibrium

  !> Part of the forces out of balance that may be left: the iteration of equilibrium around this one gains no more, as
  !> the operator lags behind von Karman's strains.
  real(wp), parameter :: settled = 0.03_wp
  !> The same of the small system, over what it was before the latest answer.
  real(wp), parameter :: settled_inside = 0.03_wp
  !> Newton iterations of the small system at most.
  integer, parameter :: most_iterations = 60
  !> Trials along a direction, and how much of the slope may be left at its end.
  integer, parameter :: most_trials = 8
  real(wp), parameter :: slope_left = 0.5_wp

  !> The small system. Its unknowns are the shares of the plate's answers.
  type :: small_system_t
    !> Jumps of the points in each answer, (3, points, unknowns)
    real(wp), allocatable :: jumps(:, :, :)
    !> Work of a unit force from outside on each answer, and that of the forces on the plate
    real(wp), allocatable :: outside(:), works(:)
    !> The shares
    real(wp), allocatable :: shares(:)
    !> Forces of the points, (3, points)
    real(wp), allocatable :: forces(:, :)
    !> Force from outside and its slope
    real(wp) :: load = 0, slope = 0
    !> Symmetric part of the tangent, factored
    type(positive_factor_t) :: factor
    !> All of it, factored
    type(dense_factor_t) :: whole
    !> True: modes of different toughness grow, and the tangent is not symmetric
    logical :: skew = .false.
  end type small_system_t

contains

  !> Change of the plate's motion that brings forces, points and the force from outside into balance, or nearer to it.
  subroutine find_equilibrium(plate, kept, points, outside, pattern, residual, most_answers, change, error)
    !> The plate
    class(linear_plate_t), intent(inout) :: plate
    !> Its answers so far
    type(plate_answers_t), intent(inout) :: kept
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> Forces on the plate of a unit force from outside, (5, local points)
    real(wp), intent(in) :: pattern(:, :)
    !> Forces out of balance, (5, local points)
    real(wp), intent(in) :: residual(:, :)
    !> Answers asked for at most
    integer, intent(in) :: most_answers
    !> The plate's own answer to them on entry, the change on return, (5, local points)
    real(wp), intent(inout) :: change(:, :)
    !> Set if the plate does not answer
    type(error_t), allocatable, intent(inout) :: error
    type(small_system_t) :: small
    real(wp), allocatable :: answer(:, :), carried(:, :), imbalance(:, :)
    real(wp) :: first
    logical :: added
    integer :: i, k

    answer = change
    allocate (carried, mold=residual)
    imbalance = residual
    first = plate%size(residual)
    allocate (small%shares(kept%kept), source=0.0_wp)
    do i = 0, most_answers
      call kept%add(plate, answer, imbalance, added)
      if (.not. added .and. i > 0) exit
      if (added) small%shares = [small%shares, 0.0_wp]
      call renew(small, plate, kept, points, pattern, residual)
      call balance(small, plate, points, outside)
      call kept%combine(small%shares, change, carried)
      imbalance = residual - carried + small%load*pattern
      do k = 1, size(points%list)
        associate (place => points%list(k)%place)
          imbalance(1:3, place) = imbalance(1:3, place) - small%forces(:, k)
        end associate
      end do
      if (.not. plate%size(imbalance) > settled*first .or. i == most_answers) exit
      call plate%answer(imbalance, answer, error)
      if (allocated(error)) return
    end do
  end subroutine find_equilibrium

  !> Renews the small system after answers have come.
  subroutine renew(self, plate, kept, points, pattern, residual)
    !> The system
    type(small_system_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> Its answers
    type(plate_answers_t), intent(in) :: kept
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Forces on the plate of a unit force from outside, and those out of balance, (5, local points)
    real(wp), intent(in) :: pattern(:, :), residual(:, :)
    real(wp), allocatable :: jumps(:, :, :)
    integer :: had

    had = 0
    if (allocated(self%jumps)) had = size(self%jumps, 3)
    allocate (jumps(3, size(points%list), kept%kept))
    if (had > 0) jumps(:, :, :had) = self%jumps
    jumps(:, :, had + 1:) = kept%motions(1:3, points%list%place, had + 1:kept%kept)
    call move_alloc(jumps, self%jumps)
    self%outside = kept%works(plate, pattern)
    self%works = kept%works(plate, residual)
    if (.not. allocated(self%forces)) allocate (self%forces(3, size(points%list)))
  end subroutine renew

  !> Shares at equilibrium of the small system, found by Newton's method along directions that descend.
  subroutine balance(self, plate, points, outside)
    !> The system
    type(small_system_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    real(wp) :: force(size(self%shares)), direction(size(force)), share, first
    integer :: i

    call find_force(self, plate, points, outside, self%shares, force)
    first = norm2(force)
    do i = 1, most_iterations
      call factorize(self, plate, points)
      direction = -force
      if (self%skew) then
        call self%whole%solve(direction)
      else
        call self%factor%solve(direction)
      end if
      call descend(self, plate, points, outside, direction, force, share)
      self%shares = self%shares + share*direction
      if (.not. norm2(force) > settled_inside*first) exit
    end do
  end subroutine balance

  !> Goes along a direction: all of it unless the force along it turns round too far on the way.
  subroutine descend(self, plate, points, outside, direction, force, share)
    !> The system
    type(small_system_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> Direction, (unknowns)
    real(wp), intent(in) :: direction(:)
    !> Force out of balance at its start on entry, at its end on return, (unknowns)
    real(wp), intent(inout) :: force(:)
    !> The share of it that was gone
    real(wp), intent(out) :: share
    real(wp) :: slope, slope_there
    integer :: i

    slope = dot_product(force, direction)
    share = 1
    do i = 1, most_trials
      call find_force(self, plate, points, outside, self%shares + share*direction, force)
      slope_there = dot_product(force, direction)
      if (.not. slope_there > slope_left*abs(slope) .or. i == most_trials) return
      share = share*min(0.9_wp, max(0.1_wp, -slope/(slope_there - slope)))
    end do
  end subroutine descend

  !> Force out of balance at some shares.
  subroutine find_force(self, plate, points, outside, shares, force)
    !> The system; receives the forces of the points and that from outside
    type(small_system_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Force from outside; unallocated: none
    class(outside_force_t), allocatable, intent(inout) :: outside
    !> The shares, (unknowns)
    real(wp), intent(in) :: shares(:)
    !> The force, (unknowns)
    real(wp), intent(out) :: force(:)
    integer :: k

    call points%find_forces(jumps_of(self, shares), self%forces)
    force = [(sum(self%jumps(:, :, k)*self%forces), k=1, size(shares))]
    call plate%sum(force)
    self%load = 0
    self%slope = 0
    if (allocated(outside)) call outside%at(dot_product(self%outside, shares), self%load, self%slope)
    force = force + shares - self%works - self%load*self%outside
  end subroutine find_force

  !> Jumps at some shares.
  pure function jumps_of(self, shares) result(jumps)
    !> The system
    type(small_system_t), intent(in) :: self
    !> The shares, (unknowns)
    real(wp), intent(in) :: shares(:)
    !> The jumps, (3, points)
    real(wp) :: jumps(3, size(self%jumps, 2))
    integer :: k

    jumps = 0
    do k = 1, size(shares)
      jumps = jumps + shares(k)*self%jumps(:, :, k)
    end do
  end function jumps_of

  !> Factors the tangent at the shares: all of it if its symmetric part is positive definite, else one without its
  !> falling part, else the secant, which always is. A positive symmetric part makes the direction of all of it descend.
  subroutine factorize(self, plate, points)
    !> The system
    type(small_system_t), intent(inout) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The points
    type(softening_points_t), intent(in) :: points
    real(wp), allocatable :: matrix(:, :)
    integer :: kind

    do kind = slopes_true, slopes_secant
      call find_tangent(self, plate, points, kind, matrix)
      call self%factor%factorize((matrix + transpose(matrix))/2)
      if (self%factor%positive) exit
    end do
    self%skew = kind == slopes_true
    if (.not. self%skew) return
    call self%whole%factorize(matrix)
    self%skew = .not. self%whole%singular
  end subroutine factorize

  !> Tangent at the shares.
  subroutine find_tangent(self, plate, points, kind, matrix)
    !> The system
    type(small_system_t), intent(in) :: self
    !> The plate
    class(linear_plate_t), intent(in) :: plate
    !> The points
    type(softening_points_t), intent(in) :: points
    !> Which of the points' derivatives
    integer, intent(in) :: kind
    !> The tangent, (unknowns, unknowns)
    real(wp), allocatable, intent(out) :: matrix(:, :)
    real(wp), allocatable :: slopes(:, :, :), jumps(:, :, :), forces(:, :, :), sums(:)
    integer, allocatable :: found(:)
    integer :: i, k

    call points%find_slopes(jumps_of(self, self%shares), kind, found, slopes)
    jumps = self%jumps(:, found, :)
    allocate (forces, mold=jumps)
    do k = 1, size(self%shares)
      do i = 1, size(found)
        forces(:, i, k) = matmul(slopes(:, :, i), jumps(:, i, k))
      end do
    end do
    associate (rows => 3*size(found), unknowns => size(self%shares))
      sums = reshape(matmul(transpose(reshape(jumps, [rows, unknowns])), reshape(forces, [rows, unknowns])), &
                     [unknowns**2])
      call plate%sum(sums)
      matrix = reshape(sums, [unknowns, unknowns])
    end associate
    do k = 1, size(self%shares)
      matrix(:, k) = matrix(:, k) - self%slope*self%outside(k)*self%outside
      matrix(k, k) = matrix(k, k) + 1
    end do
  end subroutine find_tangent
end module softening_equilibria
