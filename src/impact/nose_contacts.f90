!> Contact of a spherical nose with a deformed face, point by point, theory (F12).
!>
!> Under a force P the face around the contact sinks by half of Hertz's indentation for P; the other half is local, as
!> on an elastic foundation (K. L. Johnson, Contact Mechanics, 1985, sections 4.2 and 4.3).
!> With the pressure (3 k/(2 pi R)) sqrt(2 x) at the local depth x, contact radius, pressure and force on a flat face
!> are those of Hertz. Pressures are derivatives of one convex energy: no point is pressed that does not touch.
!>
!> Each point has the part of the nose between two circles whose area is its own, so that its pressure is a mean, and
!> the force on a flat face is Hertz's for any spacing of points.
module nose_contacts
  use kinds, only: wp
  use mathematical_constants, only: pi
  implicit none
  private
  public :: nose_t, nose_contact_t, new_nose

  !> Distances from the struck point that differ by less, relative to their size, are equal.
  real(wp), parameter :: same_distance = 1.0e-9_wp
  !> Iterations for the settlement: bisection alone needs 60 for all digits, Newton's method takes 3 to 8.
  integer, parameter :: max_iterations = 100

  !> Points of the struck face within reach of the nose.
  type :: nose_t
    !> Radius of the nose
    real(wp) :: radius = 0
    !> Areas on the full plate, and heights of the nose's surface above its tip at the inner and the outer circle of
    !> each point, (points)
    real(wp), allocatable :: area(:), inner(:), outer(:)
  contains
    procedure :: first_contact
    procedure :: press
    procedure :: foundation
  end type nose_t

  !> Contact of the nose at one position.
  type :: nose_contact_t
    !> Indentation of a flat face with the same energy; negative: the gap
    real(wp) :: indentation = 0
    !> Force of the nose relative to that of a flat face with this indentation: a face bent around the nose is stiffer
    real(wp) :: gain = 1
    !> Area under pressure
    real(wp) :: area = 0
    !> Shares of the force, with the sum 1, and their increase with the local depth, (points)
    real(wp), allocatable :: weights(:), slopes(:)
  end type nose_contact_t

