!> The equations of a border between ranks, once each rank has eliminated what is inside its own part: the sum of the
!> ranks' Schur complements, which they factor densely together (substructuring, Przemieniecki, AIAA J. 1, 1963).
module border_systems
  use communicators, only: communicator_t
  use kinds, only: wp
  use shared_triangles, only: shared_triangle_t
  implicit none
  private
  public :: border_system_t

  !> The border's equations.
  type :: border_system_t
    !> All ranks
    type(communicator_t), private :: communicator
    !> Place on the border of each of this rank's rows there
    integer, allocatable, private :: place(:)
    !> Their factor
    type(shared_triangle_t), private :: factor
  contains
    !> Sets the border's size.
    procedure :: define
    !> Adds the ranks' Schur complements up and factors the sum.
    procedure :: factorize
    !> Solves, between the two halves of the ranks' own solves.
    procedure :: solve
  end type border_system_t

contains

  !> Sets the border's size.
  subroutine define(self, communicator, rows, place)
    class(border_system_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> Rows of the border
    integer, intent(in) :: rows
    !> Place on the border of each of this rank's rows there
    integer, intent(in) :: place(:)

    self%communicator = communicator
    self%place = place
    call self%factor%define(communicator, rows)
  end subroutine define

  !> Adds the ranks' Schur complements up and factors the sum; called by all ranks together.
  subroutine factorize(self, complement, positive)
    class(border_system_t), intent(inout) :: self
    !> Schur complement of this rank's part, its lower triangle is read, (its rows, its rows)
    real(wp), intent(in) :: complement(:, :)
    !> Whether the sum is positive definite
    logical, intent(out) :: positive
    integer :: k

    self%factor%numbers = 0
    ! Places ascend, so that the lower triangle stays the lower one.
    do k = 1, size(complement, 1)
      self%factor%numbers(self%place(k:), self%place(k)) = complement(k:, k)
    end do
    call self%factor%factorize()
    positive = self%factor%positive
  end subroutine factorize

  !> Solves the border's equations; called by all ranks together.
  subroutine solve(self, forces, eliminated)
    class(border_system_t), intent(inout) :: self
    !> This rank's right-hand sides on the border: those of the equations that it owns, else zero, (border, columns)
    real(wp), intent(in) :: forces(:, :)
    !> On entry what eliminating the inside of right-hand sides without border leaves on this rank's rows there, the
    !> solution on return, (its rows, columns)
    real(wp), intent(inout) :: eliminated(:, :)
    real(wp), allocatable :: sums(:, :)

    sums = forces
    sums(self%place, :) = sums(self%place, :) + eliminated
    call self%communicator%sum(sums)
    if (size(sums, 2) == 1) then
      call self%factor%solve(sums(:, 1))
    else
      call self%factor%solve_many(sums)
    end if
    eliminated = sums(self%place, :)
  end subroutine solve
end module border_systems
