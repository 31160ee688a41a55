!> Learns from the corrections of a step's earlier iterations (Anderson's mixing): a lagged operator that would
!> converge slowly, or not at all, then does in a few iterations more, each the price of one solve.
module anderson_acceleration
  use kinds, only: wp
  use communicators, only: communicator_t
  use dense_systems, only: solve_dense
  implicit none
  private
  public :: anderson_t

  !> Iterations remembered; more no longer pay.
  integer, parameter :: depth = 8
  !> Keeps the small system solvable once two memories say the same, relative to its diagonal.
  real(wp), parameter :: regularisation = 1.0e-12_wp

  !> What one iteration showed.
  type :: memory_t
    !> A change of the displacement, and what that did to the correction, (5, points)
    real(wp), allocatable :: move(:, :), change(:, :)
    !> What it did to the force
    real(wp) :: force_change = 0
  end type memory_t

  !> What earlier iterations of a step showed.
  type :: anderson_t
    !> The iterations remembered; most steps need few
    type(memory_t) :: memories(depth)
    !> Weighted products of the changes with each other, (depth, depth)
    real(wp) :: products(depth, depth) = 0
    !> Correction and force of the iteration before, and how far that moved, (5, points)
    real(wp), allocatable :: correction(:, :), move(:, :)
    !> Force that went with that correction
    real(wp) :: force = 0
    !> Memories kept, and place of the latest
    integer :: kept = 0, latest = 0
    !> True: that correction was the move, since there was nothing to better it by
    logical :: plain = .false.
    !> True: there is a correction whose move has not been noted
    logical :: waiting = .false.
    !> True once the iteration before can be compared with
    logical :: comparable = .false.
  contains
    !> Forgets all, after the operator or the set of touching points has changed.
    procedure :: forget
    !> Compares nothing with the iteration before, after the loads have changed.
    procedure :: pause
    !> Betters a correction and the force that goes with it.
    procedure :: accelerate
    !> Takes note of the move that was made of it, before another correction is sought.
    procedure :: note
  end type anderson_t

contains

  !> Forgets all, after the operator or the set of touching points has changed.
  pure subroutine forget(self)
    !> The memory
    class(anderson_t), intent(inout) :: self

    self%kept = 0
    self%latest = 0
    call self%pause()
  end subroutine forget

  !> Compares nothing with the iteration before, after the loads have changed.
  pure subroutine pause(self)
    !> The memory
    class(anderson_t), intent(inout) :: self

    self%comparable = .false.
    self%waiting = .false.
  end subroutine pause

  !> Betters a correction and the force that goes with it: the combination with earlier ones that would have left
  !> the smallest correction if all were linear.
  subroutine accelerate(self, communicator, weight, correction, force)
    !> The memory
    class(anderson_t), intent(inout) :: self
    !> The ranks
    type(communicator_t), intent(in) :: communicator
    !> Weight of each unknown's square, (5, owned points)
    real(wp), intent(in) :: weight(:, :)
    !> Correction of the displacement, (5, points)
    real(wp), intent(inout) :: correction(:, :)
    !> Force found with it
    real(wp), intent(inout) :: force
    real(wp) :: shares(depth), matrix(depth, depth), sums(2*depth)
    logical :: singular
    integer :: i

    call remember(self, correction, force)
    if (self%kept == 0) return
    ! All at once: a sum over the ranks costs the waiting, not the numbers.
    sums = 0
    do i = 1, self%kept
      sums(i) = weighted_product(weight, self%memories(i)%change, correction)
      sums(depth + i) = weighted_product(weight, self%memories(i)%change, self%memories(self%latest)%change)
    end do
    call communicator%sum(sums)
    shares = sums(:depth)
    self%products(:, self%latest) = sums(depth + 1:)
    self%products(self%latest, :) = sums(depth + 1:)
    matrix = self%products
    do i = 1, self%kept
      matrix(i, i) = matrix(i, i)*(1 + regularisation)
    end do
    call solve_dense(matrix(:self%kept, :self%kept), shares(:self%kept), singular)
    if (singular .or. .not. all(abs(shares(:self%kept)) <= huge(force))) return
    do i = 1, self%kept
      correction = correction - shares(i)*(self%memories(i)%move + self%memories(i)%change)
      force = force - shares(i)*self%memories(i)%force_change
    end do
  end subroutine accelerate

  !> Adds what the last move showed to the memory, in place of the oldest.
  subroutine remember(self, correction, force)
    !> The memory
    type(anderson_t), intent(inout) :: self
    !> Correction after the last move, (5, points)
    real(wp), intent(in) :: correction(:, :)
    !> Force found with it
    real(wp), intent(in) :: force

    if (self%comparable) then
      self%kept = min(self%kept + 1, depth)
      self%latest = 1 + modulo(self%latest, depth)
      associate (memory => self%memories(self%latest))
        memory%move = self%move
        memory%change = correction - self%correction
        memory%force_change = force - self%force
      end associate
    end if
    self%force = force
    self%waiting = .true.
    self%plain = self%kept == 0
    if (.not. self%plain) self%correction = correction
  end subroutine remember

  !> Weighted product of two fields, over this rank's points.
  pure real(wp) function weighted_product(weight, first, second) result(product)
    !> Weight of each unknown, (5, owned points)
    real(wp), intent(in) :: weight(:, :)
    !> The fields, (5, points)
    real(wp), intent(in) :: first(:, :), second(:, :)
    integer :: i, j

    product = 0
    do j = 1, size(weight, 2)
      do i = 1, size(weight, 1)
        product = product + weight(i, j)*first(i, j)*second(i, j)
      end do
    end do
  end function weighted_product

  !> Takes note of the move that was made of a correction, if that is to be compared with the next.
  pure subroutine note(self, move)
    !> The memory
    class(anderson_t), intent(inout) :: self
    !> Change of the displacement, (5, points)
    real(wp), intent(in) :: move(:, :)

    if (.not. self%waiting) return
    self%waiting = .false.
    if (self%plain) self%correction = move
    self%move = move
    self%comparable = .true.
  end subroutine note
end module anderson_acceleration