contains

  !> A nose over points.
  pure function new_nose(radius, area, distance) result(self)
    !> Radius of the nose
    real(wp), intent(in) :: radius
    !> Area of each point on the full plate, and its distance from the struck point, below the radius, (points)
    real(wp), intent(in) :: area(:), distance(:)
    type(nose_t) :: self
    real(wp) :: inside, within
    integer :: i

    self%radius = radius
    self%area = area
    allocate (self%inner(size(area)), self%outer(size(area)))
    do i = 1, size(area)
      inside = sum(area, mask=distance < distance(i)*(1 - same_distance))
      within = sum(area, mask=distance <= distance(i)*(1 + same_distance))
      self%inner(i) = rise(radius, inside)
      self%outer(i) = rise(radius, within)
    end do
    ! Points in the corners of the square around the nose.
    where (.not. self%outer > self%inner) self%area = 0
  end function new_nose

  !> Height of the nose's surface above its tip at the circle of an area.
  pure real(wp) function rise(radius, area)
    !> Radius of the nose, and the area
    real(wp), intent(in) :: radius, area
    real(wp) :: square

    square = min(radius**2, area/pi)
    rise = square/(radius + sqrt(radius**2 - square))
  end function rise

  !> Position of the tip at which the nose touches the face.
  pure real(wp) function first_contact(self, w)
    class(nose_t), intent(in) :: self
    !> Deflections of the points
    real(wp), intent(in) :: w(:)

    first_contact = minval(w + self%inner, mask=self%area > 0)
  end function first_contact

  !> Contact at a position of the nose.
  pure subroutine press(self, w, position, contact)
    class(nose_t), intent(in) :: self
    !> Deflections of the points
    real(wp), intent(in) :: w(:)
    !> Displacement of the tip
    real(wp), intent(in) :: position
    type(nose_contact_t), intent(out) :: contact
    real(wp) :: depth(size(w)), settlement, force, energy

    allocate (contact%weights(size(w)), contact%slopes(size(w)), source=0.0_wp)
    depth = position - (w + self%inner)
    where (.not. self%area > 0) depth = -1
    contact%indentation = position - self%first_contact(w)
    if (.not. contact%indentation > 0) return
    settlement = settlement_of(self, depth, contact%indentation)
    depth = depth - settlement
    call find_pressures(self, depth, contact, energy)
    force = sum(contact%weights)
    ! For an indentation below the round-off of the deflections no pressure may be left.
    if (.not. force > 0) then
      contact%weights = merge(1.0_wp, 0.0_wp, depth >= maxval(depth))
      contact%weights = contact%weights/sum(contact%weights)
      return
    end if
    energy = energy + 0.4_wp*force*settlement
    contact%indentation = (2.5_wp*energy)**0.4_wp
    contact%gain = force/contact%indentation**1.5_wp
    contact%weights = contact%weights/force
    contact%slopes = contact%slopes/force
  end subroutine press

  !> Forces of the points, up to a factor, as on an elastic foundation with the depth of half the indentation.
  pure function foundation(self, w, indentation) result(forces)
    class(nose_t), intent(in) :: self
    !> Deflections of the points
    real(wp), intent(in) :: w(:)
    !> The indentation
    real(wp), intent(in) :: indentation
    !> (points)
    real(wp) :: forces(size(w))

    associate (height => w + (self%inner + self%outer)/2)
      forces = self%area*max(0.0_wp, indentation/2 + minval(height, mask=self%area > 0) - height)
    end associate
  end function foundation

  !> Settlement of the face, half of Hertz's indentation for the force of the local depths, by Newton's method with a
  !> bracket. Forces and energies are divided by the contact stiffness k.
  pure real(wp) function settlement_of(self, depth, approach) result(settlement)
    class(nose_t), intent(in) :: self
    !> Depths without settlement, (points)
    real(wp), intent(in) :: depth(:)
    !> The largest of them
    real(wp), intent(in) :: approach
    real(wp) :: lower, upper, residual, change, force, slope
    integer :: iteration

    lower = 0
    upper = approach
    settlement = approach/2
    do iteration = 1, max_iterations
      call find_force(self, depth - settlement, force, slope)
      residual = settlement - force**(2/3.0_wp)/2
      if (residual > 0) then
        upper = settlement
      else
        lower = settlement
      end if
      change = -residual
      if (force > 0) change = -residual/(1 + slope*force**(-1/3.0_wp)/3)
      if (.not. (settlement + change > lower .and. settlement + change < upper)) &
        change = (lower + upper)/2 - settlement
      settlement = settlement + change
      if (abs(change) <= epsilon(change)*approach) exit
    end do
  end function settlement_of

  !> Force of local depths and its derivative, without the pressures.
  pure subroutine find_force(self, depth, force, slope)
    class(nose_t), intent(in) :: self
    !> Local depths at the inner circles, (points)
    real(wp), intent(in) :: depth(:)
    !> Force over k, and its derivative by the depth
    real(wp), intent(out) :: force, slope
    real(wp) :: above, below, share
    integer :: i

    force = 0
    slope = 0
    do i = 1, size(depth)
      if (.not. depth(i) > 0) cycle
      share = 3*self%area(i)/(2*pi*self%radius*(self%outer(i) - self%inner(i)))
      above = sqrt(2*depth(i))
      below = sqrt(2*max(0.0_wp, depth(i) - (self%outer(i) - self%inner(i))))
      force = force + share*(above**3 - below**3)/3
      slope = slope + share*(above - below)
    end do
  end subroutine find_force

  !> Forces of the points, their slopes, the local energy and the area under pressure: means over the circles of each
  !> point of the pressure sqrt(2 x) and its integral.
  pure subroutine find_pressures(self, depth, contact, energy)
    class(nose_t), intent(in) :: self
    !> Local depths at the inner circles, (points)
    real(wp), intent(in) :: depth(:)
    !> Receives weights and slopes, over k, and the area
    type(nose_contact_t), intent(inout) :: contact
    !> Local energy over k
    real(wp), intent(out) :: energy
    real(wp) :: above, below, width, share
    integer :: i

    energy = 0
    do i = 1, size(depth)
      if (.not. depth(i) > 0) cycle
      width = self%outer(i) - self%inner(i)
      share = 3*self%area(i)/(2*pi*self%radius*width)
      above = sqrt(2*depth(i))
      below = sqrt(2*max(0.0_wp, depth(i) - width))
      contact%weights(i) = share*(above**3 - below**3)/3
      contact%slopes(i) = share*(above - below)
      contact%area = contact%area + self%area(i)*min(1.0_wp, depth(i)/width)
      energy = energy + share*(above**5 - below**5)/15
    end do
  end subroutine find_pressures
end module nose_contacts
