!> Line search along a Newton correction, theory (N5): until the directional derivative is at most half of its initial
!> magnitude (H. Matthies, G. Strang, Int. J. Numer. Methods Eng. 14 (1979) 1613-1626). Along negative curvature the
!> step is extended.
!>
!> The active set of contacts is constant in a search and updated between corrections: contact is far stiffer than the
!> plate, so a search with a changing active set would end at each contact.
module line_searches
  use kinds, only: wp
  use composite_plates, only: composite_plate_t
  use solution_controls, only: newton_controls_t
  implicit none
  private
  public :: line_search_t

  !> A line search.
  type :: line_search_t
    !> Its constants
    type(newton_controls_t) :: controls
    !> True: a search is active
    logical :: on = .false.
    !> True: a direction of negative curvature, which may be extended
    logical :: negative_curvature = .false.
    !> Displacement before the correction, and the correction, (5, points)
    real(wp), allocatable :: start(:, :), direction(:, :)
    !> Fraction of the correction
    real(wp) :: fraction = 1
    !> Directional derivative of contact at the start of the search, and its decrease along the correction
    real(wp), private :: contact = 0, contact_decrease = 0
    !> Directional derivative at its start
    real(wp), private :: first = 0
    !> Bracket of the root of the directional derivative, and its values there
    real(wp), private :: low = 0, high = huge(1.0_wp), low_force = 0, high_force = 0
    !> Trials so far
    integer, private :: trials = 0
  contains
    procedure :: begin
    procedure :: assess
  end type line_search_t

contains

  !> Starts a search along a correction. Collective.
  subroutine begin(self, plate, start, direction, residual, smooth, contact_stiffness, negative_curvature)
    class(line_search_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Displacement before the correction, and the correction, (5, points)
    real(wp), intent(in) :: start(:, :), direction(:, :)
    !> Residual at the owned points, and without contacts and ties, (5, points)
    real(wp), intent(in) :: residual(:, :), smooth(:, :)
    !> Stiffness that contacts and ties add to three components, (3, points)
    real(wp), intent(in) :: contact_stiffness(:, :)
    !> True: a direction of negative curvature
    logical, intent(in) :: negative_curvature
    real(wp) :: sums(3)

    associate (owned => plate%distribution%owned)
      sums = [plate%product(direction, residual), plate%product(direction, smooth), &
              sum(contact_stiffness(:, :owned)*direction(:3, :owned)**2)]
    end associate
    call plate%communicator%sum(sums)
    self%first = sums(1)
    self%contact = sums(1) - sums(2)
    self%contact_decrease = sums(3)
    self%start = start
    self%direction = direction
    self%negative_curvature = negative_curvature
    self%fraction = 1
    self%low = 0
    self%low_force = self%first
    self%high = huge(self%high)
    self%trials = 0
    self%on = self%first > 0
  end subroutine begin

  !> Accepts the fraction if the directional derivative is small enough, otherwise chooses another one. Collective.
  subroutine assess(self, plate, smooth, ends)
    class(line_search_t), intent(inout) :: self
    type(composite_plate_t), intent(in) :: plate
    !> Residual at this fraction, without contacts and ties, (5, points)
    real(wp), intent(in) :: smooth(:, :)
    !> True: the fraction is accepted
    logical, intent(out) :: ends
    real(wp) :: force, part

    force = plate%product(self%direction, smooth)
    call plate%communicator%sum(force)
    force = force + self%contact - self%fraction*self%contact_decrease
    self%trials = self%trials + 1
    ends = abs(force) <= self%controls%search_slope*self%first .or. self%trials >= self%controls%search_trials &
           .or. force > 0 .and. .not. (self%negative_curvature .or. self%high < huge(self%high))
    self%on = .not. ends
    if (ends) return
    if (force > 0) then
      self%low = self%fraction
      self%low_force = force
    else
      self%high = self%fraction
      self%high_force = force
    end if
    if (self%high < huge(self%high)) then
      part = self%low_force/(self%low_force - self%high_force)
      part = min(self%controls%search_max_part, max(self%controls%search_min_part, part))
      self%fraction = self%low + part*(self%high - self%low)
    else
      self%fraction = 2*self%fraction
    end if
  end subroutine assess
end module line_searches
