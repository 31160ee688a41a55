!> Newton's method for small systems of softening points, along directions that descend.
!>
!> The tangent is taken whole where its symmetric part is positive definite. A positive symmetric part makes the
!> direction of the whole tangent descend too; with modes of different toughness iterations without the skew part come
!> nearer by a fifth only. Where it is not, points snap: the sizes of its eigenvalues lead down along what falls. An
!> iteration that lasts goes on with the tangent without its falling part, or with the secant, which is always positive.
module softening_systems
  use dense_systems, only: dense_factor_t, positive_factor_t, solve_descending
  use kinds, only: wp
  use outside_forces, only: outside_force_t
  use softening_points, only: slopes_true, slopes_rising, slopes_secant
  implicit none
  private
  public :: softening_system_t

  !> Newton iterations at most; and those of them that may follow what falls. Snaps take some six. Ways that wander on
  !> part: of 32 pairs of runs that ought to be the same none differs with 6, two do with 20.
  integer, parameter :: most_iterations = 60, most_falling = 6
  !> Trials along a direction, and how much of the slope may be left at its end.
  integer, parameter :: most_trials = 8
  real(wp), parameter :: slope_left = 0.5_wp

  !> A small system.
  type, abstract :: softening_system_t
    !> Force from outside; null: none
    class(outside_force_t), pointer :: outside => null()
    !> Norm of the force out of balance before the first iteration
    real(wp) :: first = 0
    !> True once the tangent on the way was not positive definite: there may be other equilibria
    logical :: snaps = .false.
  contains
    !> Force out of balance.
    procedure(force_at), deferred :: find_force
    !> Its derivative.
    procedure(tangent_at), deferred :: find_tangent
    !> True if so little is left.
    procedure(is_little), deferred :: is_settled
    !> Finds the unknowns in balance.
    procedure :: bring_into_balance
  end type softening_system_t

  abstract interface
    !> Force out of balance.
    subroutine force_at(self, x, force)
      import :: softening_system_t, wp
      !> The system; may keep what it has found
      class(softening_system_t), intent(inout) :: self
      !> Unknowns
      real(wp), intent(in) :: x(:)
      !> The force, (unknowns)
      real(wp), intent(out) :: force(:)
    end subroutine force_at

    !> Derivative of the force, after it was found at the same unknowns.
    subroutine tangent_at(self, x, kind, matrix)
      import :: softening_system_t, wp
      !> The system
      class(softening_system_t), intent(in) :: self
      !> Unknowns
      real(wp), intent(in) :: x(:)
      !> Which of the points' derivatives: slopes_true, slopes_rising or slopes_secant
      integer, intent(in) :: kind
      !> The derivative, (unknowns, unknowns)
      real(wp), allocatable, intent(out) :: matrix(:, :)
    end subroutine tangent_at

    !> True if so little force is left that the system counts as balanced.
    pure logical function is_little(self, force)
      import :: softening_system_t, wp
      !> The system
      class(softening_system_t), intent(in) :: self
      !> The force, (unknowns)
      real(wp), intent(in) :: force(:)
    end function is_little
  end interface

contains

  !> Finds the unknowns in balance.
  subroutine bring_into_balance(self, x)
    !> The system; keeps what it found there
    class(softening_system_t), intent(inout) :: self
    !> First guess on entry, solution on return, (unknowns)
    real(wp), intent(inout) :: x(:)
    real(wp) :: force(size(x)), direction(size(x))
    integer :: i

    call self%find_force(x, force)
    self%first = norm2(force)
    do i = 1, most_iterations
      if (self%is_settled(force)) exit
      call find_direction(self, x, force, i <= most_falling, direction)
      call descend(self, direction, x, force)
    end do
  end subroutine bring_into_balance

  !> Direction in which to go from the unknowns.
  subroutine find_direction(self, x, force, falls, direction)
    !> The system; notes that its tangent is not positive definite
    class(softening_system_t), intent(inout) :: self
    !> The unknowns, and the force out of balance there, (unknowns)
    real(wp), intent(in) :: x(:), force(:)
    !> True: it may follow what falls
    logical, intent(in) :: falls
    !> The direction, (unknowns)
    real(wp), intent(out) :: direction(:)
    type(positive_factor_t) :: symmetric
    type(dense_factor_t) :: whole
    real(wp), allocatable :: matrix(:, :), even(:, :)
    logical :: found
    integer :: kind

    direction = -force
    call self%find_tangent(x, slopes_true, matrix)
    even = (matrix + transpose(matrix))/2
    call symmetric%factorize(even)
    if (symmetric%positive) then
      if (.not. is_symmetric(matrix)) then
        call whole%factorize(matrix)
        if (.not. whole%singular) then
          call whole%solve(direction)
          return
        end if
      end if
      call symmetric%solve(direction)
      return
    end if
    self%snaps = .true.
    found = .false.
    if (falls) call solve_descending(even, direction, found)
    if (found) return
    do kind = slopes_rising, slopes_secant
      call self%find_tangent(x, kind, matrix)
      call symmetric%factorize((matrix + transpose(matrix))/2)
      if (symmetric%positive) exit
    end do
    call symmetric%solve(direction)
  end subroutine find_direction

  !> True if a matrix is its transpose but for rounding.
  pure logical function is_symmetric(matrix)
    !> The matrix, (n, n)
    real(wp), intent(in) :: matrix(:, :)

    is_symmetric = all(abs(matrix - transpose(matrix)) <= epsilon(matrix)*maxval(abs(matrix)))
  end function is_symmetric

  !> Goes along a direction: all of it unless the force along it turns round too far on the way.
  subroutine descend(self, direction, x, force)
    !> The system
    class(softening_system_t), intent(inout) :: self
    !> The direction, (unknowns)
    real(wp), intent(in) :: direction(:)
    !> The unknowns, and the force out of balance there, (unknowns)
    real(wp), intent(inout) :: x(:), force(:)
    real(wp) :: begin(size(x)), slope, slope_there, share
    integer :: i

    begin = x
    slope = dot_product(force, direction)
    share = 1
    do i = 1, most_trials
      x = begin + share*direction
      call self%find_force(x, force)
      slope_there = dot_product(force, direction)
      if (.not. slope_there > slope_left*abs(slope)) exit
      share = share*min(0.9_wp, max(0.1_wp, -slope/(slope_there - slope)))
    end do
  end subroutine descend
end module softening_systems
