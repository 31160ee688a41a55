!> How far a correction is taken: until the force along it is at most half of what it was, of either sign (H. Matthies,
!> G. Strang, Int. J. Numer. Methods Eng. 14 (1979) 1613-1626). Along negative curvature it is taken farther.
!>
!> Contacts count as they were when the correction was found. Their law is far stiffer than the plate, and which of them
!> touch settles from correction to correction (an active set); a search along them would stop at each.
module line_searches
  use kinds, only: wp
  use models, only: model_t
  implicit none
  private
  public :: line_search_t

  !> Force along the correction over that at its start with which it ends (Matthies and Strang).
  real(wp), parameter :: slope_left = 0.5_wp
  !> Parts of a bracket between which the next trial lies, and trials at most: an eighth trial is within 1e-3 of the
  !> bracket, and a correction that requires more is rejected.
  real(wp), parameter :: min_part = 0.1_wp, max_part = 0.9_wp
  integer, parameter :: max_trials = 8

  !> A search along a correction.
  type :: line_search_t
    !> True: there is one
    logical :: on = .false.
    !> True: a correction along negative curvature, which may be too short
    logical :: negative_curvature = .false.
    !> Displacement before the correction, and the correction, (5, points)
    real(wp), allocatable :: start(:, :), direction(:, :)
    !> Part of the correction taken
    real(wp) :: share = 1
    !> Work of contacts along it at its start, and its fall
    real(wp), private :: contact = 0, contact_decrease = 0
    !> Force along it at its start
    real(wp), private :: first = 0
    !> Parts taken between which the force changes its sign, and the force there
    real(wp), private :: low = 0, high = huge(1.0_wp), low_force = 0, high_force = 0
    !> Trials so far
    integer, private :: trials = 0
  contains
    !> Begins a search.
    procedure :: begin
    !> Judges the part taken, and chooses another one.
    procedure :: assess
  end type line_search_t

contains

  !> Begins a search along a correction. Collective.
  subroutine begin(self, model, start, direction, residual, smooth, contact_stiffness, negative_curvature)
    !> The search
    class(line_search_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Displacement before the correction, and the correction, (5, points)
    real(wp), intent(in) :: start(:, :), direction(:, :)
    !> Residual at the owned points, and without contacts and ties, (5, points)
    real(wp), intent(in) :: residual(:, :), smooth(:, :)
    !> What contacts and ties add to the stiffness of three components, (3, points)
    real(wp), intent(in) :: contact_stiffness(:, :)
    !> True: a correction along negative curvature
    logical, intent(in) :: negative_curvature
    real(wp) :: sums(3)

    associate (owned => model%distribution%owned)
      sums = [model%product(direction, residual), model%product(direction, smooth), &
              sum(contact_stiffness(:, :owned)*direction(:3, :owned)**2)]
    end associate
    call model%communicator%sum(sums)
    self%first = sums(1)
    self%contact = sums(1) - sums(2)
    self%contact_decrease = sums(3)
    self%start = start
    self%direction = direction
    self%negative_curvature = negative_curvature
    self%share = 1
    self%low = 0
    self%low_force = self%first
    self%high = huge(self%high)
    self%trials = 0
    self%on = self%first > 0
  end subroutine begin

  !> Judges the part taken by the force along it, and chooses another one where that is too large. Collective.
  subroutine assess(self, model, smooth, ends)
    !> The search
    class(line_search_t), intent(inout) :: self
    type(model_t), intent(in) :: model
    !> Residual at the part taken, without contacts and ties, (5, points)
    real(wp), intent(in) :: smooth(:, :)
    !> True: the part is taken
    logical, intent(out) :: ends
    real(wp) :: force, part

    force = model%product(self%direction, smooth)
    call model%communicator%sum(force)
    force = force + self%contact - self%share*self%contact_decrease
    self%trials = self%trials + 1
    ends = abs(force) <= slope_left*self%first .or. self%trials >= max_trials &
           .or. force > 0 .and. .not. (self%negative_curvature .or. self%high < huge(self%high))
    self%on = .not. ends
    if (ends) return
    if (force > 0) then
      self%low = self%share
      self%low_force = force
    else
      self%high = self%share
      self%high_force = force
    end if
    if (self%high < huge(self%high)) then
      part = self%low_force/(self%low_force - self%high_force)
      self%share = self%low + min(max_part, max(min_part, part))*(self%high - self%low)
    else
      self%share = 2*self%share
    end if
  end subroutine assess
end module line_searches
