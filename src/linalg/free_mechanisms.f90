!> Detects a numerically singular matrix: a mechanism of the structure. Packages that factorize without pivoting do not
!> report it, so one inverse iteration per factorization tests for it.
module free_mechanisms
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
  use communicators, only: communicator_t
  use kinds, only: wp
  implicit none
  private
  public :: mechanism_t

  !> Inverse of an eigenvalue that consists of rounding errors: five times the precision of 2.2e-16, as the matrix is
  !> scaled to a diagonal of 1
  real(wp), parameter :: largest_growth = 1e15_wp

  !> Inverse iteration for the smallest eigenvalue of the matrix with unit diagonal.
  type :: mechanism_t
    !> Solves that the search takes: two for a first factor, one for later ones
    integer :: passes = 0
    !> Approximate eigenvector of the smallest eigenvalue; its largest component is 1
    real(wp), allocatable, private :: mode(:)
    !> Roots of the matrix' diagonal
    real(wp), allocatable, private :: scale(:)
  contains
    !> Begins a search.
    procedure :: begin
    !> Right-hand side of the next solve.
    procedure :: right_hand_side
    !> Tests the solution.
    procedure :: assess
    !> Resets the eigenvector.
    procedure :: reset
  end type mechanism_t

contains

  !> Begins a search. The eigenvector found by the last one serves again.
  subroutine begin(self, diagonal)
    class(mechanism_t), intent(inout) :: self
    !> Diagonal of the matrix, of the rows that this rank owns
    real(wp), intent(in) :: diagonal(:)
    integer :: i

    self%scale = sqrt(abs(diagonal))
    self%passes = 1
    if (allocated(self%mode)) return
    self%passes = 2
    self%mode = [(cos(real(i, wp)), i=1, size(diagonal))]
  end subroutine begin

  !> Right-hand side of the next solve.
  pure function right_hand_side(self) result(values)
    class(mechanism_t), intent(in) :: self
    !> This rank's part of it
    real(wp), allocatable :: values(:)

    values = self%scale*self%mode
  end function right_hand_side

  !> Tests the solution.
  subroutine assess(self, communicator, solution, found)
    class(mechanism_t), intent(inout) :: self
    !> All ranks
    type(communicator_t), intent(in) :: communicator
    !> This rank's part of it
    real(wp), intent(in) :: solution(:)
    !> Whether a part of the structure can move freely
    logical, intent(out) :: found
    real(wp) :: growth

    found = communicator%any(.not. all(ieee_is_finite(solution)))
    if (.not. found) then
      self%mode = self%scale*solution
      growth = maxval(abs(self%mode))
      call communicator%maximum(growth)
      found = growth > largest_growth .or. .not. growth > 0
    end if
    if (found) then
      call self%reset()
    else
      self%mode = self%mode/growth
    end if
  end subroutine assess

  !> Resets the eigenvector.
  subroutine reset(self)
    class(mechanism_t), intent(inout) :: self

    if (allocated(self%mode)) deallocate (self%mode)
  end subroutine reset
end module free_mechanisms
